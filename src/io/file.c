/* Reading whole files and writing files that appear only when they are whole. */
#define _POSIX_C_SOURCE 200809L
#include "io/file.h"

#include "relief/io.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

rlf_result io_buffer_reserve(io_buffer *buffer, size_t size)
{
    if (size <= buffer->capacity) {
        return RLF_OK;
    }
    /* Half as much again, so that a clip of slowly growing files soon stops allocating. */
    size_t capacity = size + size / 2;
    uint8_t *data = rlf_alloc(capacity);
    if (data == NULL) {
        return RLF_ERROR_MEMORY;
    }
    rlf_free(buffer->data);
    buffer->data = data;
    buffer->capacity = capacity;
    return RLF_OK;
}

void io_buffer_free(io_buffer *buffer)
{
    rlf_free(buffer->data);
    buffer->data = NULL;
    buffer->capacity = 0;
}

static rlf_result read_stream(FILE *stream, const char *path, size_t limit, io_buffer *buffer,
                              io_bytes *out)
{
    struct stat status;
    if (fstat(fileno(stream), &status) != 0 || !S_ISREG(status.st_mode)) {
        return rlf_fail(RLF_ERROR_IO, "%s: is not a regular file: give the name of a file", path);
    }
    if (status.st_size < 0 || (uintmax_t)status.st_size > limit) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: has %lld bytes, more than the %zu that such a file can need: check "
                        "that it is the right file",
                        path, (long long)status.st_size, limit);
    }
    size_t size = (size_t)status.st_size;
    rlf_result result = io_buffer_reserve(buffer, size);
    if (result != RLF_OK) {
        return result;
    }
    size_t got = fread(buffer->data, 1, size, stream);
    if (ferror(stream)) {
        return rlf_fail(RLF_ERROR_IO, "%s: cannot be read: %s: check the disk", path,
                        strerror(errno));
    }
    *out = (io_bytes){path, buffer->data, got};
    return RLF_OK;
}

rlf_result io_file_read(const char *path, size_t limit, const char *cure, io_buffer *buffer,
                        io_bytes *out)
{
    FILE *stream = fopen(path, "rb");
    if (stream == NULL) {
        return rlf_fail(RLF_ERROR_IO, "%s: cannot be opened: %s: %s", path, strerror(errno), cure);
    }
    rlf_result result = read_stream(stream, path, limit, buffer, out);
    fclose(stream);
    return result;
}

rlf_result io_path_join(const char *folder, const char *name, char out[IO_PATH_MAX])
{
    bool is_absolute = name[0] == '/';
    int length = is_absolute ? snprintf(out, IO_PATH_MAX, "%s", name)
                             : snprintf(out, IO_PATH_MAX, "%s/%s", folder, name);
    if (length < 0 || length >= IO_PATH_MAX) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%.100s/%.100s: the path is longer than %d bytes: use "
                        "shorter names",
                        folder, name, IO_PATH_MAX - 1);
    }
    return RLF_OK;
}

rlf_result io_out_prepare(io_out_file *file, const char *path)
{
    memset(file, 0, sizeof(*file));
    size_t length = strlen(path);
    if (length == 0 || length + sizeof(".part") > IO_PATH_MAX) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "\"%.100s\": is not a usable file name: give one of 1 "
                        "to %d bytes",
                        path, IO_PATH_MAX - (int)sizeof(".part"));
    }
    struct stat status;
    bool exists = stat(path, &status) == 0;
    if (exists && S_ISDIR(status.st_mode)) {
        return rlf_fail(RLF_ERROR_IO, "%s: is a folder: give the name of a file in it", path);
    }
    file->is_direct = exists && !S_ISREG(status.st_mode);
    memcpy(file->path, path, length + 1);
    memcpy(file->part, path, length + 1);
    if (!file->is_direct) {
        memcpy(file->part + length, ".part", sizeof(".part"));
    }
    return RLF_OK;
}

rlf_result io_out_open(io_out_file *file, const char *path)
{
    rlf_result result = io_out_prepare(file, path);
    if (result != RLF_OK) {
        return result;
    }
    file->stream = fopen(file->part, "wb");
    if (file->stream == NULL) {
        return rlf_fail(RLF_ERROR_IO,
                        "%s: cannot be created: %s: choose a folder that exists and "
                        "that you may write to",
                        path, strerror(errno));
    }
    return RLF_OK;
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

rlf_result io_out_commit(const io_out_file *file)
{
    if (!file->is_direct && rename(file->part, file->path) != 0) {
        rlf_result result =
            rlf_fail(RLF_ERROR_IO, "%s: cannot be renamed from %s: %s: choose another name",
                     file->path, file->part, strerror(errno));
        remove(file->part);
        return result;
    }
    return RLF_OK;
}

void io_out_discard(const io_out_file *file)
{
    if (!file->is_direct) {
        remove(file->part);
    }
}

rlf_result io_out_close(io_out_file *file, rlf_result result)
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
    if (result == RLF_OK && file->write_errno == 0) {
        return io_out_commit(file);
    }
    io_out_discard(file);
    return result != RLF_OK ? result : fail_write(file);
}

rlf_result rlf_file_write(const char *path, const void *data, size_t size)
{
    io_out_file file;
    rlf_result result = io_out_open(&file, path);
    if (result != RLF_OK) {
        return result;
    }
    return io_out_close(&file, io_out_write(&file, data, size));
}

rlf_result rlf_file_check(const char *path)
{
    io_out_file file;
    rlf_result result = io_out_prepare(&file, path);
    if (result != RLF_OK || file.is_direct) {
        return result;
    }
    result = io_out_open(&file, path);
    if (result == RLF_OK) {
        fclose(file.stream);
        io_out_discard(&file);
    }
    return result;
}
