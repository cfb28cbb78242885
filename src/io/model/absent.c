/* Stands in for import.c where it is not built. */
#include "io/model/model.h"

#include "base/messages.h"

rlf_result io_model_import(const io_bytes *file, io_model_format format, bool is_alone,
                           rlf_model **out)
{
    (void)format;
    (void)is_alone;
    *out = NULL;
    return rlf_fail(
        RLF_ERROR_UNSUPPORTED,
        "%s: models cannot be read by this build: use a convex OBJ as a hull, or " RLF_GET_PART(
            "libassimp-dev", "script/bootstrap", "RELIEF_WITH_MODELS"),
        file->name);
}
