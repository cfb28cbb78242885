/* RVL: from depth to bytes, and the tables. */
#include "io/picture/pixels.h"
#include "io/little.h"

#include <string.h>

/* Nibbles that wait for their word of 32 bits. */
typedef struct nibble_writer {
    uint64_t waiting;
    uint32_t bits; /* of them, < 32 between calls */
    uint8_t *out;
} nibble_writer;

/* At most 32 bits at once. A word is always stored, and counts only once it is full. */
static inline void put(nibble_writer *w, uint32_t code, uint32_t bits)
{
    w->waiting = w->waiting << bits | code;
    w->bits += bits;
    const uint32_t rest = w->bits & 31;
    uint32_t word = (uint32_t)(w->waiting >> rest);
    io_little(&word, 1, sizeof(word));
    memcpy(w->out, &word, 4);
    w->out += w->bits >> 5 << 2;
    w->bits = rest;
}

/* Three bits a nibble, lowest first; the flag says that more follow. */
static void put_number(nibble_writer *w, uint32_t value)
{
    do {
        const uint32_t nibble = value & 7;
        value >>= 3;
        put(w, nibble | (value != 0 ? 8u : 0u), 4);
    } while (value != 0);
}

static inline uint32_t zigzag(int32_t difference)
{
    return (uint32_t)difference << 1 ^ (uint32_t) - (difference < 0);
}

/* First pixel from `begin` on that is missing. */
static size_t find_missing(const uint16_t *depth, size_t begin, size_t end)
{
    const uint64_t ones = UINT64_C(0x0001000100010001);
    size_t i = begin;
    for (; i + 4 <= end; i += 4) {
        uint64_t four;
        memcpy(&four, depth + i, 8);
        if (((four - ones) & ~four & ones << 15) != 0) {
            break;
        }
    }
    while (i < end && depth[i] != 0) {
        i++;
    }
    return i;
}

/* Returns the last pixel. Two small differences at a time: most are. */
static int32_t put_run(const io_rvl *rvl, nibble_writer *writer, const uint16_t *depth,
                       size_t count, int32_t previous)
{
    nibble_writer w = *writer; /* in registers */
    size_t i = 0;
    while (i < count) {
        const uint32_t first = zigzag(depth[i] - previous);
        previous = depth[i++];
        const uint32_t second = i < count ? zigzag(depth[i] - previous) : IO_RVL_SHORT;
        if (first < IO_RVL_SHORT && second < IO_RVL_SHORT) {
            const uint32_t a = rvl->encode[first];
            const uint32_t b = rvl->encode[second];
            const uint32_t bits = b >> 12 << 2;
            put(&w, (a & 4095) << bits | (b & 4095), (a >> 12 << 2) + bits);
            previous = depth[i++];
        } else {
            put_number(&w, first);
        }
    }
    *writer = w;
    return previous;
}

size_t io_rvl_bound(size_t count)
{
    /* Six nibbles for a difference of 17 bits; the runs' lengths; words stored ahead. */
    return 3 * count + 64;
}

size_t io_rvl_encode(const io_rvl *rvl, const uint16_t *depth, size_t count, uint8_t *out)
{
    nibble_writer w = {.out = out};
    int32_t previous = 0;
    for (size_t i = 0; i < count;) {
        size_t begin = i;
        while (begin < count && depth[begin] == 0) {
            begin++;
        }
        const size_t end = find_missing(depth, begin, count);
        put_number(&w, (uint32_t)(begin - i));
        put_number(&w, (uint32_t)(end - begin));
        previous = put_run(rvl, &w, depth + begin, end - begin, previous);
        i = end;
    }
    while (w.bits != 0) {
        put(&w, 0, 4);
    }
    return (size_t)(w.out - out);
}

static void fill_entry(io_rvl_entry *entry, uint32_t window)
{
    int32_t sum = 0;
    uint32_t value = 0;
    uint32_t shift = 0;
    for (uint32_t used = 4; used <= 12; used += 4) {
        const uint32_t nibble = window >> (12 - used) & 15;
        value |= (nibble & 7) << shift;
        shift += 3;
        if ((nibble & 8) == 0) {
            sum += (int32_t)(value >> 1) ^ -(int32_t)(value & 1);
            for (int32_t i = entry->count; i < 3; i++) {
                entry->sum[i] = (int16_t)sum;
            }
            entry->count++;
            entry->bits = (uint8_t)used;
            value = 0;
            shift = 0;
        }
    }
}

void io_rvl_init(io_rvl *rvl)
{
    memset(rvl, 0, sizeof(*rvl));
    for (uint32_t i = 0; i < IO_RVL_WINDOW; i++) {
        fill_entry(&rvl->decode[i], i);
    }
    for (uint32_t i = 0; i < IO_RVL_SHORT; i++) {
        const uint32_t low = i & 7;
        const uint32_t middle = i >> 3 & 7;
        const uint32_t high = i >> 6;
        const uint32_t code = high > 0     ? (low | 8) << 8 | (middle | 8) << 4 | high
                              : middle > 0 ? (low | 8) << 4 | middle
                                           : low;
        const uint32_t nibbles = high > 0 ? 3 : middle > 0 ? 2 : 1;
        rvl->encode[i] = (uint16_t)(nibbles << 12 | code);
    }
}
