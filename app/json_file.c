/* jansson's text through the writer of whole files. */
#include "json_file.h"

#include "relief/io.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

json_t *json_file_number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

rlf_result json_file_write(const char *path, json_t *root)
{
    char *text = root != NULL ? json_dumps(root, JSON_INDENT(2)) : NULL;
    json_decref(root);
    if (text == NULL) {
        return rlf_fail(RLF_ERROR_MEMORY, "%s: not enough memory for it", path);
    }
    rlf_result result = rlf_file_write(path, text, strlen(text));
    free(text);
    return result;
}
