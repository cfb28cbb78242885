/* Collisions checked against the true scene: where a body bounced, was there something, and did the
 * contact normal point where the true surface's normal points? */
#include "eval/measures/collisions.h"

#include "eval/analytic.h"
#include "eval/measures/angles.h"

#include <stdio.h>
#include <string.h>

#define FLIGHT_S 0.1          /* without a touch before it counts as a bounce again */
#define BOUNCE_SPEED 0.3      /* m/s */
#define PHANTOM_DISTANCE 0.05 /* m: a person moves 4 cm in a frame */

/* A 10 to 20 cm cube that flies towards a point of the room, released at its turn. */
static rlf_body_def thrown_cube(eval_random *state, int32_t index)
{
    rlf_body_def def = rlf_body_def_default();
    snprintf(def.name, sizeof(def.name), "cube_%d", (int)index);
    double edge = eval_random_range(state, 0.1, 0.2);
    def.shape.size = rlf_vec3_make(edge, edge, edge);
    def.release_time = 0.4 + 0.12 * index;
    double side = index % 3 - 1.0; /* from the left, the camera, the right */
    double z = side == 0.0 ? 0.5 : 1.8;
    def.position = eval_random_in_box(state, rlf_vec3_make(side * 0.9 - 0.2, -0.5, z - 0.1),
                                      rlf_vec3_make(side * 0.9 + 0.2, 0.1, z + 0.3));
    rlf_vec3 target =
        eval_random_in_box(state, rlf_vec3_make(-1, -0.6, 2), rlf_vec3_make(1, 0.8, 3.2));
    rlf_vec3 direction = rlf_normalize(rlf_sub(target, def.position));
    def.velocity = rlf_scale(direction, eval_random_range(state, 2.0, 5.0));
    def.angular_velocity =
        eval_random_in_box(state, rlf_vec3_make(-6, -6, -6), rlf_vec3_make(6, 6, 6));
    def.collides_with_bodies = false; /* every bounce is one on the real scene */
    return def;
}

rlf_result eval_collisions_scene(uint64_t seed, int32_t body_count, rlf_scene *out)
{
    memset(out, 0, sizeof(*out));
    out->gravity = rlf_vec3_make(0, 9.81, 0);
    out->border = RLF_BORDER_EXTEND; /* an open one asks for no floor behind what hides it */
    out->bodies = rlf_alloc_array((size_t)body_count, sizeof(*out->bodies));
    if (out->bodies == NULL) {
        return RLF_ERROR_MEMORY;
    }
    out->body_count = body_count;
    eval_random state = eval_random_start(seed);
    for (int32_t i = 0; i < body_count; i++) {
        out->bodies[i] = thrown_cube(&state, i);
    }
    return RLF_OK;
}

rlf_result eval_collisions_init(eval_collisions *e, int32_t body_capacity)
{
    memset(e, 0, sizeof(*e));
    e->body_capacity = body_capacity;
    e->was_inside = rlf_alloc_array((size_t)body_capacity, sizeof(bool));
    e->last_touch_s = rlf_alloc_array((size_t)body_capacity, sizeof(double));
    return e->was_inside != NULL && e->last_touch_s != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

void eval_collisions_restart(eval_collisions *e)
{
    for (int32_t i = 0; i < e->body_capacity; i++) {
        e->was_inside[i] = false;
        e->last_touch_s[i] = -FLIGHT_S;
    }
}

void eval_collisions_finish(eval_collisions *e)
{
    rlf_free(e->was_inside);
    rlf_free(e->last_touch_s);
    e->was_inside = NULL;
    e->last_touch_s = NULL;
}

static double degrees_between(rlf_vec3 a, rlf_vec3 b)
{
    return rlf_acos(rlf_dot(a, b)) * 180.0 / RLF_PI;
}

/* At an edge of the scene all directions between its faces are right: there the true distance grows
 * along the contact normal itself. How far from that way it grows, 5 cm on, where a corner
 * misplaced by 9 mm shows as 10 degrees. */
static double degrees_ahead(const rlf_contact *contact, rlf_source *source)
{
    const double AHEAD = 0.05;
    double distance;
    rlf_vec3 normal;
    int32_t label;
    rlf_vec3 p = rlf_mad(contact->point, contact->normal, AHEAD);
    bool is_known = rlf_synthetic_distance(source, p, &distance, &normal, &label) == RLF_OK;
    return is_known ? degrees_between(contact->normal, normal) : 180.0;
}

void eval_collisions_judge(eval_collisions *e, const rlf_contact *contact, rlf_source *source)
{
    double distance;
    rlf_vec3 normal;
    int32_t label;
    if (rlf_synthetic_distance(source, contact->point, &distance, &normal, &label) != RLF_OK) {
        return;
    }
    e->bounces++;
    if (distance > PHANTOM_DISTANCE || distance < -PHANTOM_DISTANCE) {
        e->phantom++;
        return;
    }
    e->off_m += distance < 0.0 ? -distance : distance;
    double degrees = degrees_between(contact->normal, normal);
    double least = rlf_min(degrees, degrees_ahead(contact, source));
    eval_add_angle(&e->angles, degrees);
    e->right += least <= 10.0;
    e->wrong += degrees > 30.0;
    e->unexplained += least > 30.0;
}

/* Outside the view nothing is known of the room, so bodies leave it there. */
static bool is_in_view(rlf_source *source, rlf_vec3 p)
{
    const rlf_camera *camera = &rlf_source_get_info(source)->rig.depth;
    double u, v;
    return rlf_camera_project(camera, p, &u, &v) && u >= 0.0 && v >= 0.0 &&
           u <= camera->width - 1 && v <= camera->height - 1;
}

static void note_bounces(eval_collisions *e, const rlf_snapshot *snapshot, rlf_source *source)
{
    double now_s = (double)snapshot->time_ns * 1e-9;
    for (int32_t i = 0; i < snapshot->contact_count; i++) {
        const rlf_contact *contact = &snapshot->contacts[i];
        int32_t index = (int32_t)contact->body.index1 - 1;
        if (contact->other == RLF_CONTACT_BODY || contact->impulse <= 0.0 || index < 0 ||
            index >= e->body_capacity) {
            continue;
        }
        bool was_flying = now_s - e->last_touch_s[index] >= FLIGHT_S;
        e->last_touch_s[index] = now_s;
        if (was_flying && contact->approach_speed > BOUNCE_SPEED) {
            eval_collisions_judge(e, contact, source);
        }
    }
}

void eval_collisions_add(eval_collisions *e, const rlf_snapshot *snapshot, rlf_source *source)
{
    note_bounces(e, snapshot, source);
    for (int32_t i = 0; i < snapshot->body_count; i++) {
        const rlf_body_state *body = &snapshot->bodies[i];
        int32_t index = (int32_t)body->id.index1 - 1;
        double distance;
        rlf_vec3 normal;
        int32_t label;
        if (index < 0 || index >= e->body_capacity || body->is_held ||
            rlf_synthetic_distance(source, body->T_world_body.p, &distance, &normal, &label) !=
                RLF_OK) {
            continue;
        }
        bool is_inside = distance < 0.0 && is_in_view(source, body->T_world_body.p);
        e->entries += is_inside && !e->was_inside[index];
        e->was_inside[index] = is_inside;
    }
}
