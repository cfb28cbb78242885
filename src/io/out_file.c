/* Files that appear only when they are whole. */
#define _DEFAULT_SOURCE /* flock */
#define _POSIX_C_SOURCE 200809L
#include "io/file.h"

#include "io/little.h"
#include "relief/io.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#define PART_SIZE 48 /* bytes of ".PID-N.part" and its ending zero */

static rlf_result fail_create(const char *path)
{
    return rlf_fail(RLF_ERROR_IO,
                    "%s: cannot be created: %s: choose a folder that exists and that you may write "
                    "to",
                    path, strerror(errno));
}

/* Sets path and is_direct, and refuses folders. */
static rlf_result prepare(io_out_file *file, const char *path)
{
    memset(file, 0, sizeof(*file));
    size_t length = strlen(path);
    if (length == 0 || length + PART_SIZE > IO_PATH_MAX) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "\"%.100s\": is not a usable file name: give one of 1 to %d bytes", path,
                        IO_PATH_MAX - PART_SIZE);
    }
    struct stat status;
    bool exists = stat(path, &status) == 0;
    if (exists && S_ISDIR(status.st_mode)) {
        return rlf_fail(RLF_ERROR_IO, "%s: is a folder: give the name of a file in it", path);
    }
    rlf_result result = io_reading_check_file(path);
    if (result != RLF_OK) {
        return result;
    }
    file->is_direct = exists && !S_ISREG(status.st_mode);
    memcpy(file->path, path, length + 1);
    if (file->is_direct) {
        memcpy(file->part, path, length + 1);
    }
    return RLF_OK;
}

/* A new file under a name that no other thread or program has. */
static int create_part(io_out_file *file)
{
    static _Atomic unsigned counter;
    const size_t length = strlen(file->path);
    int descriptor = -1;
    memcpy(file->part, file->path, length);
    do {
        snprintf(file->part + length, PART_SIZE, ".%ld-%u.part", (long)getpid(),
                 atomic_fetch_add(&counter, 1u));
        descriptor = open(file->part, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (descriptor < 0 && errno == EEXIST);
    return descriptor;
}

rlf_result io_out_open(io_out_file *file, const char *path)
{
    rlf_result result = prepare(file, path);
    if (result != RLF_OK) {
        return result;
    }
    const int descriptor = file->is_direct ? open(path, O_WRONLY | O_CLOEXEC) : create_part(file);
    file->stream = descriptor >= 0 ? fdopen(descriptor, "wb") : NULL;
    if (file->stream != NULL) {
        return RLF_OK;
    }
    result = fail_create(path);
    if (descriptor >= 0) {
        close(descriptor);
        io_out_settle(file, result);
    }
    return result;
}

static rlf_result fail_write(const io_out_file *file)
{
    return rlf_fail(RLF_ERROR_IO, "%s: cannot be written: %s: free some space or write elsewhere",
                    file->path, strerror(file->write_errno));
}

rlf_result io_out_write(io_out_file *file, const void *data, size_t size)
{
    if (file->write_errno == 0 && size > 0 && fwrite(data, 1, size, file->stream) != size) {
        file->write_errno = errno != 0 ? errno : EIO;
    }
    return file->write_errno == 0 ? RLF_OK : fail_write(file);
}

rlf_result io_out_write_numbers(io_out_file *file, const void *numbers, size_t count, size_t size)
{
    uint8_t part[4096];
    const size_t most = sizeof(part) / size;
    const uint8_t *from = numbers;
    rlf_result result = RLF_OK;
    if (!IO_IS_BIG_ENDIAN) {
        return io_out_write(file, numbers, count * size);
    }
    while (count > 0 && result == RLF_OK) {
        const size_t some = count < most ? count : most;
        memcpy(part, from, some * size);
        io_little(part, some, size);
        result = io_out_write(file, part, some * size);
        from += some * size;
        count -= some;
    }
    return result;
}

rlf_result io_out_finish(io_out_file *file, rlf_result result)
{
    if (file->stream == NULL) {
        return result;
    }
    /* Both may be the first to notice a full disk. */
    if (fflush(file->stream) != 0 && file->write_errno == 0) {
        file->write_errno = errno;
    }
    if (fclose(file->stream) != 0 && file->write_errno == 0) {
        file->write_errno = errno;
    }
    file->stream = NULL;
    /* What the caller says after a failed write is a consequence of it. */
    return file->write_errno != 0 ? fail_write(file) : result;
}

rlf_result io_out_settle(const io_out_file *file, rlf_result result)
{
    if (file->is_direct || file->part[0] == '\0') {
        return result;
    }
    if (result == RLF_OK && rename(file->part, file->path) != 0) {
        result = rlf_fail(RLF_ERROR_IO, "%s: cannot be renamed from %s: %s: choose another name",
                          file->path, file->part, strerror(errno));
    }
    if (result != RLF_OK) {
        remove(file->part);
    }
    return result;
}

rlf_result io_out_close(io_out_file *file, rlf_result result)
{
    if (file->stream == NULL) {
        return result;
    }
    return io_out_settle(file, io_out_finish(file, result));
}

rlf_result io_out_open_in_place(const char *path, int *out_descriptor)
{
    *out_descriptor = -1;
    rlf_result result = io_reading_check_file(path);
    if (result != RLF_OK) {
        return result;
    }
    *out_descriptor = open(path, O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (*out_descriptor < 0) {
        return fail_create(path);
    }
    if (flock(*out_descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        result = rlf_fail(RLF_ERROR_IO,
                          "%s: cannot be created: another program is writing it: choose another "
                          "name",
                          path);
    } else if (ftruncate(*out_descriptor, 0) != 0 && errno != EINVAL) { /* EINVAL: a device */
        result = fail_create(path);
    }
    if (result != RLF_OK) {
        close(*out_descriptor);
        *out_descriptor = -1;
    }
    return result;
}

rlf_result rlf_file_write(const char *path, const void *data, size_t size)
{
    if (!RLF_ASSERT(path != NULL && (data != NULL || size == 0))) {
        return RLF_ERROR_INVALID;
    }
    io_out_file file;
    rlf_result result = io_out_open(&file, path);
    if (result != RLF_OK) {
        return result;
    }
    return io_out_close(&file, io_out_write(&file, data, size));
}

rlf_result rlf_file_check(const char *path)
{
    if (!RLF_ASSERT(path != NULL)) {
        return RLF_ERROR_INVALID;
    }
    io_out_file file;
    rlf_result result = prepare(&file, path);
    if (result != RLF_OK || file.is_direct) {
        return result;
    }
    const int descriptor = create_part(&file);
    if (descriptor < 0) {
        return fail_create(path);
    }
    close(descriptor);
    remove(file.part);
    return RLF_OK;
}

/* ---- folders for output ------------------------------------------------------------------ */

/* mkdir that is content with a folder that is there, also when another process just made it. */
static rlf_result make_one(const char *path)
{
    if (mkdir(path, 0777) == 0) {
        return RLF_OK;
    }
    const int code = errno; /* before the next call has one of its own */
    if (io_path_is_folder(path)) {
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
