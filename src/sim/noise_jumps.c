/* Mixed pixels at depth jumps, and the driver's filter that drops them. */
#include "sim/hash.h"
#include "sim/noise.h"

#include <string.h>

#define FLYING_PROBABILITY 0.5f /* that a jump pixel mixes both sides */
#define KEPT_AT_JUMP 0.05f      /* that the driver's edge filter keeps a jump pixel */

/* That it keeps a pixel with so many jump pixels among its eight neighbours: 0.74^n, because each
 * of them removes it with probability 0.26. */
static const float kept_beside_jumps[9] = {1.0f,        0.74f,       0.5476f,
                                           0.405224f,   0.29986576f, 0.22190066f,
                                           0.16420649f, 0.12151280f, 0.08991947f};

RLF_KERNEL_PART float magnitude(float x)
{
    return x < 0.0f ? -x : x;
}

static float bend_x(const float *z, size_t i)
{
    return magnitude(z[i - 1] - 2.0f * z[i] + z[i + 1]);
}

static float bend_y(const float *z, size_t i)
{
    return magnitude(z[i - SYNTH_DEPTH_WIDTH] - 2.0f * z[i] + z[i + SYNTH_DEPTH_WIDTH]);
}

/* The two sides of the jump at index i, mixed. */
static float flying_depth(const float *z, size_t i, float share)
{
    size_t step = bend_x(z, i) > bend_y(z, i) ? 1 : SYNTH_DEPTH_WIDTH;
    return share * z[i - step] + (1.0f - share) * z[i + step];
}

/* One pixel that is a jump or has `count` jump pixels in its 3x3 neighbourhood. */
static void apply_jump(const synth_noise *noise, const synth_noise_row *row, uint32_t key,
                       int32_t x, uint8_t count, uint16_t *out)
{
    size_t i = (size_t)row->y * SYNTH_DEPTH_WIDTH + (size_t)x;
    uint32_t h = synth_hash(key ^ ((uint32_t)x * 0x85ebca6bu + 1u));
    bool is_jump = row->jump[i] != 0;
    if (is_jump && synth_uniform(h) < FLYING_PROBABILITY && out[x] != 0) {
        uint32_t h2 = synth_hash(h + 0x9e3779b9u);
        out[x] = synth_noise_quantise(noise->min_mm, noise->max_mm,
                                      1000.0f * flying_depth(row->z, i, synth_uniform(h2)));
    }
    float kept = kept_beside_jumps[is_jump ? count - 1 : count];
    kept *= is_jump ? KEPT_AT_JUMP : 1.0f;
    if (noise->enable_edge_filter && synth_uniform(synth_hash(h ^ 0x2545f491u)) >= kept) {
        out[x] = 0;
    }
}

/* Jumps in the 3x3 neighbourhood of each pixel of a row; 0 at both ends. */
RLF_KERNEL static void count_jumps(const uint8_t *jump, uint8_t *restrict count)
{
    uint8_t column[SYNTH_DEPTH_WIDTH];
    for (int32_t x = 0; x < SYNTH_DEPTH_WIDTH; x++) {
        column[x] = (uint8_t)(jump[x - SYNTH_DEPTH_WIDTH] + jump[x] + jump[x + SYNTH_DEPTH_WIDTH]);
    }
    for (int32_t x = 1; x < SYNTH_DEPTH_WIDTH - 1; x++) {
        count[x] = (uint8_t)(column[x - 1] + column[x] + column[x + 1]);
    }
    count[0] = count[SYNTH_DEPTH_WIDTH - 1] = 0;
}

/* Visits the pixels that have a jump in their 3x3 neighbourhood. */
void synth_noise_apply_jumps(const synth_noise *noise, const synth_noise_row *row, uint32_t key,
                             uint16_t *out)
{
    uint8_t count[SYNTH_DEPTH_WIDTH];
    count_jumps(row->jump + (size_t)row->y * SYNTH_DEPTH_WIDTH, count);
    for (int32_t block = 0; block < SYNTH_DEPTH_WIDTH; block += 8) {
        uint64_t any;
        memcpy(&any, count + block, sizeof(any));
        for (int32_t x = block; any != 0 && x < block + 8; x++) {
            if (count[x] != 0) {
                apply_jump(noise, row, key, x, count[x], out);
            }
        }
    }
}
