/* The background model of one row: per pixel, one-sided, scaled with noise.
 *
 * A pixel nearer than the stored surface is foreground. A pixel at the stored surface refines its
 * mean. A pixel seen beyond the stored surface proves that the surface is gone: three frames in a
 * row replace it (no phantoms). While learning, the farthest surface seen wins at once, so that the
 * room need not be empty; holes are filled as they are seen.
 *
 * The gate is the sensor's noise, or the pixel's own mean absolute deviation where that is larger:
 * grazing, dark and distant surfaces are noisier than the sensor's model. A pixel at a silhouette
 * sees both sides in turn, so that its own deviation spans them: there it takes twelve frames
 * beyond the sensor's noise. */
#include "kernel/kernel.h"

enum { MEMORY = 32, PROOF = 3, PROOF_MIXED = 12 };

static const float sigmas_per_deviation = 1.2533141f; /* sqrt(pi / 2), normal distribution */
static const float learning_gates = 3.0f;             /* before the deviation is known */

RLF_KERNEL int32_t rlf_kernel_background_row(const rlf_kernel_background *params,
                                             const float *restrict depth, int32_t count,
                                             const rlf_kernel_model *model, uint8_t *restrict seen)
{
    rlf_kernel_noise noise = params->noise;
    float sigmas = params->sigmas;
    float least = params->min_m;
    float widen = params->learning ? learning_gates : 1.0f;
    int32_t proof = params->learning ? 1 : PROOF;
    int32_t learning = params->learning ? 1 : 0;
    float *restrict mean = model->mean;
    float *restrict deviation = model->deviation;
    uint8_t *restrict weight = model->weight;
    uint8_t *restrict beyond = model->beyond;
    int32_t changed = 0;
    for (int32_t i = 0; i < count; i++) {
        float z = depth[i];
        float m = mean[i];
        float scaled = sigmas * rlf_kernel_sigma(noise, z);
        float own = sigmas * sigmas_per_deviation * deviation[i];
        float gate = scaled > least ? scaled : least;
        float least_gate = gate * widen;
        gate = (own > gate ? own : gate) * widen;
        int32_t valid = z > 0.0f ? 1 : 0;
        int32_t known = m > 0.0f ? 1 : 0;
        int32_t nearer = valid & known & (m - z > gate ? 1 : 0);
        int32_t farther = valid & known & (z - m > gate ? 1 : 0);
        int32_t same = valid & known & (1 - nearer) & (1 - farther);
        int32_t fresh = valid & (1 - known);
        int32_t past = valid & known & (z - m > least_gate ? 1 : 0);
        int32_t count_beyond = past ? beyond[i] + 1 : (valid ? 0 : beyond[i]);
        int32_t needed = farther ? proof : PROOF_MIXED;
        int32_t replaced = past & (count_beyond >= needed ? 1 : 0);
        int32_t restart = replaced | (fresh & learning);
        int32_t samples = same ? weight[i] + 1 : weight[i];
        samples = samples > MEMORY ? MEMORY : samples;
        samples = restart ? 1 : samples;
        float part = 1.0f / (float)(samples > 0 ? samples : 1);
        float spread = deviation[i] + part * (rlf_kernel_abs(z - m) - deviation[i]);
        deviation[i] = restart ? 0.0f : (same ? spread : deviation[i]);
        mean[i] = restart ? z : (same ? m + part * (z - m) : m);
        weight[i] = (uint8_t)samples;
        beyond[i] = (uint8_t)(replaced ? 0 : count_beyond);
        seen[i] =
            (uint8_t)(nearer ? RLF_SEEN_FOREGROUND
                             : (fresh & (1 - learning) ? RLF_SEEN_UNKNOWN : RLF_SEEN_BACKGROUND));
        changed += restart;
    }
    return changed;
}

RLF_KERNEL_PART uint8_t majority(const uint8_t *const rows[3], const float *const depth[3],
                                 int32_t i, int32_t first, int32_t last)
{
    int32_t votes = 0, valid = 0;
    for (int32_t r = 0; r < 3; r++) {
        for (int32_t k = first; k <= last; k++) {
            votes += rows[r][k] == RLF_SEEN_FOREGROUND ? 1 : 0;
            valid += depth[r][k] > 0.0f ? 1 : 0;
        }
    }
    uint8_t side = 2 * votes > valid ? RLF_SEEN_FOREGROUND : RLF_SEEN_BACKGROUND;
    uint8_t kept = rows[1][i] == RLF_SEEN_UNKNOWN ? (uint8_t)RLF_SEEN_UNKNOWN : side;
    return depth[1][i] > 0.0f ? kept : (uint8_t)RLF_SEEN_BACKGROUND;
}

RLF_KERNEL void rlf_kernel_majority_row(const uint8_t *const rows[3], const float *const depth[3],
                                        int32_t count, uint8_t *restrict out)
{
    int32_t last = count - 1;
    out[0] = majority(rows, depth, 0, 0, last > 0 ? 1 : 0);
    for (int32_t i = 1; i < last; i++) {
        out[i] = majority(rows, depth, i, i - 1, i + 1);
    }
    if (last > 0) {
        out[last] = majority(rows, depth, last, last - 1, last);
    }
}
