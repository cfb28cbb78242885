/* The world's life: making it, adding, finding and changing bodies. */
#include "physics/grab/grab.h"
#include "physics/grid/field.h"
#include "physics/pair/collide.h"
#include "physics/world_state.h"

#include "base/checks.h"

#include <string.h>

rlf_world_def rlf_world_def_default(void)
{
    rlf_world_def def = {
        .cookie = RLF_DEF_COOKIE,
        .method = RLF_PHYSICS_LIVE,
        .gravity = {0, 9.81, 0},
        .body_capacity = 1024,
        .contact_capacity = 16384,
        .step_hz = 240,
        .max_speed = 50,
        .bounds = {{-20, -20, -20}, {20, 20, 20}},
        .camera_capacity = 1,
    };
    return def;
}

static rlf_result check_world_def(const rlf_world_def *def)
{
    if (def->method != RLF_PHYSICS_LIVE && def->method != RLF_PHYSICS_THESIS) {
        return rlf_fail(RLF_ERROR_INVALID, "world def: method: %d is no method", (int)def->method);
    }
    if (!rlf_vec3_is_finite(def->gravity)) {
        return rlf_fail(RLF_ERROR_INVALID, "world def: gravity: not finite: give m/s^2");
    }
    if (def->body_capacity < 1 || def->body_capacity > 1000000) {
        return rlf_fail(RLF_ERROR_INVALID, "world def: body_capacity: %d: give 1 to 1000000",
                        (int)def->body_capacity);
    }
    if (def->contact_capacity < 1 || def->contact_capacity > 10000000) {
        return rlf_fail(RLF_ERROR_INVALID, "world def: contact_capacity: %d: give 1 to 10000000",
                        (int)def->contact_capacity);
    }
    if (!(def->step_hz >= 10 && def->step_hz <= 10000)) {
        return rlf_fail(RLF_ERROR_INVALID, "world def: step_hz: %g: give 10 to 10000",
                        def->step_hz);
    }
    if (!(def->contact_distance_m >= 0 && def->contact_distance_m <= 10)) {
        return rlf_fail(RLF_ERROR_INVALID, "world def: contact_distance_m: %g: give 0 to 10 m",
                        def->contact_distance_m);
    }
    if (!(def->max_speed > 0 && def->max_speed <= 1000)) {
        return rlf_fail(RLF_ERROR_INVALID, "world def: max_speed: %g: give up to 1000 m/s",
                        def->max_speed);
    }
    if (def->border != RLF_BORDER_OPEN && def->border != RLF_BORDER_EXTEND) {
        return rlf_fail(RLF_ERROR_INVALID, "world def: border: %d is neither open nor extend",
                        (int)def->border);
    }
    if (def->camera_capacity < 1 || def->camera_capacity > RLF_WORLD_CAMERAS_MAX) {
        return rlf_fail(RLF_ERROR_INVALID, "world def: camera_capacity: %d: give 1 to %d",
                        (int)def->camera_capacity, RLF_WORLD_CAMERAS_MAX);
    }
    rlf_vec3 size = rlf_sub(def->bounds.max, def->bounds.min);
    if (!rlf_vec3_is_finite(size) || !(size.x > 0 && size.y > 0 && size.z > 0)) {
        return rlf_fail(RLF_ERROR_INVALID, "world def: bounds: give min below max, finite");
    }
    return RLF_OK;
}

rlf_result rlf_world_create(const rlf_world_def *def, rlf_world **out)
{
    if (!RLF_ASSERT(out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    if (!RLF_ASSERT(def != NULL && def->cookie == RLF_DEF_COOKIE)) {
        return rlf_fail(RLF_ERROR_INVALID, "world def: start from rlf_world_def_default()");
    }
    rlf_result result = check_world_def(def);
    rlf_world *world = result == RLF_OK ? rlf_alloc(sizeof(*world)) : NULL;
    if (world == NULL) {
        return result == RLF_OK ? RLF_ERROR_MEMORY : result;
    }
    world->def = *def;
    if (!phys_world_allocate(world)) {
        rlf_world_destroy(&world);
        return RLF_ERROR_MEMORY;
    }
    phys_world_publish(world);
    *out = world;
    return RLF_OK;
}

void rlf_world_destroy(rlf_world **world)
{
    if (world == NULL || *world == NULL) {
        return;
    }
    rlf_world *w = *world;
    for (int32_t i = 0; w->bodies != NULL && i < w->body_top; i++) {
        phys_shape_finish(&w->bodies[i].shape);
    }
    phys_world_free(w);
    rlf_free(w);
    *world = NULL;
}

/* What rested on a body that goes or moves must notice. */
static void wake_near(rlf_world *world, const phys_body *body)
{
    for (int32_t i = 0; i < world->body_top; i++) {
        phys_body *other = &world->bodies[i];
        double reach = body->shape.radius + other->shape.radius + 0.02;
        rlf_vec3 d = rlf_sub(body->x, other->x);
        if (other->is_alive && rlf_dot(d, d) <= reach * reach) {
            phys_body_wake(other);
        }
    }
}

static void remove_body(rlf_world *world, int32_t index)
{
    phys_body *body = &world->bodies[index];
    wake_near(world, body);
    phys_shape_finish(&body->shape);
    phys_grab_forget(body);
    body->is_alive = false;
    world->has_free_slot = true;
    body->generation++;
    body->surface_count = 0;
    phys_drop_pairs(world, index);
}

void rlf_world_remove_body(rlf_world *world, rlf_body_id id)
{
    int32_t index = RLF_ASSERT(world != NULL) ? phys_find_body(world, id) : -1;
    if (index >= 0) {
        remove_body(world, index);
        phys_world_publish(world);
    }
}

void phys_world_remove_strays(rlf_world *world)
{
    for (int32_t i = 0; i < world->body_top; i++) {
        const phys_body *body = &world->bodies[i];
        if (body->is_alive && !(rlf_aabb_distance2(&world->def.bounds, body->x) == 0.0)) {
            remove_body(world, i);
        }
    }
}

bool rlf_world_set_body(rlf_world *world, rlf_body_id id, const rlf_pose *T_world_body,
                        rlf_vec3 velocity, rlf_vec3 angular_velocity)
{
    if (!RLF_ASSERT(world != NULL && T_world_body != NULL)) {
        return false;
    }
    int32_t index = phys_find_body(world, id);
    if (index < 0) {
        return false;
    }
    rlf_quat q = T_world_body->q;
    if (!rlf_vec3_is_finite(T_world_body->p) || !rlf_vec3_is_finite(velocity) ||
        !rlf_vec3_is_finite(angular_velocity) || !rlf_is_finite(q.x + q.y + q.z + q.w)) {
        return false;
    }
    phys_body *body = &world->bodies[index];
    wake_near(world, body);
    phys_grab_forget(body);
    body->x = T_world_body->p;
    body->q = rlf_quat_normalize(q);
    body->throw_v = velocity;
    body->throw_w = angular_velocity;
    if (!body->is_held) {
        body->v = velocity;
        body->w = angular_velocity;
    }
    body->surface_count = 0;
    memset(body->side, 0, sizeof(body->side));
    body->turned += RLF_PI; /* whatever the turn was: its contacts are void */
    phys_body_orient(body);
    wake_near(world, body);
    phys_world_publish(world);
    return true;
}

bool rlf_world_apply_impulse(rlf_world *world, rlf_body_id id, rlf_vec3 impulse, rlf_vec3 point)
{
    int32_t index = RLF_ASSERT(world != NULL) ? phys_find_body(world, id) : -1;
    if (index < 0 || !rlf_vec3_is_finite(impulse) || !rlf_vec3_is_finite(point)) {
        return false;
    }
    phys_body *body = &world->bodies[index];
    phys_body_wake(body);
    phys_body_push(body, impulse, rlf_sub(point, body->x));
    phys_world_publish(world);
    return true;
}

bool rlf_world_apply_force(rlf_world *world, rlf_body_id id, rlf_vec3 force, rlf_vec3 point)
{
    int32_t index = RLF_ASSERT(world != NULL) ? phys_find_body(world, id) : -1;
    if (index < 0 || !rlf_vec3_is_finite(force) || !rlf_vec3_is_finite(point)) {
        return false;
    }
    phys_body *body = &world->bodies[index];
    phys_body_wake(body);
    body->force = rlf_add(body->force, force);
    body->torque = rlf_add(body->torque, rlf_cross(rlf_sub(point, body->x), force));
    return true;
}

bool rlf_world_set_gravity(rlf_world *world, rlf_vec3 gravity)
{
    if (!RLF_ASSERT(world != NULL) || !rlf_vec3_is_finite(gravity)) {
        return false;
    }
    world->def.gravity = gravity;
    world->snapshot.gravity = gravity;
    for (int32_t i = 0; i < world->body_top; i++) {
        if (world->bodies[i].is_alive) {
            phys_body_wake(&world->bodies[i]);
        }
    }
    return true;
}

void rlf_world_set_room(rlf_world *world, const struct rlf_map *room)
{
    if (RLF_ASSERT(world != NULL)) {
        world->map = room;
    }
}

void rlf_world_reset(rlf_world *world)
{
    if (!RLF_ASSERT(world != NULL)) {
        return;
    }
    for (int32_t i = 0; i < world->body_top; i++) {
        if (world->bodies[i].is_alive) {
            remove_body(world, i);
        }
    }
    world->log_begin += world->log_count;
    world->log_count = 0;
    world->touch_count = world->event_count = 0;
    world->time = 0.0;
    world->frame = 0;
    for (int32_t k = 0; k < RLF_WORLD_CAMERAS_MAX; k++) {
        world->views[k].has_grid = false;
    }
    memset(&world->room, 0, sizeof(world->room));
    memset(world->grab_hands, 0, RLF_GRID_HANDS_MAX * sizeof(*world->grab_hands));
    phys_world_publish(world);
}

/* Each camera once, and the world has room for it. */
static bool are_grids_whole(const rlf_world *world, const rlf_grid *grid)
{
    uint32_t seen = 0;
    bool is_first = true;
    for (const rlf_grid *one = grid; one != NULL; one = one->next, is_first = false) {
        if (one->camera < 0 || one->camera >= world->def.camera_capacity ||
            (seen >> one->camera & 1u) != 0 || (is_first && one->camera != 0) ||
            !grid_is_whole(one)) {
            return false;
        }
        seen |= 1u << one->camera;
    }
    return true;
}

void rlf_world_advance(rlf_world *world, const rlf_grid *grid, double dt)
{
    if (!RLF_ASSERT(world != NULL) || !RLF_ASSERT(dt > 0.0 && dt <= 1.0) ||
        !RLF_ASSERT(are_grids_whole(world, grid))) {
        return;
    }
    world->log_begin += world->log_count;
    world->log_count = 0;
    memset(&world->times, 0, sizeof(world->times));
    if (world->def.method == RLF_PHYSICS_THESIS) {
        phys_thesis_advance(world, grid, dt);
    } else {
        phys_live_advance(world, grid, dt);
    }
    for (int32_t i = 0; i < world->body_top; i++) {
        world->bodies[i].force = rlf_vec3_make(0, 0, 0);
        world->bodies[i].torque = rlf_vec3_make(0, 0, 0);
    }
    int64_t clock = rlf_clock_ns();
    world->frame++;
    phys_world_remove_strays(world);
    phys_find_events(world);
    phys_world_publish(world);
    phys_clock(&clock, &world->times.publish_ms);
}

rlf_world_times rlf_world_get_times(const rlf_world *world)
{
    const rlf_world_times none = {0};
    return RLF_ASSERT(world != NULL) ? world->times : none;
}
