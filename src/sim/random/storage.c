/* What stands at walls: shelves, cupboards, radiators, curtains. */
#include "sim/random/plan.h"

static rlf_vec3 v(double x, double y, double z)
{
    return rlf_vec3_make(x, y, z);
}

static void fill_board(synth_maker *m, double width, double depth, double height, double room)
{
    synth_draw *d = &m->plan->draw;
    double x = -0.5 * width + 0.04;
    const double end = x + width * synth_draw_range(d, 0.2, 0.9);
    while (x < end - 0.05 && m->plan->scene->static_count < SYNTH_STATICS_MAX) {
        const synth_look look = synth_look_any(d);
        const double thick = synth_draw_range(d, 0.04, 0.2),
                     tall = room * synth_draw_range(d, 0.4, 0.9);
        synth_make_box(m, &look, v(x + 0.5 * thick, height, 0.02),
                       v(thick, tall, depth * synth_draw_range(d, 0.5, 0.9)));
        x += thick + (synth_draw_chance(d, 0.3) ? 0.1 : 0.002);
    }
}

static void make_shelf(synth_maker *m, double width, double depth)
{
    synth_draw *d = &m->plan->draw;
    const int32_t boards = 2 + synth_draw_index(d, 3);
    const double room = synth_draw_range(d, 0.3, 0.42), top = boards * room + 0.04;
    const synth_look look = synth_draw_chance(d, 0.6) ? m->plan->wood : synth_look_paint(d);
    for (int32_t i = 0; i < 2; i++) {
        const double x = (i == 0 ? -0.5 : 0.5) * (width - 0.025);
        synth_make_box(m, &look, v(x, 0, 0), v(0.025, top, depth));
    }
    synth_make_box(m, &look, v(0, 0, 0.5 * depth - 0.006), v(width, top, 0.012));
    for (int32_t i = 0; i <= boards; i++) {
        synth_make_box(m, &look, v(0, i * room + 0.015, 0), v(width - 0.02, 0.025, depth));
        if (i < boards) {
            fill_board(m, width - 0.06, depth, i * room + 0.04, room - 0.03);
        }
    }
    synth_maker on = *m;
    on.base = top;
    synth_draw_clutter(&on, width, depth, 1 + synth_draw_index(d, 3));
}

static void make_cupboard(synth_maker *m, double width, double depth)
{
    synth_draw *d = &m->plan->draw;
    const double height =
        synth_draw_chance(d, 0.5) ? synth_draw_range(d, 0.7, 1.1) : synth_draw_range(d, 1.6, 2.1);
    const synth_look look = synth_draw_chance(d, 0.5) ? synth_look_wood(d) : synth_look_paint(d);
    const int32_t doors = width > 0.9 ? 2 : 1;
    synth_make_box(m, &look, v(0, 0.06, 0), v(width, height - 0.06, depth));
    synth_make_box(m, &m->plan->metal, v(0, 0, 0.02), v(width - 0.06, 0.06, depth - 0.06));
    for (int32_t i = 0; i < doors; i++) { /* a knob for each door */
        const double x = doors == 1 ? 0.4 * width : (i == 0 ? -0.05 : 0.05);
        synth_make_egg(m, &m->plan->metal, v(x, 0.55 * height, -0.5 * depth - 0.015),
                       v(0.016, 0.016, 0.022));
    }
    synth_maker on = *m;
    on.base = height;
    synth_draw_clutter(&on, width, depth, 1 + synth_draw_index(d, 4));
}

/* Upright tubes in a row. */
static void make_radiator(synth_maker *m, double width)
{
    const synth_look white = synth_look_plain(v(0.85, 0.85, 0.83), 0.6, 0.4);
    const int32_t count = (int32_t)(width / 0.11);
    for (int32_t i = 0; i < count; i++) {
        const double x = (i + 0.5 - 0.5 * count) * 0.11;
        synth_make_rod(m, &white, v(x, 0.2, 0), v(x, 0.72, 0), 0.045);
    }
    synth_make_rod(m, &white, v(-0.5 * width, 0.16, 0), v(0.5 * width, 0.16, 0), 0.03);
}

/* Folds side by side. */
static void make_curtain(synth_maker *m, double width)
{
    const synth_look cloth = synth_look_cloth(&m->plan->draw);
    const double height = m->plan->height - 0.25, pitch = 0.15;
    const int32_t count = (int32_t)(width / pitch);
    for (int32_t i = 0; i < count; i++) {
        const double x = (i + 0.5 - 0.5 * count) * pitch, z = i % 2 == 0 ? 0.0 : 0.02;
        synth_make_rod(m, &cloth, v(x, 0.1, z), v(x, height, z), 0.08);
    }
    synth_make_rod(m, &m->plan->metal, v(-0.55 * width, height + 0.05, 0),
                   v(0.55 * width, height + 0.05, 0), 0.015);
}

bool synth_draw_storage(synth_plan *plan, int32_t kind)
{
    synth_draw *d = &plan->draw;
    static const double depths[4] = {0.3, 0.45, 0.12, 0.2};
    const double width = synth_draw_range(d, 0.5, kind == 1 ? 1.5 : 1.2);
    synth_spot spot;
    if (!synth_place_at_wall(plan, width, depths[kind] + 0.05, &spot)) {
        return false;
    }
    synth_maker m = synth_make(plan, spot);
    switch (kind) {
    case 0: make_shelf(&m, width, depths[0]); break;
    case 1: make_cupboard(&m, width, depths[1]); break;
    case 2: make_radiator(&m, width); break;
    default: make_curtain(&m, width); break;
    }
    return true;
}
