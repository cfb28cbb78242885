/* Mean of a pixel's inverse depth over time, gated by the sensor's noise: what lies farther from
 * the mean than the gate is motion, and the mean starts anew with it; so does one whose neighbours
 * all lie off to the same side, by less than the gate. Noise alone passes the gate of one pixel in
 * 400: a pixel that is alone in it has a wider one. So a result is never farther from the current
 * frame than that: nothing that has left can stay. */
#include "kernel/kernel.h"

#include "relief/surface.h"

#include <math.h>

enum {
    CHUNK = 256,
    PER_SIGMA = 8,            /* steps of a lag */
    MOST_LAG = 4 * PER_SIGMA, /* one mixed pixel is not the motion of those about it */
    GATE = 3 * PER_SIGMA,     /* of a pixel */
    CALM = 5 * PER_SIGMA / 2, /* all eight about one that may be off by MOST_LAG */
    SUM_GATE = 13 * PER_SIGMA /* of the 3x3 pixels about it */
};

/* Of one pixel, in steps. */
RLF_KERNEL_PART int32_t lag_of(rlf_kernel_noise noise, const float n[3], float x, float y, float z,
                               float mean, float frames)
{
    bool is_known = z > 0.0f && (frames > 0.0f || frames < 0.0f);
    float w = 1.0f / (z > 0.0f ? z : 1.0f);
    float facing = n[0] * x + n[1] * y + n[2];
    float length = sqrtf(x * x + y * y + 1.0f);
    float slant = rlf_kernel_slant(facing < 0.0f ? -facing : length, length);
    float off = (float)PER_SIGMA * (w - mean) / (rlf_kernel_inverse_sigma(noise, w) * slant);
    off = off < (float)MOST_LAG ? off : (float)MOST_LAG;
    off = off > (float)-MOST_LAG ? off : (float)-MOST_LAG;
    return (int32_t)(is_known ? off : 0.0f);
}

RLF_KERNEL void rlf_kernel_lag_row(rlf_kernel_noise noise, const rlf_kernel_lag_in *in,
                                   int32_t count, int8_t *restrict lag)
{
    const float *restrict nx = in->normal[0], *restrict ny = in->normal[1];
    const float *restrict nz = in->normal[2], *restrict x = in->ray_x, *restrict y = in->ray_y;
    const float *restrict depth = in->depth, *restrict mean = in->mean;
    const float *restrict frames = in->frames;
    int32_t steps[CHUNK];
    for (int32_t first = 0; first < count; first += CHUNK) {
        int32_t size = count - first < CHUNK ? count - first : CHUNK;
        for (int32_t k = 0; k < size; k++) {
            int32_t i = first + k;
            const float n[3] = {nx[i], ny[i], nz[i]};
            steps[k] = lag_of(noise, n, x[i], y[i], depth[i], mean[i], frames[i]);
        }
        for (int32_t k = 0; k < size; k++) { /* apart, because bytes make longer vectors */
            lag[first + k] = (int8_t)steps[k];
        }
    }
}

RLF_KERNEL_PART int8_t larger(int8_t a, int8_t b)
{
    return a > b ? a : b;
}

RLF_KERNEL_PART int8_t smaller(int8_t a, int8_t b)
{
    return a < b ? a : b;
}

/* Whether the eight about a pixel are where they were. */
RLF_KERNEL_PART bool is_calm(const int8_t *up, const int8_t *at, const int8_t *down)
{
    int8_t most = larger(larger(larger(up[-1], up[0]), larger(up[1], at[-1])),
                         larger(larger(at[1], down[-1]), larger(down[0], down[1])));
    int8_t least = smaller(smaller(smaller(up[-1], up[0]), smaller(up[1], at[-1])),
                           smaller(smaller(at[1], down[-1]), smaller(down[0], down[1])));
    return (most <= CALM) & (least >= -CALM);
}

/* Pixels first .. end - 1: 1 where one has moved. Those at the sides of the image by themselves. */
RLF_KERNEL_PART void find_moved(const rlf_kernel_steady_in *in, int32_t first, int32_t end,
                                uint8_t *restrict moved)
{
    const int8_t *restrict up = in->lag[0], *restrict at = in->lag[1], *restrict down = in->lag[2];
    int32_t last = end < in->count ? end : in->count - 1;
    for (int32_t i = first > 0 ? first : 1; i < last; i++) {
        int16_t left = (int16_t)(up[i - 1] + at[i - 1] + down[i - 1]);
        int16_t middle = (int16_t)(up[i] + at[i] + down[i]);
        int16_t right = (int16_t)(up[i + 1] + at[i + 1] + down[i + 1]);
        int16_t sum = (int16_t)(left + middle + right), own = at[i];
        int16_t off = (int16_t)(sum < 0 ? -sum : sum), alone = (int16_t)(own < 0 ? -own : own);
        int16_t gate = is_calm(up + i, at + i, down + i) ? MOST_LAG - 1 : GATE;
        moved[i - first] = (uint8_t)((off > SUM_GATE) | (alone > gate));
    }
    if (first == 0) {
        moved[0] = at[0] > GATE || at[0] < -GATE;
    }
    if (end == in->count) {
        moved[end - 1 - first] = at[end - 1] > GATE || at[end - 1] < -GATE;
    }
}

RLF_KERNEL_PART void steady_chunk(const uint8_t *restrict moved, const uint8_t *restrict reason,
                                  float most, int32_t count, float *restrict depth,
                                  float *restrict mean, float *restrict frames)
{
    int32_t resets[CHUNK], seen[CHUNK];
    for (int32_t i = 0; i < count; i++) { /* apart, because bytes make longer vectors */
        resets[i] = moved[i];
        seen[i] = reason[i] == RLF_REASON_OK;
    }
    for (int32_t i = 0; i < count; i++) {
        float old_mean = mean[i], old_frames = frames[i], old_depth = depth[i];
        bool is_seen = seen[i] != 0;
        float w = 1.0f / (is_seen ? old_depth : 1.0f);
        float n = (resets[i] == 0 ? rlf_kernel_abs(old_frames) : 0.0f) + 1.0f;
        n = n < most ? n : most;
        float next = n > 1.0f ? old_mean + (w - old_mean) / n : w;
        mean[i] = is_seen ? next : old_mean;
        frames[i] = is_seen ? n : old_frames;
        depth[i] = is_seen && n > 1.0f ? 1.0f / (is_seen ? next : 1.0f) : old_depth;
    }
}

RLF_KERNEL void rlf_kernel_steady_row(const rlf_kernel_steady_in *in, float *restrict depth,
                                      float *restrict mean, float *restrict frames)
{
    uint8_t moved[CHUNK];
    for (int32_t first = 0; first < in->count; first += CHUNK) {
        int32_t end = first + CHUNK < in->count ? first + CHUNK : in->count;
        find_moved(in, first, end, moved);
        steady_chunk(moved, in->reason + first, in->most, end - first, depth + first, mean + first,
                     frames + first);
    }
}
