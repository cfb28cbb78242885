/* What a pixel on an edge is mixed of. A camera adds up light, not the codes of colours, so shares
 * are worked out in linear light; from the colours right beside the edge, since farther away a
 * surface has other shades. */
#ifndef RLF_ENVIRONMENT_EDGE_MATTE_MIXTURE_H
#define RLF_ENVIRONMENT_EDGE_MATTE_MIXTURE_H

#include "environment/srgb.h"

#define MIXTURE_NOISE 36.0f /* variance of a channel, sRGB steps squared */
#define MIXTURE_OFF_LINE                                                                           \
    0.6f /* squared distance of a colour from the line between the sides', in */
         /* squares of that line's length, that halves what it says */

typedef struct edge_matte_mixture {
    float far_light[3], difference[3]; /* near minus far, linear */
    float square;                      /* of the difference */
    float weight;                      /* of what the colours say, 0..1 */
} edge_matte_mixture;

/* Of the RGB of two unmixed pixels on each side, the nearer to the edge first. */
RLF_KERNEL_PART edge_matte_mixture edge_matte_mix(const uint8_t *const near_side[2],
                                                  const uint8_t *const far_side[2])
{
    edge_matte_mixture m = {.weight = 0.0f};
    float codes = 0.0f;
    for (int k = 0; k < 3; k++) {
        float near_light =
            0.75f * srgb_to_linear(near_side[0][k]) + 0.25f * srgb_to_linear(near_side[1][k]);
        m.far_light[k] =
            0.75f * srgb_to_linear(far_side[0][k]) + 0.25f * srgb_to_linear(far_side[1][k]);
        m.difference[k] = near_light - m.far_light[k];
        m.square += m.difference[k] * m.difference[k];
        float off = (float)(near_side[0][k] - far_side[0][k]);
        codes += off * off;
    }
    m.weight = m.square > 0.0f ? codes / (codes + MIXTURE_NOISE) : 0.0f;
    return m;
}

/* Share of the near side in a pixel of colour `c`; `unknown` as far as colours do not tell: where
 * the sides are much alike, or the colour is not mixed of those two. */
RLF_KERNEL_PART float edge_matte_share(const edge_matte_mixture *m, const uint8_t *c, float unknown)
{
    if (!(m->weight > 0.0f)) {
        return unknown;
    }
    float along = 0.0f;
    float length = 0.0f;
    for (int k = 0; k < 3; k++) {
        float from_far = srgb_to_linear(c[k]) - m->far_light[k];
        along += from_far * m->difference[k];
        length += from_far * from_far;
    }
    float share = along / m->square;
    const float strange = (length - share * along) / (m->square * MIXTURE_OFF_LINE);
    const float weight = m->weight / (1.0f + strange * strange);
    share = share < 0.0f ? 0.0f : (share > 1.0f ? 1.0f : share);
    return unknown + weight * (share - unknown);
}

#endif
