/* Chairs, armchairs, sofas, beds. Their backs are at +z. */
#include "sim/random/plan.h"

static rlf_vec3 v(double x, double y, double z)
{
    return rlf_vec3_make(x, y, z);
}

static void add_legs(synth_maker *m, const synth_look *look, double width, double depth,
                     double height)
{
    const double thick = 0.022;
    for (int32_t i = 0; i < 4; i++) {
        const double x = (i & 1 ? 0.5 : -0.5) * (width - 3.0 * thick);
        const double z = (i & 2 ? 0.5 : -0.5) * (depth - 3.0 * thick);
        synth_make_rod(m, look, v(x, thick, z), v(x, height - thick, z), thick);
    }
}

static void make_chair(synth_maker *m)
{
    synth_draw *d = &m->plan->draw;
    const double side = 0.42, seat = 0.45, back = synth_draw_range(d, 0.3, 0.5);
    const synth_look *look = &m->plan->wood;
    add_legs(m, look, side, side, seat - 0.03);
    synth_make_box(m, look, v(0, seat - 0.03, 0), v(side, 0.03, side));
    for (int32_t i = 0; i < 2; i++) {
        const double x = i == 0 ? -0.18 : 0.18;
        synth_make_rod(m, look, v(x, seat, 0.19), v(x, seat + back, 0.21), 0.018);
    }
    synth_make_box(m, look, v(0, seat + 0.6 * back, 0.2), v(0.36, 0.4 * back, 0.02));
    if (synth_draw_chance(d, 0.4)) {
        synth_make_egg(m, &m->plan->cloth, v(0, seat + 0.03, 0), v(0.2, 0.045, 0.2));
    }
}

/* Feet in a star, a column, a round seat, a rounded back. */
static void make_office_chair(synth_maker *m)
{
    const synth_look *metal = &m->plan->metal, *cloth = &m->plan->cloth;
    for (int32_t i = 0; i < 5; i++) {
        const double a = 2.0 * RLF_PI * i / 5.0;
        synth_make_rod(m, metal, v(0, 0.07, 0), v(0.28 * rlf_sin(a), 0.04, 0.28 * rlf_cos(a)),
                       0.025);
    }
    synth_make_round(m, metal, v(0, 0.05, 0), 0.03, 0.03, 0.37);
    synth_make_egg(m, cloth, v(0, 0.45, 0), v(0.25, 0.06, 0.24));
    synth_make_rod(m, metal, v(0, 0.44, 0.18), v(0, 0.72, 0.27), 0.02);
    synth_make_egg(m, cloth, v(0, 0.78, 0.26), v(0.22, 0.25, 0.05));
}

/* A sofa for `width`: base, back, arms with round tops, cushions. */
static void make_sofa(synth_maker *m, double width, double depth)
{
    synth_draw *d = &m->plan->draw;
    const synth_look cloth = synth_look_cloth(d), cushion = synth_look_cloth(d);
    const double arm = 0.16, seat = 0.4, inner = width - 2.0 * arm;
    synth_make_box(m, &cloth, v(0, 0.06, 0), v(width, 0.2, depth));
    synth_make_box(m, &cloth, v(0, 0.26, 0.5 * depth - 0.11), v(width, 0.52, 0.22));
    for (int32_t i = 0; i < 2; i++) {
        const double x = (i == 0 ? -0.5 : 0.5) * (width - arm);
        synth_make_box(m, &cloth, v(x, 0.26, 0), v(arm, 0.26, depth));
        synth_make_rod(m, &cloth, v(x, 0.53, -0.5 * depth + 0.09), v(x, 0.53, 0.5 * depth - 0.09),
                       0.09);
    }
    const int32_t count = inner > 1.0 ? 2 : 1;
    for (int32_t i = 0; i < count; i++) {
        const double each = inner / count, x = -0.5 * inner + (i + 0.5) * each;
        synth_make_egg(m, &cloth, v(x, seat - 0.06, -0.09),
                       v(0.54 * each, 0.13, 0.5 * depth - 0.08));
        if (synth_draw_chance(d, 0.7)) {
            synth_maker on = synth_make_on(m, x + synth_draw_range(d, -0.1, 0.1), seat + 0.02,
                                           0.5 * depth - 0.34, synth_draw_range(d, -0.4, 0.4));
            synth_make_egg(&on, &cushion, v(0, 0.2, 0), v(0.22, 0.21, 0.09));
        }
    }
}

static void make_bed(synth_maker *m, double width, double length)
{
    synth_draw *d = &m->plan->draw;
    const synth_look sheet = synth_look_cloth(d), blanket = synth_look_cloth(d);
    synth_make_box(m, &m->plan->wood, v(0, 0.0, 0), v(width, 0.28, length));
    synth_make_box(m, &m->plan->wood, v(0, 0.0, 0.5 * length - 0.03), v(width, 0.85, 0.06));
    synth_make_box(m, &sheet, v(0, 0.28, -0.02), v(width - 0.06, 0.16, length - 0.1));
    synth_make_egg(m, &blanket, v(0, 0.42, -0.2 * length), v(0.52 * width, 0.11, 0.33 * length));
    const int32_t count = width > 1.2 ? 2 : 1;
    for (int32_t i = 0; i < count; i++) {
        const double x = (i + 0.5) * width / count - 0.5 * width;
        synth_make_egg(m, &sheet, v(x, 0.49, 0.5 * length - 0.3), v(0.3, 0.09, 0.2));
    }
}

static void make_beanbag(synth_maker *m)
{
    const synth_look cloth = synth_look_cloth(&m->plan->draw);
    synth_make_egg(m, &cloth, v(0, 0.24, 0), v(0.42, 0.24, 0.42));
    synth_make_egg(m, &cloth, v(0, 0.42, 0.14), v(0.3, 0.28, 0.24));
}

bool synth_draw_seat(synth_plan *plan, int32_t kind)
{
    synth_draw *d = &plan->draw;
    static const double widths[6] = {0.46, 0.62, 0.0, 0.92, 0.0, 0.86};
    static const double depths[6] = {0.48, 0.62, 0.88, 0.86, 0.0, 0.86};
    double width = widths[kind], depth = depths[kind];
    width = kind == 2 ? synth_draw_range(d, 1.5, 2.1) : width;
    if (kind == 4) { /* a bed */
        width = synth_draw_chance(d, 0.5) ? 0.95 : 1.5;
        depth = 2.02;
    }
    synth_spot spot;
    const bool is_loose = kind < 2 || kind == 5 || (kind == 3 && synth_draw_chance(d, 0.5));
    if (is_loose ? !synth_place_anywhere(plan, width, depth, &spot)
                 : !synth_place_at_wall(plan, width, depth, &spot)) {
        return false;
    }
    synth_maker m = synth_make(plan, spot);
    switch (kind) {
    case 0: make_chair(&m); break;
    case 1: make_office_chair(&m); break;
    case 4: make_bed(&m, width, depth); break;
    case 5: make_beanbag(&m); break;
    default: make_sofa(&m, width, depth); break;
    }
    return true;
}
