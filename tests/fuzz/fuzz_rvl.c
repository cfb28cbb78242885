/* RVL: any bytes give a picture of the size asked for, or none. */
#include "fuzz.h"

#include "io/picture/pixels.h"

#include <stdlib.h>

#define COUNT_MAX 4096

size_t fuzz_seed(int index, uint8_t *out, size_t capacity)
{
    if (index > 2) {
        return 0;
    }
    static io_rvl rvl;
    uint16_t depth[1200];
    uint8_t bytes[3 * 1200 + 64];
    io_rvl_init(&rvl);
    for (int i = 0; i < 1200; i++) {
        depth[i] = (uint16_t)(i % 17 == 0  ? 0
                              : index == 0 ? 1000 + i % 40
                                           : i * 7919 * (index + 1));
    }
    const size_t size = io_rvl_encode(&rvl, depth, 1200, bytes);
    if (size > capacity) {
        return 0;
    }
    memcpy(out, bytes, size);
    return size;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static io_rvl rvl;
    if (rvl.encode[1] == 0) {
        io_rvl_init(&rvl);
    }
    const size_t count = size > 0 ? (size_t)data[0] * 1200 / 255 + 1 : 1200;
    uint16_t *out = malloc(count * sizeof(out[0]));
    uint8_t *again = malloc(io_rvl_bound(count));
    uint16_t *back = malloc(count * sizeof(back[0]));
    if (out != NULL && again != NULL && back != NULL &&
        io_rvl_decode(&rvl, data, size, out, count)) {
        /* What was read can be written and read again. */
        const size_t length = io_rvl_encode(&rvl, out, count, again);
        if (!io_rvl_decode(&rvl, again, length, back, count) ||
            memcmp(out, back, count * sizeof(out[0])) != 0) {
            abort();
        }
    }
    free(out);
    free(again);
    free(back);
    return 0;
}
