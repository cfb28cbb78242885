/* Bounces: within a substep, impacts are found and answered one after the other in time.
 *
 * Each body moves as x(t) = x + shift + v t + a t^2 / 2 during the substep; an impulse at time t
 * changes v by dv and shift by -dv t, so that the path is continuous at t. Restitution therefore
 * acts at the speed and the place of the impact (no height is lost to the step), and a row of
 * touching balls passes a blow on ball by ball. Slow contacts are left to the solver. */
#include "physics/fetch.h"
#include "physics/grid/job.h"
#include "physics/impact/answer.h"
#include "physics/solver.h"

#define NO_EVENT 1e30
#define SLOW 0.02 /* m/s: no bounce */
#define EVENTS_PER_GROUP 4

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

/* The most that a body which rests on something is kept from falling by, m/s^2. */
static double held_acceleration(const phys_body *body)
{
    bool is_held = phys_body_is_moving(body) && body->was_pressed;
    return is_held ? body->pull : 0.0;
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

/* How near a point without a velocity of its own must be to touch in this substep, while nothing
 * has bounced; a little more. */
static double first_reach(const phys_group *g, double h)
{
    double pull = phys_body_is_moving(g->a) ? g->a->pull : 0.0;
    pull += g->b != NULL && phys_body_is_moving(g->b) ? g->b->pull : 0.0;
    return 1.001 * (g->speed + pull * h) * h;
}

/* Whether none of its points comes together too fast to rest, wherever they are and whatever their
 * normals, while nothing has bounced. */
static bool is_resting(const phys_group *g, double h)
{
    for (int32_t i = 0; i < g->point_count && g->b == NULL; i++) {
        if (rlf_dot(g->points[i].r_b, g->points[i].r_b) > 0.0) {
            return false;
        }
    }
    return 1.001 * (g->speed + rlf_length(acceleration_between(g)) * h) < slow_speed(g, h);
}

/* Points whose gap is beyond `reach` cannot touch. */
static double event_time(const phys_group *g, double reach, double h)
{
    double resting = slow_speed(g, h), best = NO_EVENT;
    phys_sides s = sides_load(g);
    for (int32_t i = 0; i < g->point_count; i++) {
        const phys_point *p = &g->points[i];
        double flow2 = g->b == NULL ? rlf_dot(p->r_b, p->r_b) : 0.0;
        if (p->separation > reach && flow2 == 0.0) {
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
    phys_impact_answer(g, t);
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

/* Fetches the bodies of the groups after the k-th. */
RLF_KERNEL_PART void fetch_groups(const phys_group *groups, int32_t k, int32_t count)
{
    enum { AHEAD = 6 };
    const phys_group *g = &groups[k + AHEAD < count ? k + AHEAD : k];
    phys_fetch_motion(g->a);
    if (g->b != NULL) {
        phys_fetch_motion(g->b);
    }
}

/* Sets a group's next event and lists it. */
static void look_at_group(event_list *list, int32_t k, double reach)
{
    bool was_pending = list->times[k] <= list->h;
    const phys_group *g = &list->groups[k];
    bool is_done = list->counts[k] >= EVENTS_PER_GROUP || g->restitution <= 0.0;
    list->times[k] = is_done ? NO_EVENT : event_time(g, reach, list->h);
    if (!was_pending && list->times[k] <= list->h) {
        list->pending[list->pending_count++] = k;
    }
}

/* But for the group `seen`, which was looked at. */
static void look_at_body(event_list *list, const phys_body *body, int32_t seen)
{
    if (body == NULL || !phys_body_is_moving(body)) {
        return;
    }
    int32_t link = list->world->first_link[body - list->world->bodies];
    for (; link >= 0; link = list->next_link[link]) {
        if (link / 2 != seen) {
            look_at_group(list, link / 2, NO_EVENT);
        }
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
        fetch_groups(groups, k, count);
        list.counts[k] = 0;
        list.times[k] = NO_EVENT;
        if (!is_resting(&groups[k], h)) {
            look_at_group(&list, k, first_reach(&groups[k], h));
        }
    }
    if (list.pending_count == 0) {
        return;
    }
    link_groups(&list, island, count);
    for (int32_t k = take_first(&list); k >= 0; k = take_first(&list)) {
        list.counts[k]++;
        bounce(&groups[k], list.times[k], h);
        look_at_group(&list, k, NO_EVENT);
        look_at_body(&list, groups[k].a, k);
        look_at_body(&list, groups[k].b, k);
    }
    for (int32_t k = 0; k < count; k++) {
        fetch_groups(groups, k, count);
        carry_gaps(&groups[k]);
    }
}
