/* Grids, stacks, rings and random places. */
#include "io/scene/pattern.h"

#define PLACES_STREAM (-1) /* of a seed; bodies have those from 0 */

/* Along x, then z, then layer on layer upwards (-y). */
static void place_grid(const io_pattern *p, rlf_vec3 *out)
{
    for (int32_t i = 0; i < p->count; i++) {
        int32_t layer = p->along[0] * p->along[2];
        double x = i % p->along[0] - 0.5 * (p->along[0] - 1);
        double y = 0.5 * (p->along[1] - 1) - i / layer;
        double z = i % layer / p->along[0] - 0.5 * (p->along[2] - 1);
        out[i] = rlf_vec3_make(x * p->spacing.x, y * p->spacing.y, z * p->spacing.z);
    }
}

static void place_stack(const io_pattern *p, rlf_vec3 *out)
{
    for (int32_t i = 0; i < p->count; i++) {
        out[i] = rlf_scale(p->up, i * p->spacing.y);
    }
}

/* The first at +x, or at +z where x is up. */
static void place_ring(const io_pattern *p, rlf_vec3 *out)
{
    rlf_vec3 x = rlf_vec3_make(1, 0, 0);
    if (p->up.x * p->up.x > 0.9) {
        x = rlf_vec3_make(0, 0, 1);
    }
    rlf_vec3 side = rlf_normalize(rlf_mad(x, p->up, -rlf_dot(x, p->up)));
    rlf_vec3 ahead = rlf_cross(p->up, side);
    for (int32_t i = 0; i < p->count; i++) {
        double angle = 2.0 * RLF_PI * i / p->count;
        out[i] =
            rlf_mad(rlf_scale(side, p->radius * rlf_cos(angle)), ahead, p->radius * rlf_sin(angle));
    }
}

/* ---- random --------------------------------------------------------------------------------- */

static int32_t cells_along(double extent, double edge)
{
    return (int32_t)rlf_max(1.0, extent / edge);
}

static int64_t count_cells(const rlf_vec3 *box, double edge, int32_t out[3])
{
    out[0] = cells_along(box->x, edge);
    out[1] = cells_along(box->y, edge);
    out[2] = cells_along(box->z, edge);
    return (int64_t)out[0] * out[1] * out[2];
}

/* The box cut into the largest cells of which there are `count`: at most 8 times as many. */
static int32_t cut_box(const rlf_vec3 *box, int32_t count, int32_t out[3])
{
    double longest = rlf_max(rlf_max(box->x, box->y), box->z);
    double low = longest / (count + 1.0), high = 2.0 * longest;
    for (int32_t i = 0; i < 60; i++) {
        double middle = 0.5 * (low + high);
        *(count_cells(box, middle, out) >= count ? &low : &high) = middle;
    }
    return (int32_t)count_cells(box, rlf_max(low, 1e-12), out);
}

/* Within a cell, and not nearer to its walls than `reach` where it is wide enough. */
static double place_in(double extent, int32_t cells, int32_t cell, double reach, double uniform)
{
    double width = extent / cells;
    double play = rlf_max(0.0, width - 2.0 * reach);
    return (cell + 0.5) * width - 0.5 * extent + (uniform - 0.5) * play;
}

/* Each in a cell of its own, so that in a box that is large enough none begins inside another. */
static rlf_result place_random(const io_pattern *p, rlf_vec3 *out)
{
    int32_t n[3];
    int32_t total = cut_box(&p->box, p->count, n);
    int32_t *cells = rlf_alloc_array((size_t)total, sizeof(*cells));
    if (cells == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (int32_t i = 0; i < total; i++) {
        cells[i] = i;
    }
    io_random r = io_random_make(p->seed, PLACES_STREAM);
    for (int32_t i = 0; i < p->count; i++) {
        int32_t k = i + (int32_t)(io_random_uniform(&r) * (total - i)); /* Fisher and Yates */
        int32_t c = cells[k];
        cells[k] = cells[i];
        double x = place_in(p->box.x, n[0], c % n[0], p->reach, io_random_uniform(&r));
        double y = place_in(p->box.y, n[1], c / n[0] % n[1], p->reach, io_random_uniform(&r));
        double z = place_in(p->box.z, n[2], c / n[0] / n[1], p->reach, io_random_uniform(&r));
        out[i] = rlf_vec3_make(x, y, z);
    }
    rlf_free(cells);
    return RLF_OK;
}

rlf_result io_pattern_place(const io_pattern *p, rlf_vec3 *out)
{
    switch (p->kind) {
    case IO_PATTERN_GRID: place_grid(p, out); break;
    case IO_PATTERN_STACK: place_stack(p, out); break;
    case IO_PATTERN_RING: place_ring(p, out); break;
    case IO_PATTERN_RANDOM: return place_random(p, out);
    }
    return RLF_OK;
}
