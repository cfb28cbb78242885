/* Maps of rooms as files. */
#include "relief/io.h"
#include "io/file.h"

#include <string.h>

static bool write_some(void *context, const void *data, size_t size)
{
    return io_out_write(context, data, size) == RLF_OK;
}

rlf_result rlf_map_write_file(const rlf_map *map, const char *path)
{
    if (!RLF_ASSERT(map != NULL && path != NULL)) {
        return RLF_ERROR_INVALID;
    }
    io_out_file file;
    rlf_result result = io_out_open(&file, path);
    if (result != RLF_OK) {
        return result;
    }
    return io_out_close(&file, rlf_map_save(map, write_some, &file));
}

/* A file read from its beginning to its end. */
typedef struct map_reader {
    io_file file;
    int64_t position;
    uint8_t ahead[65536];
    size_t ahead_size, ahead_read;
} map_reader;

static bool read_some(void *context, void *data, size_t size)
{
    map_reader *r = context;
    uint8_t *out = data;
    while (size > 0) {
        if (r->ahead_read == r->ahead_size) {
            r->ahead_size = io_file_read_at(&r->file, r->position, r->ahead, sizeof(r->ahead));
            r->position += (int64_t)r->ahead_size;
            r->ahead_read = 0;
        }
        size_t part = r->ahead_size - r->ahead_read;
        part = part < size ? part : size;
        if (part == 0) {
            return false;
        }
        memcpy(out, r->ahead + r->ahead_read, part);
        r->ahead_read += part;
        out += part;
        size -= part;
    }
    return true;
}

rlf_result rlf_map_read_file(rlf_map *map, const char *path)
{
    if (!RLF_ASSERT(map != NULL && path != NULL)) {
        return RLF_ERROR_INVALID;
    }
    map_reader *r = rlf_alloc(sizeof(*r));
    if (r == NULL) {
        return RLF_ERROR_MEMORY;
    }
    rlf_result result = io_file_open(&r->file, path, "make one with `relief run --save-map`");
    if (result == RLF_OK) {
        result = rlf_map_load(map, read_some, r);
        if (result < 0) {
            char cause[1024];
            (void)snprintf(cause, sizeof(cause), "%s", rlf_error_text());
            result = rlf_fail(result, "%s: %s", path, cause);
        }
        io_file_close(&r->file);
    }
    rlf_free(r);
    return result;
}
