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

/* The contacts of a pair, or of a body with the surface. */
typedef struct group {
    phys_contact *contacts;
    int32_t count;
    phys_body *a, *b; /* b NULL: surface */
} group;

static group group_at(rlf_world *world, int32_t index)
{
    group g = {0};
    if (index < world->pair_count) {
        phys_pair *pair = &world->pairs[index];
        g.contacts = pair->contacts;
        g.count = pair->contact_count;
        g.a = &world->bodies[pair->a];
        g.b = &world->bodies[pair->b];
        if ((g.a->is_asleep || g.a->inverse_mass == 0.0) &&
            (g.b->is_asleep || g.b->inverse_mass == 0.0)) {
            g.count = 0;
        }
        return g;
    }
    g.a = &world->bodies[index - world->pair_count];
    g.contacts = g.a->surface;
    g.count = g.a->is_alive && !g.a->is_asleep && g.a->inverse_mass > 0.0 ? g.a->surface_count : 0;
    return g;
}

static rlf_vec3 shift_at(const phys_body *body, rlf_vec3 r)
{
    return rlf_add(body->impact_shift, rlf_cross(body->impact_turn, r));
}

/* Gap of the contact extrapolated back to the start of the substep. */
static double virtual_gap(const phys_contact *c, const group *g)
{
    rlf_vec3 shift = shift_at(g->a, c->r_a);
    if (g->b != NULL) {
        shift = rlf_sub(shift, shift_at(g->b, c->r_b));
    }
    return c->separation + rlf_dot(c->normal, shift);
}

static double normal_acceleration(const phys_contact *c, const group *g)
{
    rlf_vec3 a = g->a->acceleration;
    return rlf_dot(c->normal, g->b != NULL ? rlf_sub(a, g->b->acceleration) : a);
}

static double start_time(const group *g)
{
    return g->b != NULL ? rlf_max(g->a->impact_time, g->b->impact_time) : g->a->impact_time;
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

static double event_time(const rlf_world *world, const group *g, double h)
{
    double from = start_time(g);
    double best = NO_EVENT;
    for (int32_t i = 0; i < g->count; i++) {
        const phys_contact *c = &g->contacts[i];
        double v = rlf_dot(c->normal, phys_contact_velocity(world, c));
        double a = normal_acceleration(c, g);
        if (c->restitution <= 0.0) {
            continue;
        }
        double t = closing_time(virtual_gap(c, g), v, a, from);
        /* Gravity alone gives |a| h per substep: a bounce slower than a few of these is rest. */
        double slow = 0.02 + 3.0 * (a < 0.0 ? -a : a) * h;
        if (t <= h && v + a * t < -slow) {
            best = rlf_min(best, t);
        }
    }
    return best;
}

/* All contacts that close at time t answer together: the normal velocities after are those before
 * times -restitution, found by sequential impulses within the group. */
static void answer(rlf_world *world, group *g, double t)
{
    double target[PHYS_SURFACE_CONTACTS], approach[PHYS_SURFACE_CONTACTS];
    bool takes_part[PHYS_SURFACE_CONTACTS];
    double saved[PHYS_SURFACE_CONTACTS][3];
    for (int32_t i = 0; i < g->count; i++) {
        phys_contact *c = &g->contacts[i];
        double fall = normal_acceleration(c, g) * t;
        double v = rlf_dot(c->normal, phys_contact_velocity(world, c));
        takes_part[i] = virtual_gap(c, g) + (v + 0.5 * fall) * t <= TOGETHER;
        approach[i] = rlf_max(0.0, -(v + fall));
        target[i] = c->restitution * approach[i] - fall;
        saved[i][0] = c->impulse_n;
        saved[i][1] = c->impulse_t[0];
        saved[i][2] = c->impulse_t[1];
        c->impulse_n = c->impulse_t[0] = c->impulse_t[1] = 0.0;
    }
    for (int32_t pass = 0; pass < 12; pass++) {
        for (int32_t i = 0; i < g->count; i++) {
            phys_contact *c = &g->contacts[i];
            if (!takes_part[i]) {
                continue;
            }
            double v = rlf_dot(c->normal, phys_contact_velocity(world, c));
            double sum = rlf_max(0.0, c->impulse_n + c->mass_n * (target[i] - v));
            phys_contact_push(world, c, rlf_scale(c->normal, sum - c->impulse_n));
            c->impulse_n = sum;
            phys_contact_friction(world, c);
        }
    }
    for (int32_t i = 0; i < g->count; i++) {
        phys_contact *c = &g->contacts[i];
        if (c->impulse_n > 0.0) {
            c->is_impacted = true;
            phys_log_impulse(world, c, c->impulse_n, approach[i]);
        }
        c->impulse_n = saved[i][0];
        c->impulse_t[0] = saved[i][1];
        c->impulse_t[1] = saved[i][2];
    }
}

/* Keeps x(t) continuous at the time of the impact. */
static void shift_back(phys_body *body, rlf_vec3 v, rlf_vec3 w, double t)
{
    if (body != NULL) {
        body->impact_shift = rlf_mad(body->impact_shift, rlf_sub(body->v, v), -t);
        body->impact_turn = rlf_mad(body->impact_turn, rlf_sub(body->w, w), -t);
        body->impact_time = t;
        body->surface_age = body->surface_period; /* its way is a new one: look again */
    }
}

static void bounce(rlf_world *world, group *g, double t)
{
    rlf_vec3 v_a = g->a->v, w_a = g->a->w;
    rlf_vec3 v_b = g->b != NULL ? g->b->v : v_a;
    rlf_vec3 w_b = g->b != NULL ? g->b->w : w_a;
    answer(world, g, t);
    shift_back(g->a, v_a, w_a, t);
    shift_back(g->b, v_b, w_b, t);
}

/* Gaps seen by the solver are those of the new paths; a contact that bounced must only not close
 * again. */
static void carry_gaps(rlf_world *world, int32_t group_count)
{
    for (int32_t i = 0; i < group_count; i++) {
        group g = group_at(world, i);
        if (g.count == 0 || start_time(&g) == 0.0) {
            continue;
        }
        for (int32_t k = 0; k < g.count; k++) {
            phys_contact *c = &g.contacts[k];
            double gap = virtual_gap(c, &g);
            c->separation = gap > 0.0 ? gap : rlf_min(c->separation, 0.0);
        }
    }
}

/* Lists of the pairs of each body, so that a bounce asks only its neighbours again. */
static void link_pairs(rlf_world *world)
{
    for (int32_t i = 0; i < world->body_top; i++) {
        world->pair_head[i] = -1;
    }
    for (int32_t k = 0; k < world->pair_count; k++) {
        const phys_pair *pair = &world->pairs[k];
        world->pair_next[2 * k] = world->pair_head[pair->a];
        world->pair_head[pair->a] = 2 * k;
        world->pair_next[2 * k + 1] = world->pair_head[pair->b];
        world->pair_head[pair->b] = 2 * k + 1;
    }
}

/* Sets a group's next event; returns the new number of pending groups. */
static int32_t look_at_group(rlf_world *world, int32_t index, double h, int32_t pending_count)
{
    group g = group_at(world, index);
    bool was_pending = world->event_times[index] <= h;
    bool is_done = world->event_counts[index] >= EVENTS_PER_GROUP;
    world->event_times[index] = is_done ? NO_EVENT : event_time(world, &g, h);
    if (!was_pending && world->event_times[index] <= h) {
        world->pending[pending_count++] = index;
    }
    return pending_count;
}

static int32_t look_at_body(rlf_world *world, const phys_body *body, double h,
                            int32_t pending_count)
{
    int32_t index = (int32_t)(body - world->bodies);
    pending_count = look_at_group(world, world->pair_count + index, h, pending_count);
    for (int32_t k = world->pair_head[index]; k >= 0; k = world->pair_next[k]) {
        pending_count = look_at_group(world, k / 2, h, pending_count);
    }
    return pending_count;
}

/* Earliest pending group, the lower index first among equals; drops those without an event. */
static int32_t take_first(rlf_world *world, double h, int32_t *pending_count)
{
    int32_t first = -1, kept = 0;
    for (int32_t i = 0; i < *pending_count; i++) {
        int32_t index = world->pending[i];
        double t = world->event_times[index];
        if (t > h) {
            continue;
        }
        world->pending[kept++] = index;
        if (first < 0 || t < world->event_times[first] ||
            (t == world->event_times[first] && index < first)) {
            first = index;
        }
    }
    *pending_count = kept;
    return first;
}

void phys_solve_impacts(rlf_world *world, double h)
{
    int32_t group_count = world->pair_count + world->body_top;
    int32_t pending_count = 0;
    for (int32_t i = 0; i < group_count; i++) {
        world->event_counts[i] = 0;
        world->event_times[i] = NO_EVENT;
        pending_count = look_at_group(world, i, h, pending_count);
    }
    if (pending_count == 0) {
        return;
    }
    link_pairs(world);
    for (;;) {
        int32_t first = take_first(world, h, &pending_count);
        if (first < 0) {
            break;
        }
        group hit = group_at(world, first);
        world->event_counts[first]++;
        bounce(world, &hit, world->event_times[first]);
        pending_count = look_at_body(world, hit.a, h, pending_count);
        if (hit.b != NULL) {
            pending_count = look_at_body(world, hit.b, h, pending_count);
        }
    }
    carry_gaps(world, group_count);
}
