/* The answer to an impact: restitution and friction at all points of a group that close. */
#include "physics/impact/answer.h"
#include "kernel/kernel.h"

/* Gap at which a contact of the same group takes part in an impact, metres. A real surface that is
 * seen is flat up to its noise: there it may be wider, up to a share of the body's radius. */
#define TOGETHER 2e-4
#define TOGETHER_SEEN 1e-3
#define TOGETHER_SHARE 0.05
/* Passes over the contacts of a group, until no speed changes by more than a share of the blow's.
 */
#define PASSES 12
#define SETTLED 1e-7

/* What does not move is not written: others may be reading it. */
static void sides_store(const phys_sides *s, const phys_group *g)
{
    if (s->mobility_a > 0.0) {
        g->a->v = s->v_a;
        g->a->w = s->w_a;
    }
    if (g->b != NULL && s->mobility_b > 0.0) {
        g->b->v = s->v_b;
        g->b->w = s->w_b;
    }
}

/* Twice the kinetic energy that goes with a turn: w.I w' of a body. */
static double turn_product(const phys_body *body, rlf_vec3 w, rlf_vec3 other)
{
    rlf_mat3 to_body = rlf_mat3_transpose(&body->R);
    rlf_vec3 local = rlf_mat3_mul_vec(&to_body, w);
    return rlf_dot(rlf_mat3_mul_vec(&to_body, other), rlf_mat3_mul_vec(&body->inertia, local));
}

/* Share of a change of a body's velocities at time t: its energy grows by s (b + s a) with it. */
static void add_gain(const phys_body *body, rlf_vec3 v, rlf_vec3 dv, rlf_vec3 w, rlf_vec3 dw,
                     double t, double gain[2])
{
    rlf_vec3 then = rlf_mad(v, body->acceleration, t);
    gain[0] += 0.5 * body->mass * rlf_dot(dv, dv) + 0.5 * turn_product(body, dw, dw);
    gain[1] += body->mass * rlf_dot(then, dv) + turn_product(body, w, dw);
}

static bool is_driven(const phys_group *g)
{
    bool is_surface_moving = false;
    for (int32_t i = 0; i < g->point_count && g->b == NULL; i++) {
        rlf_vec3 v = g->points[i].r_b;
        is_surface_moving = is_surface_moving || rlf_dot(v, v) > 0.0;
    }
    return is_surface_moving || phys_body_is_driven(g->a) ||
           (g->b != NULL && phys_body_is_driven(g->b));
}

/* Restitution speed by speed can gain energy when bodies meet off centre with friction (Kane 1984):
 * then the whole blow is made smaller until it does not. */
static void limit_energy(const phys_group *g, const phys_sides *before, phys_sides *after, double t)
{
    double gain[2] = {0.0, 0.0};
    phys_sides d = {.v_a = rlf_sub(after->v_a, before->v_a),
                    .w_a = rlf_sub(after->w_a, before->w_a),
                    .v_b = rlf_sub(after->v_b, before->v_b),
                    .w_b = rlf_sub(after->w_b, before->w_b)};
    if (before->mobility_a > 0.0) {
        add_gain(g->a, before->v_a, d.v_a, before->w_a, d.w_a, t, gain);
    }
    if (before->mobility_b > 0.0) {
        add_gain(g->b, before->v_b, d.v_b, before->w_b, d.w_b, t, gain);
    }
    if (gain[0] + gain[1] <= 0.0 || !(gain[0] > 0.0) || is_driven(g)) {
        return;
    }
    double share = rlf_clamp(-gain[1] / gain[0], 0.0, 1.0);
    after->v_a = rlf_mad(before->v_a, d.v_a, share);
    after->w_a = rlf_mad(before->w_a, d.w_a, share);
    after->v_b = rlf_mad(before->v_b, d.v_b, share);
    after->w_b = rlf_mad(before->w_b, d.w_b, share);
}

/* A direction in which a contact acts, and what a unit impulse along it does. */
typedef struct impact_row {
    rlf_vec3 direction, spin_a, spin_b;
    double mass;     /* effective, kg */
    double mobility; /* 1 / mass, or 0 */
    double impulse;  /* N s */
} impact_row;

static impact_row row_make(const phys_point *p, const phys_group *g, const phys_sides *s,
                           rlf_vec3 direction)
{
    impact_row row = {.direction = direction};
    double mobility = 0.0;
    if (s->mobility_a > 0.0) {
        rlf_vec3 turn = rlf_cross(p->r_a, direction);
        row.spin_a = rlf_mat3_mul_vec(&g->a->inverse_inertia_world, turn);
        mobility += s->mobility_a + rlf_dot(turn, row.spin_a);
    }
    if (s->mobility_b > 0.0) {
        rlf_vec3 turn = rlf_cross(p->r_b, direction);
        row.spin_b = rlf_mat3_mul_vec(&g->b->inverse_inertia_world, turn);
        mobility += s->mobility_b + rlf_dot(turn, row.spin_b);
    }
    row.mobility = mobility;
    row.mass = mobility > 0.0 ? 1.0 / mobility : 0.0;
    return row;
}

/* Returns by how much the point's speed along the row changed, m/s. */
RLF_KERNEL_PART double row_push(impact_row *row, phys_sides *s, bool has_b, double impulse)
{
    double change = impulse - row->impulse;
    s->v_a = rlf_mad(s->v_a, row->direction, change * s->mobility_a);
    s->w_a = rlf_mad(s->w_a, row->spin_a, change);
    if (has_b) {
        s->v_b = rlf_mad(s->v_b, row->direction, -change * s->mobility_b);
        s->w_b = rlf_mad(s->w_b, row->spin_b, -change);
    }
    row->impulse = impulse;
    return (change < 0.0 ? -change : change) * row->mobility;
}

/* A contact that takes part in an impact. */
typedef struct impact_point {
    phys_point *near;
    double target, approach; /* m/s along the normal */
    impact_row rows[3];
    rlf_mat3 mass; /* the impulses along the rows that change the speeds along them by 1 each */
    bool has_mass;
} impact_point;

/* How much the point's velocity changes by a unit impulse along the row. */
static rlf_vec3 answer_of(const impact_row *row, const phys_point *p, const phys_sides *s)
{
    rlf_vec3 v = rlf_scale(row->direction, s->mobility_a + s->mobility_b);
    v = rlf_add(v, rlf_cross(row->spin_a, p->r_a));
    return s->mobility_b > 0.0 ? rlf_add(v, rlf_cross(row->spin_b, p->r_b)) : v;
}

static void find_mass(impact_point *p, const phys_sides *s)
{
    rlf_mat3 mobility;
    for (int32_t k = 0; k < 3; k++) {
        rlf_vec3 v = answer_of(&p->rows[k], p->near, s);
        for (int32_t i = 0; i < 3; i++) {
            mobility.m[i][k] = rlf_dot(p->rows[i].direction, v);
        }
    }
    p->has_mass = rlf_mat3_invert(&mobility, &p->mass);
}

/* The impulses that stop the point in all three directions at once, `v` being its speeds along
 * them. Returns whether friction holds it then. */
RLF_KERNEL_PART bool find_hold(const impact_point *p, double friction, rlf_vec3 v, rlf_vec3 *out)
{
    const impact_row *rows = p->rows;
    rlf_vec3 lack = {p->target - v.x, -v.y, -v.z};
    rlf_vec3 j = rlf_mat3_mul_vec(&p->mass, lack);
    *out = rlf_add(j, rlf_vec3_make(rows[0].impulse, rows[1].impulse, rows[2].impulse));
    double limit = friction * out->x;
    return p->has_mass && out->x >= 0.0 && !(out->y * out->y + out->z * out->z > limit * limit);
}

/* One pass: where friction does not hold it the normal's row, then friction within the cone that
 * its impulse allows. Returns the largest change of speed, m/s. */
RLF_KERNEL_PART double solve_point(impact_point *p, double friction, phys_sides *s, bool has_b)
{
    impact_row *rows = p->rows;
    rlf_vec3 v = relative_velocity(p->near, s, has_b), hold;
    v = rlf_vec3_make(rlf_dot(rows[0].direction, v), rlf_dot(rows[1].direction, v),
                      rlf_dot(rows[2].direction, v));
    if (find_hold(p, friction, v, &hold)) {
        double change = row_push(&rows[0], s, has_b, hold.x);
        change = rlf_max(change, row_push(&rows[1], s, has_b, hold.y));
        return rlf_max(change, row_push(&rows[2], s, has_b, hold.z));
    }
    double blow = rlf_max(0.0, rows[0].impulse + rows[0].mass * (p->target - v.x));
    double most = row_push(&rows[0], s, has_b, blow);
    rlf_vec3 slip = relative_velocity(p->near, s, has_b);
    double j0 = rows[1].impulse - rows[1].mass * rlf_dot(rows[1].direction, slip);
    double j1 = rows[2].impulse - rows[2].mass * rlf_dot(rows[2].direction, slip);
    double limit = friction * rows[0].impulse, length2 = j0 * j0 + j1 * j1;
    double scale = length2 > limit * limit ? limit / sqrt(length2) : 1.0;
    most = rlf_max(most, row_push(&rows[1], s, has_b, j0 * scale));
    return rlf_max(most, row_push(&rows[2], s, has_b, j1 * scale));
}

static double together(const phys_group *g)
{
    double seen = rlf_min(TOGETHER_SEEN, TOGETHER_SHARE * g->a->shape.radius);
    return g->b == NULL ? rlf_max(TOGETHER, seen) : TOGETHER;
}

/* Those of the group's contacts that close at time t. */
static int32_t list_points(const phys_group *g, const phys_sides *s, double t, impact_point *points)
{
    int32_t count = 0;
    double gap = together(g);
    for (int32_t i = 0; i < g->point_count; i++) {
        phys_point *near = &g->points[i];
        double fall = normal_acceleration(near, g) * t;
        double v = rlf_dot(near->normal, relative_velocity(near, s, g->b != NULL));
        if (virtual_gap(near, g) + (v + 0.5 * fall) * t > gap) {
            continue;
        }
        impact_point *p = &points[count++];
        rlf_vec3 tangent = rlf_perpendicular(near->normal);
        p->near = near;
        p->approach = rlf_max(0.0, -(v + fall));
        p->target = g->restitution * p->approach - fall;
        p->rows[0] = row_make(near, g, s, near->normal);
        p->rows[1] = row_make(near, g, s, tangent);
        p->rows[2] = row_make(near, g, s, rlf_cross(near->normal, tangent));
        find_mass(p, s);
    }
    return count;
}

RLF_KERNEL_PART void solve_points(const phys_group *g, impact_point *points, int32_t count,
                                  bool has_b, phys_sides *s)
{
    double fastest = 0.0, change = 1e30;
    for (int32_t i = 0; i < count; i++) {
        fastest = rlf_max(fastest, points[i].approach);
    }
    for (int32_t pass = 0; pass < PASSES && change > SETTLED * fastest; pass++) {
        change = 0.0;
        for (int32_t i = 0; i < count; i++) {
            change = rlf_max(change, solve_point(&points[i], g->friction, s, has_b));
        }
    }
}

/* Where a's point is at time t, world. */
static rlf_vec3 place_at(const phys_point *p, const phys_group *g, const phys_sides *s, double t)
{
    const phys_body *a = g->a;
    rlf_vec3 at = rlf_add(rlf_add(a->x, a->impact_shift), p->r_a);
    at = rlf_add(at, rlf_cross(a->impact_turn, p->r_a));
    at = rlf_mad(at, rlf_add(s->v_a, rlf_cross(s->w_a, p->r_a)), t);
    return s->mobility_a > 0.0 ? rlf_mad(at, a->acceleration, 0.5 * t * t) : at;
}

/* Adds a blow to what the frame's list will hold of the contact. */
static void note_blow(const impact_point *p, const phys_group *g, const phys_sides *before,
                      double t)
{
    phys_contact *c = p->near->contact;
    p->near->is_impacted = true;
    c->impulse_sum += p->rows[0].impulse;
    if (p->approach > c->approach) {
        c->approach = p->approach;
        c->met = phys_narrow(place_at(p->near, g, before, t));
        c->met_normal = phys_narrow(p->near->normal);
    }
}

void phys_impact_answer(const phys_group *g, double t)
{
    impact_point points[PHYS_SURFACE_CONTACTS];
    phys_sides s = sides_load(g);
    const phys_sides before = s;
    int32_t count = list_points(g, &s, t, points);
    if (g->b != NULL) { /* each has a loop of its own */
        solve_points(g, points, count, true, &s);
    } else {
        solve_points(g, points, count, false, &s);
    }
    limit_energy(g, &before, &s, t);
    sides_store(&s, g);
    for (int32_t i = 0; i < count; i++) {
        if (points[i].rows[0].impulse > 0.0) {
            note_blow(&points[i], g, &before, t);
        }
    }
}
