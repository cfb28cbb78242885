/* Small .klg and .sens recordings. Include after cmocka.h. */
#ifndef RLF_TEST_LOG_SAMPLE_H
#define RLF_TEST_LOG_SAMPLE_H

#include "byte_file.h"
#include "jpeg_sample.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <zlib.h>

#define LOG_SAMPLE_FRAMES 4
#define LOG_SAMPLE_PIXELS (16 * 8)

/* Depth of frame i: 1000 + 100 i + p, packed or not. Returns the size. */
static inline uint32_t log_sample_depth(int i, bool is_packed, uint8_t *out, size_t capacity)
{
    uint16_t depth[LOG_SAMPLE_PIXELS];
    for (int p = 0; p < LOG_SAMPLE_PIXELS; p++) {
        depth[p] = (uint16_t)(1000 + 100 * i + p);
    }
    uLongf size = sizeof(depth);
    if (is_packed) {
        size = (uLongf)capacity;
        compress(out, &size, (const Bytef *)depth, sizeof(depth));
    } else {
        memcpy(out, depth, sizeof(depth));
    }
    return (uint32_t)size;
}

/* The odd frames' depth is raw; the last one has raw colour, red 200. */
static inline uint32_t log_sample_color(int i, uint8_t *out)
{
    if (i + 1 < LOG_SAMPLE_FRAMES) {
        memcpy(out, jpeg_sample, sizeof(jpeg_sample));
        return (uint32_t)sizeof(jpeg_sample);
    }
    memset(out, 0, 3 * LOG_SAMPLE_PIXELS);
    for (int p = 0; p < LOG_SAMPLE_PIXELS; p++) {
        out[3 * p] = 200;
    }
    return 3 * LOG_SAMPLE_PIXELS;
}

static inline byte_file *klg_sample_make(int32_t promised)
{
    byte_file *b = calloc(1, sizeof(*b));
    uint8_t depth[1024];
    uint8_t color[2048];
    bytes_u32(b, (uint32_t)promised);
    for (int i = 0; i < LOG_SAMPLE_FRAMES; i++) {
        const uint32_t depth_size = log_sample_depth(i, i % 2 == 0, depth, sizeof(depth));
        const uint32_t color_size = log_sample_color(i, color);
        bytes_u64(b, 1000000 + 40000 * (uint64_t)i); /* microseconds */
        bytes_u32(b, depth_size);
        bytes_u32(b, color_size);
        bytes_put(b, depth, depth_size);
        bytes_put(b, color, color_size);
    }
    return b;
}

static inline void sens_matrix(byte_file *b, const float rows[12])
{
    const float last[4] = {0, 0, 0, 1};
    bytes_put(b, rows, 12 * sizeof(float));
    bytes_put(b, last, sizeof(last));
}

/* Frame i stands at x = i / 10; the third has no pose. */
static inline byte_file *sens_sample_make(uint32_t depth_packing, uint64_t promised)
{
    const float color_k[12] = {20, 0, 7.5f, 0, 0, 21, 3.5f, 0, 0, 0, 1, 0};
    const float depth_k[12] = {10, 0, 8, 0, 0, 11, 4, 0, 0, 0, 1, 0};
    const float identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    const float moved[12] = {1, 0, 0, 0.02f, 0, 1, 0, 0, 0, 0, 1, 0};
    byte_file *b = calloc(1, sizeof(*b));
    uint8_t depth[1024];
    uint8_t color[2048];
    bytes_u32(b, 4);
    bytes_u64(b, 4);
    bytes_put(b, "iPad", 4);
    sens_matrix(b, color_k);
    sens_matrix(b, identity);
    sens_matrix(b, depth_k);
    sens_matrix(b, moved);
    bytes_u32(b, 2);
    bytes_u32(b, depth_packing);
    for (int i = 0; i < 2; i++) {
        bytes_u32(b, 16);
        bytes_u32(b, 8);
    }
    bytes_f32(b, 1000.0f);
    bytes_u64(b, promised);
    for (int i = 0; i < LOG_SAMPLE_FRAMES; i++) {
        float pose[12] = {1, 0, 0, (float)i / 10.0f, 0, 1, 0, 0, 0, 0, 1, 0};
        for (int k = 0; k < 12 && i == 2; k++) {
            pose[k] = -INFINITY;
        }
        sens_matrix(b, pose);
        const uint32_t depth_size = log_sample_depth(i, depth_packing == 1, depth, sizeof(depth));
        const uint32_t color_size = log_sample_color(i, color);
        bytes_u64(b, 1001000 + 40000 * (uint64_t)i);
        bytes_u64(b, 1000000 + 40000 * (uint64_t)i);
        bytes_u64(b, color_size);
        bytes_u64(b, depth_size);
        bytes_put(b, color, color_size);
        bytes_put(b, depth, depth_size);
    }
    bytes_u64(b, 0); /* movements of the device */
    return b;
}

#endif
