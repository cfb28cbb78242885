/* The noise recipe. Every number is a function of (seed, frame, pixel). */
#include "sim/noise.h"
#include "sim/hash.h"
#include "kernel/kernel.h"

#include <string.h>

#define AMPLITUDE_THRESHOLD 0.0042f
#define AMPLITUDE_SIGMA 0.002f
#define JUMP_SHARE 0.04f /* of the depth: second difference that counts as a jump */

enum { BLOCK = 64 }; /* pixels worked on together: a share of the width */

void synth_noise_init(synth_noise *noise, uint64_t seed)
{
    const double theta_max = 80.0 * RLF_PI / 180.0;
    *noise = (synth_noise){.seed = synth_hash2((uint32_t)seed, (uint32_t)(seed >> 32))};
    for (int i = 0; i <= SYNTH_INCIDENCE_STEPS; i++) {
        double theta = rlf_min(rlf_acos((double)i / SYNTH_INCIDENCE_STEPS), theta_max);
        double ratio = theta / (0.5 * RLF_PI - theta);
        noise->incidence[i] = (float)(ratio * ratio);
    }
}

RLF_KERNEL_PART float sigma_of(const float *incidences, float z, float cosine)
{
    float c = cosine < 0.0f ? 0.0f : (cosine > 1.0f ? 1.0f : cosine);
    float x = c * (float)SYNTH_INCIDENCE_STEPS;
    int32_t i = (int32_t)x;
    i = i < SYNTH_INCIDENCE_STEPS ? i : SYNTH_INCIDENCE_STEPS - 1;
    float f = x - (float)i;
    float incidence = incidences[i] + (incidences[i + 1] - incidences[i]) * f;
    return 1.5f - 0.5f * z + 0.3f * z * z + 0.1f * z * sqrtf(z) * incidence;
}

float synth_noise_sigma(const synth_noise *noise, float z, float cosine)
{
    return sigma_of(noise->incidence, z, cosine);
}

RLF_KERNEL_PART float margin_of(float reflectance, float z, float cosine, float vignette)
{
    float amplitude = reflectance * cosine / (z * z) * vignette;
    return (amplitude - AMPLITUDE_THRESHOLD) / AMPLITUDE_SIGMA;
}

float synth_noise_margin(float reflectance, float z, float cosine, float vignette)
{
    return margin_of(reflectance, z, cosine, vignette);
}

RLF_KERNEL void synth_noise_find(const synth_noise *noise, const synth_noise_seen *seen,
                                 float *restrict sigma, float *restrict margin)
{
    const float *restrict z = seen->z;
    const float *restrict cosine = seen->cosine;
    const float *restrict vignette = seen->vignette;
    const float reflectance = seen->reflectance;
    for (int32_t i = 0; i < seen->count; i++) {
        sigma[i] = sigma_of(noise->incidence, z[i], cosine[i]);
        margin[i] = margin_of(reflectance, z[i], cosine[i], vignette[i]);
    }
}

double synth_noise_vignette(double u, double v)
{
    double x = (u - 255.5) / 300.0;
    double y = (v - 211.5) / 258.0;
    return 1.0 / (1.0 + rlf_exp(60.0 * (sqrt(x * x + y * y) - 1.045)));
}

RLF_KERNEL_PART float magnitude(float x)
{
    return x < 0.0f ? -x : x;
}

RLF_KERNEL void synth_noise_find_jumps(const float *z, int32_t count, uint8_t *restrict out)
{
    const float *above = z - SYNTH_DEPTH_WIDTH;
    const float *below = z + SYNTH_DEPTH_WIDTH;
    for (int32_t i = 0; i < count; i++) {
        float limit = JUMP_SHARE * z[i];
        float across = magnitude(z[i - 1] - 2.0f * z[i] + z[i + 1]);
        float down = magnitude(above[i] - 2.0f * z[i] + below[i]);
        out[i] = (across > limit ? 1 : 0) | (down > limit ? 1 : 0);
    }
}

static void apply_steps(const synth_noise *noise, const synth_noise_row *row, uint16_t *out)
{
    const float *z = row->z + (size_t)row->y * SYNTH_DEPTH_WIDTH;
    for (int32_t x = 0; x < SYNTH_DEPTH_WIDTH; x++) {
        if (out[x] != 0) {
            float seen = synth_noise_steps(noise, row->frame, x, row->y, z[x]);
            out[x] = synth_noise_quantise(noise->min_mm, noise->max_mm, 1000.0f * seen);
        }
    }
}

/* Depth with its noise where enough light comes back, else 0: in millimetres. */
RLF_KERNEL_PART void add_axial(const float *restrict z, const float *restrict sigma,
                               const float *restrict margin, uint32_t key, int32_t x0,
                               float *restrict out)
{
    for (int32_t i = 0; i < BLOCK; i++) {
        uint32_t h = synth_hash(key + (uint32_t)(x0 + i) * 0x9e3779b9u);
        uint32_t h2 = h * 0x9e3779b1u;
        h2 ^= h2 >> 15;
        float depth = z[i] * 1000.0f + sigma[i] * synth_normal(h);
        int is_lit = margin[i] + synth_normal(h2) >= 0.0f;
        out[i] = is_lit ? depth : 0.0f;
    }
}

RLF_KERNEL static void apply_axial(const synth_noise *noise, const synth_noise_row *row,
                                   uint32_t key, uint16_t *restrict out)
{
    const size_t first = (size_t)row->y * SYNTH_DEPTH_WIDTH;
    const float least = noise->min_mm;
    const float most = noise->max_mm;
    float depth[BLOCK];
    for (int32_t x = 0; x < SYNTH_DEPTH_WIDTH; x += BLOCK) {
        const size_t at = first + (size_t)x;
        add_axial(row->z + at, row->sigma + at, row->margin + at, key, x, depth);
        for (int32_t i = 0; i < BLOCK; i++) {
            out[x + i] = synth_noise_quantise(least, most, depth[i]);
        }
    }
}

void synth_noise_apply(const synth_noise *noise, const synth_noise_row *row, uint16_t *out)
{
    if (!noise->enable) {
        const float *z = row->z + (size_t)row->y * SYNTH_DEPTH_WIDTH;
        for (int32_t x = 0; x < SYNTH_DEPTH_WIDTH; x++) {
            out[x] = synth_noise_quantise(noise->min_mm, noise->max_mm, z[x] * 1000.0f);
        }
        return;
    }
    if (row->y == 0 || row->y == SYNTH_DEPTH_HEIGHT - 1) {
        memset(out, 0, SYNTH_DEPTH_WIDTH * sizeof(*out));
        return;
    }
    if (noise->drawn != NULL) {
        synth_noise_apply_drawn(noise, row, out);
        return;
    }
    uint32_t key = synth_hash2(synth_hash2(noise->seed, row->frame), (uint32_t)row->y);
    apply_axial(noise, row, key, out);
    if (noise->enable_steps) {
        apply_steps(noise, row, out);
    }
    synth_noise_apply_jumps(noise, row, key, out);
    out[0] = 0;
    out[SYNTH_DEPTH_WIDTH - 1] = 0;
}
