/* A room drawn at random, and drawn again until it can be seen. */
#include "sim/random/plan.h"

#define ATTEMPTS 60
#define GRID 24           /* rays across and down that try the view */
#define SEEN_SHARE 0.6    /* of them that must meet something in range */
#define NEAREST_M 0.65    /* nothing hangs before the lens */
#define STATIC_MARGIN 0.1 /* metres inside the range */

static void turn_part(synth_part *part, rlf_quat q)
{
    part->shape.T_camera_shape.p = rlf_rotate(q, part->shape.T_camera_shape.p);
    part->shape.T_camera_shape.q = rlf_quat_mul(q, part->shape.T_camera_shape.q);
}

/* From the level frame into the camera's. */
static void turn_all(synth_scene *scene, synth_random *random)
{
    const rlf_quat q = random->q_camera_level;
    synth_moved *m = &random->moved;
    for (int32_t i = 0; i < scene->static_count; i++) {
        turn_part(&scene->statics[i], q);
    }
    for (int32_t i = 0; i < m->part_count; i++) {
        turn_part(&m->parts[i], q);
    }
    m->along = rlf_rotate(q, m->along);
    m->aside = rlf_rotate(q, m->aside);
    m->up = rlf_rotate(q, m->up);
    scene->lamp = rlf_rotate(q, scene->lamp);
}

/* Share of rays that meet the room in range; 0 when something is too near. */
static double seen_share(const synth_scene *scene, const synth_random *random)
{
    int32_t seen = 0;
    for (int32_t k = 0; k < GRID * GRID; k++) {
        const double u = (k % GRID + 0.5) / GRID - 0.5, v = (k / GRID + 0.5) / GRID - 0.5;
        const synth_ray ray = {.direction = {u * SYNTH_DEPTH_WIDTH / random->focal,
                                             v * SYNTH_DEPTH_HEIGHT / random->focal, 1.0}};
        double nearest = 1e9;
        for (int32_t i = 0; i < scene->static_count; i++) {
            synth_interval hit;
            if (synth_shape_intersect(&scene->statics[i].shape, &ray, &hit) && hit.far > 0.0) {
                nearest = rlf_min(nearest, hit.near);
            }
        }
        if (nearest < NEAREST_M) {
            return 0.0;
        }
        seen += nearest < random->max_m - STATIC_MARGIN;
    }
    return (double)seen / (GRID * GRID);
}

static void draw_lamp(synth_plan *plan)
{
    synth_draw *d = &plan->draw;
    const synth_plot *r = &plan->room;
    plan->scene->lamp = rlf_vec3_make(synth_draw_range(d, 0.6 * r->x0, 0.6 * r->x1),
                                      plan->floor_y - plan->height + 0.15,
                                      synth_draw_range(d, 0.3 * r->z1, 0.7 * r->z1));
}

static bool draw_room(synth_plan *plan, const rlf_synthetic_def *def)
{
    const bool is_pushed = def->push != RLF_SYNTHETIC_PUSH_NONE;
    synth_draw_camera(plan, is_pushed);
    synth_draw_shell(plan);
    draw_lamp(plan);
    if (is_pushed) {
        if (!synth_draw_push(plan, def)) {
            return false;
        }
        synth_draw_furniture(plan);
    } else {
        synth_draw_people(plan, def->seed);
        synth_draw_furniture(plan);
        synth_draw_moved(plan);
    }
    synth_draw_put_back(plan);
    if (!is_pushed && plan->random->people_count == 0) {
        return false;
    }
    turn_all(plan->scene, plan->random);
    return true;
}

void synth_random_build(synth_scene *scene, synth_random *random, const rlf_synthetic_def *def)
{
    for (uint32_t attempt = 0; attempt < ATTEMPTS; attempt++) {
        *random = (synth_random){.people_count = 0};
        *scene = (synth_scene){.kind = RLF_SYNTHETIC_RANDOM,
                               .speed = def->speed,
                               .random = random,
                               .q_camera_level = &random->q_camera_level};
        synth_plan plan = {.draw = synth_draw_start(def->seed, 16 + attempt),
                           .scene = scene,
                           .random = random,
                           .label = RLF_SYNTHETIC_LABEL_THING - 1};
        synth_draw_device(&plan, def->seed);
        if (draw_room(&plan, def) && seen_share(scene, random) >= SEEN_SHARE) {
            break;
        }
    }
    synth_scene_bound(scene);
    synth_random_move(scene, 0.0);
}
