/* Depth of .oni files: differences from pixel to pixel in half bytes.
 *
 *   [u16 n, n times u16]  the table, where there is one
 *   u16                   first value
 *   hi lo                 two pixels, each lower by the half byte - 6 (0..12); a low one of 13 is
 *                         none
 *   hi F, FF              (one pixel as above, then) one pixel by the next byte b: lower by
 *                         b - 192 where b >= 128, else the value is b * 256 + the byte after it
 *   E1..EF                one to fifteen pairs of pixels that do not change */
#include "io/formats/oni.h"

#define ZERO_STEP 6
#define NO_PIXEL 0x0D
#define ESCAPE 0x0F
#define PAIRS 0xE0
#define FULL_ESCAPE 0xFF
#define SMALL_STEP 192

typedef struct decoder {
    const uint8_t *data, *end;
    const uint8_t *table; /* NULL = values stand for themselves */
    size_t table_count;
    uint16_t *out, *out_end;
    uint16_t value;
} decoder;

static uint16_t read_u16(const uint8_t *p)
{
    return (uint16_t)(p[0] | p[1] << 8);
}

static bool put(decoder *d)
{
    if (d->out == d->out_end || (d->table != NULL && d->value >= d->table_count)) {
        return false;
    }
    *d->out++ = d->table != NULL ? read_u16(d->table + (ptrdiff_t)2 * d->value) : d->value;
    return true;
}

static bool step(decoder *d, int down)
{
    d->value = (uint16_t)(d->value - down);
    return put(d);
}

static bool put_escaped(decoder *d)
{
    if (d->end - d->data < 1) {
        return false;
    }
    const uint8_t b = *d->data++;
    if (b >= 0x80) {
        return step(d, b - SMALL_STEP);
    }
    if (d->end - d->data < 1) {
        return false;
    }
    d->value = (uint16_t)(b << 8 | *d->data++);
    return put(d);
}

static bool put_pairs(decoder *d, int count)
{
    bool is_good = true;
    for (int i = 0; i < 2 * count && is_good; i++) {
        is_good = put(d);
    }
    return is_good;
}

static bool put_code(decoder *d, uint8_t code)
{
    if (code == FULL_ESCAPE) {
        return put_escaped(d);
    }
    if (code >= PAIRS) {
        return put_pairs(d, code - PAIRS);
    }
    const int low = code & 0x0F;
    if (!step(d, (code >> 4) - ZERO_STEP)) {
        return false;
    }
    if (low == ESCAPE) {
        return put_escaped(d);
    }
    return low == NO_PIXEL || step(d, low - ZERO_STEP);
}

bool oni_depth_decode(const uint8_t *data, size_t size, bool has_table, uint16_t *out, size_t count)
{
    decoder d = {.data = data, .end = data + size, .out = out, .out_end = out + count};
    if (has_table) {
        if (size < 2 || (size - 2) / 2 < read_u16(data)) {
            return false;
        }
        d.table_count = read_u16(data);
        d.table = data + 2;
        d.data = d.table + 2 * d.table_count;
    }
    if (d.end - d.data < 2) {
        return false;
    }
    d.value = read_u16(d.data);
    d.data += 2;
    bool is_good = put(&d);
    while (is_good && d.data < d.end && d.out < d.out_end) {
        is_good = put_code(&d, *d.data++);
    }
    return is_good && d.out == d.out_end;
}
