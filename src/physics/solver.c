/* Sequential impulses with substeps and a relaxation pass (Macklin et al. 2019, "Small steps";
 * Catto 2024, "Solver2D"): one search for contacts, many small steps, impulses kept. */
#include "physics/solver.h"

/* Contacts are springs of half the substep rate, critically damped, solved implicitly (Catto 2011,
 * "Soft constraints"): omega h = pi, a1 = 2 zeta + omega h, a2 = omega h a1. A tall stack stands
 * still where rigid contacts, solved by a few passes, keep tilting it. */
#define SOFT_OMEGA_H RLF_PI
#define SOFT_A1 (2.0 + SOFT_OMEGA_H)
#define SOFT_A2 (SOFT_OMEGA_H * SOFT_A1)
/* Overlaps are pushed apart no faster than this, m/s. */
#define PUSH_SPEED_MAX 3.0
/* Overlap left alone, as a share of the body's radius, so that contacts persist. */
#define SLOP_SHARE 0.002
/* Rows serve until their bodies have turned by this, radians: levers are then 1 % off. */
#define TURN_MAX 0.01
/* Changes of a contact's speed below this ask for no further pass, m/s. */
#define SETTLED 5e-4
/* Contacts that are farther than their bodies can come, even when something makes them so much
 * faster, wait for the next substep: a factor, and m/s. */
#define FAR_FACTOR 2.0
#define FAR_SPEED 0.2

static void make_row(phys_row *row, rlf_vec3 direction, const phys_contact *c, const phys_group *g,
                     const phys_stance *stance)
{
    const rlf_vec3 none = {0, 0, 0};
    double mobility = 0.0;
    row->direction = direction;
    row->drive = rlf_dot(direction, c->surface_velocity);
    row->turn_a = rlf_cross(c->r_a, direction);
    row->spin_a = none;
    if (stance->is_moving_a) {
        row->spin_a = rlf_mat3_mul_vec(&g->a->inverse_inertia_world, row->turn_a);
        mobility += g->a->inverse_mass + rlf_dot(row->turn_a, row->spin_a);
    }
    if (g->b != NULL) {
        row->turn_b = rlf_cross(c->r_b, direction);
        row->spin_b = none;
        if (stance->is_moving_b) {
            row->spin_b = rlf_mat3_mul_vec(&g->b->inverse_inertia_world, row->turn_b);
            mobility += g->b->inverse_mass + rlf_dot(row->turn_b, row->spin_b);
        }
    }
    row->mass = mobility > 0.0 ? 1.0 / mobility : 0.0;
}

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

static phys_stance stance_of(const phys_group *g)
{
    phys_stance now = {.turned_a = g->a->turned, .is_moving_a = phys_body_is_moving(g->a)};
    if (g->b != NULL) {
        now.turned_b = g->b->turned;
        now.is_moving_b = phys_body_is_moving(g->b);
    }
    now.is_set = true;
    return now;
}

static double speed_of(const phys_body *body)
{
    return body == NULL ? 0.0 : rlf_length(body->v) + rlf_length(body->w) * body->shape.radius;
}

bool phys_group_prepare(const rlf_world *world, const phys_group *g, double h)
{
    phys_stance *before = g->stance, now = stance_of(g);
    bool is_any_near = false;
    if (g->count == 0) {
        return false;
    }
    bool is_same = before->is_set && before->is_moving_a == now.is_moving_a &&
                   before->is_moving_b == now.is_moving_b &&
                   now.turned_a - before->turned_a + now.turned_b - before->turned_b < TURN_MAX;
    double way = (FAR_SPEED + FAR_FACTOR * (speed_of(g->a) + speed_of(g->b))) * h;
    for (int32_t i = 0; i < g->count; i++) {
        phys_contact *c = &g->contacts[i];
        measure_gap(world, c, g);
        c->is_far = c->separation > way + rlf_length(c->surface_velocity) * h;
        is_any_near = is_any_near || !c->is_far;
    }
    for (int32_t i = 0; i < g->count; i++) {
        phys_contact *c = &g->contacts[i];
        if (c->is_far) {
            c->rows[0].impulse = c->rows[1].impulse = c->rows[2].impulse = 0.0;
        }
        if (is_any_near && !is_same) {
            rlf_vec3 tangent = rlf_perpendicular(c->normal);
            make_row(&c->rows[0], c->normal, c, g, &now);
            make_row(&c->rows[1], tangent, c, g, &now);
            make_row(&c->rows[2], rlf_cross(c->normal, tangent), c, g, &now);
        }
    }
    if (is_any_near && !is_same) {
        now.rolling = before->is_set ? before->rolling : now.rolling;
        *g->stance = now;
    }
    if (!is_any_near) {
        g->stance->rolling = rlf_vec3_make(0, 0, 0);
    }
    return is_any_near;
}

static void turn_sides(const phys_group *g, phys_sides *s, bool has_b, rlf_vec3 impulse)
{
    if (s->mobility_a > 0.0) {
        s->w_a = rlf_add(s->w_a, rlf_mat3_mul_vec(&g->a->inverse_inertia_world, impulse));
    }
    if (has_b && s->mobility_b > 0.0) {
        s->w_b = rlf_sub(s->w_b, rlf_mat3_mul_vec(&g->b->inverse_inertia_world, impulse));
    }
}

static bool resists_rolling(const phys_group *g, bool has_b)
{
    return g->a->rolling_resistance > 0.0 || (has_b && g->b->rolling_resistance > 0.0);
}

static inline void warm_start(const phys_group *g, bool has_b)
{
    phys_sides s = phys_sides_load(g);
    for (int32_t i = 0; i < g->count; i++) {
        const phys_contact *c = &g->contacts[i];
        for (int32_t row = 0; row < 3 && c->rows[0].impulse > 0.0; row++) {
            phys_row_push(&c->rows[row], &s, has_b, c->rows[row].impulse);
        }
    }
    if (resists_rolling(g, has_b)) {
        turn_sides(g, &s, has_b, g->stance->rolling);
    }
    phys_sides_store(&s, g);
}

void phys_group_warm_start(const phys_group *g)
{
    if (g->b != NULL) {
        warm_start(g, true);
    } else {
        warm_start(g, false);
    }
}

static inline bool is_more(double change, double limit)
{
    return change > limit || change < -limit;
}

static inline bool solve_normal(phys_contact *c, phys_sides *s, bool has_b, bool bias, double slop,
                                double h)
{
    phys_row *row = &c->rows[0];
    double target = 0.0; /* least normal velocity */
    double mass_scale = 1.0, impulse_scale = 0.0;
    if (c->separation > 0.0) {
        target = -c->separation / h; /* may close the gap, not more */
    } else if (bias && !c->is_impacted) {
        mass_scale = SOFT_A2 / (1.0 + SOFT_A2);
        impulse_scale = 1.0 / (1.0 + SOFT_A2);
        double overlap = rlf_min(c->separation + slop, 0.0);
        target = rlf_min(-SOFT_OMEGA_H / SOFT_A1 / h * overlap, PUSH_SPEED_MAX);
    }
    double v = phys_row_speed(row, s, has_b);
    double change = row->mass * mass_scale * (target - v) - impulse_scale * row->impulse;
    double sum = rlf_max(0.0, row->impulse + change);
    change = sum - row->impulse;
    row->impulse = sum;
    if (change != 0.0) {
        phys_row_push(row, s, has_b, change);
    }
    return is_more(change, SETTLED * row->mass);
}

static inline bool solve_friction(phys_contact *c, phys_sides *s, bool has_b)
{
    phys_row *t0 = &c->rows[1], *t1 = &c->rows[2];
    double limit = c->friction * c->rows[0].impulse;
    double before[2] = {t0->impulse, t1->impulse};
    if (limit == 0.0 && before[0] == 0.0 && before[1] == 0.0) {
        return false;
    }
    double v0 = phys_row_speed(t0, s, has_b), v1 = phys_row_speed(t1, s, has_b);
    double j0 = before[0] - t0->mass * v0, j1 = before[1] - t1->mass * v1;
    double length2 = j0 * j0 + j1 * j1;
    if (length2 > limit * limit) { /* Coulomb's cone */
        double scale = limit / sqrt(length2);
        j0 *= scale;
        j1 *= scale;
    }
    t0->impulse = j0;
    t1->impulse = j1;
    phys_row_push(t0, s, has_b, j0 - before[0]);
    phys_row_push(t1, s, has_b, j1 - before[1]);
    return is_more(j0 - before[0], SETTLED * t0->mass) ||
           is_more(j1 - before[1], SETTLED * t1->mass);
}

bool phys_contact_friction(phys_contact *c, phys_sides *s, bool has_b)
{
    return solve_friction(c, s, has_b);
}

/* An angular impulse against the bodies' turning on each other, at most resistance times radius
 * times the impulse that presses them together. */
static bool solve_rolling(const phys_group *g, phys_sides *s, bool has_b)
{
    double resistance = g->a->rolling_resistance, radius = g->a->shape.radius, pressing = 0.0;
    rlf_mat3 mobility =
        s->mobility_a > 0.0 ? g->a->inverse_inertia_world : rlf_mat3_diagonal(0, 0, 0);
    rlf_vec3 w = s->w_a;
    if (has_b) {
        resistance = rlf_max(resistance, g->b->rolling_resistance);
        radius = rlf_min(radius, g->b->shape.radius);
        w = rlf_sub(w, s->w_b);
    }
    for (int32_t i = 0; i < 9 && has_b && s->mobility_b > 0.0; i++) {
        mobility.m[i / 3][i % 3] += g->b->inverse_inertia_world.m[i / 3][i % 3];
    }
    for (int32_t i = 0; i < g->count; i++) {
        pressing += g->contacts[i].rows[0].impulse;
    }
    rlf_mat3 mass;
    rlf_vec3 before = g->stance->rolling;
    if (!rlf_mat3_invert(&mobility, &mass)) {
        return false;
    }
    rlf_vec3 sum = rlf_sub(before, rlf_mat3_mul_vec(&mass, w));
    double length = rlf_length(sum), limit = resistance * radius * pressing;
    g->stance->rolling = length > limit ? rlf_scale(sum, limit / length) : sum;
    rlf_vec3 change = rlf_sub(g->stance->rolling, before);
    turn_sides(g, s, has_b, change);
    return rlf_length(change) > 0.01 * limit;
}

static inline bool solve(const phys_group *g, bool has_b, bool bias, double h)
{
    bool is_busy = false;
    double slop = SLOP_SHARE * g->a->shape.radius;
    phys_sides s = phys_sides_load(g);
    for (int32_t i = 0; i < g->count; i++) {
        is_busy |=
            !g->contacts[i].is_far && solve_normal(&g->contacts[i], &s, has_b, bias, slop, h);
    }
    for (int32_t i = 0; i < g->count; i++) {
        is_busy |= !g->contacts[i].is_far && solve_friction(&g->contacts[i], &s, has_b);
    }
    if (resists_rolling(g, has_b)) {
        is_busy |= solve_rolling(g, &s, has_b);
    }
    phys_sides_store(&s, g);
    return is_busy;
}

bool phys_group_solve(const phys_group *g, bool bias, double h)
{
    if (g->count == 0) {
        return false;
    }
    return g->b != NULL ? solve(g, true, bias, h) : solve(g, false, bias, h);
}

void phys_group_finish(const phys_group *g)
{
    for (int32_t i = 0; i < g->count; i++) {
        phys_contact *c = &g->contacts[i];
        c->impulse_sum += c->rows[0].impulse;
    }
}
