/* Bounces: within a substep, impacts are found and answered one after the other in time.
 *
 * Each body moves as x(t) = x + shift + v t + a t^2 / 2 during the substep; an impulse at time t
 * changes v by dv and shift by -dv t, so that the path is continuous at t. Restitution therefore
 * acts at the speed and the place of the impact (no height is lost to the step), and a row of
 * touching balls passes a blow on ball by ball. Slow contacts are left to the solver. */
#include "physics/grid_scan.h"
#include "physics/solver.h"

#define NO_EVENT 1e30
#define SLOW 0.02 /* m/s: no bounce */
#define EVENTS_PER_GROUP 4
/* Gap at which a contact of the same group takes part in an impact, metres. */
#define TOGETHER 2e-4
/* Passes over the contacts of a group, until no speed changes by more than a share of the blow's.
 */
#define PASSES 12
#define SETTLED 1e-7

/* The groups of an island that have an event. */
typedef struct event_list {
    rlf_world *world;
    double h;
    const phys_group *groups; /* of the island, those that may touch */
    double *times;            /* of their next events, NO_EVENT = none */
    int32_t *counts;          /* of those that were answered */
    int32_t *next_link;       /* see world_state.h */
    int32_t *pending;
    int32_t pending_count;
} event_list;

/* The speeds of a group's bodies; a body that does not move has mobility 0. */
typedef struct phys_sides {
    rlf_vec3 v_a, w_a, v_b, w_b;
    double mobility_a, mobility_b; /* 1/kg */
} phys_sides;

static phys_sides sides_load(const phys_group *g)
{
    phys_sides s = {.v_a = g->a->v, .w_a = g->a->w};
    s.mobility_a = phys_body_is_moving(g->a) ? g->a->inverse_mass : 0.0;
    if (g->b != NULL) {
        s.v_b = g->b->v;
        s.w_b = g->b->w;
        s.mobility_b = phys_body_is_moving(g->b) ? g->b->inverse_mass : 0.0;
    }
    return s;
}

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

/* Velocity of a's point as b or the surface sees it. */
static inline rlf_vec3 relative_velocity(const phys_point *p, const phys_sides *s, bool has_b)
{
    rlf_vec3 of_a = rlf_add(s->v_a, rlf_cross(s->w_a, p->r_a));
    return rlf_sub(of_a, has_b ? rlf_add(s->v_b, rlf_cross(s->w_b, p->r_b)) : p->r_b);
}

/* Gap of the contact extrapolated back to the start of the substep. */
static double virtual_gap(const phys_point *p, const phys_group *g)
{
    rlf_vec3 shift = rlf_add(g->a->impact_shift, rlf_cross(g->a->impact_turn, p->r_a));
    if (g->b != NULL) {
        shift = rlf_sub(shift, g->b->impact_shift);
        shift = rlf_sub(shift, rlf_cross(g->b->impact_turn, p->r_b));
    }
    return p->separation + rlf_dot(p->normal, shift);
}

static double normal_acceleration(const phys_point *p, const phys_group *g)
{
    rlf_vec3 a = phys_body_is_moving(g->a) ? g->a->acceleration : rlf_vec3_make(0, 0, 0);
    if (g->b != NULL && phys_body_is_moving(g->b)) {
        a = rlf_sub(a, g->b->acceleration);
    }
    return rlf_dot(p->normal, a);
}

/* The most that a body which rests on something is kept from falling by, m/s^2. */
static double held_acceleration(const phys_body *body)
{
    bool is_held = phys_body_is_moving(body) && body->was_pressed;
    return is_held ? rlf_length(body->acceleration) : 0.0;
}

/* No bounce is slower, m/s. What falls alone or is held up by others gains and loses |a| h per
 * substep: a bounce slower than a few of these is rest. */
static double slow_speed(const phys_group *g, double h)
{
    double a = held_acceleration(g->a);
    if (g->b != NULL) {
        a = rlf_max(a, held_acceleration(g->b));
    }
    return SLOW + 3.0 * a * h;
}

static double time_of(const phys_body *body)
{
    return phys_body_is_moving(body) ? body->impact_time : 0.0;
}

static double start_time(const phys_group *g)
{
    return g->b != NULL ? rlf_max(time_of(g->a), time_of(g->b)) : time_of(g->a);
}

/* First time from `from` on at which s + v t + a t^2/2 reaches 0 while falling. */
static double closing_time(double s, double v, double a, double from)
{
    if (s + from * (v + 0.5 * a * from) <= 0.0) {
        return from;
    }
    double square = v * v - 2.0 * a * s;
    if (square < 0.0) {
        return NO_EVENT;
    }
    double root = sqrt(square); /* speed at impact is -root: t = 2 s / (root - v) */
    double t = root - v > 0.0 ? 2.0 * s / (root - v) : NO_EVENT;
    return t >= from ? t : NO_EVENT;
}

static double event_time(const phys_group *g, double h)
{
    double resting = slow_speed(g, h), best = NO_EVENT;
    phys_sides s = sides_load(g);
    for (int32_t i = 0; i < g->point_count; i++) {
        const phys_point *p = &g->points[i];
        if (p->restitution <= 0.0) {
            continue;
        }
        double v = rlf_dot(p->normal, relative_velocity(p, &s, g->b != NULL));
        double a = normal_acceleration(p, g);
        /* Gravity alone gives |a| h per substep: a bounce slower than a few of these is rest. */
        double slow = rlf_max(resting, SLOW + 3.0 * (a < 0.0 ? -a : a) * h);
        if (v + rlf_min(a * h, 0.0) >= -slow) {
            continue;
        }
        double t = closing_time(virtual_gap(p, g), v, a, start_time(g));
        if (t <= h && v + a * t < -slow) {
            best = rlf_min(best, t);
        }
    }
    return best;
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
    double mass;    /* effective, kg */
    double impulse; /* N s */
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
    row.mass = mobility > 0.0 ? 1.0 / mobility : 0.0;
    return row;
}

/* Returns by how much the point's speed along the row changed, m/s. */
static inline double row_push(impact_row *row, phys_sides *s, double impulse)
{
    double change = impulse - row->impulse;
    s->v_a = rlf_mad(s->v_a, row->direction, change * s->mobility_a);
    s->w_a = rlf_mad(s->w_a, row->spin_a, change);
    s->v_b = rlf_mad(s->v_b, row->direction, -change * s->mobility_b);
    s->w_b = rlf_mad(s->w_b, row->spin_b, -change);
    row->impulse = impulse;
    return (change < 0.0 ? -change : change) / row->mass;
}

/* A contact that takes part in an impact. */
typedef struct impact_point {
    phys_point *near;
    double target, approach; /* m/s along the normal */
    impact_row rows[3];
} impact_point;

/* One pass: the normal's row, then friction within the cone that its impulse allows. Returns the
 * largest change of speed, m/s. */
static double solve_point(impact_point *p, phys_sides *s, bool has_b)
{
    impact_row *rows = p->rows;
    double v = rlf_dot(rows[0].direction, relative_velocity(p->near, s, has_b));
    double blow = rlf_max(0.0, rows[0].impulse + rows[0].mass * (p->target - v));
    double most = row_push(&rows[0], s, blow);
    rlf_vec3 slip = relative_velocity(p->near, s, has_b);
    double j0 = rows[1].impulse - rows[1].mass * rlf_dot(rows[1].direction, slip);
    double j1 = rows[2].impulse - rows[2].mass * rlf_dot(rows[2].direction, slip);
    double limit = p->near->friction * rows[0].impulse, length2 = j0 * j0 + j1 * j1;
    double scale = length2 > limit * limit ? limit / sqrt(length2) : 1.0;
    most = rlf_max(most, row_push(&rows[1], s, j0 * scale));
    return rlf_max(most, row_push(&rows[2], s, j1 * scale));
}

/* Those of the group's contacts that close at time t. */
static int32_t list_points(const phys_group *g, const phys_sides *s, double t, impact_point *points)
{
    int32_t count = 0;
    for (int32_t i = 0; i < g->point_count; i++) {
        phys_point *near = &g->points[i];
        double fall = normal_acceleration(near, g) * t;
        double v = rlf_dot(near->normal, relative_velocity(near, s, g->b != NULL));
        if (virtual_gap(near, g) + (v + 0.5 * fall) * t > TOGETHER) {
            continue;
        }
        impact_point *p = &points[count++];
        rlf_vec3 tangent = rlf_perpendicular(near->normal);
        p->near = near;
        p->approach = rlf_max(0.0, -(v + fall));
        p->target = near->restitution * p->approach - fall;
        p->rows[0] = row_make(near, g, s, near->normal);
        p->rows[1] = row_make(near, g, s, tangent);
        p->rows[2] = row_make(near, g, s, rlf_cross(near->normal, tangent));
    }
    return count;
}

static void solve_points(impact_point *points, int32_t count, phys_sides *s, bool has_b)
{
    double fastest = 0.0, change = 1e30;
    for (int32_t i = 0; i < count; i++) {
        fastest = rlf_max(fastest, points[i].approach);
    }
    for (int32_t pass = 0; pass < PASSES && change > SETTLED * fastest; pass++) {
        change = 0.0;
        for (int32_t i = 0; i < count; i++) {
            change = rlf_max(change, solve_point(&points[i], s, has_b));
        }
    }
}

/* All contacts that close at time t answer together: the normal velocities after are those before
 * times -restitution, found by sequential impulses within the group. */
static void answer(const phys_group *g, double t)
{
    impact_point points[PHYS_SURFACE_CONTACTS];
    phys_sides s = sides_load(g);
    const phys_sides before = s;
    int32_t count = list_points(g, &s, t, points);
    solve_points(points, count, &s, g->b != NULL);
    limit_energy(g, &before, &s, t);
    sides_store(&s, g);
    for (int32_t i = 0; i < count; i++) {
        phys_contact *c = points[i].near->contact;
        if (points[i].rows[0].impulse > 0.0) {
            points[i].near->is_impacted = true;
            c->impulse_sum += points[i].rows[0].impulse;
            c->approach = rlf_max(c->approach, points[i].approach);
        }
    }
}

/* Whether a body goes another way than the one for which its contacts with the surface were
 * searched: its points may come nearer than the search looked. */
static bool has_turned(const phys_body *body, double h)
{
    double change = rlf_length(rlf_sub(body->v, body->surface_v)) +
                    rlf_length(rlf_sub(body->w, body->surface_w)) * body->shape.radius;
    return change * (body->surface_period + 1) * h > 0.5 * GRID_MARGIN;
}

/* Keeps x(t) continuous at the time of the impact. */
static void shift_back(phys_body *body, rlf_vec3 v, rlf_vec3 w, double t, double h)
{
    if (body != NULL && phys_body_is_moving(body)) {
        body->impact_shift = rlf_mad(body->impact_shift, rlf_sub(body->v, v), -t);
        body->impact_turn = rlf_mad(body->impact_turn, rlf_sub(body->w, w), -t);
        body->impact_time = t;
        body->is_restless = body->is_restless || has_turned(body, h);
    }
}

static void bounce(const phys_group *g, double t, double h)
{
    rlf_vec3 v_a = g->a->v, w_a = g->a->w;
    rlf_vec3 v_b = g->b != NULL ? g->b->v : v_a;
    rlf_vec3 w_b = g->b != NULL ? g->b->w : w_a;
    answer(g, t);
    shift_back(g->a, v_a, w_a, t, h);
    shift_back(g->b, v_b, w_b, t, h);
}

/* Gaps seen by the solver are those of the new paths; a contact that bounced must only not close
 * again. */
static void carry_gaps(const phys_group *g)
{
    if (start_time(g) == 0.0) {
        return;
    }
    for (int32_t k = 0; k < g->point_count; k++) {
        phys_point *p = &g->points[k];
        double gap = virtual_gap(p, g);
        p->separation = gap > 0.0 ? gap : rlf_min(p->separation, 0.0);
    }
}

static void add_link(event_list *list, const phys_body *body, int32_t link)
{
    if (phys_body_is_moving(body)) {
        int32_t *first = &list->world->first_link[body - list->world->bodies];
        list->next_link[link] = *first;
        *first = link;
    }
}

/* Lists of the groups of each body, so that a bounce asks only its neighbours. */
static void link_groups(event_list *list, const phys_island *island, int32_t count)
{
    for (int32_t i = island->body_begin; i < island->body_end; i++) {
        list->world->first_link[list->world->island_bodies[i]] = -1;
    }
    for (int32_t k = 0; k < count; k++) {
        add_link(list, list->groups[k].a, 2 * k);
        if (list->groups[k].b != NULL) {
            add_link(list, list->groups[k].b, 2 * k + 1);
        }
    }
}

/* Sets a group's next event and lists it. */
static void look_at_group(event_list *list, int32_t k)
{
    bool was_pending = list->times[k] <= list->h;
    bool is_done = list->counts[k] >= EVENTS_PER_GROUP;
    list->times[k] = is_done ? NO_EVENT : event_time(&list->groups[k], list->h);
    if (!was_pending && list->times[k] <= list->h) {
        list->pending[list->pending_count++] = k;
    }
}

static void look_at_body(event_list *list, const phys_body *body)
{
    if (body == NULL || !phys_body_is_moving(body)) {
        return;
    }
    int32_t link = list->world->first_link[body - list->world->bodies];
    for (; link >= 0; link = list->next_link[link]) {
        look_at_group(list, link / 2);
    }
}

/* Earliest pending group, the first among equals; drops those without an event. */
static int32_t take_first(event_list *list)
{
    const double *times = list->times;
    int32_t first = -1, kept = 0;
    for (int32_t i = 0; i < list->pending_count; i++) {
        int32_t k = list->pending[i];
        if (times[k] > list->h) {
            continue;
        }
        list->pending[kept++] = k;
        if (first < 0 || times[k] < times[first] || (times[k] == times[first] && k < first)) {
            first = k;
        }
    }
    list->pending_count = kept;
    return first;
}

void phys_solve_impacts(rlf_world *world, const phys_island *island, const phys_group *groups,
                        int32_t count, double h)
{
    int32_t place = island->pair_begin + island->body_begin;
    event_list list = {.world = world, .h = h, .groups = groups};
    list.times = world->event_times + place;
    list.counts = world->event_counts + place;
    list.next_link = world->next_link + 2 * place;
    list.pending = world->pending + place;
    for (int32_t k = 0; k < count; k++) {
        list.counts[k] = 0;
        list.times[k] = NO_EVENT;
        if (groups[k].b == NULL || groups[k].speed > SLOW) {
            look_at_group(&list, k);
        }
    }
    if (list.pending_count == 0) {
        return;
    }
    link_groups(&list, island, count);
    for (int32_t k = take_first(&list); k >= 0; k = take_first(&list)) {
        list.counts[k]++;
        bounce(&groups[k], list.times[k], h);
        look_at_body(&list, groups[k].a);
        look_at_body(&list, groups[k].b);
    }
    for (int32_t k = 0; k < count; k++) {
        carry_gaps(&groups[k]);
    }
}
