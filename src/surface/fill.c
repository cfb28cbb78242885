/* Fills small holes from the right side of an edge.
 *
 * A hole pixel with a valid pixel on both sides, along its row, column or diagonal, at most
 * RLF_FILL_GAP apart, is filled. When the two ends belong to one surface, inverse depth (linear on
 * planes) is interpolated; when there is an edge between them, the nearer end in the image is
 * continued, so that a silhouette stays where the middle of the gap is. */
#include "surface/steps.h"

#include "kernel/kernel.h"

/* A wide hole must not be crossed from corner to corner. */
enum { DIAGONAL_GAP = 4 };

typedef struct gap {
    float before, after; /* depths of the ends; 0 = none */
    int32_t to_before, to_after;
} gap;

/* Steps that stay inside the image from a pixel, to both sides. */
typedef struct line {
    ptrdiff_t step; /* to the next pixel */
    int32_t before, after;
} line;

static gap find_gap(const float *depth, line l)
{
    gap g = {0.0f, 0.0f, 0, 0};
    int32_t reach = l.before < RLF_FILL_GAP ? l.before : RLF_FILL_GAP;
    for (int32_t d = 1; d <= reach && g.before <= 0.0f; d++) {
        g.before = depth[-(ptrdiff_t)d * l.step];
        g.to_before = d;
    }
    int32_t room = RLF_FILL_GAP + 1 - g.to_before;
    reach = l.after < room ? l.after : room;
    for (int32_t d = 1; d <= reach && g.before > 0.0f && g.after <= 0.0f; d++) {
        g.after = depth[(ptrdiff_t)d * l.step];
        g.to_after = d;
    }
    return g;
}

static bool is_closed(gap g)
{
    return g.before > 0.0f && g.after > 0.0f;
}

static float bridge(gap g)
{
    float span = (float)(g.to_before + g.to_after);
    float nearest = g.before < g.after ? g.before : g.after;
    float jump = rlf_kernel_abs(g.before - g.after);
    if (jump > (0.01f * span + 0.01f) * nearest) {
        return g.to_before <= g.to_after ? g.before : g.after;
    }
    float t = (float)g.to_before / span;
    return 1.0f / ((1.0f - t) / g.before + t / g.after);
}

static bool may_fill(uint8_t reason)
{
    return reason == RLF_REASON_NO_RETURN || reason == RLF_REASON_FLYING;
}

typedef struct fill_job {
    const rlf_reconstruct *stage;
    const float *depth;
    float *out;
    uint8_t *reason;
} fill_job;

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

/* The shortest closed gap along the row, the column or, failing both, a diagonal. */
static float fill_pixel(const fill_job *job, int32_t x, int32_t y)
{
    const rlf_grid *grid = &job->stage->grid;
    const float *at = job->depth + (ptrdiff_t)y * grid->width + x;
    int32_t right = grid->width - 1 - x, down = grid->height - 1 - y;
    const line lines[4] = {{1, x, right},
                           {grid->width, y, down},
                           {grid->width + 1, least(x, y), least(right, down)},
                           {grid->width - 1, least(right, y), least(x, down)}};
    gap best = {0.0f, 0.0f, 0, 0};
    for (int k = 0; k < 4 && (k < 2 || !is_closed(best)); k++) {
        gap g = find_gap(at, lines[k]);
        bool shorter = g.to_before + g.to_after < best.to_before + best.to_after;
        bool fits = k < 2 || g.to_before + g.to_after <= DIAGONAL_GAP;
        if (is_closed(g) && fits && (!is_closed(best) || shorter)) {
            best = g;
        }
    }
    return is_closed(best) ? bridge(best) : 0.0f;
}

static void fill_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const fill_job *job = context;
    int32_t width = job->stage->grid.width;
    for (int32_t y = begin; y < end; y++) {
        for (int32_t x = 0; x < width; x++) {
            ptrdiff_t i = (ptrdiff_t)y * width + x;
            job->out[i] = job->depth[i];
            if (job->depth[i] > 0.0f || !may_fill(job->reason[i])) {
                continue;
            }
            job->out[i] = fill_pixel(job, x, y);
            if (job->out[i] > 0.0f) {
                job->reason[i] = RLF_REASON_FILLED;
            }
        }
    }
}

void rlf_fill_holes(const rlf_reconstruct *stage, const float *depth, float *out, uint8_t *reason)
{
    fill_job job = {stage, depth, out, reason};
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, fill_rows, &job);
}
