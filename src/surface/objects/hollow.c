/* The inside of a bowl or a cup is a thing with its outside, although a depth step or a concave
 * edge lies between them. Only what is hollow shows a surface whose normals converge. */
#include "surface/objects/objects.h"

#include <string.h>

/* Covariance of points and normals, per spread of the points: of half a sphere it is -0.6. */
static const double MOST_SPREAD = -0.15;
static const double LEAST_BORDER = 0.25; /* of what is about it, the outside's share */

/* Where a thing's normals converge: true. */
static bool is_hollow(const rlf_object_sum *s)
{
    double inv = s->count > 0.0 ? 1.0 / s->count : 0.0;
    double along = s->along * inv, spread = s->square * inv;
    for (int k = 0; k < 3; k++) {
        along -= s->p[k] * s->n[k] * inv * inv;
        spread -= s->p[k] * s->p[k] * inv * inv;
    }
    return s->count > 0.0 && along < 0.0 &&
           along * along > MOST_SPREAD * MOST_SPREAD * rlf_max(spread, 0.0);
}

static void add_points(rlf_reconstruct *stage, const rlf_layer_in *in)
{
    const rlf_grid *grid = &stage->grid;
    rlf_object_sum *sums = stage->objects->sum;
    for (int32_t i = 0; i < grid->count; i++) {
        int32_t c = stage->work.component[i];
        if (c <= stage->objects->count || c >= RLF_OBJECTS_SUMMED) {
            continue;
        }
        rlf_object_sum *s = &sums[c];
        double z = in->depth[i];
        const double p[3] = {z * grid->ray_x[i], z * grid->ray_y[i], z};
        s->count += 1.0;
        for (int k = 0; k < 3; k++) {
            double n = in->normal[k][i];
            s->p[k] += p[k];
            s->n[k] += n;
            s->along += p[k] * n;
            s->square += p[k] * p[k];
        }
    }
}

static void meet(rlf_object_sum *s, int32_t other, int32_t supports)
{
    s->border++;
    if (other <= supports) {
        return;
    }
    if (s->votes == 0) {
        s->neighbour = other;
    }
    s->votes += s->neighbour == other ? 1 : -1;
}

static void visit_borders(rlf_reconstruct *stage, bool is_count)
{
    const int32_t *number = stage->work.component;
    const rlf_grid *grid = &stage->grid;
    rlf_object_sum *sums = stage->objects->sum;
    for (int32_t i = grid->width; i < grid->count; i++) {
        const int32_t beside[2] = {i % grid->width > 0 ? i - 1 : i, i - grid->width};
        for (int k = 0; k < 2; k++) {
            int32_t a = number[i], b = number[beside[k]];
            for (int swap = 0; a != b && swap < 2; swap++) {
                int32_t own = swap ? b : a, other = swap ? a : b;
                if (own < RLF_OBJECTS_SUMMED && sums[own].is_hollow) {
                    if (is_count) {
                        sums[own].shared += other == sums[own].neighbour ? 1 : 0;
                    } else {
                        meet(&sums[own], other, stage->objects->count);
                    }
                }
            }
        }
    }
}

void rlf_hollows_join(rlf_reconstruct *stage, const rlf_layer_in *in, int32_t components)
{
    rlf_object_sum *sums = stage->objects->sum;
    int32_t end = components + 1 < RLF_OBJECTS_SUMMED ? components + 1 : RLF_OBJECTS_SUMMED;
    memset(sums, 0, sizeof *sums * RLF_OBJECTS_SUMMED);
    add_points(stage, in);
    for (int32_t c = stage->objects->count + 1; c < end; c++) {
        sums[c].is_hollow = is_hollow(&sums[c]);
    }
    visit_borders(stage, false);
    visit_borders(stage, true);
    for (int32_t i = 0; i < stage->grid.count; i++) {
        int32_t c = stage->work.component[i];
        const rlf_object_sum *s = c < RLF_OBJECTS_SUMMED ? &sums[c] : &sums[0];
        if (s->is_hollow && s->neighbour > 0 && s->shared >= LEAST_BORDER * s->border &&
            (s->neighbour >= RLF_OBJECTS_SUMMED || !sums[s->neighbour].is_hollow)) {
            stage->work.component[i] = s->neighbour;
        }
    }
}
