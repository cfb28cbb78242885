/* Paths without links and "..", compared. */
#define _XOPEN_SOURCE 700
#include "io/model/beside.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#ifndef PATH_MAX
#define PATH_MAX 4096
#endif

/* The model's folder as it is named, without links. */
static bool real_folder(const char *model, char out[PATH_MAX])
{
    char folder[IO_PATH_MAX] = ".";
    const char *slash = strrchr(model, '/');
    const size_t length = slash != NULL ? (size_t)(slash - model) + 1 : 0;
    if (length >= sizeof(folder)) {
        return false;
    }
    if (length > 0) {
        memcpy(folder, model, length);
        folder[length] = '\0';
    }
    return realpath(folder, out) != NULL;
}

static bool is_below(const char *folder, const char *path)
{
    const size_t length = strcmp(folder, "/") == 0 ? 0 : strlen(folder);
    return strncmp(folder, path, length) == 0 && path[length] == '/';
}

rlf_result io_model_beside(const char *model, const char *path, char out[IO_PATH_MAX])
{
    char folder[PATH_MAX], real[PATH_MAX];
    const bool is_there = realpath(path, real) != NULL;
    if (is_there && (!real_folder(model, folder) || !is_below(folder, real))) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: names %s, which is outside of the model's folder and is not read: put "
                        "it beside the model",
                        model, path);
    }
    const char *read = is_there ? real : path; /* who reads it says what is wrong */
    if (strlen(read) >= IO_PATH_MAX) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: the path is longer than %d bytes: use shorter names", path,
                        IO_PATH_MAX - 1);
    }
    memcpy(out, read, strlen(read) + 1);
    return RLF_OK;
}
