/* Sums over the front of a chord, and its solid: see surface/thickness/conic.c. */
#include "kernel/kernel.h"

#include <math.h>

/* Half the thickness at k of a solid whose ratio is 1, in steps. */
RLF_KERNEL_PART float conic_profile(const rlf_kernel_chord c, float k)
{
    return sqrtf((k - c.begin) * (c.end - k));
}

/* One value for each sample and sum. */
typedef struct samples {
    float n[RLF_CHORD_RUN], s[RLF_CHORD_RUN], h[RLF_CHORD_RUN], y[RLF_CHORD_RUN];
    float ss[RLF_CHORD_RUN], hh[RLF_CHORD_RUN], sh[RLF_CHORD_RUN], sy[RLF_CHORD_RUN];
    float hy[RLF_CHORD_RUN], yy[RLF_CHORD_RUN];
} samples;

RLF_KERNEL_PART void make_profile(const rlf_kernel_chord c, float metres, int32_t first,
                                  int32_t count, float *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        out[i] = conic_profile(c, (float)(first + i)) * metres;
    }
}

RLF_KERNEL_PART void make_samples(const rlf_kernel_chord c, const rlf_kernel_chord_noise p,
                                  const float *restrict seen, const float *restrict profile,
                                  int32_t first, int32_t count, samples *restrict out)
{
    float centre = 0.5f * (c.begin + c.end);
    for (int32_t i = 0; i < count; i++) {
        float k = (float)(first + i), w = seen[i];
        float l = k - c.begin, r = c.end - k, lr = l * r;
        float known = lr / (p.noise * lr + p.blur[0] * r * r + p.blur[1] * l * l);
        float weight = w > 0.0f ? known : 0.0f;
        float s = (k - centre) * p.metres, h = profile[i], y = (p.inverse - w) * p.z * p.z;
        float ws = weight * s, wh = weight * h, wy = weight * y;
        out->n[i] = weight;
        out->s[i] = ws;
        out->h[i] = wh;
        out->y[i] = wy;
        out->ss[i] = ws * s;
        out->hh[i] = wh * h;
        out->sh[i] = ws * h;
        out->sy[i] = ws * y;
        out->hy[i] = wh * y;
        out->yy[i] = wy * y;
    }
}

RLF_KERNEL void rlf_kernel_chord_sum(const rlf_kernel_chord *chord,
                                     const rlf_kernel_chord_noise *noise,
                                     const float *restrict seen, int32_t first, int32_t count,
                                     rlf_kernel_chord_sums *restrict sums)
{
    float profile[RLF_CHORD_RUN];
    samples all;
    make_profile(*chord, noise->metres, first, count, profile);
    make_samples(*chord, *noise, seen, profile, first, count, &all);
    rlf_kernel_chord_sums t = *sums;
    for (int32_t i = 0; i < count; i++) {
        t.n += all.n[i];
        t.s += all.s[i];
        t.h += all.h[i];
        t.y += all.y[i];
        t.ss += all.ss[i];
        t.hh += all.hh[i];
        t.sh += all.sh[i];
        t.sy += all.sy[i];
        t.hy += all.hy[i];
        t.yy += all.yy[i];
    }
    *sums = t;
}

RLF_KERNEL void rlf_kernel_chord_solid_run(const rlf_kernel_chord *chord,
                                           const rlf_kernel_chord_solid *solid, int32_t first,
                                           int32_t step, int32_t count, float *restrict weight,
                                           float *restrict middle, float *restrict half)
{
    const rlf_kernel_chord c = *chord;
    const rlf_kernel_chord_solid s = *solid;
    float both = s.share * s.half;
    for (int32_t i = 0; i < count; i++) {
        float k = (float)(first + step * i);
        float inverse = 1.0f / sqrtf((k - c.begin) * (c.end - k));
        float w = s.share * inverse * inverse;
        weight[i] = w;
        middle[i] = w * (s.middle + s.slope * k);
        half[i] = both * inverse;
    }
}
