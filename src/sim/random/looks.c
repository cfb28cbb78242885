/* Colours and patterns of furniture, cloth and paint. */
#include "sim/random/plan.h"

static rlf_vec3 rgb(double r, double g, double b)
{
    return rlf_vec3_make(r, g, b);
}

/* Any colour of that brightness: hue by weights of the three primaries. */
static rlf_vec3 color_of(synth_draw *d, double brightness, double saturation)
{
    rlf_vec3 c =
        rgb(synth_draw_range(d, 0, 1), synth_draw_range(d, 0, 1), synth_draw_range(d, 0, 1));
    const double most = rlf_max(c.x, rlf_max(c.y, c.z)) + 0.05;
    c = rlf_scale(c, brightness * saturation / most);
    return rlf_add(c, rlf_scale(rgb(1, 1, 1), brightness * (1.0 - saturation)));
}

synth_look synth_look_plain(rlf_vec3 color, double reflectance, double texture)
{
    return (synth_look){color, rlf_scale(color, 0.86), SYNTH_PLAIN,
                        0.4,   (float)reflectance,     (float)texture};
}

synth_look synth_look_wood(synth_draw *d)
{
    const double tone = synth_draw_range(d, 0.25, 1.0);
    const rlf_vec3 light = rgb(0.62 * tone, 0.44 * tone, 0.27 * tone);
    return (synth_look){light,
                        rlf_scale(light, synth_draw_range(d, 0.5, 0.75)),
                        SYNTH_WOOD,
                        0.04,
                        (float)synth_draw_range(d, 0.3, 0.6),
                        (float)synth_draw_range(d, 0.3, 0.9)};
}

synth_look synth_look_cloth(synth_draw *d)
{
    static const synth_pattern patterns[6] = {SYNTH_PLAIN,   SYNTH_SPECKLE, SYNTH_SPECKLE,
                                              SYNTH_STRIPES, SYNTH_CHECKS,  SYNTH_PRINT};
    const double brightness = synth_draw_range(d, 0.03, 0.75);
    const synth_pattern pattern = patterns[synth_draw_index(d, 6)];
    const rlf_vec3 color = color_of(d, brightness, 0.6);
    const bool is_fine = pattern == SYNTH_SPECKLE;
    synth_look look = {.color = color,
                       .second = is_fine ? rlf_scale(color, 0.6) : color_of(d, 0.5, 0.6),
                       .pattern = pattern,
                       .size = is_fine ? 0.006 : synth_draw_range(d, 0.02, 0.12)};
    /* black cloth may send nothing back, or look bright in infrared */
    const bool is_black = brightness < 0.15 && synth_draw_chance(d, 0.5);
    look.reflectance =
        (float)(is_black ? synth_draw_range(d, 0.006, 0.03) : synth_draw_range(d, 0.2, 0.7));
    look.texture = pattern == SYNTH_PLAIN ? 0.35f : 0.9f;
    return look;
}

synth_look synth_look_paint(synth_draw *d)
{
    const rlf_vec3 color = color_of(d, synth_draw_range(d, 0.15, 0.85), 0.35);
    synth_look look =
        synth_look_plain(color, synth_draw_range(d, 0.35, 0.75), synth_draw_range(d, 0.1, 0.5));
    if (synth_draw_chance(d, 0.15)) { /* wall paper */
        look.pattern = synth_draw_chance(d, 0.5) ? SYNTH_STRIPES : SYNTH_PRINT;
        look.size = synth_draw_range(d, 0.05, 0.25);
        look.texture = 0.8f;
    }
    return look;
}

synth_look synth_look_any(synth_draw *d)
{
    switch (synth_draw_index(d, 4)) {
    case 0: return synth_look_wood(d);
    case 1: return synth_look_cloth(d);
    case 2:
        return synth_look_plain(color_of(d, synth_draw_range(d, 0.05, 0.9), 0.9),
                                synth_draw_range(d, 0.08, 0.7), 0.4);
    default: return synth_look_paint(d);
    }
}
