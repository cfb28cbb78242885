/* Sweep and prune along x (Baraff 1992), then contacts pair by pair. */
#include "physics/broad_phase.h"
#include "physics/pair_collide.h"

#define MARGIN 0.002

static double reach_of(const phys_body *body, double horizon)
{
    double speed = rlf_length(body->v) + rlf_length(body->w) * body->shape.radius;
    return body->shape.radius + MARGIN + speed * horizon;
}

/* Insertion sort: nearly sorted from one call to the next. Equal keys keep the order of bodies. */
static int32_t sort_intervals(rlf_world *world, double horizon)
{
    int32_t count = 0;
    for (int32_t i = 0; i < world->body_top; i++) {
        const phys_body *body = &world->bodies[i];
        if (!body->is_alive || !body->collides_with_bodies) {
            continue;
        }
        double reach = reach_of(body, horizon);
        phys_interval interval = {body->x.x - reach, body->x.x + reach, i};
        int32_t at = count++;
        while (at > 0 && world->intervals[at - 1].low > interval.low) {
            world->intervals[at] = world->intervals[at - 1];
            at--;
        }
        world->intervals[at] = interval;
    }
    return count;
}

static bool is_before(const phys_pair *p, const phys_pair *q)
{
    return p->a < q->a || (p->a == q->a && p->b < q->b);
}

static void add_pair(rlf_world *world, int32_t i, int32_t k)
{
    if (world->pair_count < world->pair_capacity) {
        phys_pair *pair = &world->pairs[world->pair_count++];
        pair->a = i < k ? i : k;
        pair->b = i < k ? k : i;
        pair->contact_count = 0;
    }
}

/* Only a and b are set yet, so sorting moves the keys alone (Shell 1959). */
static void sort_pairs(rlf_world *world)
{
    for (int32_t gap = world->pair_count / 2; gap > 0; gap /= 2) {
        for (int32_t i = gap; i < world->pair_count; i++) {
            phys_pair key = {.a = world->pairs[i].a, .b = world->pairs[i].b};
            int32_t at = i;
            while (at >= gap && is_before(&key, &world->pairs[at - gap])) {
                world->pairs[at].a = world->pairs[at - gap].a;
                world->pairs[at].b = world->pairs[at - gap].b;
                at -= gap;
            }
            world->pairs[at].a = key.a;
            world->pairs[at].b = key.b;
        }
    }
}

static const phys_pair *find_old(const rlf_world *world, const phys_pair *key)
{
    int32_t low = 0, high = world->old_pair_count;
    while (low < high) {
        int32_t middle = (low + high) / 2;
        if (is_before(&world->old_pairs[middle], key)) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    const phys_pair *found = &world->old_pairs[low];
    return low < world->old_pair_count && found->a == key->a && found->b == key->b ? found : NULL;
}

static void keep_impulse(phys_contact *contact, const phys_pair *old, double limit)
{
    double best2 = limit * limit;
    for (int32_t i = 0; old != NULL && i < old->contact_count; i++) {
        const phys_contact *before = &old->contacts[i];
        rlf_vec3 d = rlf_sub(before->anchor_a, contact->anchor_a);
        if (rlf_dot(d, d) < best2 && rlf_dot(before->normal, contact->normal) > 0.8) {
            best2 = rlf_dot(d, d);
            contact->impulse_n = before->impulse_n;
            contact->impulse_t[0] = before->impulse_t[0];
            contact->impulse_t[1] = before->impulse_t[1];
            contact->log = before->log;
        }
    }
}

static void collide_pair(rlf_world *world, phys_pair *pair, double horizon)
{
    pair_point points[PAIR_POINTS_MAX];
    int32_t chosen[PHYS_PAIR_CONTACTS];
    const phys_body *a = &world->bodies[pair->a], *b = &world->bodies[pair->b];
    rlf_vec3 v = rlf_sub(a->v, b->v);
    double margin = MARGIN + horizon * (rlf_length(v) + rlf_length(a->w) * a->shape.radius +
                                        rlf_length(b->w) * b->shape.radius);
    bool are_boxes = a->shape.shape.type == RLF_SHAPE_BOX && b->shape.shape.type == RLF_SHAPE_BOX;
    int32_t count = are_boxes ? pair_collide_boxes(a, b, margin, points)
                              : pair_collide_shapes(a, b, margin, points);
    double radius = rlf_min(a->shape.radius, b->shape.radius);
    pair->contact_count = pair_reduce(points, count, radius, chosen);
    const phys_pair *old = find_old(world, pair);
    for (int32_t i = 0; i < pair->contact_count; i++) {
        const pair_point *p = &points[chosen[i]];
        phys_contact fresh = {.a = pair->a, .b = pair->b, .other = RLF_CONTACT_BODY, .log = -1};
        fresh.anchor_a = rlf_rotate(rlf_quat_conjugate(a->q), rlf_sub(p->core_a, a->x));
        fresh.anchor_b = rlf_rotate(rlf_quat_conjugate(b->q), rlf_sub(p->core_b, b->x));
        fresh.rounding_a = p->rounding_a;
        fresh.rounding_b = p->rounding_b;
        fresh.normal = p->normal;
        fresh.friction = sqrt(a->friction * b->friction);
        fresh.restitution = rlf_max(a->restitution, b->restitution);
        keep_impulse(&fresh, old, 0.2 * radius);
        pair->contacts[i] = fresh;
    }
}

typedef struct pair_job {
    rlf_world *world;
    double horizon;
} pair_job;

static void collide_range(void *context, int32_t begin, int32_t end, int32_t worker)
{
    pair_job *job = context;
    (void)worker;
    for (int32_t i = begin; i < end; i++) {
        collide_pair(job->world, &job->world->pairs[i], job->horizon);
    }
}

void phys_find_pairs(rlf_world *world, double horizon)
{
    phys_pair *swap = world->old_pairs;
    world->old_pairs = world->pairs;
    world->pairs = swap;
    world->old_pair_count = world->pair_count;
    world->pair_count = 0;
    int32_t count = sort_intervals(world, horizon);
    for (int32_t i = 0; i < count; i++) {
        const phys_interval *one = &world->intervals[i];
        const phys_body *a = &world->bodies[one->body];
        double reach_a = 0.5 * (one->high - one->low);
        for (int32_t k = i + 1; k < count && world->intervals[k].low <= one->high; k++) {
            const phys_interval *two = &world->intervals[k];
            const phys_body *b = &world->bodies[two->body];
            double reach = reach_a + 0.5 * (two->high - two->low);
            rlf_vec3 d = rlf_sub(a->x, b->x);
            bool is_idle = phys_body_is_idle(a) && phys_body_is_idle(b);
            bool is_fixed = phys_body_is_fixed(a) && phys_body_is_fixed(b);
            if (!is_idle && !is_fixed && rlf_dot(d, d) <= reach * reach) {
                add_pair(world, one->body, two->body);
            }
        }
    }
    sort_pairs(world);
    pair_job job = {world, horizon};
    rlf_pool *pool = world->pair_count >= 64 ? world->def.pool : NULL;
    rlf_parallel_for(pool, world->pair_count, 16, collide_range, &job);
}
