/* Folders for output. */
#define _POSIX_C_SOURCE 200809L
#include "relief/io.h"
#include "io/file.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

static bool is_folder(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

/* mkdir that is content with a folder that is there, also when another process just made it. */
static rlf_result make_one(const char *path)
{
    if (mkdir(path, 0777) == 0) {
        return RLF_OK;
    }
    const int code = errno; /* before is_folder has one of its own */
    if (is_folder(path)) {
        return RLF_OK;
    }
    return rlf_fail(RLF_ERROR_IO,
                    "%s: the folder cannot be made: %s: choose a place that you may "
                    "write to",
                    path, code == EEXIST ? "a file of that name exists" : strerror(code));
}

rlf_result rlf_make_folder(const char *path)
{
    if (!RLF_ASSERT(path != NULL)) {
        return RLF_ERROR_INVALID;
    }
    size_t length = strlen(path);
    if (length == 0 || length >= IO_PATH_MAX) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "\"%.100s\": is not a usable folder name: give one of 1 "
                        "to %d bytes",
                        path, IO_PATH_MAX - 1);
    }
    char part[IO_PATH_MAX];
    memcpy(part, path, length + 1);
    for (size_t i = 1; i < length; i++) {
        if (part[i] != '/' || part[i - 1] == '/') {
            continue;
        }
        part[i] = '\0';
        rlf_result result = make_one(part);
        if (result != RLF_OK) {
            return result;
        }
        part[i] = '/';
    }
    rlf_result result = io_reading_check_folder(part);
    return result == RLF_OK ? make_one(part) : result;
}
