/* Islands, and what happens to one in a substep. No two islands share a body that moves, so they
 * may be worked on in any order. */
#include "physics/fetch.h"
#include "physics/grab/grab.h"
#include "physics/grid/contact/contact.h"
#include "physics/solver.h"

#define SOLVE_PASSES 6
/* A blow that is not taken out in full leaves a turn: the smaller the body, the faster. */
#define HARD_SOLVE_PASSES 40
#define RELAX_PASSES 2
/* Where much is pushed apart at once, speeds add up through all of it: they are taken out again. */
#define DEEP_RELAX_PASSES 40
#define WORK_LEAST 256 /* bodies and pairs that are worked on together, in one island or more */

static int32_t root_of(rlf_world *world, int32_t i)
{
    while (world->parent[i] != i) {
        world->parent[i] = world->parent[world->parent[i]];
        i = world->parent[i];
    }
    return i;
}

/* Pairs that touch now, or that will be searched again before the islands are. */
static bool links(const phys_pair *pair)
{
    return pair->contact_count > 0 || pair->period < PHYS_PERIOD_MAX;
}

static void unite(rlf_world *world)
{
    for (int32_t i = 0; i < world->body_top; i++) {
        world->parent[i] = i;
    }
    for (int32_t k = 0; k < world->pair_count; k++) {
        const phys_pair *pair = &world->pairs[k];
        if (links(pair) && phys_body_is_moving(&world->bodies[pair->a]) &&
            phys_body_is_moving(&world->bodies[pair->b])) {
            int32_t a = root_of(world, pair->a), b = root_of(world, pair->b);
            world->parent[a > b ? a : b] = a > b ? b : a; /* the lowest body is the root */
        }
    }
}

/* The island of a pair: that of one of its bodies that moves; -1 when neither does, or when there
 * is nothing between them. */
static int32_t island_of_pair(const rlf_world *world, const phys_pair *pair)
{
    if (!links(pair)) {
        return -1;
    }
    if (phys_body_is_moving(&world->bodies[pair->a])) {
        return world->island_of[pair->a];
    }
    return phys_body_is_moving(&world->bodies[pair->b]) ? world->island_of[pair->b] : -1;
}

/* Numbers the islands by their lowest body and counts what they hold in the ..._end fields. */
static void count_islands(rlf_world *world)
{
    world->island_count = 0;
    for (int32_t i = 0; i < world->body_top; i++) {
        if (!phys_body_is_moving(&world->bodies[i])) {
            continue;
        }
        int32_t root = root_of(world, i);
        if (root == i) {
            world->island_of[i] = world->island_count;
            world->islands[world->island_count++] = (phys_island){0, 0, 0, 0};
        }
        world->island_of[i] = world->island_of[root];
        world->islands[world->island_of[i]].body_end++;
    }
    for (int32_t k = 0; k < world->pair_count; k++) {
        int32_t island = island_of_pair(world, &world->pairs[k]);
        if (island >= 0) {
            world->islands[island].pair_end++;
        }
    }
}

static void load_speed(rlf_world *world, int32_t i)
{
    const phys_body *body = &world->bodies[i];
    world->speeds[i] = (rlf_lane_speed){{(float)body->v.x, (float)body->v.y, (float)body->v.z,
                                         (float)body->w.x, (float)body->w.y, (float)body->w.z}};
    world->old_speeds[i] = world->speeds[i];
}

static void start_speed(rlf_world *world, int32_t i)
{
    load_speed(world, i);
    world->lightness[i] = 1.0f;
}

/* Adds what has changed since it was loaded: what nothing touches keeps all its digits. The old
 * ones come from memory: GCC 12 vectorises (double)(float)x to x here. */
static void store_speed(rlf_world *world, int32_t i)
{
    phys_body *body = &world->bodies[i];
    const float *now = world->speeds[i].of, *old = world->old_speeds[i].of;
    double change[6];
    for (int32_t k = 0; k < 6; k++) {
        change[k] = (double)now[k] - (double)old[k];
    }
    body->v = rlf_add(body->v, rlf_vec3_make(change[0], change[1], change[2]));
    body->w = rlf_add(body->w, rlf_vec3_make(change[3], change[4], change[5]));
}

/* Small islands are worked on together, so that the solver's lanes are full. */
static void join_islands(rlf_world *world)
{
    int32_t kept = -1;
    for (int32_t i = 0; i < world->island_count; i++) {
        phys_island island = world->islands[i], *last = &world->islands[kept < 0 ? 0 : kept];
        if (kept < 0 || last->body_end + last->pair_end >= WORK_LEAST) {
            world->islands[++kept] = island;
        } else {
            last->body_end += island.body_end;
            last->pair_end += island.pair_end;
        }
        world->parent[i] = kept; /* the bodies' own parents are not needed any more */
    }
    world->island_count = kept + 1;
    for (int32_t i = 0; i < world->body_top; i++) {
        if (phys_body_is_moving(&world->bodies[i])) {
            world->island_of[i] = world->parent[world->island_of[i]];
        }
    }
}

void phys_find_islands(rlf_world *world)
{
    unite(world);
    count_islands(world);
    join_islands(world);
    int32_t bodies = 0, pairs = 0;
    for (int32_t i = 0; i < world->island_count; i++) {
        phys_island *island = &world->islands[i];
        int32_t body_count = island->body_end, pair_count = island->pair_end;
        *island = (phys_island){bodies, bodies, pairs, pairs};
        bodies += body_count;
        pairs += pair_count;
    }
    for (int32_t i = 0; i < world->body_top; i++) {
        if (phys_body_is_moving(&world->bodies[i])) {
            world->island_bodies[world->islands[world->island_of[i]].body_end++] = i;
        } else {
            load_speed(world, i); /* that of what pushes others stays until the next search */
            world->bodies[i].speed = phys_body_speed(&world->bodies[i]);
        }
    }
    for (int32_t k = 0; k < world->pair_count; k++) {
        int32_t island = island_of_pair(world, &world->pairs[k]);
        if (island >= 0) {
            world->island_pairs[world->islands[island].pair_end++] = k;
        }
    }
}

static void start_body(const rlf_world *world, phys_body *body)
{
    rlf_vec3 zero = {0, 0, 0};
    body->impact_shift = body->impact_turn = zero;
    body->impact_time = 0.0;
    body->speed = phys_body_speed(body);
    body->was_pressed = body->is_pressed;
    body->is_pressed = false;
    rlf_vec3 gravity = rlf_scale(world->def.gravity, body->gravity_scale);
    body->acceleration = rlf_mad(gravity, body->force, body->inverse_mass);
    body->pull = rlf_length(body->acceleration);
    body->angular_acceleration = rlf_mat3_mul_vec(&body->inverse_inertia_world, body->torque);
    if (body->grab != NULL) {
        phys_grab_pull(world, body);
    }
}

static void limit_speed(phys_body *body, double max_speed, double h)
{
    double speed = rlf_length(body->v);
    double spin = rlf_length(body->w) * h;
    if (speed > max_speed) {
        body->v = rlf_scale(body->v, max_speed / speed);
    }
    if (spin > 1.0) { /* one radian per substep */
        body->w = rlf_scale(body->w, 1.0 / spin);
    }
}

static void accelerate(const rlf_world *world, phys_body *body, double h)
{
    body->v = rlf_mad(body->v, body->acceleration, h);
    body->w = rlf_mad(body->w, body->angular_acceleration, h);
    if (body->linear_damping > 0.0) {
        body->v = rlf_scale(body->v, rlf_exp(-body->linear_damping * h));
    }
    if (body->angular_damping > 0.0) {
        body->w = rlf_scale(body->w, rlf_exp(-body->angular_damping * h));
    }
    limit_speed(body, world->def.max_speed, h);
}

static void move_body(const rlf_world *world, phys_body *body, const grid_query *query, double h)
{
    rlf_vec3 before = body->x;
    limit_speed(body, world->def.max_speed, h);
    phys_integrate_position(body, h);
    rlf_vec3 moved = rlf_sub(body->x, before);
    if (query != NULL && rlf_length(moved) > 0.1 * body->shape.inner_radius &&
        !phys_body_is_clear(body)) {
        grid_guard_centre(query, body, (int32_t)(body - world->bodies), before);
    }
}

enum { PAIRS_AHEAD = 8, CONTACTS_AHEAD = 4, BODIES_AHEAD = 4 };

/* Fetches what the groups of the pairs after the k-th of the island will be read from. */
RLF_KERNEL_PART void fetch_pairs(const rlf_world *world, const phys_island *island, int32_t k)
{
    if (k + PAIRS_AHEAD < island->pair_end) {
        phys_fetch(&world->pairs[world->island_pairs[k + PAIRS_AHEAD]], sizeof(phys_pair));
    }
    if (k + CONTACTS_AHEAD < island->pair_end) {
        const phys_pair *pair = &world->pairs[world->island_pairs[k + CONTACTS_AHEAD]];
        phys_fetch_near(pair->contacts, pair->contact_count);
        phys_fetch_place(&world->bodies[pair->b]); /* a's is that of the pair before */
    }
}

/* The body some places after the i-th of the island. */
static inline const phys_body *next_body(const rlf_world *world, const phys_island *island,
                                         int32_t i)
{
    int32_t next = i + BODIES_AHEAD < island->body_end ? i + BODIES_AHEAD : i;
    return &world->bodies[world->island_bodies[next]];
}

RLF_KERNEL_PART void fetch_surface(const rlf_world *world, const phys_island *island, int32_t i)
{
    const phys_body *far =
        next_body(world, island, i + CONTACTS_AHEAD < island->body_end ? i + CONTACTS_AHEAD : i);
    const phys_body *body = next_body(world, island, i);
    phys_fetch_place(far);
    phys_fetch_weight(far);
    phys_fetch(body->surface, (size_t)body->surface_count * sizeof(phys_contact));
}

/* What the parts of a substep read of it. */
RLF_KERNEL_PART void fetch_to_start(const phys_body *body)
{
    phys_fetch_motion(body);
    phys_fetch_push(body);
    phys_fetch_weight(body);
}

RLF_KERNEL_PART void fetch_to_accelerate(const phys_body *body)
{
    phys_fetch_motion(body);
    phys_fetch_push(body);
}

RLF_KERNEL_PART void fetch_to_move(const phys_body *body)
{
    phys_fetch_motion(body);
    phys_fetch_place(body);
    RLF_KERNEL_SOON(&body->shape);
}

/* Lists the island's groups that may touch in this substep: its pairs first. The real surface comes
 * last: nothing gives way less. Returns their number. */
static int32_t list_groups(rlf_world *world, const phys_island *island, phys_group *groups,
                           double h)
{
    phys_point *points = world->near_points + island->pair_begin * PHYS_PAIR_CONTACTS +
                         island->body_begin * PHYS_SURFACE_CONTACTS;
    int32_t count = 0;
    for (int32_t k = island->pair_begin; k < island->pair_end; k++) {
        fetch_pairs(world, island, k);
        if (phys_group_of_pair(world, world->island_pairs[k], h, points, &groups[count])) {
            points += groups[count++].point_count;
        }
    }
    for (int32_t i = island->body_begin; i < island->body_end; i++) {
        fetch_surface(world, island, i);
        if (phys_group_of_body(world, world->island_bodies[i], h, points, &groups[count])) {
            points += groups[count++].point_count;
        }
    }
    return count;
}

static void mark_pressed(const phys_batch *batch)
{
    for (int32_t i = 0; i < batch->lanes.point_count; i++) {
        for (int32_t lane = 0; lane < batch->count; lane++) {
            const phys_group *g = batch->groups[lane];
            bool is_pressed = batch->lanes.points[i].impulse[0][lane] > 0.0f;
            if (is_pressed && batch->lanes.inverse_mass_a[lane] > 0.0f) {
                g->a->is_pressed = true;
            }
            if (is_pressed && batch->lanes.inverse_mass_b[lane] > 0.0f) {
                g->b->is_pressed = true;
            }
        }
    }
}

static int32_t solve_passes(const phys_batch *batches, int32_t count)
{
    for (int32_t k = 0; k < count; k++) {
        if (batches[k].is_hard) {
            return HARD_SOLVE_PASSES;
        }
    }
    return SOLVE_PASSES;
}

static int32_t relax_passes(const phys_batch *batches, int32_t count)
{
    for (int32_t k = 0; k < count; k++) {
        if (batches[k].is_deep) {
            return DEEP_RELAX_PASSES;
        }
    }
    return RELAX_PASSES;
}

void phys_island_substep(rlf_world *world, const phys_island *island, const grid_query *query,
                         double h)
{
    const int32_t *bodies = world->island_bodies;
    int32_t begin = island->body_begin, end = island->body_end;
    phys_group *groups = world->groups + island->pair_begin + island->body_begin;
    for (int32_t i = begin; i < end; i++) {
        fetch_to_start(next_body(world, island, i));
        start_body(world, &world->bodies[bodies[i]]);
    }
    int32_t count = list_groups(world, island, groups, h);
    phys_solve_impacts(world, island, groups, count, h);
    for (int32_t i = begin; i < end; i++) {
        fetch_to_accelerate(next_body(world, island, i));
        accelerate(world, &world->bodies[bodies[i]], h);
        start_speed(world, bodies[i]);
    }
    phys_bear_burdens(world, groups, count);
    phys_batch *batches = phys_batches_of(world, island);
    count = phys_batches_make(world, island, groups, count, h);
    phys_batches_warm_start(world, batches, count);
    phys_batches_solve(world, batches, count, true, solve_passes(batches, count));
    for (int32_t k = 0; k < count; k++) {
        mark_pressed(&batches[k]);
    }
    for (int32_t i = begin; i < end; i++) {
        fetch_to_move(next_body(world, island, i));
        store_speed(world, bodies[i]);
        move_body(world, &world->bodies[bodies[i]], query, h);
        load_speed(world, bodies[i]);
    }
    phys_batches_solve(world, batches, count, false, relax_passes(batches, count));
    for (int32_t i = begin; i < end; i++) {
        RLF_KERNEL_SOON_WRITTEN(&next_body(world, island, i)->v);
        store_speed(world, bodies[i]);
    }
    phys_batches_finish(batches, count);
}
