/* NumPy arrays, format version 1.0 (NEP 1). */
#include "relief/io.h"
#include "io/file.h"
#include "io/little.h"

#include <string.h>

#define HEADER_ALIGNMENT 64
#define HEADER_MAX 256
#define PREFIX_SIZE 10 /* magic, version, header length */

/* The Python dictionary that describes the array, padded so that the data starts aligned. Returns
 * the whole header's size. */
static size_t format_header(rlf_npy_type type, const int64_t *shape, int32_t rank,
                            char out[HEADER_MAX])
{
    static const char *const descriptions[] = {"<f4", "<i4", "|u1"};
    char *text = out + PREFIX_SIZE;
    size_t room = HEADER_MAX - PREFIX_SIZE;
    size_t length = (size_t)snprintf(
        text, room, "{'descr': '%s', 'fortran_order': False, 'shape': (", descriptions[type]);
    for (int32_t i = 0; i < rank; i++) {
        length += (size_t)snprintf(text + length, room - length, "%lld,%s", (long long)shape[i],
                                   i + 1 < rank ? " " : "");
    }
    length += (size_t)snprintf(text + length, room - length, "), }");
    size_t unpadded = PREFIX_SIZE + length + 1;
    size_t total = (unpadded + HEADER_ALIGNMENT - 1) / HEADER_ALIGNMENT * HEADER_ALIGNMENT;
    memset(out + PREFIX_SIZE + length, ' ', total - PREFIX_SIZE - length);
    out[total - 1] = '\n';
    size_t stored = total - PREFIX_SIZE;
    memcpy(out, "\x93NUMPY\x01\x00", 8);
    out[8] = (char)(stored & 0xFF);
    out[9] = (char)(stored >> 8);
    return total;
}

rlf_result rlf_npy_write(const char *path, rlf_npy_type type, const void *data,
                         const int64_t *shape, int32_t rank)
{
    if (!RLF_ASSERT(path != NULL && data != NULL && shape != NULL) ||
        !RLF_ASSERT(rank >= 1 && rank <= 4) || !RLF_ASSERT((int)type >= 0 && type <= RLF_NPY_U8)) {
        return RLF_ERROR_INVALID;
    }
    uint64_t size = type == RLF_NPY_U8 ? 1 : 4;
    for (int32_t i = 0; i < rank; i++) {
        if (!RLF_ASSERT(shape[i] >= 0) ||
            !RLF_ASSERT(shape[i] == 0 || size <= (uint64_t)SIZE_MAX / 2 / (uint64_t)shape[i])) {
            return RLF_ERROR_INVALID;
        }
        size *= (uint64_t)shape[i];
    }
    char header[HEADER_MAX];
    size_t header_size = format_header(type, shape, rank, header);
    io_out_file file;
    rlf_result result = io_out_open(&file, path);
    if (result != RLF_OK) {
        return result;
    }
    result = io_out_write(&file, header, header_size);
    if (result == RLF_OK) {
        const size_t each = type == RLF_NPY_U8 ? 1 : 4;
        result = io_out_write_numbers(&file, data, (size_t)size / each, each);
    }
    return io_out_close(&file, result);
}
