/* From the parts that a back end makes to a source. */
#include "io/source/backends.h"

rlf_result io_source_create(const rlf_opened *opened, rlf_source **out)
{
    rlf_result result =
        rlf_source_create_custom(&opened->methods, &opened->info, opened->self, out);
    if (result != RLF_OK && opened->methods.destroy != NULL) {
        opened->methods.destroy(opened->self);
    }
    return result;
}
