/* Broad phase: bodies in the cells of a grid, found through a hash table (Teschner et al. 2003).
 * Cells are as large as the boxes of most bodies; the few that are larger ask everybody. */
#include "physics/broad_phase.h"
#include "physics/pair_search.h"

#define LARGE (-1) /* cell of a body that is larger than a cell */
#define NONE (-2)  /* ... of one that is not there */

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

static double longest(rlf_vec3 half)
{
    return rlf_max(half.x, rlf_max(half.y, half.z));
}

/* Fills the boxes; returns the size of a cell. */
static double measure(rlf_world *world, double horizon)
{
    double sum = 0.0, most = 0.0, count = 0.0;
    for (int32_t i = 0; i < world->body_top; i++) {
        phys_proxy *proxy = &world->proxies[i];
        proxy->cell = NONE;
        if (collides(world, &world->bodies[i])) {
            const phys_body *body = &world->bodies[i];
            proxy->centre = body->x;
            proxy->half = half_of(body, horizon);
            proxy->is_idle = phys_body_is_idle(body);
            proxy->is_fixed = phys_body_is_fixed(body);
            proxy->is_real = body->is_real;
            proxy->meets_bodies = body->collides_with_bodies;
            double size = longest(proxy->half);
            proxy->cell = 0;
            sum += size;
            most = rlf_max(most, size);
            count += 1.0;
        }
    }
    return count > 0.0 ? 2.0 * rlf_min(most, 2.0 * sum / count) : 1.0;
}

static int32_t cell_index(double x, double cell)
{
    double at = x / cell + 524288.0; /* bodies are within 20 m or so of the origin */
    return at > 1.0 ? (int32_t)rlf_min(at, 1048574.0) : 1; /* so is what is no number */
}

/* Three numbers below 2^20 side by side. */
static int64_t cell_at(int32_t x, int32_t y, int32_t z)
{
    return (int64_t)x << 40 | (int64_t)y << 20 | (int64_t)z;
}

static int32_t bucket_of(const rlf_world *world, int64_t cell)
{
    uint64_t mixed = (uint64_t)cell * 0x9e3779b97f4a7c15u; /* Fibonacci hashing, Knuth 6.4 */
    return (int32_t)((mixed >> 32) & (uint64_t)(world->bucket_count - 1));
}

/* Sorts the bodies by bucket; those of a bucket stay in their order. */
static void fill_buckets(rlf_world *world, double cell)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < world->bucket_count + 2; i++) {
        world->buckets[i] = 0;
    }
    for (int32_t i = 0; i < world->body_top; i++) {
        phys_proxy *proxy = &world->proxies[i];
        rlf_vec3 x = proxy->centre;
        if (proxy->cell == NONE) {
            continue;
        }
        proxy->cell =
            longest(proxy->half) > 0.5 * cell
                ? LARGE
                : cell_at(cell_index(x.x, cell), cell_index(x.y, cell), cell_index(x.z, cell));
        if (proxy->cell != LARGE) {
            world->buckets[bucket_of(world, proxy->cell) + 1]++;
            kept++;
        }
    }
    for (int32_t i = 0; i < world->bucket_count; i++) {
        world->buckets[i + 1] += world->buckets[i];
    }
    /* Placed from the last on, each bucket's end moves down to its beginning; buckets[i + 1] then
     * holds where bucket i begins. */
    for (int32_t i = world->body_top - 1; i >= 0; i--) {
        if (world->proxies[i].cell >= 0) {
            int32_t place = --world->buckets[bucket_of(world, world->proxies[i].cell) + 1];
            world->bucket_items[place] = i;
        }
    }
    world->buckets[world->bucket_count + 1] = kept;
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

static void ask_cell(rlf_world *world, int32_t i, int64_t key)
{
    int32_t bucket = bucket_of(world, key);
    int32_t end = world->buckets[bucket + 2];
    for (int32_t p = world->buckets[bucket + 1]; p < end; p++) {
        int32_t k = world->bucket_items[p];
        if (world->proxies[k].cell == key && k != i && (k > i || world->proxies[k].is_idle)) {
            test(world, i, k);
        }
    }
}

/* Body i, which moves, against those of the cells in which the centre of one that is no larger than
 * a cell can be: two or three of them along each axis. */
static void ask_cells(rlf_world *world, int32_t i, double cell)
{
    const phys_proxy *proxy = &world->proxies[i];
    rlf_vec3 x = proxy->centre;
    rlf_vec3 way = rlf_add(proxy->half, rlf_vec3_make(0.5 * cell, 0.5 * cell, 0.5 * cell));
    int32_t low[3] = {cell_index(x.x - way.x, cell), cell_index(x.y - way.y, cell),
                      cell_index(x.z - way.z, cell)};
    int32_t high[3] = {cell_index(x.x + way.x, cell), cell_index(x.y + way.y, cell),
                       cell_index(x.z + way.z, cell)};
    for (int32_t u = low[0]; u <= high[0]; u++) {
        for (int32_t v = low[1]; v <= high[1]; v++) {
            for (int32_t w = low[2]; w <= high[2]; w++) {
                ask_cell(world, i, cell_at(u, v, w));
            }
        }
    }
}

/* A large body against everybody. */
static void ask_all(rlf_world *world, int32_t i)
{
    bool is_idle = world->proxies[i].is_idle;
    for (int32_t k = 0; k < world->body_top; k++) {
        int64_t cell = world->proxies[k].cell;
        bool is_other = cell >= 0 || (cell == LARGE && k > i);
        if (is_other && !(is_idle && world->proxies[k].is_idle)) {
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
    double cell = measure(world, horizon);
    fill_buckets(world, cell);
    for (int32_t i = 0; i < world->body_top; i++) {
        if (world->proxies[i].cell == LARGE) {
            ask_all(world, i);
        } else if (world->proxies[i].cell >= 0 && !world->proxies[i].is_idle) {
            ask_cells(world, i, cell);
        }
    }
    sort_near(world);
}
