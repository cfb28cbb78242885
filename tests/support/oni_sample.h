/* Small .oni files, put together in memory record by record. */
#ifndef RLF_TEST_ONI_SAMPLE_H
#define RLF_TEST_ONI_SAMPLE_H

#include "io/formats/oni.h"

#include <string.h>

#define ONI_W 8
#define ONI_H 4
#define ONI_PIXELS (ONI_W * ONI_H)
#define ONI_FRAMES 3
#define ONI_FRAME_US 33333

enum { ONI_DEPTH_NODE = 1, ONI_COLOR_NODE = 2 };

typedef struct oni_bytes {
    uint8_t data[6000];
    size_t size;
    bool is_old; /* places are 32 bits wide */
} oni_bytes;

static inline void oni_put(oni_bytes *b, const void *data, size_t size)
{
    if (size > 0 && size <= sizeof(b->data) - b->size) {
        memcpy(b->data + b->size, data, size);
        b->size += size;
    }
}

static inline void oni_u32(oni_bytes *b, uint32_t value)
{
    oni_put(b, &value, 4);
}

static inline void oni_u64(oni_bytes *b, uint64_t value)
{
    oni_put(b, &value, 8);
}

static inline void oni_text(oni_bytes *b, const char *text)
{
    oni_u32(b, (uint32_t)strlen(text) + 1);
    oni_put(b, text, strlen(text) + 1);
}

static inline void oni_begin(oni_bytes *b, bool is_old)
{
    memset(b, 0, sizeof(*b));
    b->is_old = is_old;
    oni_put(b, "NI10", 4);
    oni_u64(b, 1 | (uint64_t)(is_old ? 0 : 1) << 16);
    oni_u64(b, 100000);
    oni_u32(b, 2);
}

/* Returns where the record begins. */
static inline size_t oni_record(oni_bytes *b, uint32_t type, uint32_t node)
{
    const size_t at = b->size;
    oni_u32(b, 0x0052494E);
    oni_u32(b, type);
    oni_u32(b, node);
    oni_u32(b, 0);
    oni_u32(b, 0);
    oni_u32(b, 0);
    if (!b->is_old) {
        oni_u32(b, 0);
    }
    return at;
}

static inline void oni_record_end(oni_bytes *b, size_t at, const void *payload, uint32_t size)
{
    const uint32_t fields = (uint32_t)(b->size - at);
    memcpy(b->data + at + 12, &fields, 4);
    memcpy(b->data + at + 16, &size, 4);
    oni_put(b, payload, size);
}

static inline void oni_node_added(oni_bytes *b, uint32_t node, uint32_t type, uint32_t codec)
{
    const size_t at = oni_record(b, 13, node);
    oni_text(b, type == 2 ? "Depth" : "Image");
    oni_u32(b, type);
    oni_u32(b, codec);
    oni_u32(b, ONI_FRAMES);
    oni_u64(b, 0);
    oni_u64(b, 100000);
    oni_u64(b, 0);
    oni_record_end(b, at, NULL, 0);
}

static inline void oni_int(oni_bytes *b, uint32_t node, const char *name, uint64_t value)
{
    const size_t at = oni_record(b, 3, node);
    oni_text(b, name);
    oni_u32(b, 8);
    oni_u64(b, value);
    oni_record_end(b, at, NULL, 0);
}

static inline void oni_mode(oni_bytes *b, uint32_t node, uint32_t width, uint32_t height)
{
    const size_t at = oni_record(b, 6, node);
    oni_text(b, "xnMapOutputMode");
    oni_u32(b, 12);
    oni_u32(b, width);
    oni_u32(b, height);
    oni_u32(b, 30);
    oni_record_end(b, at, NULL, 0);
}

static inline void oni_fov(oni_bytes *b, uint32_t node, double x, double y)
{
    const size_t at = oni_record(b, 6, node);
    oni_text(b, "xnFOV");
    oni_u32(b, 16);
    oni_put(b, &x, 8);
    oni_put(b, &y, 8);
    oni_record_end(b, at, NULL, 0);
}

static inline void oni_data(oni_bytes *b, uint32_t node, uint64_t time_us, uint32_t number,
                            const void *payload, uint32_t size)
{
    const size_t at = oni_record(b, 10, node);
    oni_u64(b, time_us);
    oni_u32(b, number);
    oni_record_end(b, at, payload, size);
}

static inline void oni_finish(oni_bytes *b)
{
    const size_t at = oni_record(b, 11, 0);
    oni_record_end(b, at, NULL, 0);
}

/* Pixel p of picture n: rows that rise by one from 500 + 50 n, and 0 in the last column. */
static inline uint16_t oni_sample_depth(int n, int p)
{
    return p % ONI_W == ONI_W - 1 ? 0 : (uint16_t)(500 + 50 * n + p);
}

static inline uint8_t oni_sample_color(int n, int p, int c)
{
    return (uint8_t)(10 * n + 3 * p + c);
}

/* Depth of picture n, packed with a table of the values and one code for each pixel. */
static inline uint32_t oni_sample_packed(int n, uint8_t *out)
{
    uint32_t size = 0;
    uint16_t table[ONI_PIXELS + 1] = {0};
    for (int i = 0; i < ONI_PIXELS; i++) {
        table[i + 1] = (uint16_t)(500 + 50 * n + i);
    }
    const uint16_t count = ONI_PIXELS + 1;
    memcpy(out, &count, 2);
    memcpy(out + 2, table, sizeof(table));
    size = 2 + sizeof(table);
    const uint16_t first = 1;
    memcpy(out + size, &first, 2);
    size += 2;
    int last = 1;
    for (int p = 1; p < ONI_PIXELS; p++) {
        const int index = oni_sample_depth(n, p) == 0 ? 0 : p + 1;
        const int down = last - index;
        if (down >= -6 && down <= 6) {
            out[size++] = (uint8_t)((down + 6) << 4 | 0x0D);
        } else {
            out[size++] = 0xFF;
            out[size++] = (uint8_t)(down + 192);
        }
        last = index;
    }
    return size;
}

/* Three pairs; depth packed or not, mirrored as the file says. */
static inline void oni_sample(oni_bytes *b, bool is_old, bool is_packed)
{
    oni_begin(b, is_old);
    oni_node_added(b, ONI_DEPTH_NODE, 2, is_packed ? ONI_CODEC_16Z_TABLE : ONI_CODEC_NONE);
    oni_mode(b, ONI_DEPTH_NODE, ONI_W, ONI_H);
    oni_fov(b, ONI_DEPTH_NODE, 1.0145, 0.7898);
    oni_int(b, ONI_DEPTH_NODE, "xnMirror", is_packed ? 1 : 0);
    oni_int(b, ONI_DEPTH_NODE, "AlternativeViewPoint", is_packed ? 1 : 0);
    oni_int(b, ONI_DEPTH_NODE, "oniPixelFormat", is_packed ? 100 : 101);
    oni_node_added(b, ONI_COLOR_NODE, 3, ONI_CODEC_NONE);
    oni_mode(b, ONI_COLOR_NODE, ONI_W, ONI_H);
    oni_int(b, ONI_COLOR_NODE, "xnPixelFormat", 1);
    for (int n = 0; n < ONI_FRAMES; n++) {
        uint8_t packed[4 * ONI_PIXELS + 64];
        uint32_t size = 0;
        for (int p = 0; p < ONI_PIXELS && !is_packed; p++) {
            const uint16_t z = oni_sample_depth(n, p);
            memcpy(packed + 2 * p, &z, 2);
            size += 2;
        }
        size = is_packed ? oni_sample_packed(n, packed) : size;
        oni_data(b, ONI_DEPTH_NODE, (uint64_t)n * ONI_FRAME_US, (uint32_t)n + 1, packed, size);
        uint8_t rgb[3 * ONI_PIXELS];
        for (int i = 0; i < 3 * ONI_PIXELS; i++) {
            rgb[i] = oni_sample_color(n, i / 3, i % 3);
        }
        oni_data(b, ONI_COLOR_NODE, (uint64_t)n * ONI_FRAME_US + 5000, (uint32_t)n + 1, rgb,
                 sizeof(rgb));
    }
    oni_finish(b);
}

#endif
