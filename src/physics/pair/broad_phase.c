/* Broad phase: sweep and prune (Ericson 2005, 7.5). Bodies are sorted by where their boxes begin
 * along one axis, and each that moves is held against those that may reach into its box, in lanes.
 */
#include "physics/pair/collide.h"
#include "kernel/lanes.h"

/* Far more than a float of some metres is rounded by: metres, and a share. */
#define ROUNDING 1e-6
#define NOWHERE 1e30

/* Models of real things are met by those too that meet no other bodies. */
static bool collides(const rlf_world *world, const phys_body *body)
{
    return body->is_alive && (body->collides_with_bodies || world->snapshot.known_count > 0);
}

static bool may_meet(const phys_proxy *a, const phys_proxy *b)
{
    return !(a->is_fixed && b->is_fixed) && (a->meets_bodies || (!a->is_real && b->is_real)) &&
           (b->meets_bodies || (!b->is_real && a->is_real));
}

/* Half the size of the box about a body on its way. */
static rlf_vec3 half_of(const phys_body *body, double horizon)
{
    const phys_shape *shape = &body->shape;
    double travel = rlf_length(body->v) + rlf_length(body->w) * shape->radius;
    double margin = 0.5 * PHYS_PAIR_MARGIN + travel * horizon;
    rlf_vec3 half = rlf_vec3_make(shape->radius, shape->radius, shape->radius);
    if (shape->shape.type == RLF_SHAPE_BOX) {
        double size[3] = {shape->shape.size.x, shape->shape.size.y, shape->shape.size.z};
        double sum[3] = {0, 0, 0};
        for (int32_t i = 0; i < 9; i++) {
            double m = body->R.m[i / 3][i % 3];
            sum[i / 3] += 0.5 * size[i % 3] * (m < 0.0 ? -m : m);
        }
        half = rlf_vec3_make(sum[0], sum[1], sum[2]);
    }
    return rlf_add(half, rlf_vec3_make(margin, margin, margin));
}

/* Fills the boxes of those that meet others; returns their number. */
static int32_t measure(rlf_world *world, double horizon)
{
    int32_t count = 0;
    for (int32_t i = 0; i < world->body_top; i++) {
        const phys_body *body = &world->bodies[i];
        phys_proxy *proxy = &world->proxies[i];
        proxy->is_there = collides(world, body) && rlf_vec3_is_finite(body->x);
        if (proxy->is_there) {
            proxy->centre = body->x;
            proxy->half = half_of(body, horizon);
            proxy->is_idle = phys_body_is_idle(body);
            proxy->is_fixed = phys_body_is_fixed(body);
            proxy->is_real = body->is_real;
            proxy->meets_bodies = body->collides_with_bodies;
            count++;
        }
    }
    return count;
}

/* Places along an axis, in bins. */
typedef struct bins {
    int32_t axis, count;
    float from, per_metre;
} bins;

static double along(rlf_vec3 v, int32_t axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* Bins along the axis on which the centres spread most, two standard deviations to each side. */
static bins choose_bins(const rlf_world *world, int32_t count)
{
    double sum[3] = {0, 0, 0}, square[3] = {0, 0, 0}, mean[3], variance[3];
    int32_t axis = 0;
    for (int32_t i = 0; i < world->body_top; i++) {
        for (int32_t k = 0; k < 3 && world->proxies[i].is_there; k++) {
            double x = rlf_clamp(along(world->proxies[i].centre, k), -1e6, 1e6);
            sum[k] += x;
            square[k] += x * x;
        }
    }
    for (int32_t k = 0; k < 3; k++) {
        mean[k] = sum[k] / rlf_max(count, 1.0);
        variance[k] = rlf_max(square[k] / rlf_max(count, 1.0) - mean[k] * mean[k], 1e-6);
        axis = variance[k] > variance[axis] ? k : axis;
    }
    double half = 2.0 * sqrt(variance[axis]);
    return (bins){axis, world->bin_count, (float)(mean[axis] - half),
                  (float)(0.5 * world->bin_count / half)};
}

/* Those beyond the first and the last bin are in these. */
static int32_t bin_of(const bins *b, float x)
{
    float at = (x - b->from) * b->per_metre;
    float last = (float)(b->count - 1);
    return at > 0.0f ? (int32_t)(at < last ? at : last) : 0; /* so is what is no number */
}

/* The six ends of a body's box, a little outside it. */
static void ends_of(const phys_proxy *proxy, float ends[6])
{
    for (int32_t k = 0; k < 3; k++) {
        double centre = along(proxy->centre, k), half = along(proxy->half, k);
        double slack = ROUNDING + ROUNDING * (half + (centre < 0.0 ? -centre : centre));
        ends[k] = (float)rlf_clamp(centre - half - slack, -NOWHERE, NOWHERE);
        ends[k + 3] = (float)rlf_clamp(centre + half + slack, -NOWHERE, NOWHERE);
    }
}

/* Lists the bodies by the bins in which their boxes begin, those of a bin in their order. Returns
 * the longest box along the axis of those that are idle. */
static float sort_boxes(rlf_world *world, const bins *b)
{
    int32_t *begin = world->bins, stride = phys_box_stride(world);
    float longest = 0.0f;
    for (int32_t i = 0; i <= b->count; i++) {
        begin[i] = 0;
    }
    for (int32_t i = 0; i < world->body_top; i++) {
        phys_proxy *proxy = &world->proxies[i];
        if (proxy->is_there) {
            ends_of(proxy, proxy->ends);
            proxy->bin = bin_of(b, proxy->ends[b->axis]);
            begin[proxy->bin]++;
            float length = proxy->ends[b->axis + 3] - proxy->ends[b->axis];
            longest = proxy->is_idle && length > longest ? length : longest;
        }
    }
    for (int32_t i = 0; i < b->count; i++) {
        begin[i + 1] += begin[i];
    }
    /* Placed from the last on, each bin's end moves down to its beginning. */
    for (int32_t i = world->body_top - 1; i >= 0; i--) {
        phys_proxy *proxy = &world->proxies[i];
        if (proxy->is_there) {
            proxy->place = --begin[proxy->bin];
            world->box_bodies[proxy->place] = i;
            for (int32_t k = 0; k < 6; k++) {
                world->box_ends[k * stride + proxy->place] = proxy->ends[k];
            }
        }
    }
    return longest;
}

static void add_near(rlf_world *world, int32_t i, int32_t k)
{
    if (world->near_count < world->pair_capacity) {
        phys_near near = {i < k ? i : k, i < k ? k : i};
        world->near[world->near_count++] = near;
    }
}

static void test(rlf_world *world, int32_t i, int32_t k)
{
    const phys_proxy *a = &world->proxies[i], *b = &world->proxies[k];
    rlf_vec3 d = rlf_sub(a->centre, b->centre), half = rlf_add(a->half, b->half);
    if (d.x <= half.x && d.x >= -half.x && d.y <= half.y && d.y >= -half.y && d.z <= half.z &&
        d.z >= -half.z && may_meet(a, b)) {
        add_near(world, i, k);
    }
}

/* Body i, which moves, against those after it, and the idle ones before it, which ask nobody. */
static void sweep(rlf_world *world, int32_t i, const bins *b, float longest)
{
    const phys_proxy *proxy = &world->proxies[i];
    float first = proxy->ends[b->axis] - 1.001f * longest - 0.001f;
    int32_t begin = longest > 0.0f ? world->bins[bin_of(b, first)] : proxy->place + 1;
    int32_t end = world->bins[bin_of(b, proxy->ends[b->axis + 3]) + 1];
    int32_t count = rlf_kernel_boxes_meet(world->box_ends, phys_box_stride(world), begin, end,
                                          proxy->ends, world->box_found);
    for (int32_t n = 0; n < count; n++) {
        int32_t place = world->box_found[n], k = world->box_bodies[place];
        if (k != i && (place > proxy->place || world->proxies[k].is_idle)) {
            test(world, i, k);
        }
    }
}

/* By counting for a, by insertion for the few b of each a. */
static void sort_near(rlf_world *world)
{
    int32_t *begin = world->near_begin;
    for (int32_t i = 0; i <= world->body_top; i++) {
        begin[i] = 0;
    }
    for (int32_t k = 0; k < world->near_count; k++) {
        begin[world->near[k].a + 1]++;
    }
    for (int32_t i = 0; i < world->body_top; i++) {
        begin[i + 1] += begin[i];
    }
    for (int32_t k = world->near_count - 1; k >= 0; k--) {
        world->near_sorted[--begin[world->near[k].a + 1]] = world->near[k];
    }
    for (int32_t k = 1; k < world->near_count; k++) {
        phys_near key = world->near_sorted[k];
        int32_t at = k;
        for (; at > 0 && world->near_sorted[at - 1].a == key.a &&
               world->near_sorted[at - 1].b > key.b;
             at--) {
            world->near_sorted[at] = world->near_sorted[at - 1];
        }
        world->near_sorted[at] = key;
    }
}

void phys_find_near(rlf_world *world, double horizon)
{
    world->near_count = 0;
    bins b = choose_bins(world, measure(world, horizon));
    float longest = sort_boxes(world, &b);
    for (int32_t i = 0; i < world->body_top; i++) {
        if (world->proxies[i].is_there && !world->proxies[i].is_idle) {
            sweep(world, i, &b, longest);
        }
    }
    sort_near(world);
}
