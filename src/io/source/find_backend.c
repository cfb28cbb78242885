/* Which back end opens a SOURCE. */
#define _POSIX_C_SOURCE 200809L
#include "io/source/find_backend.h"

#include "io/source/backends.h"
#include "io/source/absent.h"

#include <string.h>
#include <strings.h>
#include <sys/stat.h>

/* Whether `list`, words with blanks between, has the extension of `path`. */
static bool has_extension(const char *path, const char *list)
{
    const char *dot = strrchr(path, '.');
    if (dot == NULL || list == NULL || strchr(dot, '/') != NULL) {
        return false;
    }
    size_t length = strlen(dot);
    for (const char *word = list; *word != '\0'; word += strspn(word, " ")) {
        size_t size = strcspn(word, " ");
        if (size == length && strncasecmp(word, dot, size) == 0) {
            return true;
        }
        word += size;
    }
    return false;
}

static const rlf_backend *by_scheme(const char *scheme)
{
    const rlf_backend *b;
    for (int32_t i = 0; (b = io_backend_at(i)) != NULL; i++) {
        if (strcmp(b->scheme, scheme) == 0) {
            return b;
        }
    }
    return NULL;
}

static const rlf_backend *by_path(const char *path)
{
    const rlf_backend *b;
    for (int32_t i = 0; (b = io_backend_at(i)) != NULL; i++) {
        if (has_extension(path, b->extensions)) {
            return b;
        }
    }
    for (int32_t i = 0; (b = io_backend_at(i)) != NULL; i++) {
        if (b->recognises != NULL && b->recognises(path)) {
            return b;
        }
    }
    return NULL;
}

static rlf_result fail_absent(const char *source, const io_backend_absent *a)
{
    return rlf_fail(RLF_ERROR_UNSUPPORTED,
                    "%s: this build was made without %s: configure it with -D%s=ON", source,
                    a->scheme, a->option);
}

static rlf_result fail_scheme(const char *source, const char *scheme)
{
    const io_backend_absent *a;
    for (int32_t i = 0; (a = io_backend_absent_at(i)) != NULL; i++) {
        if (strcmp(a->scheme, scheme) == 0) {
            return fail_absent(source, a);
        }
    }
    return rlf_fail(RLF_ERROR_UNSUPPORTED,
                    "%s: this build has no source \"%.40s:\": `relief sources` lists what it can "
                    "open, e.g. synthetic:room or a folder with depth.txt and camera.json",
                    source, scheme);
}

static rlf_result fail_path(const char *source, const char *path)
{
    struct stat status;
    if (stat(path, &status) != 0) {
        return rlf_fail(RLF_ERROR_IO,
                        "%s: no such file or folder: give a folder with depth.txt and "
                        "camera.json, a recording, or synthetic:room",
                        source);
    }
    const io_backend_absent *a;
    for (int32_t i = 0; (a = io_backend_absent_at(i)) != NULL; i++) {
        if (has_extension(path, a->extensions)) {
            return fail_absent(source, a);
        }
    }
    return rlf_fail(RLF_ERROR_UNSUPPORTED,
                    "%s: is a file of a kind that this build cannot open: give the folder that "
                    "holds depth.txt and camera.json, or what `relief sources` lists",
                    source);
}

rlf_result io_backend_find(const char *source, const io_address *address, const rlf_backend **out)
{
    const bool is_path = address->scheme[0] == '\0';
    *out = is_path ? by_path(address->place) : by_scheme(address->scheme);
    if (*out == NULL) {
        return is_path ? fail_path(source, address->place) : fail_scheme(source, address->scheme);
    }
    const char *reason = (*out)->unavailable != NULL ? (*out)->unavailable() : NULL;
    return reason == NULL
               ? RLF_OK
               : rlf_fail(RLF_ERROR_UNSUPPORTED, "%s: cannot be opened: %s", source, reason);
}
