/* Reading regular files. */
#define _FILE_OFFSET_BITS 64
#define _POSIX_C_SOURCE 200809L
#include "io/file.h"
#include "relief/math.h"

#include <errno.h>
#include <fcntl.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

io_bytes io_bytes_unmarked(const io_bytes *text)
{
    const size_t mark = text->size >= 3 && memcmp(text->data, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
    return mark == 0 ? *text : (io_bytes){text->name, text->data + mark, text->size - mark};
}

size_t io_bytes_lines(const io_bytes *text)
{
    size_t lines = 1;
    for (size_t i = 0; i < text->size; i++) {
        lines += text->data[i] == '\n' ? 1 : 0;
    }
    return lines;
}

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

rlf_result io_list_grow(void **items, int32_t count, int64_t more, int32_t *room, size_t size)
{
    if (count + more <= *room) {
        return RLF_OK;
    }
    const int64_t wanted = count + more > 2 * (int64_t)*room ? count + more : 2 * (int64_t)*room;
    void *grown = rlf_alloc_array((size_t)wanted, size);
    if (grown == NULL) {
        return RLF_ERROR_MEMORY;
    }
    if (count > 0) {
        memcpy(grown, *items, (size_t)count * size);
    }
    rlf_free(*items);
    *items = grown;
    *room = (int32_t)wanted;
    return RLF_OK;
}

rlf_result io_file_open(io_file *file, const char *path, const char *cure)
{
    file->descriptor = -1;
    file->size = 0;
    const size_t length = strlen(path);
    if (length >= IO_PATH_MAX) {
        return rlf_fail(RLF_ERROR_INVALID, "%.100s...: the path is too long: use a shorter one",
                        path);
    }
    memcpy(file->path, path, length + 1);
    /* Without O_NONBLOCK a pipe that nobody writes to would wait for ever. */
    file->descriptor = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    struct stat status;
    if (file->descriptor < 0 || fstat(file->descriptor, &status) != 0) {
        return rlf_fail(RLF_ERROR_IO, "%s: cannot be opened: %s: %s", path, strerror(errno), cure);
    }
    if (!S_ISREG(status.st_mode)) {
        close(file->descriptor);
        file->descriptor = -1;
        return rlf_fail(RLF_ERROR_IO, "%s: is not a regular file: give the name of a file", path);
    }
    file->size = (int64_t)status.st_size;
    io_reading_begin_file(file->descriptor);
    return RLF_OK;
}

void io_file_close(io_file *file)
{
    if (file->descriptor >= 0) {
        io_reading_end_file(file->descriptor);
        close(file->descriptor);
    }
    file->descriptor = -1;
}

size_t io_file_read_at(const io_file *file, int64_t position, void *out, size_t size)
{
    size_t done = 0;
    while (done < size) {
        const ssize_t got = pread(file->descriptor, (char *)out + done, size - done,
                                  (off_t)(position + (int64_t)done));
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got <= 0) {
            break;
        }
        done += (size_t)got;
    }
    return done;
}

rlf_result io_file_read_bytes(const io_file *file, int64_t position, size_t size, io_buffer *buffer,
                              io_bytes *out)
{
    rlf_result result = io_buffer_reserve(buffer, size);
    *out = (io_bytes){file->path, buffer->data, size};
    return result != RLF_OK || io_file_read_at(file, position, buffer->data, size) == size
               ? result
               : rlf_fail(RLF_ERROR_IO, "%s: cannot be read: check the disk", file->path);
}

static rlf_result read_whole(const io_file *file, size_t limit, io_buffer *buffer, io_bytes *out)
{
    if ((uintmax_t)file->size > limit) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: has %lld bytes, more than the %zu that such a file can need: check "
                        "that it is the right file",
                        file->path, (long long)file->size, limit);
    }
    const size_t size = (size_t)file->size;
    rlf_result result = io_buffer_reserve(buffer, size);
    if (result != RLF_OK) {
        return result;
    }
    errno = 0;
    const size_t got = io_file_read_at(file, 0, buffer->data, size);
    if (got < size && errno != 0) {
        return rlf_fail(RLF_ERROR_IO, "%s: cannot be read: %s: check the disk", file->path,
                        strerror(errno));
    }
    out->data = buffer->data;
    out->size = got;
    return RLF_OK;
}

rlf_result io_file_read(const char *path, size_t limit, const char *cure, io_buffer *buffer,
                        io_bytes *out)
{
    io_file file;
    *out = (io_bytes){.name = path};
    rlf_result result = io_file_open(&file, path, cure);
    if (result == RLF_OK) {
        result = read_whole(&file, limit, buffer, out);
        io_file_close(&file);
    }
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

bool io_path_exists(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0;
}

bool io_path_is_folder(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

bool io_folder_has(const char *folder, const char *name)
{
    char path[IO_PATH_MAX];
    const int length = snprintf(path, sizeof(path), "%s/%s", folder, name);
    return length > 0 && length < IO_PATH_MAX && io_path_exists(path);
}

/* ---- decimal numbers, whatever the locale ------------------------------------------------ */

#define TOKEN_MAX 127

int io_number_format(double x, char out[IO_NUMBER_SIZE])
{
    char text[IO_NUMBER_SIZE];
    snprintf(text, sizeof(text), "%.9g", x);
    int length = 0;
    for (const char *c = text; *c != '\0'; c++) {
        bool is_number = strchr("0123456789+-einfa", *c) != NULL;
        if (is_number) {
            out[length++] = *c;
        } else if (length == 0 || out[length - 1] != '.') {
            out[length++] = '.'; /* a point of several bytes becomes one */
        }
    }
    out[length] = '\0';
    return length;
}

bool io_number_parse(const char *token, double *out)
{
    size_t length = strlen(token);
    const char *point = localeconv()->decimal_point;
    size_t point_length = strlen(point);
    char text[TOKEN_MAX + 1];
    if (length == 0 || length + point_length > TOKEN_MAX ||
        strspn(token, "0123456789+-.eE") != length) {
        return false; /* strspn also keeps out "inf", "nan" and hexadecimal */
    }
    const char *dot = strchr(token, '.');
    if (dot == NULL) {
        memcpy(text, token, length + 1);
    } else {
        size_t before = (size_t)(dot - token);
        memcpy(text, token, before);
        memcpy(text + before, point, point_length);
        memcpy(text + before + point_length, dot + 1, length - before);
    }
    char *end = NULL;
    *out = strtod(text, &end);
    return *end == '\0' && end != text && rlf_is_finite(*out);
}
