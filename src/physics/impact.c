/* Bounces: within a substep, impacts are found and answered one after the other in time.
 *
 * Each body moves as x(t) = x + shift + v t + a t^2 / 2 during the substep; an impulse at time t
 * changes v by dv and shift by -dv t, so that the path is continuous at t. Restitution therefore
 * acts at the speed and the place of the impact (no height is lost to the step), and a row of
 * touching balls passes a blow on ball by ball. Slow contacts are left to the solver. */
#include "physics/solver.h"

#define NO_EVENT 1e30
#define EVENTS_PER_GROUP 4
/* Gap at which a contact of the same group takes part in an impact, metres. */
#define TOGETHER 2e-4

/* The groups of an island that have an event, by their keys: pairs, then bodies' surfaces. */
typedef struct event_list {
    rlf_world *world;
    double h;
    int32_t *keys; /* a part of world->pending */
    int32_t count;
} event_list;

static phys_group group_at(const event_list *list, int32_t key)
{
    int32_t body = key - list->world->pair_capacity;
    return body < 0 ? phys_group_of_pair(list->world, key) : phys_group_of_body(list->world, body);
}

/* Gap of the contact extrapolated back to the start of the substep. */
static double virtual_gap(const phys_contact *c, const phys_group *g)
{
    const phys_row *row = &c->rows[0];
    double gap = c->separation + rlf_dot(row->direction, g->a->impact_shift) +
                 rlf_dot(row->turn_a, g->a->impact_turn);
    if (g->b != NULL) {
        gap -=
            rlf_dot(row->direction, g->b->impact_shift) + rlf_dot(row->turn_b, g->b->impact_turn);
    }
    return gap;
}

static double normal_acceleration(const phys_contact *c, const phys_group *g)
{
    rlf_vec3 a = phys_body_is_moving(g->a) ? g->a->acceleration : rlf_vec3_make(0, 0, 0);
    if (g->b != NULL && phys_body_is_moving(g->b)) {
        a = rlf_sub(a, g->b->acceleration);
    }
    return rlf_dot(c->normal, a);
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
    double from = start_time(g);
    double best = NO_EVENT;
    phys_sides s = phys_sides_load(g);
    for (int32_t i = 0; i < g->count; i++) {
        const phys_contact *c = &g->contacts[i];
        if (c->is_far || c->restitution <= 0.0) {
            continue;
        }
        double v = phys_row_speed(&c->rows[0], &s, g->b != NULL);
        double a = normal_acceleration(c, g);
        /* Gravity alone gives |a| h per substep: a bounce slower than a few of these is rest. */
        double slow = 0.02 + 3.0 * (a < 0.0 ? -a : a) * h;
        if (v + rlf_min(a * h, 0.0) >= -slow) {
            continue;
        }
        double t = closing_time(virtual_gap(c, g), v, a, from);
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
    for (int32_t i = 0; i < g->count; i++) {
        rlf_vec3 v = g->contacts[i].surface_velocity;
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

/* All contacts that close at time t answer together: the normal velocities after are those before
 * times -restitution, found by sequential impulses within the group. */
static void answer(phys_group *g, double t)
{
    double target[PHYS_SURFACE_CONTACTS], approach[PHYS_SURFACE_CONTACTS];
    bool takes_part[PHYS_SURFACE_CONTACTS];
    double saved[PHYS_SURFACE_CONTACTS][3];
    bool has_b = g->b != NULL;
    phys_sides s = phys_sides_load(g);
    const phys_sides before = s;
    for (int32_t i = 0; i < g->count; i++) {
        phys_contact *c = &g->contacts[i];
        double fall = normal_acceleration(c, g) * t;
        double v = phys_row_speed(&c->rows[0], &s, has_b);
        takes_part[i] = !c->is_far && virtual_gap(c, g) + (v + 0.5 * fall) * t <= TOGETHER;
        approach[i] = rlf_max(0.0, -(v + fall));
        target[i] = c->restitution * approach[i] - fall;
        for (int32_t row = 0; row < 3; row++) {
            saved[i][row] = c->rows[row].impulse;
            c->rows[row].impulse = 0.0;
        }
    }
    for (int32_t pass = 0; pass < 12; pass++) {
        for (int32_t i = 0; i < g->count; i++) {
            phys_row *row = &g->contacts[i].rows[0];
            if (!takes_part[i]) {
                continue;
            }
            double v = phys_row_speed(row, &s, has_b);
            double sum = rlf_max(0.0, row->impulse + row->mass * (target[i] - v));
            phys_row_push(row, &s, has_b, sum - row->impulse);
            row->impulse = sum;
            phys_contact_friction(&g->contacts[i], &s, has_b);
        }
    }
    limit_energy(g, &before, &s, t);
    phys_sides_store(&s, g);
    for (int32_t i = 0; i < g->count; i++) {
        phys_contact *c = &g->contacts[i];
        if (c->rows[0].impulse > 0.0) {
            c->is_impacted = true;
            c->impulse_sum += c->rows[0].impulse;
            c->approach = rlf_max(c->approach, approach[i]);
        }
        for (int32_t row = 0; row < 3; row++) {
            c->rows[row].impulse = saved[i][row];
        }
    }
}

/* Keeps x(t) continuous at the time of the impact. */
static void shift_back(phys_body *body, rlf_vec3 v, rlf_vec3 w, double t)
{
    if (body != NULL && phys_body_is_moving(body)) {
        body->impact_shift = rlf_mad(body->impact_shift, rlf_sub(body->v, v), -t);
        body->impact_turn = rlf_mad(body->impact_turn, rlf_sub(body->w, w), -t);
        body->impact_time = t;
        body->is_restless = true; /* its way is a new one: look again */
    }
}

static void bounce(phys_group *g, double t)
{
    rlf_vec3 v_a = g->a->v, w_a = g->a->w;
    rlf_vec3 v_b = g->b != NULL ? g->b->v : v_a;
    rlf_vec3 w_b = g->b != NULL ? g->b->w : w_a;
    answer(g, t);
    shift_back(g->a, v_a, w_a, t);
    shift_back(g->b, v_b, w_b, t);
}

/* Gaps seen by the solver are those of the new paths; a contact that bounced must only not close
 * again. */
static void carry_gaps(const phys_group *g)
{
    if (start_time(g) == 0.0) {
        return;
    }
    for (int32_t k = 0; k < g->count; k++) {
        phys_contact *c = &g->contacts[k];
        double gap = virtual_gap(c, g);
        c->separation = gap > 0.0 ? gap : rlf_min(c->separation, 0.0);
    }
}

static void link_pair(rlf_world *world, int32_t body, int32_t link)
{
    if (phys_body_is_moving(&world->bodies[body])) {
        world->pair_next[link] = world->pair_head[body];
        world->pair_head[body] = link;
    }
}

/* Lists of the pairs of each body, so that a bounce asks only its neighbours again. */
static void link_pairs(rlf_world *world, const phys_island *island)
{
    for (int32_t i = island->body_begin; i < island->body_end; i++) {
        world->pair_head[world->island_bodies[i]] = -1;
    }
    for (int32_t k = island->pair_begin; k < island->pair_end; k++) {
        int32_t index = world->island_pairs[k];
        link_pair(world, world->pairs[index].a, 2 * index);
        link_pair(world, world->pairs[index].b, 2 * index + 1);
    }
}

/* Sets a group's next event and lists it. */
static void look_at_group(event_list *list, const phys_group *g)
{
    rlf_world *world = list->world;
    int32_t key = g->key;
    bool was_pending = world->event_times[key] <= list->h;
    bool is_done = world->event_counts[key] >= EVENTS_PER_GROUP;
    world->event_times[key] = is_done ? NO_EVENT : event_time(g, list->h);
    if (!was_pending && world->event_times[key] <= list->h) {
        list->keys[list->count++] = key;
    }
}

static void look_at_body(event_list *list, const phys_body *body)
{
    rlf_world *world = list->world;
    if (body == NULL || !phys_body_is_moving(body)) {
        return;
    }
    int32_t index = (int32_t)(body - world->bodies);
    phys_group g = phys_group_of_body(world, index);
    look_at_group(list, &g);
    for (int32_t k = world->pair_head[index]; k >= 0; k = world->pair_next[k]) {
        g = phys_group_of_pair(world, k / 2);
        look_at_group(list, &g);
    }
}

/* Earliest pending group, the lower key first among equals; drops those without an event. */
static int32_t take_first(event_list *list)
{
    const double *times = list->world->event_times;
    int32_t first = -1, kept = 0;
    for (int32_t i = 0; i < list->count; i++) {
        int32_t key = list->keys[i];
        if (times[key] > list->h) {
            continue;
        }
        list->keys[kept++] = key;
        if (first < 0 || times[key] < times[first] || (times[key] == times[first] && key < first)) {
            first = key;
        }
    }
    list->count = kept;
    return first;
}

void phys_solve_impacts(rlf_world *world, const phys_island *island, const phys_group *groups,
                        int32_t count, double h)
{
    event_list list = {world, h, world->pending + island->pair_begin + island->body_begin, 0};
    for (int32_t k = 0; k < count; k++) {
        world->event_counts[groups[k].key] = 0;
        world->event_times[groups[k].key] = NO_EVENT;
        look_at_group(&list, &groups[k]);
    }
    if (list.count == 0) {
        return;
    }
    link_pairs(world, island);
    for (int32_t first = take_first(&list); first >= 0; first = take_first(&list)) {
        phys_group hit = group_at(&list, first);
        world->event_counts[first]++;
        bounce(&hit, world->event_times[first]);
        look_at_body(&list, hit.a);
        look_at_body(&list, hit.b);
    }
    for (int32_t k = 0; k < count; k++) {
        carry_gaps(&groups[k]);
    }
}
