/* Tables and desks, with what lies on them. */
#include "sim/random/plan.h"

static rlf_vec3 v(double x, double y, double z)
{
    return rlf_vec3_make(x, y, z);
}

static void make_square(synth_maker *m, const synth_look *look, double width, double depth,
                        double height)
{
    const double side = 0.05, top = 0.03;
    synth_make_box(m, look, v(0, height - top, 0), v(width, top, depth));
    for (int32_t i = 0; i < 4; i++) {
        const double x = (i & 1 ? 0.5 : -0.5) * (width - 1.4 * side);
        const double z = (i & 2 ? 0.5 : -0.5) * (depth - 1.4 * side);
        synth_make_box(m, look, v(x, 0, z), v(side, height - top, side));
    }
}

static void make_disc(synth_maker *m, const synth_look *look, double radius, double height)
{
    synth_make_round(m, look, v(0, height - 0.03, 0), radius, radius, 0.03);
    synth_make_round(m, look, v(0, 0.04, 0), 0.045, 0.045, height - 0.07);
    synth_make_round(m, look, v(0, 0, 0), 0.45 * radius, 0.3 * radius, 0.04);
}

/* A screen on a foot, a keyboard, a lap top: on a desk, seen from -z. */
static void add_computer(synth_maker *m, double height, double depth)
{
    synth_draw *d = &m->plan->draw;
    const synth_look dark = synth_look_plain(v(0.03, 0.03, 0.035), 0.02, 0.15);
    const synth_look grey = synth_look_plain(v(0.3, 0.3, 0.32), 0.3, 0.6);
    const double z = 0.5 * depth - 0.16;
    if (synth_draw_chance(d, 0.5)) {
        synth_maker screen = synth_make_on(m, 0, height, z, synth_draw_range(d, -0.2, 0.2));
        synth_make_round(&screen, &grey, v(0, 0, 0), 0.11, 0.10, 0.015);
        synth_make_rod(&screen, &grey, v(0, 0.02, 0.02), v(0, 0.25, 0.03), 0.018);
        synth_make_box(&screen, &dark, v(0, 0.12, 0), v(0.55, 0.33, 0.035));
        synth_maker keys = synth_make_on(m, 0, height, z - 0.28, 0.0);
        synth_make_box(&keys, &grey, v(0, 0, 0), v(0.42, 0.02, 0.14));
        return;
    }
    synth_maker book = synth_make_on(m, 0, height, z - 0.18, synth_draw_range(d, -0.4, 0.4));
    synth_make_box(&book, &grey, v(0, 0, 0), v(0.33, 0.018, 0.23));
    synth_make_box(&book, &dark, v(0, 0.018, 0.12), v(0.33, 0.22, 0.012));
}

bool synth_draw_table(synth_plan *plan)
{
    synth_draw *d = &plan->draw;
    const bool is_low = synth_draw_chance(d, 0.3), is_round = synth_draw_chance(d, 0.35);
    const bool is_desk = !is_low && !is_round && synth_draw_chance(d, 0.5);
    const double height = is_low ? synth_draw_range(d, 0.35, 0.5) : synth_draw_range(d, 0.68, 0.8);
    double width = synth_draw_range(d, 0.7, 1.7), depth = synth_draw_range(d, 0.5, 0.85);
    width = is_round ? synth_draw_range(d, 0.5, 1.1) : width;
    depth = is_round ? width : depth;
    synth_spot spot;
    const bool is_at_wall = is_desk || synth_draw_chance(d, 0.3);
    if (is_at_wall ? !synth_place_at_wall(plan, width, depth, &spot)
                   : !synth_place_anywhere(plan, width, depth, &spot)) {
        return false;
    }
    synth_maker m = synth_make(plan, spot);
    const synth_look look = synth_draw_chance(d, 0.7) ? plan->wood : synth_look_paint(d);
    if (is_round) {
        make_disc(&m, &look, 0.5 * width, height);
        width = depth = 0.7 * width; /* the square in the circle */
    } else {
        make_square(&m, &look, width, depth, height);
    }
    if (is_desk) {
        add_computer(&m, height, depth);
    }
    synth_maker top = m;
    top.base = height;
    synth_draw_clutter(&top, width, is_desk ? 0.5 * depth : depth,
                       2 + synth_draw_index(d, plan->is_crowded ? 9 : 5));
    return true;
}
