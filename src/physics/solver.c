/* Sequential impulses with substeps and a relaxation pass (Macklin et al. 2019, "Small steps";
 * Catto 2024, "Solver2D"): one search for contacts, many small steps, impulses kept. */
#include "physics/solver.h"

/* Changes of a contact's speed below this ask for no further pass, m/s. */
#define SETTLED 5e-5f
/* Contacts that are farther than their bodies can come, even when something makes them so much
 * faster, wait for the next substep: a factor, and m/s. */
#define FAR_FACTOR 2.0
#define FAR_SPEED 0.2

/* Fills in `p` but for b's side. Returns a's touching point. */
static rlf_vec3 point_of(phys_contact *c, const phys_body *a, phys_point *p)
{
    p->normal = c->normal;
    p->r_a = phys_contact_arm(c, a);
    for (int32_t row = 0; row < 3; row++) {
        p->impulses[row] = c->impulses[row];
    }
    p->contact = c;
    p->is_impacted = false;
    return rlf_add(a->x, p->r_a);
}

/* Keeps the point when it is near enough. */
static void take_point(phys_contact *c, double gap, double way, phys_group *g)
{
    c->separation = g->points[g->point_count].separation = gap;
    if (gap > way) {
        c->impulses[0] = c->impulses[1] = c->impulses[2] = 0.0;
    } else {
        g->point_count++;
    }
}

/* How far a contact's two sides may come towards each other. */
static double way_of(const phys_group *g, double h)
{
    return (FAR_SPEED + FAR_FACTOR * g->speed) * h;
}

static bool finish_group(phys_group *g)
{
    bool is_any = g->point_count > 0;
    if (!g->stance->is_set || !is_any) {
        g->stance->rolling = rlf_vec3_make(0, 0, 0);
    }
    g->stance->is_set = g->stance->is_set || is_any;
    return is_any;
}

/* The normal of a side as the box stands now. */
static rlf_vec3 normal_of(const phys_side *side, const phys_body *box)
{
    const rlf_mat3 *R = &box->R;
    rlf_vec3 axis = {R->m[0][side->axis], R->m[1][side->axis], R->m[2][side->axis]};
    return rlf_scale(axis, side->sign);
}

static void turn_normals(phys_pair *pair, const phys_body *a, const phys_body *b)
{
    if (pair->side.of != PHYS_SIDE_NONE) {
        rlf_vec3 normal = normal_of(&pair->side, pair->side.of == PHYS_SIDE_OF_A ? a : b);
        for (int32_t i = 0; i < pair->contact_count; i++) {
            pair->contacts[i].normal = normal;
        }
    }
}

bool phys_group_of_pair(rlf_world *world, int32_t pair_index, double h, phys_point *points,
                        phys_group *out)
{
    phys_pair *pair = &world->pairs[pair_index];
    phys_body *a = &world->bodies[pair->a], *b = &world->bodies[pair->b];
    if (pair->contact_count == 0) {
        return false;
    }
    *out = (phys_group){.points = points, .a = a, .b = b, .stance = &pair->stance};
    out->speed = a->speed + b->speed;
    out->friction = pair->friction;
    out->restitution = pair->restitution;
    turn_normals(pair, a, b);
    for (int32_t i = 0; i < pair->contact_count; i++) {
        phys_contact *c = &pair->contacts[i];
        phys_point *p = &points[out->point_count];
        rlf_vec3 on_a = point_of(c, a, p);
        p->r_b = rlf_mad(rlf_mat3_mul_vec(&b->R, c->anchor_b), c->normal, c->rounding_b);
        rlf_vec3 on_b = rlf_add(b->x, p->r_b);
        take_point(c, rlf_dot(c->normal, rlf_sub(on_a, on_b)), way_of(out, h), out);
    }
    return finish_group(out);
}

bool phys_group_of_body(rlf_world *world, int32_t body_index, double h, phys_point *points,
                        phys_group *out)
{
    phys_body *a = &world->bodies[body_index];
    if (a->surface_count == 0) {
        return false;
    }
    *out = (phys_group){.points = points, .a = a, .stance = &a->stance, .speed = a->speed};
    out->friction = a->friction;
    out->restitution = a->restitution;
    for (int32_t i = 0; i < a->surface_count; i++) {
        phys_contact *c = &a->surface[i];
        phys_point *p = &points[out->point_count];
        rlf_vec3 on_a = point_of(c, a, p);
        p->r_b = c->surface_velocity;
        rlf_vec3 on_b = rlf_mad(c->anchor_b, c->surface_velocity, world->time - c->surface_time);
        double way = way_of(out, h) + rlf_length(c->surface_velocity) * h;
        /* The hand that holds it moves it by the joint alone: fingers that are seen a little too
           near would squeeze it out. */
        bool is_of_hand = (a->grab != NULL || world->time < a->soft_until || a->grip_frames > 0) &&
                          c->other == RLF_CONTACT_FOREGROUND;
        take_point(c, rlf_dot(c->normal, rlf_sub(on_a, on_b)), is_of_hand ? -1e9 : way, out);
    }
    return finish_group(out);
}

static rlf_vec3 spin_of(const rlf_lane_speed *speed)
{
    return rlf_vec3_make(speed->of[3], speed->of[4], speed->of[5]);
}

static void turn_body(const rlf_world *world, const phys_body *body, rlf_lane_speed *speed,
                      rlf_vec3 impulse)
{
    double lightness = (double)world->lightness[body - world->bodies];
    rlf_vec3 change = rlf_mat3_mul_vec(&body->inverse_inertia_world, rlf_scale(impulse, lightness));
    speed->of[3] += (float)change.x;
    speed->of[4] += (float)change.y;
    speed->of[5] += (float)change.z;
}

/* What does not move is not written: others may be reading it. */
static void turn_sides(rlf_world *world, const phys_batch *batch, int32_t lane, rlf_vec3 impulse)
{
    const phys_group *g = batch->groups[lane];
    const rlf_lane_batch *lanes = &batch->lanes;
    if (lanes->inverse_mass_a[lane] > 0.0f) {
        turn_body(world, g->a, &world->speeds[lanes->a[lane]], impulse);
    }
    if (g->b != NULL && lanes->inverse_mass_b[lane] > 0.0f) {
        turn_body(world, g->b, &world->speeds[lanes->b[lane]], rlf_neg(impulse));
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

static void add_turning(const rlf_world *world, const phys_body *body, rlf_mat3 *sum)
{
    double lightness = (double)world->lightness[body - world->bodies];
    for (int32_t i = 0; i < 9; i++) {
        sum->m[i / 3][i % 3] += lightness * body->inverse_inertia_world.m[i / 3][i % 3];
    }
}

static rlf_mat3 turning_mobility(const rlf_world *world, const phys_batch *batch, int32_t lane)
{
    const phys_group *g = batch->groups[lane];
    rlf_mat3 sum = rlf_mat3_diagonal(0, 0, 0);
    if (batch->lanes.inverse_mass_a[lane] > 0.0f) {
        add_turning(world, g->a, &sum);
    }
    if (g->b != NULL && batch->lanes.inverse_mass_b[lane] > 0.0f) {
        add_turning(world, g->b, &sum);
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
        pressing += (double)batch->lanes.points[i].impulse[0][lane];
    }
    rlf_mat3 mobility = turning_mobility(world, batch, lane), mass;
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
    for (int32_t lane = 0; lane < RLF_LANES && !is_busy; lane++) {
        is_busy =
            (lanes->inverse_mass_a[lane] > 0.0f && world->busy_pass[lanes->a[lane]] >= pass) ||
            (lanes->inverse_mass_b[lane] > 0.0f && world->busy_pass[lanes->b[lane]] >= pass);
    }
    return is_busy;
}

static void set_busy(rlf_world *world, const rlf_lane_batch *lanes, int32_t lane, int32_t pass)
{
    if (lanes->inverse_mass_a[lane] > 0.0f) {
        world->busy_pass[lanes->a[lane]] = pass;
    }
    if (lanes->inverse_mass_b[lane] > 0.0f) {
        world->busy_pass[lanes->b[lane]] = pass;
    }
}

/* Solves for rolling, and marks the bodies next to which an impulse changed by more than rounding:
 * the next pass looks there again. Returns whether one did. */
static bool finish_batch(rlf_world *world, const phys_batch *batch, const float *excess,
                         int32_t pass)
{
    bool is_any = false;
    for (int32_t lane = 0; lane < batch->count; lane++) {
        bool is_busy = excess[lane] > 0.0f;
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

/* Solves one batch, or two that are apart. */
static bool solve_batches(rlf_world *world, const phys_batch *const batches[2], int32_t count,
                          bool push, int32_t pass)
{
    float excess[2][RLF_LANES];
    const rlf_lane_batch *lanes[2] = {&batches[0]->lanes, &batches[count - 1]->lanes};
    if (count == 2) {
        rlf_kernel_lanes_solve_two(lanes, world->speeds, push, SETTLED, excess);
    } else {
        rlf_kernel_lanes_solve(lanes[0], world->speeds, push, SETTLED, excess[0]);
    }
    bool is_busy = finish_batch(world, batches[0], excess[0], pass);
    return count == 2 ? finish_batch(world, batches[1], excess[1], pass) || is_busy : is_busy;
}

/* One pass over the batches that are busy. Returns whether some still are. */
static bool solve_pass(rlf_world *world, const phys_batch *batches, int32_t count, bool push,
                       int32_t pass)
{
    const phys_batch *waiting[2] = {NULL, NULL};
    bool is_busy = false;
    for (int32_t k = 0; k < count; k++) {
        if (waiting[0] != NULL && !batches[k].is_apart) {
            is_busy |= solve_batches(world, waiting, 1, push, pass);
            waiting[0] = NULL;
        }
        if (!is_busy_in(world, &batches[k].lanes, pass)) {
            continue;
        }
        if (waiting[0] == NULL) {
            waiting[0] = &batches[k];
        } else {
            waiting[1] = &batches[k];
            is_busy |= solve_batches(world, waiting, 2, push, pass);
            waiting[0] = NULL;
        }
    }
    return waiting[0] != NULL ? solve_batches(world, waiting, 1, push, pass) || is_busy : is_busy;
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
        is_busy = solve_pass(world, batches, count, push, pass);
    }
}
