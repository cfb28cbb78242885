/* Keeping pairs from one broad phase to the next, and searching their contacts when they moved. */
#include "physics/pair/collide.h"
#include "physics/fetch.h"

/* Bodies that moved less than this share of their radius past each other keep their contacts: their
 * points move with the bodies, and a normal with the side of a box. */
#define STILL_SHARE 0.002
#define STILL_SHARE_OF_SIDE 0.01
/* Fast bodies are searched again when they moved by this share of the largest ball in them. */
#define TRAVEL_SHARE 0.3

enum { BODIES_AHEAD = 4, PAIRS_AHEAD = 8 };

static double travel_of(const phys_body *a, const phys_body *b)
{
    return rlf_length(rlf_sub(a->v, b->v)) + rlf_length(a->w) * a->shape.radius +
           rlf_length(b->w) * b->shape.radius;
}

/* How far any point of one can have moved past the other since the last search. */
static double moved_since(const phys_pair *pair, const phys_body *a, const phys_body *b)
{
    rlf_vec3 offset = rlf_sub(b->x, a->x);
    return rlf_length(rlf_sub(offset, pair->offset)) +
           (a->turned - pair->turned_a) * a->shape.radius +
           (b->turned - pair->turned_b) * b->shape.radius;
}

static void keep_impulse(phys_contact *contact, const phys_trace *old, int32_t old_count,
                         double limit)
{
    double best2 = limit * limit;
    for (int32_t i = 0; i < old_count; i++) {
        const phys_trace *before = &old[i];
        rlf_vec3 d = rlf_sub(before->anchor_a, contact->anchor_a);
        if (rlf_dot(d, d) < best2 && rlf_dot(before->normal, contact->normal) > 0.8) {
            best2 = rlf_dot(d, d);
            phys_trace_follow(before, contact);
        }
    }
}

static void set_contacts(phys_pair *pair, const phys_body *a, const phys_body *b,
                         const pair_point *points, const int32_t *chosen, int32_t count)
{
    phys_trace old[PHYS_PAIR_CONTACTS];
    int32_t old_count = pair->contact_count;
    for (int32_t i = 0; i < old_count; i++) {
        old[i] = phys_trace_of(&pair->contacts[i]);
    }
    double radius = rlf_min(a->shape.radius, b->shape.radius);
    pair->contact_count = count;
    for (int32_t i = 0; i < count; i++) {
        const pair_point *p = &points[chosen[i]];
        phys_contact *fresh = &pair->contacts[i];
        *fresh = (phys_contact){.a = pair->a, .b = pair->b, .other = RLF_CONTACT_BODY, .log = -1};
        fresh->anchor_a = phys_to_frame(&a->R, rlf_sub(p->core_a, a->x));
        fresh->anchor_b = phys_to_frame(&b->R, rlf_sub(p->core_b, b->x));
        fresh->rounding_a = p->rounding_a;
        fresh->rounding_b = p->rounding_b;
        fresh->normal = p->normal;
        fresh->separation = p->separation;
        keep_impulse(fresh, old, old_count, 0.2 * radius);
    }
}

/* Begins a search, whose axes are found in lane `lane` of `pairs`. */
static void start_search(const rlf_world *world, phys_pair *pair, double h, int32_t lane,
                         rlf_sat_pairs *pairs)
{
    const phys_body *a = &world->bodies[pair->a], *b = &world->bodies[pair->b];
    double travel = travel_of(a, b) * h;
    double inner = rlf_min(a->shape.inner_radius, b->shape.inner_radius);
    double period = rlf_clamp(TRAVEL_SHARE * inner / rlf_max(travel, 1e-9), 1.0, PHYS_PERIOD_MAX);
    pair->period = (int32_t)period;
    pair->age = 0;
    pair->margin = PHYS_PAIR_MARGIN + (pair->period + 1) * travel;
    pair->offset = rlf_sub(b->x, a->x);
    pair->turned_a = a->turned;
    pair->turned_b = b->turned;
    pair->stance.is_set = false;
    pair->gap = -1.0;
    pair->side.of = PHYS_SIDE_NONE;
    pair_boxes_load(a, b, pair->margin, lane, pairs);
}

static void collide_pair(const rlf_world *world, phys_pair *pair, const rlf_sat_axes *axes,
                         int32_t lane)
{
    pair_point points[PAIR_POINTS_MAX];
    int32_t chosen[PHYS_PAIR_CONTACTS];
    const phys_body *a = &world->bodies[pair->a], *b = &world->bodies[pair->b];
    bool are_boxes = a->shape.shape.type == RLF_SHAPE_BOX && b->shape.shape.type == RLF_SHAPE_BOX;
    int32_t count = are_boxes ? pair_collide_boxes(a, b, pair->margin, axes, lane, points,
                                                   &pair->gap, &pair->side)
                              : pair_collide_shapes(a, b, pair->margin, points, &pair->gap);
    if (count == 0) {
        pair->contact_count = 0;
        return;
    }
    count = pair_reduce(points, count, rlf_min(a->shape.radius, b->shape.radius), chosen);
    set_contacts(pair, a, b, points, chosen, count);
}

/* Whether a search of a pair that touches would find what the last one found. */
static bool is_settled(const rlf_world *world, const phys_pair *pair, double h)
{
    if (pair->contact_count == 0) {
        return false;
    }
    const phys_body *a = &world->bodies[pair->a], *b = &world->bodies[pair->b];
    double moved = moved_since(pair, a, b);
    double margin = PHYS_PAIR_MARGIN + (PHYS_PERIOD_MAX + 1) * travel_of(a, b) * h;
    double share = pair->side.of == PHYS_SIDE_NONE ? STILL_SHARE : STILL_SHARE_OF_SIDE;
    return margin <= pair->margin + PHYS_PAIR_MARGIN &&
           moved < share * rlf_min(a->shape.radius, b->shape.radius);
}

/* Substeps, up to PHYS_PERIOD_MAX, after which the gap that is left will still be more than they
 * come nearer in one more; 0: they may touch. */
static int32_t apart_for(const rlf_world *world, const phys_pair *pair, double h)
{
    if (pair->contact_count > 0 || !(pair->gap > 0.0)) {
        return 0;
    }
    const phys_body *a = &world->bodies[pair->a], *b = &world->bodies[pair->b];
    double left = pair->gap - moved_since(pair, a, b) - PHYS_PAIR_MARGIN;
    double steps = left / rlf_max(travel_of(a, b) * h, 1e-9) - 1.0;
    return (int32_t)rlf_clamp(steps, 0.0, PHYS_PERIOD_MAX);
}

/* Fetches the pairs after the k-th, and their bodies: a's is most often that of the pair before. */
RLF_KERNEL_PART void fetch_pairs(const rlf_world *world, int32_t k)
{
    if (k + PAIRS_AHEAD < world->pair_count) {
        phys_fetch(&world->pairs[k + PAIRS_AHEAD], sizeof(phys_pair));
        const phys_body *b = &world->bodies[world->pairs[k + BODIES_AHEAD].b];
        RLF_KERNEL_SOON(&b->v);
        RLF_KERNEL_SOON(&b->is_alive);
        RLF_KERNEL_SOON(&b->x);
        RLF_KERNEL_SOON(&b->shape);
    }
}

/* What a search reads of one of the bodies. */
RLF_KERNEL_PART void fetch_side(const phys_body *body)
{
    phys_fetch_place(body);
    PHYS_FETCH_PART(body, shape, release_time);
}

/* Those after the n-th that is due, and its bodies and contacts. */
RLF_KERNEL_PART void fetch_due(const rlf_world *world, int32_t n, int32_t end)
{
    if (n + PAIRS_AHEAD < end) {
        const phys_pair *pair = &world->pairs[world->due_pairs[n + PAIRS_AHEAD]];
        fetch_side(&world->bodies[pair->a]);
        fetch_side(&world->bodies[pair->b]);
        phys_fetch_contacts(pair);
    }
}

typedef struct pair_job {
    rlf_world *world;
    double h;
} pair_job;

static void collide_range(void *context, int32_t begin, int32_t end, int32_t worker)
{
    pair_job *job = context;
    rlf_world *world = job->world;
    (void)worker;
    rlf_sat_pairs lanes;
    rlf_sat_axes axes;
    for (int32_t first = begin; first < end; first += RLF_SAT_LANES) {
        int32_t count = end - first < RLF_SAT_LANES ? end - first : RLF_SAT_LANES;
        for (int32_t lane = 0; lane < RLF_SAT_LANES; lane++) { /* the last one fills what is left */
            int32_t i = first + (lane < count ? lane : count - 1);
            fetch_due(world, i, end);
            start_search(world, &world->pairs[world->due_pairs[i]], job->h, lane, &lanes);
        }
        rlf_kernel_sat_find(&lanes, &axes);
        for (int32_t lane = 0; lane < count; lane++) {
            collide_pair(world, &world->pairs[world->due_pairs[first + lane]], &axes, lane);
        }
    }
}

static void search_due(rlf_world *world, int32_t count, double h)
{
    for (int32_t i = 0; i < count; i++) {
        fetch_due(world, i, count);
        phys_pair *pair = &world->pairs[world->due_pairs[i]];
        phys_log_contacts(world, pair->contacts, pair->contact_count);
    }
    pair_job job = {world, h};
    rlf_parallel_for(count >= 64 ? world->def.pool : NULL, count, 32, collide_range, &job);
}

static void add_pair(rlf_world *world, phys_near key)
{
    if (world->free_count > 0) {
        world->free_count--;
        int32_t k = world->pair_count++;
        const phys_body *a = &world->bodies[key.a], *b = &world->bodies[key.b];
        phys_pair *pair = &world->pairs[k];
        *pair = (phys_pair){.a = key.a, .b = key.b};
        pair->contacts = &world->pair_contacts[k * PHYS_PAIR_CONTACTS];
        pair->friction = sqrt(a->friction * b->friction);
        pair->restitution = rlf_max(a->restitution, b->restitution);
        pair->offset = rlf_sub(b->x, a->x);
        pair->turned_a = a->turned;
        pair->turned_b = b->turned;
        pair->gap = rlf_length(pair->offset) - a->shape.radius - b->shape.radius;
    }
}

static void keep_pair(rlf_world *world, const phys_pair *old)
{
    int32_t k = world->pair_count++;
    world->pairs[k] = *old;
    world->pairs[k].contacts = &world->pair_contacts[k * PHYS_PAIR_CONTACTS];
    for (int32_t i = 0; i < old->contact_count; i++) {
        world->pairs[k].contacts[i] = old->contacts[i];
    }
}

static void free_pair(rlf_world *world, phys_pair *pair)
{
    phys_log_contacts(world, pair->contacts, pair->contact_count);
    world->free_count++;
}

static bool is_before(const phys_pair *pair, phys_near key)
{
    return pair->a < key.a || (pair->a == key.a && pair->b < key.b);
}

/* An old pair that is not near any more: kept while both bodies sleep. */
static void keep_or_free(rlf_world *world, phys_pair *pair)
{
    const phys_body *a = &world->bodies[pair->a], *b = &world->bodies[pair->b];
    if (phys_body_is_idle(a) && phys_body_is_idle(b) && pair->contact_count > 0) {
        keep_pair(world, pair);
    } else {
        free_pair(world, pair);
    }
}

/* Both lists are sorted. */
static void merge(rlf_world *world)
{
    phys_pair *old = world->pairs, *old_end = old + world->pair_count;
    phys_contact *old_contacts = world->pair_contacts;
    world->pairs = world->old_pairs;
    world->old_pairs = old;
    world->pair_contacts = world->old_pair_contacts;
    world->old_pair_contacts = old_contacts;
    world->pair_count = 0;
    for (int32_t k = 0; k < world->near_count; k++) {
        phys_near key = world->near_sorted[k];
        if (old_end - old > PAIRS_AHEAD) {
            phys_fetch_contacts(old + PAIRS_AHEAD);
        }
        while (old < old_end && is_before(old, key)) {
            keep_or_free(world, old++);
        }
        if (old < old_end && old->a == key.a && old->b == key.b) {
            keep_pair(world, old++);
        } else {
            add_pair(world, key);
        }
    }
    while (old < old_end) {
        keep_or_free(world, old++);
    }
}

void phys_find_pairs(rlf_world *world, double h)
{
    int32_t due = 0;
    phys_find_near(world, (PHYS_PERIOD_MAX + 1) * h);
    merge(world);
    for (int32_t i = 0; i < world->pair_count; i++) {
        phys_pair *pair = &world->pairs[i];
        fetch_pairs(world, i);
        bool is_idle = phys_body_is_idle(&world->bodies[pair->a]) &&
                       phys_body_is_idle(&world->bodies[pair->b]);
        pair->age = 0;
        bool is_kept = is_idle || is_settled(world, pair, h);
        pair->period = is_kept ? PHYS_PERIOD_MAX : apart_for(world, pair, h);
        if (pair->period == 0) {
            world->due_pairs[due++] = i;
        }
    }
    search_due(world, due, h);
}

void phys_refresh_pairs(rlf_world *world, double h)
{
    int32_t due = 0;
    for (int32_t i = 0; i < world->pair_count; i++) {
        phys_pair *pair = &world->pairs[i];
        fetch_pairs(world, i);
        if (++pair->age >= pair->period && apart_for(world, pair, h) == 0) {
            world->due_pairs[due++] = i;
        }
    }
    search_due(world, due, h);
}

void phys_drop_pairs(rlf_world *world, int32_t body)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < world->pair_count; i++) {
        phys_pair *pair = &world->pairs[i];
        if (pair->a == body || pair->b == body) {
            free_pair(world, pair);
        } else {
            world->pairs[kept++] = *pair;
        }
    }
    world->pair_count = kept;
}
