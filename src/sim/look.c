/* Looks of drawn parts: a colour, a second one, and a pattern of either. Coordinates are metres in
 * the part's own frame. */
#include "sim/material.h"

static rlf_vec3 mix(rlf_vec3 a, rlf_vec3 b, double t)
{
    return rlf_add(a, rlf_scale(rlf_sub(b, a), t));
}

static double fraction(double x)
{
    double whole = (double)(int64_t)x;
    return x < whole ? x - whole + 1.0 : x - whole;
}

/* Share of the second colour, 0..1. */
static double pattern_at(const synth_look *look, double u, double v)
{
    const double across = u / look->size, along = v / look->size;
    switch (look->pattern) {
    case SYNTH_WOOD:
        return 0.6 * synth_value_noise(along * 0.3, across * 2.0) +
               0.4 * fraction(3.0 * synth_value_noise(along * 0.08, across * 0.8));
    case SYNTH_STRIPES: return fraction(along) < 0.5 ? 0.0 : 1.0;
    case SYNTH_CHECKS: return (fraction(along) < 0.5) == (fraction(across) < 0.5) ? 0.0 : 1.0;
    case SYNTH_SPECKLE: return synth_value_noise(across, along);
    case SYNTH_PRINT: return synth_value_noise(across, along) < 0.5 ? 0.0 : 1.0;
    default: return 0.25 * synth_value_noise(across, along);
    }
}

rlf_vec3 synth_look_albedo(const synth_look *look, rlf_vec3 p)
{
    const double u = p.x + 0.71 * p.z, v = p.y - 0.69 * p.z;
    return mix(look->color, look->second, pattern_at(look, u, v));
}

/* A plain surface has dust, light and shade that a matcher finds here and there. */
float synth_look_texture(const synth_part *part, rlf_vec3 p)
{
    const double u = p.x + 0.71 * p.z, v = p.y - 0.69 * p.z;
    const double own = part->material == SYNTH_DRAWN ? part->look.texture : 0.6;
    return (float)(own + 0.5 * synth_value_noise(3.1 * u, 3.1 * v) - 0.25);
}
