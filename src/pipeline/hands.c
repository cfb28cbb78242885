/* The tracker of hands within the frame loop, and what a scene does on their events. */
#include "pipeline/hands.h"

#include "pipeline/state.h"
#include "relief/query.h"

#include <string.h>

#define UP_FRAMES 10 /* the first one's noise may hide what the next ones show */
#define THROW_M_S 3.0
#define NEAR_M 0.25        /* a body so close to an event is meant by it */
#define HAND_M 0.2         /* a palm is no farther from what its fingers hold */
#define POINT_RANGE_M 10.0 /* of a pointing hand */
#define SPAWN_SIZE_M 0.06  /* of a body where the scene has none */
#define SPAWN_MASS_KG 0.1

rlf_result hand_stage_set(hand_stage *stage, const rlf_camera *grid, bool is_on)
{
    rlf_result result = RLF_OK;
    if (is_on && stage->tracker == NULL) {
        const rlf_hand_tracker_def def = rlf_hand_tracker_def_default(grid->width, grid->height);
        result = rlf_hand_tracker_create(&def, &stage->tracker);
    }
    if (is_on && !stage->is_on && result == RLF_OK) {
        hand_stage_restart(stage);
    }
    stage->is_on = is_on && result == RLF_OK;
    stage->last = stage->is_on ? stage->last : NULL;
    return result;
}

void hand_stage_destroy(hand_stage *stage)
{
    rlf_hand_tracker_destroy(&stage->tracker);
    stage->last = NULL;
}

void hand_stage_restart(hand_stage *stage)
{
    if (stage->tracker != NULL) {
        rlf_hand_tracker_reset(stage->tracker);
    }
    stage->last = NULL;
    stage->up_world = rlf_vec3_make(0.0, -1.0, 0.0);
    stage->up_confidence = 0.0;
    stage->frames_asked = 0;
}

/* The room says where down is. Gravity does not: whoever plays may turn it round. */
static void find_down(hand_stage *stage, const rlf_surface *surface, const rlf_pose *T_world_camera)
{
    rlf_vec3 up;
    if (stage->up_confidence < RLF_UP_SURE && stage->frames_asked < UP_FRAMES) {
        stage->frames_asked++;
        stage->up_confidence = rlf_surface_find_up(surface, &up);
        if (stage->up_confidence >= RLF_UP_SURE) {
            stage->up_world = rlf_rotate(T_world_camera->q, up);
        }
    }
    const rlf_vec3 down = rlf_neg(stage->up_world);
    rlf_hand_tracker_set_down(stage->tracker,
                              rlf_rotate(rlf_quat_conjugate(T_world_camera->q), down));
}

void hand_stage_update(hand_stage *stage, const rlf_surface *surface,
                       const rlf_pose *T_world_camera)
{
    if (stage->is_on) {
        find_down(stage, surface, T_world_camera);
    }
    const rlf_hands *found = stage->is_on ? rlf_hand_tracker_update(stage->tracker, surface) : NULL;
    if (found != NULL) {
        stage->now = *found;
    }
    stage->last = found != NULL ? &stage->now : NULL;
}

void hand_stage_show(hand_stage *stage, rlf_grid *grid)
{
    _Static_assert(RLF_HANDS_MAX <= RLF_GRID_HANDS_MAX, "all hands are shown");
    _Static_assert(RLF_HAND_CONES == RLF_GRID_HAND_CONES, "of all their cones");
    stage->shape_count = 0;
    for (int32_t k = 0; stage->last != NULL && k < stage->now.count; k++) {
        const rlf_hand *h = &stage->now.hand[k];
        if (h->confidence < RLF_HAND_SURE || h->shape[0].radius_a <= 0.0) {
            continue;
        }
        rlf_grid_hand *shape = &stage->shapes[stage->shape_count++];
        *shape = (rlf_grid_hand){.id = h->id, .is_sure = h->is_shape_sure};
        shape->palm = h->palm;
        shape->facing = h->facing;
        memcpy(shape->cones, h->shape, sizeof(shape->cones));
    }
    grid->hands = stage->shapes;
    grid->hand_count = stage->shape_count;
}

void hand_stage_hold(hand_stage *stage, const rlf_snapshot *snapshot,
                     const rlf_pose *T_world_camera)
{
    double nearest[RLF_HANDS_MAX];
    for (int32_t h = 0; h < stage->now.count; h++) {
        nearest[h] = HAND_M;
    }
    for (int32_t i = 0; stage->last != NULL && i < snapshot->body_count; i++) {
        const rlf_body_state *body = &snapshot->bodies[i];
        const rlf_vec3 p = rlf_transform_inverse(T_world_camera, body->T_world_body.p);
        for (int32_t h = 0; body->is_grabbed && h < stage->now.count; h++) {
            rlf_hand *hand = &stage->now.hand[h];
            const double way = rlf_length(rlf_sub(p, hand->palm)) - rlf_shape_radius(&body->shape);
            if (way < nearest[h]) {
                nearest[h] = way;
                hand->holding = (uint64_t)body->id.generation << 32 | body->id.index1;
            }
        }
    }
}

bool hand_scene_binds(const rlf_scene *scene)
{
    bool binds = false;
    for (int32_t k = 0; k < RLF_HAND_EVENT_COUNT; k++) {
        binds = binds || scene->on[k] != RLF_HAND_ACTION_NONE;
    }
    return binds;
}

/* The scene's first body or a small cube, at the event and clear of the fingers. */
static void spawn(const hand_answer *a, rlf_vec3 position, rlf_vec3 direction, double speed)
{
    rlf_body_def def = rlf_body_def_default();
    if (a->scene->body_count > 0) {
        def = a->scene->bodies[0];
        def.name[0] = '\0';
    } else {
        def.shape.type = RLF_SHAPE_BOX;
        def.shape.size = rlf_vec3_make(SPAWN_SIZE_M, SPAWN_SIZE_M, SPAWN_SIZE_M);
        def.mass = SPAWN_MASS_KG;
    }
    rlf_body_id id;
    def.position = rlf_mad(position, direction, rlf_shape_radius(&def.shape));
    def.velocity = rlf_scale(direction, speed);
    def.angular_velocity = rlf_vec3_make(0, 0, 0);
    if (rlf_world_add_body(a->world, &def, &id) != RLF_OK) {
        rlf_log(RLF_LOG_INFO, "hands: no more bodies: %s", rlf_error_text());
    }
}

static void remove_body(const hand_answer *a, const rlf_hand_event *e, rlf_vec3 position,
                        rlf_vec3 direction)
{
    rlf_body_id id = {0, 0};
    if (e->kind == RLF_HAND_EVENT_POINT_BEGIN || e->kind == RLF_HAND_EVENT_POINT_END) {
        id = rlf_world_cast_ray(a->world, NULL, position, direction, POINT_RANGE_M).body;
    } else if (rlf_world_overlap_sphere(a->world, NULL, position, NEAR_M, &id, 1).body_count == 0) {
        return;
    }
    rlf_world_remove_body(a->world, id);
}

bool hand_stage_answer(const hand_stage *stage, const hand_answer *a)
{
    bool starts_anew = false;
    const int32_t count = stage->last != NULL ? stage->last->event_count : 0;
    for (int32_t k = 0; k < count; k++) {
        const rlf_hand_event *e = &stage->last->event[k];
        const rlf_vec3 position = rlf_transform(&a->T_world_camera, e->position);
        const rlf_vec3 direction = rlf_rotate(a->T_world_camera.q, e->direction);
        switch (a->scene->on[e->kind]) {
        case RLF_HAND_ACTION_SPAWN: spawn(a, position, direction, 0.0); break;
        case RLF_HAND_ACTION_THROW: spawn(a, position, direction, THROW_M_S); break;
        case RLF_HAND_ACTION_REMOVE: remove_body(a, e, position, direction); break;
        case RLF_HAND_ACTION_RESET: starts_anew = true; break;
        case RLF_HAND_ACTION_NONE:
        case RLF_HAND_ACTION_COUNT: break;
        }
    }
    return starts_anew;
}

rlf_result rlf_pipeline_set_hands(rlf_pipeline *p, bool is_on)
{
    return RLF_ASSERT(p != NULL) ? hand_stage_set(&p->hands, &p->compositor_def.grid, is_on)
                                 : RLF_ERROR_INVALID;
}

const rlf_hands *rlf_pipeline_hands(const rlf_pipeline *p)
{
    return RLF_ASSERT(p != NULL) ? p->hands.last : NULL;
}
