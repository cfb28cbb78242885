/* What stands about: cartons, balls, lamps, plants, bins, rugs. */
#include "sim/random/plan.h"

static rlf_vec3 v(double x, double y, double z)
{
    return rlf_vec3_make(x, y, z);
}

static void make_cartons(synth_maker *m, double side)
{
    synth_draw *d = &m->plan->draw;
    const rlf_vec3 brown = {0.42, 0.275, 0.15};
    synth_look look = synth_look_plain(brown, 0.5, 0.5);
    double base = 0.0;
    const int32_t count = 1 + synth_draw_index(d, 3);
    for (int32_t i = 0; i < count; i++) {
        const double size = side * synth_draw_range(d, 0.75, 1.0) * (1.0 - 0.18 * i);
        const double tall = size * synth_draw_range(d, 0.5, 0.9);
        synth_maker box = synth_make_on(m, 0, base, 0, synth_draw_range(d, -0.25, 0.25));
        synth_make_box(&box, &look, v(0, 0, 0), v(0.9 * size, tall, 0.7 * size));
        base += tall;
    }
}

static void make_lamp(synth_maker *m)
{
    const synth_look shade = synth_look_any(&m->plan->draw);
    synth_make_round(m, &m->plan->metal, v(0, 0, 0), 0.15, 0.14, 0.025);
    synth_make_round(m, &m->plan->metal, v(0, 0.025, 0), 0.013, 0.013, 1.4);
    synth_make_round(m, &shade, v(0, 1.38, 0), 0.21, 0.13, 0.28);
}

/* A pot, a stem, leaves as thin ellipsoids. */
static void make_plant(synth_maker *m)
{
    synth_draw *d = &m->plan->draw;
    const synth_look pot = synth_look_any(d);
    const double green = synth_draw_range(d, 0.12, 0.4), tall = synth_draw_range(d, 0.5, 1.2);
    synth_look leaf = synth_look_plain(v(0.3 * green, green, 0.25 * green), 0.6, 0.8);
    synth_make_round(m, &pot, v(0, 0, 0), 0.11, 0.16, 0.26);
    synth_make_rod(m, &leaf, v(0, 0.24, 0), v(0, tall, 0), 0.015);
    for (int32_t i = 0; i < 9; i++) {
        const double a = 2.4 * i, up = 0.35 + (tall - 0.25) * i / 9.0;
        synth_maker on = synth_make_on(m, 0.16 * rlf_sin(a), up, 0.16 * rlf_cos(a), a);
        on.label = m->label;
        synth_make_egg(&on, &leaf, v(0, 0, 0), v(0.055, 0.03 + 0.006 * (i % 3), 0.17));
    }
}

static void make_ball(synth_maker *m)
{
    synth_draw *d = &m->plan->draw;
    const synth_look look = synth_look_any(d);
    const double r = synth_draw_range(d, 0.09, 0.3);
    synth_make_egg(m, &look, v(0, r, 0), v(r, r, r));
}

static void make_bin(synth_maker *m)
{
    const synth_look look = synth_look_any(&m->plan->draw);
    synth_make_round(m, &look, v(0, 0, 0), 0.11, 0.15, 0.32);
    synth_make_egg(m, &look, v(0, 0.33, 0), v(0.12, 0.04, 0.12));
}

static void make_suitcase(synth_maker *m)
{
    const synth_look look = synth_look_cloth(&m->plan->draw);
    synth_make_box(m, &look, v(0, 0.04, 0), v(0.42, 0.6, 0.24));
    synth_make_rod(m, &m->plan->metal, v(-0.12, 0.64, 0.09), v(-0.12, 0.95, 0.09), 0.008);
    synth_make_rod(m, &m->plan->metal, v(0.12, 0.64, 0.09), v(0.12, 0.95, 0.09), 0.008);
    synth_make_rod(m, &m->plan->metal, v(-0.12, 0.95, 0.09), v(0.12, 0.95, 0.09), 0.012);
    for (int32_t i = 0; i < 2; i++) {
        const double x = i == 0 ? -0.16 : 0.16;
        synth_make_egg(m, &m->plan->metal, v(x, 0.03, 0), v(0.02, 0.03, 0.08));
    }
}

bool synth_draw_loose(synth_plan *plan, int32_t kind)
{
    static const double sides[6] = {0.5, 0.36, 0.42, 0.4, 0.3, 0.44};
    const double side = sides[kind] * (kind == 0 ? synth_draw_range(&plan->draw, 0.6, 1.2) : 1.0);
    synth_spot spot;
    if (!synth_place_anywhere(plan, side / 1.42 + 0.04, side / 1.42 + 0.04, &spot)) {
        return false;
    }
    synth_maker m = synth_make(plan, spot);
    switch (kind) {
    case 0: make_cartons(&m, side / 1.25); break;
    case 1: make_lamp(&m); break;
    case 2: make_plant(&m); break;
    case 3: make_ball(&m); break;
    case 4: make_bin(&m); break;
    default: make_suitcase(&m); break;
    }
    return true;
}
