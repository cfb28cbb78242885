/* Sequential impulses with substeps and a relaxation pass (Macklin et al. 2019, "Small steps";
 * Catto 2024, "Solver2D"): one search for contacts, many small steps, impulses kept. */
#include "physics/solver.h"

/* Changes of a contact's speed below this ask for no further pass, m/s. */
#define SETTLED 5e-4
/* Contacts that are farther than their bodies can come, even when something makes them so much
 * faster, wait for the next substep: a factor, and m/s. */
#define FAR_FACTOR 2.0
#define FAR_SPEED 0.2

static void measure_gap(const rlf_world *world, phys_contact *c, const phys_group *g)
{
    rlf_vec3 n = c->normal;
    c->r_a = rlf_mad(rlf_mat3_mul_vec(&g->a->R, c->anchor_a), n, -c->rounding_a);
    rlf_vec3 on_a = rlf_add(g->a->x, c->r_a), on_b;
    if (g->b != NULL) {
        c->r_b = rlf_mad(rlf_mat3_mul_vec(&g->b->R, c->anchor_b), n, c->rounding_b);
        on_b = rlf_add(g->b->x, c->r_b);
    } else {
        on_b = rlf_mad(c->anchor_b, c->surface_velocity, world->time - c->surface_time);
    }
    c->separation = rlf_dot(n, rlf_sub(on_a, on_b));
    c->is_impacted = false;
}

static double speed_of(const phys_body *body)
{
    return body == NULL ? 0.0 : rlf_length(body->v) + rlf_length(body->w) * body->shape.radius;
}

bool phys_group_prepare(const rlf_world *world, phys_group *g, double h)
{
    g->near_count = 0;
    if (g->count == 0) {
        return false;
    }
    g->speed = speed_of(g->a) + speed_of(g->b);
    double way = (FAR_SPEED + FAR_FACTOR * g->speed) * h;
    for (int32_t i = 0; i < g->count; i++) {
        phys_contact *c = &g->contacts[i];
        measure_gap(world, c, g);
        c->is_far = c->separation > way + rlf_length(c->surface_velocity) * h;
        if (c->is_far) {
            c->impulses[0] = c->impulses[1] = c->impulses[2] = 0.0;
        }
        g->near_count += c->is_far ? 0 : 1;
    }
    if (!g->stance->is_set || g->near_count == 0) {
        g->stance->rolling = rlf_vec3_make(0, 0, 0);
    }
    g->stance->is_set = g->stance->is_set || g->near_count > 0;
    return g->near_count > 0;
}

static rlf_vec3 spin_of(const rlf_lane_speed *speed)
{
    return rlf_vec3_make(speed->of[3], speed->of[4], speed->of[5]);
}

static void turn_body(const phys_body *body, rlf_lane_speed *speed, rlf_vec3 impulse)
{
    rlf_vec3 change = rlf_mat3_mul_vec(&body->inverse_inertia_world, impulse);
    speed->of[3] += change.x;
    speed->of[4] += change.y;
    speed->of[5] += change.z;
}

/* What does not move is not written: others may be reading it. */
static void turn_sides(rlf_world *world, const phys_batch *batch, int32_t lane, rlf_vec3 impulse)
{
    const phys_group *g = batch->groups[lane];
    const rlf_lane_batch *lanes = &batch->lanes;
    if (lanes->inverse_mass_a[lane] > 0.0) {
        turn_body(g->a, &world->speeds[lanes->a[lane]], impulse);
    }
    if (g->b != NULL && lanes->inverse_mass_b[lane] > 0.0) {
        turn_body(g->b, &world->speeds[lanes->b[lane]], rlf_neg(impulse));
    }
}

void phys_batches_warm_start(rlf_world *world, const phys_batch *batches, int32_t count)
{
    for (int32_t k = 0; k < count; k++) {
        const phys_batch *batch = &batches[k];
        rlf_kernel_lanes_push(&batch->lanes, world->speeds);
        for (int32_t lane = 0; lane < batch->count && batch->resists_rolling; lane++) {
            turn_sides(world, batch, lane, batch->groups[lane]->stance->rolling);
        }
    }
}

static rlf_mat3 turning_mobility(const phys_batch *batch, int32_t lane)
{
    const phys_group *g = batch->groups[lane];
    rlf_mat3 sum = rlf_mat3_diagonal(0, 0, 0);
    for (int32_t i = 0; i < 9; i++) {
        if (batch->lanes.inverse_mass_a[lane] > 0.0) {
            sum.m[i / 3][i % 3] += g->a->inverse_inertia_world.m[i / 3][i % 3];
        }
        if (g->b != NULL && batch->lanes.inverse_mass_b[lane] > 0.0) {
            sum.m[i / 3][i % 3] += g->b->inverse_inertia_world.m[i / 3][i % 3];
        }
    }
    return sum;
}

/* An angular impulse against the bodies' turning on each other, at most resistance times radius
 * times the impulse that presses them together. Returns whether it changed. */
static bool solve_rolling(rlf_world *world, const phys_batch *batch, int32_t lane)
{
    const phys_group *g = batch->groups[lane];
    double resistance = g->a->rolling_resistance, radius = g->a->shape.radius, pressing = 0.0;
    rlf_vec3 w = spin_of(&world->speeds[batch->lanes.a[lane]]);
    if (g->b != NULL) {
        resistance = rlf_max(resistance, g->b->rolling_resistance);
        radius = rlf_min(radius, g->b->shape.radius);
        w = rlf_sub(w, spin_of(&world->speeds[batch->lanes.b[lane]]));
    }
    for (int32_t i = 0; i < batch->lanes.point_count; i++) {
        pressing += batch->lanes.points[i].impulse[0][lane];
    }
    rlf_mat3 mobility = turning_mobility(batch, lane), mass;
    rlf_vec3 before = g->stance->rolling;
    if (resistance == 0.0 || !rlf_mat3_invert(&mobility, &mass)) {
        return false;
    }
    rlf_vec3 sum = rlf_sub(before, rlf_mat3_mul_vec(&mass, w));
    double length = rlf_length(sum), limit = resistance * radius * pressing;
    g->stance->rolling = length > limit ? rlf_scale(sum, limit / length) : sum;
    rlf_vec3 change = rlf_sub(g->stance->rolling, before);
    turn_sides(world, batch, lane, change);
    return rlf_length(change) > 0.01 * limit;
}

static bool is_busy_in(const rlf_world *world, const rlf_lane_batch *lanes, int32_t pass)
{
    bool is_busy = false;
    for (int32_t lane = 0; lane < RLF_LANES; lane++) {
        is_busy |= lanes->inverse_mass_a[lane] > 0.0 && world->busy_pass[lanes->a[lane]] >= pass;
        is_busy |= lanes->inverse_mass_b[lane] > 0.0 && world->busy_pass[lanes->b[lane]] >= pass;
    }
    return is_busy;
}

static void set_busy(rlf_world *world, const rlf_lane_batch *lanes, int32_t lane, int32_t pass)
{
    if (lanes->inverse_mass_a[lane] > 0.0) {
        world->busy_pass[lanes->a[lane]] = pass;
    }
    if (lanes->inverse_mass_b[lane] > 0.0) {
        world->busy_pass[lanes->b[lane]] = pass;
    }
}

/* Returns whether an impulse changed by more than rounding: the next pass looks there again. */
static bool solve_batch(rlf_world *world, const phys_batch *batch, bool push, int32_t pass)
{
    double excess[RLF_LANES];
    bool is_any = false;
    rlf_kernel_lanes_solve(&batch->lanes, world->speeds, push, SETTLED, excess);
    for (int32_t lane = 0; lane < batch->count; lane++) {
        bool is_busy = excess[lane] > 0.0;
        if (batch->resists_rolling) {
            is_busy |= solve_rolling(world, batch, lane);
        }
        if (is_busy) {
            set_busy(world, &batch->lanes, lane, pass + 1);
            is_any = true;
        }
    }
    return is_any;
}

void phys_batches_solve(rlf_world *world, const phys_batch *batches, int32_t count, bool push,
                        int32_t passes)
{
    for (int32_t k = 0; k < count; k++) {
        for (int32_t lane = 0; lane < batches[k].count; lane++) {
            set_busy(world, &batches[k].lanes, lane, 0);
        }
    }
    bool is_busy = true;
    for (int32_t pass = 0; pass < passes && is_busy; pass++) {
        is_busy = false;
        for (int32_t k = 0; k < count; k++) {
            if (is_busy_in(world, &batches[k].lanes, pass)) {
                is_busy |= solve_batch(world, &batches[k], push, pass);
            }
        }
    }
}
