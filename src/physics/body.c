/* Bodies: made from their defs, found, woken, released from being held. */
#include "physics/world_state.h"

#include "base/checks.h"

#include <stdio.h>
#include <string.h>

rlf_body_def rlf_body_def_default(void)
{
    rlf_body_def def = {
        .cookie = RLF_DEF_COOKIE,
        .shape = {.type = RLF_SHAPE_BOX, .size = {0.1, 0.1, 0.1}},
        .look = {.scale = 1},
        .mass = 0.1,
        .position = {0, 0, 1},
        .orientation = {0, 0, 0, 1},
        .restitution = 0.5,
        .friction = 0.5,
        .gravity_scale = 1,
        .collides_with_bodies = true,
        .color = {1.0f, 0.6f, 0.1f},
    };
    return def;
}

static rlf_result check_vectors(const rlf_body_def *def)
{
    const char *field = NULL;
    rlf_quat q = def->orientation;
    if (!rlf_vec3_is_finite(def->position)) {
        field = "position";
    } else if (!(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w > 1e-12) ||
               !rlf_is_finite(q.x + q.y + q.z + q.w)) {
        field = "orientation";
    } else if (!rlf_vec3_is_finite(def->velocity)) {
        field = "velocity";
    } else if (!rlf_vec3_is_finite(def->angular_velocity)) {
        field = "angular_velocity";
    } else if (!rlf_vec3_is_finite(def->look.offset)) {
        field = "look.offset";
    } else if (!rlf_is_finite(def->look.scale) || !(def->look.scale > 0)) {
        field = "look.scale";
    } else if (!rlf_is_finite(def->color[0] + def->color[1] + def->color[2])) {
        field = "color";
    }
    if (field != NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "body def: %s: not a finite value that can be used",
                        field);
    }
    return RLF_OK;
}

static rlf_result check_body_def(const rlf_body_def *def)
{
    if (memchr(def->name, 0, sizeof(def->name)) == NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "body def: name: no ending zero in %d bytes",
                        RLF_NAME_MAX);
    }
    if (!(def->mass > 1e-9 && def->mass <= 1e6)) {
        return rlf_fail(RLF_ERROR_INVALID, "body def: mass: %g: give kilograms above 0", def->mass);
    }
    if (!(def->restitution >= 0 && def->restitution <= 1)) {
        return rlf_fail(RLF_ERROR_INVALID, "body def: restitution: %g: give 0 to 1",
                        def->restitution);
    }
    if (!(def->friction >= 0 && def->friction <= 1e3)) {
        return rlf_fail(RLF_ERROR_INVALID, "body def: friction: %g: give 0 to 1000", def->friction);
    }
    if (!(def->rolling_resistance >= 0 && def->rolling_resistance <= 1e3)) {
        return rlf_fail(RLF_ERROR_INVALID, "body def: rolling_resistance: %g: give 0 to 1000",
                        def->rolling_resistance);
    }
    if (!rlf_is_finite(def->gravity_scale)) {
        return rlf_fail(RLF_ERROR_INVALID, "body def: gravity_scale: not finite");
    }
    if (!rlf_is_finite(def->release_time)) {
        return rlf_fail(RLF_ERROR_INVALID, "body def: release_time: not finite");
    }
    if (!(def->linear_damping >= 0 && def->linear_damping <= 1e3) ||
        !(def->angular_damping >= 0 && def->angular_damping <= 1e3)) {
        return rlf_fail(RLF_ERROR_INVALID, "body def: linear_damping, angular_damping: give 0 to "
                                           "1000 per second");
    }
    rlf_result result = check_vectors(def);
    return result == RLF_OK ? phys_shape_check(&def->shape) : result;
}

static bool is_isotropic(const rlf_mat3 *inertia)
{
    double d = inertia->m[0][0];
    double tolerance = 1e-12 * d;
    for (int32_t i = 0; i < 9; i++) {
        double off = inertia->m[i / 3][i % 3] - (i / 3 == i % 3 ? d : 0.0);
        if (off > tolerance || off < -tolerance) {
            return false;
        }
    }
    return true;
}

static void set_held(phys_body *body, bool is_held)
{
    body->is_held = is_held;
    body->inverse_mass = is_held || body->is_kinematic ? 0.0 : 1.0 / body->mass;
    body->v = is_held ? rlf_vec3_make(0, 0, 0) : body->throw_v;
    body->w = is_held ? rlf_vec3_make(0, 0, 0) : body->throw_w;
    phys_body_orient(body);
}

static void fill_body(phys_body *body, const rlf_body_def *def, int32_t index)
{
    if (def->name[0] != 0) {
        memcpy(body->name, def->name, sizeof(body->name));
    } else {
        snprintf(body->name, sizeof(body->name), "body-%d", (int)index + 1);
    }
    memcpy(body->color, def->color, sizeof(body->color));
    body->look = def->look;
    body->mass = def->mass;
    body->restitution = def->restitution;
    body->friction = def->friction;
    body->gravity_scale = def->gravity_scale;
    body->rolling_resistance = def->rolling_resistance;
    body->release_time = def->release_time;
    body->linear_damping = def->linear_damping;
    body->angular_damping = def->angular_damping;
    body->is_kinematic = def->is_kinematic || def->is_real;
    body->is_real = def->is_real;
    body->collides_with_bodies = def->collides_with_bodies;
    body->x = def->position;
    body->throw_v = def->velocity;
    body->throw_w = def->angular_velocity;
    body->q = rlf_quat_normalize(def->orientation);
    body->inertia = rlf_shape_inertia(&def->shape, def->mass);
    body->is_isotropic = is_isotropic(&body->inertia);
}

rlf_result rlf_world_add_body(rlf_world *world, const rlf_body_def *def, rlf_body_id *out_id)
{
    if (!RLF_ASSERT(world != NULL && def != NULL && def->cookie == RLF_DEF_COOKIE)) {
        return rlf_fail(RLF_ERROR_INVALID, "body def: start from rlf_body_def_default()");
    }
    rlf_result result = check_body_def(def);
    if (result != RLF_OK) {
        return result;
    }
    if ((def->is_kinematic || def->is_real) && world->def.method == RLF_PHYSICS_THESIS) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "body def: %s: the thesis's method has no such bodies, use profile live",
                        def->is_real ? "is_real" : "is_kinematic");
    }
    int32_t index = world->has_free_slot ? 0 : world->body_top;
    while (index < world->body_top && world->bodies[index].is_alive) {
        index++;
    }
    world->has_free_slot = index < world->body_top;
    if (index == world->def.body_capacity) {
        return rlf_fail(RLF_ERROR_CAPACITY, "world: all %d bodies are in use: raise body_capacity",
                        (int)world->def.body_capacity);
    }
    phys_body *body = &world->bodies[index];
    phys_body fresh = {.generation = body->generation > 0 ? body->generation : 1};
    fresh.surface = &world->surface[(size_t)index * PHYS_SURFACE_CONTACTS];
    result =
        phys_shape_init(&fresh.shape, &def->shape, &world->points[(size_t)index * PHYS_POINTS_MAX]);
    if (result != RLF_OK) {
        return result;
    }
    fill_body(&fresh, def, index);
    if (!rlf_mat3_invert(&fresh.inertia, &fresh.inverse_inertia)) {
        phys_shape_finish(&fresh.shape);
        return rlf_fail(RLF_ERROR_INVALID, "body def: shape: its inertia tensor has no inverse");
    }
    fresh.is_alive = true;
    set_held(&fresh, world->time < def->release_time);
    *body = fresh;
    if (index == world->body_top) {
        world->body_top++;
    }
    if (out_id != NULL) {
        *out_id = phys_body_id(world, index);
    }
    if (index == world->body_top - 1 && !def->is_real && world->snapshot.known_count == 0) {
        phys_world_publish_last(world);
    } else {
        phys_world_publish(world);
    }
    return RLF_OK;
}

void phys_world_release(rlf_world *world)
{
    for (int32_t i = 0; i < world->body_top; i++) {
        phys_body *body = &world->bodies[i];
        if (body->is_alive && body->is_held && world->time >= body->release_time - 1e-9) {
            set_held(body, false);
            phys_body_wake(body);
        }
    }
}

void phys_body_wake(phys_body *body)
{
    body->is_asleep = false;
    body->still_time = 0.0;
    body->has_block = false;
    phys_body_ask_surface(body);
}

int32_t phys_find_body(const rlf_world *world, rlf_body_id id)
{
    if (world == NULL || id.index1 < 1 || id.index1 > (uint32_t)world->body_top) {
        return -1;
    }
    int32_t index = (int32_t)(id.index1 - 1);
    const phys_body *body = &world->bodies[index];
    return body->is_alive && body->generation == id.generation ? index : -1;
}

bool rlf_world_has_body(const rlf_world *world, rlf_body_id id)
{
    return RLF_ASSERT(world != NULL) && phys_find_body(world, id) >= 0;
}

bool rlf_world_get_body_def(const rlf_world *world, rlf_body_id id, rlf_body_def *out)
{
    const int32_t index = RLF_ASSERT(world != NULL && out != NULL) ? phys_find_body(world, id) : -1;
    if (index < 0) {
        return false;
    }
    const phys_body *body = &world->bodies[index];
    *out = (rlf_body_def){
        .cookie = RLF_DEF_COOKIE,
        .shape = body->shape.shape,
        .look = body->look,
        .mass = body->mass,
        .position = body->x,
        .orientation = body->q,
        .velocity = body->is_held ? body->throw_v : body->v,
        .angular_velocity = body->is_held ? body->throw_w : body->w,
        .restitution = body->restitution,
        .friction = body->friction,
        .gravity_scale = body->gravity_scale,
        .release_time = body->release_time,
        .collides_with_bodies = body->collides_with_bodies,
        .rolling_resistance = body->rolling_resistance,
        .linear_damping = body->linear_damping,
        .angular_damping = body->angular_damping,
        .is_kinematic = body->is_kinematic,
        .is_real = body->is_real,
    };
    memcpy(out->name, body->name, sizeof(out->name));
    memcpy(out->color, body->color, sizeof(out->color));
    return true;
}
