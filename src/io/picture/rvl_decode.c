/* RVL: from bytes to depth. The bytes may be anything. */
#include "io/picture/pixels.h"
#include "io/little.h"

#include <string.h>

/* Bits of the stream, the next one highest. Behind the end there are zeros, and what was taken of
 * them makes `bits` negative once the real ones are used up. */
typedef struct nibble_reader {
    const uint8_t *data, *end;
    uint64_t ahead;
    int32_t bits;
} nibble_reader;

/* At least 32 bits ahead, as long as there are any. */
static inline void refill(nibble_reader *r)
{
    if (r->bits <= 32 && r->end - r->data >= 4) {
        uint32_t word;
        io_little_read(r->data, &word, 4);
        r->data += 4;
        r->ahead |= (uint64_t)word << (32 - r->bits);
        r->bits += 32;
    }
}

static inline void skip(nibble_reader *r, int32_t bits)
{
    r->ahead <<= bits;
    r->bits -= bits;
}

/* False when the number has more than 30 bits or the stream has ended. */
static bool read_number(nibble_reader *r, uint32_t *out)
{
    uint32_t value = 0;
    for (uint32_t shift = 0; shift < 30; shift += 3) {
        refill(r);
        const uint32_t nibble = (uint32_t)(r->ahead >> 60);
        skip(r, 4);
        value |= (nibble & 7) << shift;
        if ((nibble & 8) == 0) {
            *out = value;
            return r->bits >= 0;
        }
    }
    return false;
}

/* `count` measured pixels; *previous is the one before and becomes the last. */
static bool read_run(const io_rvl *rvl, nibble_reader *reader, uint16_t *out, size_t count,
                     uint32_t *previous)
{
    nibble_reader r = *reader; /* in registers */
    uint32_t last = *previous;
    size_t i = 0;
    while (i < count) {
        refill(&r);
        const io_rvl_entry e = rvl->decode[r.ahead >> 52];
        if (e.count > 0 && count - i >= 3) {
            out[i] = (uint16_t)(last + (uint32_t)e.sum[0]);
            out[i + 1] = (uint16_t)(last + (uint32_t)e.sum[1]);
            out[i + 2] = (uint16_t)(last + (uint32_t)e.sum[2]);
            last += (uint32_t)e.sum[2];
            i += e.count;
            skip(&r, e.bits);
            if (r.bits < 0) {
                return false;
            }
            continue;
        }
        uint32_t value;
        if (!read_number(&r, &value)) {
            return false;
        }
        last += value >> 1 ^ (0u - (value & 1));
        out[i++] = (uint16_t)last;
    }
    *previous = last;
    *reader = r;
    return true;
}

bool io_rvl_decode(const io_rvl *rvl, const uint8_t *data, size_t size, uint16_t *out, size_t count)
{
    nibble_reader r = {.data = data, .end = data + size};
    uint32_t previous = 0;
    for (size_t i = 0; i < count;) {
        uint32_t missing, measured;
        if (!read_number(&r, &missing) || missing > count - i) {
            return false;
        }
        memset(out + i, 0, missing * sizeof(out[0]));
        i += missing;
        if (!read_number(&r, &measured) || measured > count - i ||
            !read_run(rvl, &r, out + i, measured, &previous)) {
            return false;
        }
        i += measured;
    }
    return true;
}
