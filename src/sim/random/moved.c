/* A thing that stood since the first frame and is moved: taken away at once, lifted slowly, or
 * pushed as LIFT, SWIPE and CARRY ask. Until it starts it is a part of the room. */
#include "sim/random/plan.h"

#define START 3.0      /* s; of a push */
#define LIFT_RISE 0.4  /* metres */
#define SWEEP_BACK 0.6 /* metres that the board starts before the middle of its way */
#define TRIES 400
#define INSIDE 0.06 /* metres that all of it stays inside the picture */
#define TURNED 0.35 /* radians that the board's pushing side is turned to the camera */

static const rlf_vec3 plate_size = {0.5, 0.024, 0.4}, board_size = {0.024, 0.5, 0.4};

/* Where a push happens: on the floor, seen along `yaw`. */
typedef struct stage {
    synth_spot spot;
    double height; /* of the plate's middle */
} stage;

/* Whether the thing's corners, and what lies 12 cm over them, are in the picture all the way. */
static bool is_seen_all_the_way(const synth_plan *plan, const stage *s, rlf_vec3 size,
                                rlf_synthetic_push push)
{
    const double c = rlf_cos(s->spot.yaw), n = rlf_sin(s->spot.yaw);
    const bool is_lift = push == RLF_SYNTHETIC_PUSH_LIFT,
               is_swipe = push == RLF_SYNTHETIC_PUSH_SWIPE;
    for (int32_t i = 0; i < 24; i++) {
        const int32_t end = i / 8; /* both ends of the way, and the middle */
        const double x0 = (i & 1 ? 0.5 : -0.5) * size.x, z0 = (i & 2 ? 0.5 : -0.5) * size.z;
        const double ways[3] = {is_swipe ? -SWEEP_BACK : -2.0 * SYNTH_CIRCLE,
                                is_swipe ? SYNTH_SWEEP_WAY - SWEEP_BACK + 0.15 : 0.0, 0.0};
        const double x = x0 + (is_lift ? 0.0 : ways[end]);
        const double z = z0 + (is_lift || is_swipe ? 0.0 : (end - 1) * SYNTH_CIRCLE);
        const double up =
            (i & 4 ? 0.5 * size.y + 0.12 : -0.5 * size.y) + (is_lift && end == 1 ? LIFT_RISE : 0.0);
        const rlf_vec3 at = {s->spot.x + c * x + n * z, s->height + up, s->spot.z - n * x + c * z};
        const double away = sqrt(at.x * at.x + at.z * at.z);
        if (!synth_place_is_seen(plan, at, INSIDE) || away < plan->random->min_m + 0.1) {
            return false;
        }
    }
    return true;
}

static bool draw_stage(synth_plan *plan, rlf_synthetic_push push, stage *out)
{
    synth_draw *d = &plan->draw;
    const synth_plot *r = &plan->room;
    const rlf_vec3 size = push == RLF_SYNTHETIC_PUSH_SWIPE ? board_size : plate_size;
    for (int32_t i = 0; i < TRIES; i++) {
        const double x = synth_draw_range(d, r->x0 + 0.7, r->x1 - 0.7);
        const double z = synth_draw_range(d, r->z0 + 0.7, r->z1 - 0.7);
        const double away = sqrt(x * x + z * z), h = plan->floor_y;
        const double most = h - 0.35 * away - (push == RLF_SYNTHETIC_PUSH_LIFT ? LIFT_RISE : 0.0);
        out->spot = (synth_spot){x, z, rlf_atan2(x, z)};
        out->height = push == RLF_SYNTHETIC_PUSH_SWIPE
                          ? 0.5 * size.y + 0.01
                          : rlf_min(most, synth_draw_range(d, 0.15, 0.9));
        const double reach = push == RLF_SYNTHETIC_PUSH_SWIPE ? 1.0 : 0.6;
        const synth_plot plot = {x - reach, x + reach, z - reach, z + reach};
        if (away > 1.0 && away < 2.8 && out->height > 0.12 && synth_place_is_free(plan, plot) &&
            is_seen_all_the_way(plan, out, size, push)) {
            synth_place_take(plan, plot);
            return true;
        }
    }
    return false;
}

/* Takes the last `count` parts out of the room: they are what is moved. */
static void take_last(synth_plan *plan, int32_t count, double start)
{
    synth_scene *scene = plan->scene;
    synth_moved *m = &plan->random->moved;
    m->part_count = count;
    m->start = start;
    scene->static_count -= count;
    for (int32_t i = 0; i < count; i++) {
        m->parts[i] = scene->statics[scene->static_count + i];
    }
}

void synth_draw_put_back(synth_plan *plan)
{
    synth_scene *scene = plan->scene;
    const synth_moved *m = &plan->random->moved;
    scene->removal_time = m->start;
    scene->removed_count = m->part_count;
    for (int32_t i = 0; i < m->part_count; i++) {
        scene->statics[scene->static_count++] = m->parts[i];
    }
}

/* Nothing stands between the camera and the stage. */
static void keep_sight_free(synth_plan *plan, const stage *s)
{
    if (plan->lane_count < SYNTH_PEOPLE_MAX) {
        plan->lanes[plan->lane_count++] = (synth_lane){0, 0, s->spot.x, s->spot.z};
    }
}

bool synth_draw_push(synth_plan *plan, const rlf_synthetic_def *def)
{
    static const char *const names[4] = {"", "plate", "board", "tray"};
    synth_moved *m = &plan->random->moved;
    stage s;
    if (!draw_stage(plan, def->push, &s)) {
        return false;
    }
    const bool is_swipe = def->push == RLF_SYNTHETIC_PUSH_SWIPE;
    const rlf_quat turn = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), s.spot.yaw);
    keep_sight_free(plan, &s);
    m->push = def->push;
    m->speed = def->speed;
    m->rise = LIFT_RISE;
    m->along = rlf_rotate(turn, rlf_vec3_make(1, 0, 0));
    m->aside = rlf_rotate(turn, rlf_vec3_make(0, 0, 1));
    m->up = rlf_vec3_make(0, -1, 0);
    synth_maker place = synth_make(plan, s.spot);
    synth_maker thing =
        synth_make_on(&place, is_swipe ? -SWEEP_BACK : 0.0, s.height, 0.0, is_swipe ? TURNED : 0.0);
    const rlf_vec3 size = is_swipe ? board_size : plate_size;
    const synth_look look = synth_look_any(&plan->draw);
    if (!is_swipe) { /* a pedestal that stays */
        synth_make_box(&place, &plan->wood, rlf_vec3_make(0, 0, 0),
                       rlf_vec3_make(0.3, s.height - 0.5 * size.y, 0.26));
    }
    synth_make_box(&thing, &look, rlf_vec3_make(0, -0.5 * size.y, 0), size);
    synth_part *part = &plan->scene->statics[plan->scene->static_count - 1];
    part->name = names[def->push];
    part->look.reflectance = part->look.reflectance < 0.3f ? 0.3f : part->look.reflectance;
    part->look.texture = part->look.texture < 0.6f ? 0.6f : part->look.texture;
    take_last(plan, 1, START);
    return true;
}

void synth_draw_moved(synth_plan *plan)
{
    synth_draw *d = &plan->draw;
    synth_scene *scene = plan->scene;
    synth_moved *m = &plan->random->moved;
    const int32_t first = scene->static_count;
    const bool is_gone = synth_draw_chance(d, 0.5);
    const double start = synth_draw_range(d, 2.0, 4.5);
    m->push = RLF_SYNTHETIC_PUSH_NONE;
    m->up = rlf_vec3_make(0, -1, 0);
    m->speed = synth_draw_range(d, 0.05, 0.4);
    m->rise = synth_draw_range(d, 0.15, 0.45);
    if (!synth_draw_chance(d, 0.4)) {
        return;
    }
    const bool is_chair = synth_draw_chance(d, 0.5);
    if (is_chair ? !synth_draw_seat(plan, synth_draw_index(d, 2)) : !synth_draw_loose(plan, 0)) {
        return;
    }
    const int32_t count = scene->static_count - first;
    if (count > 0 && count <= SYNTH_THING_MAX) {
        m->is_gone = is_gone;
        take_last(plan, count, start);
    }
}
