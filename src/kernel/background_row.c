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

enum { MEMORY = 32, PROOF = 3, PROOF_MIXED = 12, CHUNK = 128 };

static const float sigmas_per_deviation = 1.2533141f; /* sqrt(pi / 2), normal distribution */
static const float learning_gates = 3.0f;             /* before the deviation is known */

/* Bytes of some pixels as integers: beside bytes, vectors of floats would be as long as theirs, and
 * most of a short row would be left to single values. */
typedef struct counts {
    int32_t weight[CHUNK], beyond[CHUNK], seen[CHUNK];
} counts;

RLF_KERNEL_PART int32_t update(const rlf_kernel_background *params, const float *restrict depth,
                               int32_t count, float *restrict mean, float *restrict deviation,
                               counts *restrict at)
{
    rlf_kernel_noise noise = params->noise;
    float sigmas = params->sigmas, own_sigmas = params->sigmas * sigmas_per_deviation;
    float least = params->min_m;
    float widen = params->learning ? learning_gates : 1.0f;
    int32_t proof = params->learning ? 1 : PROOF;
    int32_t learning = params->learning ? 1 : 0;
    int32_t changed = 0;
    for (int32_t i = 0; i < count; i++) {
        float z = depth[i], m = mean[i], old = deviation[i];
        int32_t had = at->weight[i], past_before = at->beyond[i];
        float sigma = rlf_kernel_sigma(noise, z), off = z - m, distance = rlf_kernel_abs(off);
        float scaled = sigmas * sigma, own = own_sigmas * old;
        float gate = scaled > least ? scaled : least;
        float least_gate = gate * widen;
        gate = (own > gate ? own : gate) * widen;
        int32_t valid = z > 0.0f ? 1 : 0, known = m > 0.0f ? 1 : 0;
        int32_t both = valid & known;
        int32_t nearer = both & (-off > gate ? 1 : 0);
        int32_t farther = both & (off > gate ? 1 : 0);
        int32_t past = both & (off > least_gate ? 1 : 0);
        int32_t same = both & ~(nearer | farther);
        int32_t fresh = valid & ~known;
        int32_t count_beyond = (past & valid) * (past_before + 1) + (1 - valid) * past_before;
        int32_t needed = farther != 0 ? proof : PROOF_MIXED;
        int32_t replaced = past & (count_beyond >= needed ? 1 : 0);
        int32_t restart = replaced | (fresh & learning);
        int32_t samples = had + same;
        samples = samples > MEMORY ? MEMORY : samples;
        samples = restart != 0 ? 1 : samples;
        float part = 1.0f / (float)(samples > 1 ? samples : 1);
        float spread = old + part * (distance - old), next = m + part * off;
        spread = same != 0 ? spread : old;
        next = same != 0 ? next : m;
        deviation[i] = restart != 0 ? 0.0f : spread;
        mean[i] = restart != 0 ? z : next;
        at->weight[i] = samples;
        at->beyond[i] = count_beyond * (1 - replaced);
        at->seen[i] = nearer * RLF_SEEN_FOREGROUND + (fresh & ~learning) * RLF_SEEN_UNKNOWN +
                      (1 - valid) * RLF_SEEN_MISSING + (farther & ~learning) * RLF_SEEN_PAST;
        changed += restart;
    }
    return changed;
}

RLF_KERNEL int32_t rlf_kernel_background_row(const rlf_kernel_background *params,
                                             const float *restrict depth, int32_t count,
                                             const rlf_kernel_model *model, uint8_t *restrict seen)
{
    uint8_t *restrict weight = model->weight;
    uint8_t *restrict beyond = model->beyond;
    int32_t changed = 0;
    for (int32_t first = 0; first < count; first += CHUNK) {
        int32_t size = count - first < CHUNK ? count - first : CHUNK;
        counts at;
        for (int32_t i = 0; i < size; i++) {
            at.weight[i] = weight[first + i];
            at.beyond[i] = beyond[first + i];
        }
        changed +=
            update(params, depth + first, size, model->mean + first, model->deviation + first, &at);
        for (int32_t i = 0; i < size; i++) {
            weight[first + i] = (uint8_t)at.weight[i];
            beyond[first + i] = (uint8_t)at.beyond[i];
            seen[first + i] = (uint8_t)at.seen[i];
        }
    }
    return changed;
}

/* What a pixel's vote weighs: for the foreground, against it, or nothing. */
RLF_KERNEL_PART int8_t vote(uint8_t seen)
{
    int8_t front = seen == RLF_SEEN_FOREGROUND ? 2 : 0;
    return (int8_t)(front - (seen == RLF_SEEN_MISSING ? 0 : 1));
}

/* A pixel at the background's depth stays there: no neighbour can tell its depth in front of it. */
RLF_KERNEL_PART uint8_t decide(uint8_t own, int8_t votes)
{
    uint8_t side = votes > 0 ? RLF_SEEN_FOREGROUND : RLF_SEEN_BACKGROUND;
    uint8_t kept = own == RLF_SEEN_FOREGROUND ? side : own;
    return own == RLF_SEEN_MISSING ? (uint8_t)RLF_SEEN_BACKGROUND : kept;
}

RLF_KERNEL_PART int8_t column(const uint8_t *a, const uint8_t *b, const uint8_t *c, int32_t i)
{
    return (int8_t)(vote(a[i]) + vote(b[i]) + vote(c[i]));
}

RLF_KERNEL void rlf_kernel_majority_row(const uint8_t *const rows[3], int32_t count,
                                        uint8_t *restrict out)
{
    const uint8_t *a = rows[0], *b = rows[1], *c = rows[2];
    int32_t last = count - 1;
    int8_t next = column(a, b, c, last > 0 ? 1 : 0);
    out[0] = decide(b[0], (int8_t)(column(a, b, c, 0) + (last > 0 ? next : 0)));
    for (int32_t i = 1; i < last; i++) {
        int8_t votes = (int8_t)(column(a, b, c, i - 1) + column(a, b, c, i));
        out[i] = decide(b[i], (int8_t)(votes + column(a, b, c, i + 1)));
    }
    if (last > 0) {
        out[last] = decide(b[last], (int8_t)(column(a, b, c, last - 1) + column(a, b, c, last)));
    }
}
