/* From the SOURCE of a command line to a source. */
#define _POSIX_C_SOURCE 200809L
#include "relief/io.h"

#include <string.h>
#include <sys/stat.h>

static rlf_result open_synthetic(const char *source, rlf_pool *pool, rlf_source **out)
{
    rlf_synthetic_def def = rlf_synthetic_def_default();
    rlf_result result = rlf_synthetic_parse(source, &def);
    if (result != RLF_OK) {
        return result;
    }
    def.pool = pool;
    return rlf_synthetic_create(&def, out);
}

/* Length of "name:" at the start, with the colon; 0 when there is none. */
static size_t scheme_length(const char *source)
{
    size_t length = strspn(source, "abcdefghijklmnopqrstuvwxyz0123456789_-");
    return length > 0 && source[length] == ':' ? length + 1 : 0;
}

rlf_result rlf_open_source(const char *source, rlf_pool *pool, rlf_source **out)
{
    if (!RLF_ASSERT(source != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    if (source[0] == '\0') {
        return rlf_fail(RLF_ERROR_INVALID, "the SOURCE is empty: give synthetic:room or a folder "
                                           "with depth.txt and camera.json");
    }
    if (strncmp(source, "synthetic:", strlen("synthetic:")) == 0) {
        return open_synthetic(source, pool, out);
    }
    size_t scheme = scheme_length(source);
    struct stat status;
    if (scheme > 0 && stat(source, &status) != 0) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: this build has no source \"%.*s\": use synthetic:NAME (room, empty, "
                        "thesis, chair, book, hand) or a folder with depth.txt and camera.json",
                        source, (int)(scheme < 40 ? scheme : 40), source);
    }
    return rlf_folder_source_open(source, out);
}
