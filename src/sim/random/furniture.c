/* How much of what stands in the room. */
#include "sim/random/plan.h"

static void add_one(synth_plan *plan)
{
    synth_draw *d = &plan->draw;
    switch (synth_draw_index(d, 8)) {
    case 0:
    case 1: (void)synth_draw_table(plan); break;
    case 2:
    case 3: (void)synth_draw_seat(plan, synth_draw_index(d, 6)); break;
    case 4:
    case 5: (void)synth_draw_storage(plan, synth_draw_index(d, 4)); break;
    default: (void)synth_draw_loose(plan, synth_draw_index(d, 6)); break;
    }
}

/* Flat on the floor and under everything. */
static void add_rug(synth_plan *plan)
{
    synth_draw *d = &plan->draw;
    const synth_plot *r = &plan->room;
    const synth_look look = synth_look_cloth(d);
    const synth_spot spot = {synth_draw_range(d, 0.7 * r->x0, 0.7 * r->x1),
                             synth_draw_range(d, 0.3 * r->z1, 0.7 * r->z1),
                             synth_draw_range(d, -0.3, 0.3)};
    synth_maker m = {plan, spot, 0.0, RLF_SYNTHETIC_LABEL_FLOOR};
    synth_make_box(
        &m, &look, rlf_vec3_make(0, -0.05, 0),
        rlf_vec3_make(synth_draw_range(d, 0.8, 2.2), 0.057, synth_draw_range(d, 0.6, 1.5)));
}

/* A ball of paper or glass on a cord, where nobody's head goes. */
static void add_hanging_lamp(synth_plan *plan)
{
    synth_draw *d = &plan->draw;
    const synth_look look = synth_look_any(d);
    const synth_spot spot = {synth_draw_range(d, 0.8 * plan->room.x0, 0.8 * plan->room.x1),
                             synth_draw_range(d, 1.0, rlf_max(1.1, plan->room.z1 - 0.4)), 0.0};
    const double radius = synth_draw_range(d, 0.1, 0.24), hang = plan->height - 0.35 - radius;
    if (hang - radius < 1.9) {
        return;
    }
    synth_maker m = synth_make(plan, spot);
    synth_make_rod(&m, &plan->metal, rlf_vec3_make(0, hang, 0),
                   rlf_vec3_make(0, plan->height + 0.02, 0), 0.006);
    synth_make_egg(&m, &look, rlf_vec3_make(0, hang, 0),
                   rlf_vec3_make(radius, 0.8 * radius, radius));
}

void synth_draw_furniture(synth_plan *plan)
{
    synth_draw *d = &plan->draw;
    const synth_plot *r = &plan->room;
    const double floor = (r->x1 - r->x0) * (r->z1 - r->z0);
    plan->is_crowded = synth_draw_chance(d, 0.4);
    const int32_t count = (int32_t)(floor * (plan->is_crowded ? 0.8 : 0.45)) + 3;
    if (synth_draw_chance(d, 0.5)) {
        add_rug(plan);
    }
    if (synth_draw_chance(d, 0.3)) {
        add_hanging_lamp(plan);
    }
    for (int32_t i = 0; i < count && plan->scene->static_count < SYNTH_STATICS_MAX - 30; i++) {
        add_one(plan);
    }
}
