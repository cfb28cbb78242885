/* What kind of depth camera it is: lens, range, noise, rim. */
#include "sim/random/plan.h"

/* Half of the sensors have a rim without depth on one side or on all. */
static void draw_rim(synth_draw *d, int32_t rim[4])
{
    const bool has_rim = synth_draw_chance(d, 0.6), has_all = synth_draw_chance(d, 0.4);
    const int32_t side = synth_draw_index(d, 4);
    for (int32_t k = 0; k < 4; k++) {
        const int32_t wide = synth_draw_index(d, 17);
        rim[k] = has_rim && (has_all || k == side) ? wide : 0;
    }
}

static void draw_flight(synth_random *r, synth_draw *d)
{
    r->min_m = synth_draw_range(d, 0.25, 0.5);
    r->max_m = synth_draw_range(d, 4.5, 6.5);
    r->sigma = (rlf_depth_noise){0.0015, -0.0005, 0.0003};
    r->noise.kind = SYNTH_FLIGHT;
    r->noise.has_even_light = synth_draw_chance(d, 0.5);
    r->noise.alike = (float)synth_draw_range(d, 0.0, 0.6);
    r->noise.lasting = (float)synth_draw_range(d, 0.0, 0.4);
    r->noise.pitch = 2 + synth_draw_index(d, 3);
}

static void draw_pattern(synth_random *r, synth_draw *d)
{
    r->min_m = synth_draw_range(d, 0.4, 0.6);
    r->max_m = synth_draw_range(d, 4.0, 6.0);
    r->noise.kind = SYNTH_PATTERN;
    r->noise.shift_m = (float)(0.075 * r->focal * synth_draw_range(d, 0.8, 1.5));
    r->noise.alike = (float)synth_draw_range(d, 0.8, 1.0);
    r->noise.lasting = (float)synth_draw_range(d, 0.3, 0.7);
    r->noise.pitch = 3 + synth_draw_index(d, 3);
    r->noise.keeps_edges = synth_draw_chance(d, 0.5);
    /* a third of a step of an eighth of a pixel, and the step itself */
    r->sigma = (rlf_depth_noise){0.0005, 0.0, 0.057 / (double)r->noise.shift_m};
}

static void draw_stereo(synth_random *r, synth_draw *d)
{
    r->min_m = synth_draw_range(d, 0.25, 0.4);
    r->max_m = synth_draw_range(d, 4.0, 6.0);
    r->noise.kind = SYNTH_STEREO;
    r->noise.shift_m = (float)(r->focal * synth_draw_range(d, 0.05, 0.1));
    r->noise.alike = (float)synth_draw_range(d, 0.85, 1.0);
    r->noise.lasting = (float)synth_draw_range(d, 0.3, 0.6);
    r->noise.pitch = 5 + synth_draw_index(d, 4);
    r->noise.fat = 1 + synth_draw_index(d, 3);
    r->noise.keeps_edges = true;
    r->sigma = (rlf_depth_noise){0.0005, 0.0, 0.07 / (double)r->noise.shift_m};
}

void synth_draw_device(synth_plan *plan, uint64_t seed)
{
    synth_random *r = plan->random;
    synth_draw d = synth_draw_start(seed, 3);
    const double half_view = synth_draw_range(&d, 27.0, 43.0) * RLF_PI / 180.0;
    r->focal = 0.5 * SYNTH_DEPTH_WIDTH * rlf_cos(half_view) / rlf_sin(half_view);
    r->noise = (synth_drawn_noise){.pitch = 4};
    r->noise.has_even_light = true;
    draw_rim(&d, r->noise.rim);
    switch (synth_draw_index(&d, 3)) {
    case 0: draw_flight(r, &d); break;
    case 1: draw_pattern(r, &d); break;
    default: draw_stereo(r, &d); break;
    }
}
