/* Small things on tables and shelves: each stands free of the others. */
#include "sim/random/plan.h"

#define CLUTTER_MAX 12

static rlf_vec3 v(double x, double y, double z)
{
    return rlf_vec3_make(x, y, z);
}

static synth_look shiny(synth_draw *d)
{
    synth_look look = synth_look_any(d);
    look.texture *= 0.8f;
    return look;
}

static void make_bottle(synth_maker *m, synth_draw *d)
{
    const synth_look look = shiny(d);
    const double r = synth_draw_range(d, 0.03, 0.045), h = synth_draw_range(d, 0.13, 0.22);
    synth_make_round(m, &look, v(0, 0, 0), r, r, h);
    synth_make_round(m, &look, v(0, h, 0), r, 0.35 * r, 0.05);
    synth_make_round(m, &look, v(0, h + 0.05, 0), 0.35 * r, 0.35 * r, 0.04);
}

static void make_bowl(synth_maker *m, synth_draw *d)
{
    const synth_look look = shiny(d), fruit = synth_look_any(d);
    const double r = synth_draw_range(d, 0.08, 0.14), h = 0.55 * r;
    synth_make_round(m, &look, v(0, 0, 0), 0.5 * r, r, h);
    for (int32_t i = 0; i < 4; i++) {
        const double a = 0.5 * RLF_PI * i, off = i == 3 ? 0.0 : 0.45 * r, size = 0.32 * r;
        synth_make_egg(m, &fruit, v(off * rlf_sin(a), h + 0.6 * size, off * rlf_cos(a)),
                       v(size, size, size));
    }
}

static void make_cup(synth_maker *m, synth_draw *d)
{
    const synth_look look = shiny(d);
    synth_make_round(m, &look, v(0, 0, 0), 0.032, 0.042, 0.09);
    synth_make_rod(m, &look, v(0.05, 0.03, 0), v(0.05, 0.065, 0), 0.008);
}

static void make_books(synth_maker *m, synth_draw *d)
{
    const int32_t count = 1 + synth_draw_index(d, 4);
    double height = 0.0;
    for (int32_t i = 0; i < count; i++) {
        const synth_look look = synth_look_any(d);
        const double thick = synth_draw_range(d, 0.012, 0.05);
        synth_make_box(m, &look, v(synth_draw_range(d, -0.01, 0.01), height, 0),
                       v(synth_draw_range(d, 0.13, 0.2), thick, synth_draw_range(d, 0.18, 0.26)));
        height += thick;
    }
}

static void make_carton(synth_maker *m, synth_draw *d)
{
    const synth_look look = synth_look_any(d);
    synth_make_box(m, &look, v(0, 0, 0),
                   v(synth_draw_range(d, 0.06, 0.22), synth_draw_range(d, 0.05, 0.25),
                     synth_draw_range(d, 0.06, 0.2)));
}

static void make_ball(synth_maker *m, synth_draw *d)
{
    const synth_look look = synth_look_any(d);
    const double r = synth_draw_range(d, 0.03, 0.09);
    synth_make_egg(m, &look, v(0, r, 0), v(r, r, r));
}

static void make_plate(synth_maker *m, synth_draw *d)
{
    const synth_look look = shiny(d);
    const double r = synth_draw_range(d, 0.09, 0.14);
    synth_make_round(m, &look, v(0, 0, 0), 0.6 * r, r, 0.02);
}

/* A body, a head, ears: a toy. */
static void make_toy(synth_maker *m, synth_draw *d)
{
    const synth_look look = synth_look_cloth(d);
    synth_make_egg(m, &look, v(0, 0.07, 0), v(0.06, 0.07, 0.055));
    synth_make_egg(m, &look, v(0, 0.165, 0), v(0.045, 0.045, 0.045));
    for (int32_t i = 0; i < 2; i++) {
        const double x = i == 0 ? -1.0 : 1.0;
        synth_make_egg(m, &look, v(0.035 * x, 0.2, 0), v(0.016, 0.02, 0.01));
        synth_make_rod(m, &look, v(0.045 * x, 0.1, 0), v(0.085 * x, 0.06, -0.03), 0.018);
    }
}

/* Foot, arm, shade. */
static void make_lamp(synth_maker *m, synth_draw *d)
{
    const synth_look shade = synth_look_any(d);
    synth_make_round(m, &m->plan->metal, v(0, 0, 0), 0.07, 0.06, 0.02);
    synth_make_rod(m, &m->plan->metal, v(0, 0.03, 0), v(0, 0.3, 0), 0.008);
    synth_make_round(m, &shade, v(0, 0.25, 0), 0.11, 0.06, 0.14);
}

static void make_thing(synth_maker *m, synth_draw *d)
{
    switch (synth_draw_index(d, 10)) {
    case 0: make_bottle(m, d); break;
    case 1: make_bowl(m, d); break;
    case 2:
    case 3: make_cup(m, d); break;
    case 4: make_books(m, d); break;
    case 5: make_carton(m, d); break;
    case 6: make_ball(m, d); break;
    case 7: make_plate(m, d); break;
    case 8: make_toy(m, d); break;
    default: make_lamp(m, d); break;
    }
}

void synth_draw_clutter(synth_maker *top, double width, double depth, int32_t count)
{
    const double apart = 0.16, rim = 0.12;
    synth_draw *d = &top->plan->draw;
    double at[CLUTTER_MAX][2];
    int32_t placed = 0;
    for (int32_t i = 0; i < 6 * count && placed < count && placed < CLUTTER_MAX; i++) {
        const double x = synth_draw_range(d, -0.5, 0.5) * rlf_max(0.0, width - 2.0 * rim);
        const double z = synth_draw_range(d, -0.5, 0.5) * rlf_max(0.0, depth - 2.0 * rim);
        bool is_free = top->plan->scene->static_count < SYNTH_STATICS_MAX;
        for (int32_t k = 0; k < placed && is_free; k++) {
            const double dx = x - at[k][0], dz = z - at[k][1];
            is_free = dx * dx + dz * dz > apart * apart;
        }
        if (is_free) {
            at[placed][0] = x;
            at[placed++][1] = z;
            synth_maker m = synth_make_on(top, x, 0.0, z, synth_draw_range(d, -RLF_PI, RLF_PI));
            make_thing(&m, d);
        }
    }
}
