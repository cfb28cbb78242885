/* Sleep: a body that is still, and whose neighbours are, is left alone until something happens to
 * it. */
#include "physics/grid/mapped/mapped.h"
#include "physics/solver.h"

/* A body is still while its place, averaged over blocks of time, does not drift: the noise of a
 * depth camera shakes what rests on it (some tenths of a mm at 2 m), but a slope 0.05 degrees too
 * steep shifts a cube by 0.7 mm from its first quarter of a second to the second. */
#define BLOCK_TIME 0.25     /* s */
#define DRIFT_MAX 0.0004    /* m from block to block */
#define EXCURSION_MAX 0.004 /* m of any point from the place where the rest began */
#define STILL_SPEED 0.3     /* m/s of any point: faster is not still, wherever it is */
#define TOUCH_SPEED 0.02    /* m/s of what wakes a sleeper by touching it */
#define STILL_TIME 0.45     /* s, so two blocks without drift */
#define TOUCHING 0.001      /* m */
/* How far a surface may wander under a sleeper: several sigma of a depth camera at 2 m. Noise grows
 * with the square of the distance (Khoshelham and Elberink 2012). */
#define WANDER 0.006
#define WANDER_AT 2.0

static bool has_left_its_place(const phys_body *body)
{
    rlf_quat turn = rlf_quat_mul(body->q, rlf_quat_conjugate(body->still_q));
    double angle = 2.0 * rlf_length(rlf_vec3_make(turn.x, turn.y, turn.z)); /* for small angles */
    double moved = rlf_length(rlf_sub(body->x, body->still_x)) + angle * body->shape.radius;
    return moved > EXCURSION_MAX || phys_body_speed(body) > STILL_SPEED;
}

static void start_rest(phys_body *body)
{
    body->still_time = 0.0;
    body->still_x = body->x;
    body->still_q = body->q;
    body->block_sum = rlf_vec3_make(0, 0, 0);
    body->block_time = 0.0;
    body->has_block = false;
}

/* Counts the time that the body has been still, block by block. */
static void watch_rest(phys_body *body, double h)
{
    body->has_left = has_left_its_place(body);
    if (body->has_left) {
        start_rest(body);
        return;
    }
    body->block_sum = rlf_mad(body->block_sum, rlf_sub(body->x, body->still_x), h);
    body->block_time += h;
    if (body->block_time < BLOCK_TIME - 1e-9) {
        return;
    }
    rlf_vec3 mean = rlf_scale(body->block_sum, 1.0 / body->block_time);
    double drift = rlf_length(rlf_sub(mean, body->block_mean));
    if (body->has_block) {
        body->still_time = drift <= DRIFT_MAX ? body->still_time + body->block_time : 0.0;
    }
    body->has_block = true;
    body->block_mean = mean;
    body->block_sum = rlf_vec3_make(0, 0, 0);
    body->block_time = 0.0;
}

static double least_separation(const phys_body *body)
{
    double least = 1.0;
    for (int32_t i = 0; i < body->surface_count; i++) {
        least = rlf_min(least, body->surface[i].separation);
    }
    return least;
}

static double gap_now(const phys_body *body, const phys_contact *c)
{
    rlf_vec3 r = phys_contact_arm(c, body);
    return rlf_dot(c->normal, rlf_sub(rlf_add(body->x, r), c->anchor_b));
}

/* Whether the surface moves and touches there, or will within `horizon` seconds. */
static bool is_reached(const phys_contact *c, double horizon)
{
    double coming = rlf_max(0.0, rlf_dot(c->normal, c->surface_velocity));
    return c->separation < TOUCHING + coming * horizon &&
           rlf_length(c->surface_velocity) > TOUCH_SPEED;
}

static double wander_of(const grid_query *query, const phys_body *body)
{
    double far = rlf_transform(&query->T_grid_world, body->x).z / WANDER_AT;
    return WANDER * rlf_max(1.0, far * far);
}

/* Asks the surface under a sleeper once more; whether it moves, came closer or went away. */
static bool has_moved(const grid_query *query, phys_body *body, int32_t index, double horizon)
{
    double before = least_separation(body);
    bool is_moved = false;
    grid_collide(query, body, index);
    for (int32_t k = 0; k < body->surface_count; k++) {
        phys_contact *c = &body->surface[k];
        c->separation = gap_now(body, c);
        is_moved = is_moved || is_reached(c, horizon);
    }
    double change = least_separation(body) - before, wander = wander_of(query, body);
    return is_moved || change > wander || change < -wander;
}

/* Whether the grid sees all places at which a sleeper touches the surface. In a room that is known
 * one that nobody sees sleeps on: what it lies on is not gone because its pixels are. */
static bool is_watched(const grid_query *query, const phys_body *body)
{
    for (int32_t i = 0; i < body->surface_count; i++) {
        rlf_vec3 p = rlf_transform(&query->T_grid_world, body->surface[i].anchor_b);
        if (!mapped_is_seen(query->grid, p)) {
            return false;
        }
    }
    return mapped_is_seen(query->grid, rlf_transform(&query->T_grid_world, body->x));
}

void phys_wake_by_surface(rlf_world *world, const grid_query *query, double horizon)
{
    for (int32_t i = 0; i < world->body_top; i++) {
        phys_body *body = &world->bodies[i];
        if (!body->is_alive || !body->is_asleep) {
            continue;
        }
        if (query == NULL) {
            bool was_held = body->surface_count > 0;
            body->surface_count = 0;
            if (was_held) {
                phys_body_wake(body);
            }
            continue;
        }
        bool is_alone = !grid_collide_prepare(query, body);
        if (is_alone && (body->rest_version == world->rest_version ||
                         (world->map != NULL && !is_watched(query, body)))) {
            continue;
        }
        body->rest_version = is_alone ? world->rest_version : 0;
        if (has_moved(query, body, i, horizon)) {
            phys_body_wake(body);
        }
    }
}

/* Whether two bodies touch, or will when one comes nearer by `way`. */
static bool touches(const phys_pair *pair, double way)
{
    for (int32_t i = 0; i < pair->contact_count; i++) {
        if (pair->contacts[i].separation < TOUCHING + way) {
            return true;
        }
    }
    return false;
}

/* Moves, and not for long at the same place. */
static bool is_restless(const phys_body *body)
{
    return phys_body_is_driven(body) || (phys_body_is_moving(body) && body->still_time <= 0.0);
}

void phys_wake_by_touch(rlf_world *world, double horizon)
{
    for (int32_t i = 0; i < world->pair_count; i++) {
        const phys_pair *pair = &world->pairs[i];
        phys_body *a = &world->bodies[pair->a], *b = &world->bodies[pair->b];
        if (a->is_asleep == b->is_asleep) {
            continue;
        }
        const phys_body *awake = a->is_asleep ? b : a;
        double speed = phys_body_speed(awake);
        bool is_hit = speed > TOUCH_SPEED && touches(pair, speed * horizon);
        bool is_left = awake->has_left && touches(pair, EXCURSION_MAX); /* however slowly */
        if (is_hit || is_left) {
            phys_body_wake(a->is_asleep ? a : b);
        }
    }
}

/* A restless body keeps those awake that it touches. */
static void disturb_neighbours(rlf_world *world)
{
    for (int32_t i = 0; i < world->pair_count; i++) {
        const phys_pair *pair = &world->pairs[i];
        phys_body *a = &world->bodies[pair->a], *b = &world->bodies[pair->b];
        if (!touches(pair, 0.0)) {
            continue;
        }
        if (is_restless(a)) {
            b->is_disturbed = true;
        }
        if (is_restless(b)) {
            a->is_disturbed = true;
        }
    }
}

void phys_fall_asleep(rlf_world *world, double h)
{
    bool is_any_tired = false;
    for (int32_t i = 0; i < world->body_top; i++) {
        phys_body *body = &world->bodies[i];
        body->is_disturbed = false;
        if (phys_body_is_moving(body)) {
            watch_rest(body, h);
            is_any_tired = is_any_tired || body->still_time > STILL_TIME;
        }
    }
    if (!is_any_tired) {
        return;
    }
    disturb_neighbours(world);
    for (int32_t i = 0; i < world->body_top; i++) {
        phys_body *body = &world->bodies[i];
        if (phys_body_is_moving(body) && body->still_time > STILL_TIME && !body->is_disturbed) {
            body->is_asleep = true;
            body->rest_version = 0;
            body->v = body->w = rlf_vec3_make(0, 0, 0);
            body->impact_shift = body->impact_turn = body->v;
        }
    }
}
