/* Fills small holes from the right side of an edge.
 *
 * A hole pixel with a valid pixel on both sides, along its row, column or diagonal, at most
 * RLF_FILL_GAP apart, is filled. When the two ends belong to one surface, inverse depth (linear on
 * planes) is interpolated. When there is an edge between them, drivers have taken a band away whose
 * middle is the edge, ragged by a pixel on both sides. The valid pixels about the hole pixel vote,
 * near ones more, for the side that it belongs to: that averages the raggedness along the edge. The
 * depth is that side's plane, least squares in depth, which is straight enough within two pixels,
 * or the background's own where that goes on there. A gap between two near ends that is wider than
 * a driver's band shows the background in its middle. */
#include "surface/steps.h"
#include "surface/window.h"

#include "kernel/kernel.h"

#include <string.h>

/* A wide hole must not be crossed from corner to corner. */
enum { DIAGONAL_GAP = 4, REACH = 2, EDGE_WIDTH = 2 };

/* What a pixel at an offset counts: less the farther it is. */
static const float votes_at[2 * REACH + 1][2 * REACH + 1] = {{0.2f, 0.3f, 0.4f, 0.3f, 0.2f},
                                                             {0.3f, 1.3f, 4.0f, 1.3f, 0.3f},
                                                             {0.4f, 4.0f, 0.0f, 4.0f, 0.4f},
                                                             {0.3f, 1.3f, 4.0f, 1.3f, 0.3f},
                                                             {0.2f, 0.3f, 0.4f, 0.3f, 0.2f}};

/* Share of the depth, from a side's end to a hole pixel. */
static const float MOST_CHANGE = 0.05f;

typedef struct gap {
    float before, after; /* depths of the ends; 0 = none */
    int32_t to_before, to_after;
} gap;

/* Steps that stay inside the image from a pixel, to both sides. */
typedef struct line {
    ptrdiff_t step; /* to the next pixel */
    int32_t before, after;
} line;

/* Steps to the first pixel with depth, RLF_FILL_GAP + 1 when none is within `reach`. Looks at all
 * of them from the last to the first, which is faster than to stop at one: where holes end is not
 * to be foreseen. */
static inline int32_t steps_to_depth(const float *depth, ptrdiff_t step, int32_t reach)
{
    int32_t steps = RLF_FILL_GAP + 1;
    for (int32_t d = reach; d >= 1; d--) {
        steps = depth[d * step] > 0.0f ? d : steps;
    }
    return steps;
}

/* Not closed when the ends are farther apart than a gap may be, or there is none. */
static gap find_gap(const float *depth, line l)
{
    bool inside = l.before >= RLF_FILL_GAP && l.after >= RLF_FILL_GAP;
    gap g = {0.0f, 0.0f, RLF_FILL_GAP + 1, RLF_FILL_GAP + 1};
    if (inside) {
        g.to_before = steps_to_depth(depth, -l.step, RLF_FILL_GAP);
        g.to_after = steps_to_depth(depth, l.step, RLF_FILL_GAP);
    } else {
        g.to_before = steps_to_depth(depth, -l.step, rlf_least(l.before, RLF_FILL_GAP));
        g.to_after = steps_to_depth(depth, l.step, rlf_least(l.after, RLF_FILL_GAP));
    }
    if (g.to_before + g.to_after <= RLF_FILL_GAP + 1) {
        g.before = depth[-(ptrdiff_t)g.to_before * l.step];
        g.after = depth[(ptrdiff_t)g.to_after * l.step];
    }
    return g;
}

static bool is_closed(gap g)
{
    return g.before > 0.0f && g.after > 0.0f;
}

static float interpolate(gap g)
{
    float t = (float)g.to_before / (float)(g.to_before + g.to_after);
    return 1.0f / ((1.0f - t) / g.before + t / g.after);
}

static bool is_edge(gap g)
{
    float span = (float)(g.to_before + g.to_after);
    float nearest = g.before < g.after ? g.before : g.after;
    return rlf_kernel_abs(g.before - g.after) > (0.01f * span + 0.01f) * nearest;
}

/* Depths about a hole pixel; 0 outside the image. */
typedef struct window {
    float z[2 * REACH + 1][2 * REACH + 1];
} window;

/* Sums over the pixels of one side, depth relative to its end. */
typedef struct side {
    float end;
    float n, x, y, xx, xy, yy, z, xz, yz;
} side;

/* Sums over the pixels that are nearer than `middle`, or over those that are not. */
static side sum_side(const window *w, float middle, bool is_near, float end)
{
    side s = {.end = end};
    for (int32_t dy = -REACH; dy <= REACH; dy++) {
        float y = (float)dy, row_n = 0.0f, row_x = 0.0f, row_z = 0.0f, row_xz = 0.0f;
        for (int32_t dx = -REACH; dx <= REACH; dx++) {
            float x = (float)dx, at = w->z[dy + REACH][dx + REACH];
            float has = (at > 0.0f) & ((at < middle) == is_near) ? 1.0f : 0.0f;
            float z = has * (at - end);
            row_n += has;
            row_x += has * x;
            row_z += z;
            row_xz += z * x;
            s.xx += has * x * x;
        }
        s.n += row_n;
        s.x += row_x;
        s.y += y * row_n;
        s.xy += y * row_x;
        s.yy += y * y * row_n;
        s.z += row_z;
        s.xz += row_xz;
        s.yz += y * row_z;
    }
    return s;
}

/* The side's plane at the pixel itself (0, 0). The ridge keeps it level across a direction in which
 * the side has hardly an extent. */
static float continue_side(const side *s)
{
    const float ridge = 0.5f;
    float inv = s->n > 0.0f ? 1.0f / s->n : 0.0f;
    float mx = s->x * inv, my = s->y * inv, mz = s->z * inv;
    float xx = s->xx - s->x * mx + ridge, yy = s->yy - s->y * my + ridge;
    float xy = s->xy - s->x * my;
    float xz = s->xz - s->x * mz, yz = s->yz - s->y * mz;
    float inv_det = 1.0f / (xx * yy - xy * xy);
    float b = (xz * yy - yz * xy) * inv_det, c = (yz * xx - xz * xy) * inv_det;
    float z = mz - b * mx - c * my;
    float limit = MOST_CHANGE * s->end;
    z = z > limit ? limit : z;
    return s->end + (z < -limit ? -limit : z);
}

typedef struct fill_job {
    const rlf_reconstruct *stage;
    const rlf_sheet *behind; /* the background; NULL = unknown */
    float *const *normal;    /* NULL = not wanted */
    const float *depth;
    float *out;
    uint8_t *reason;
} fill_job;

/* The background has no outline about a pixel, where its own normals would be guesses too. */
static bool is_whole(const fill_job *job, int32_t x, int32_t y)
{
    enum { ABOUT = 3 };
    const rlf_grid *grid = &job->stage->grid;
    const float *at = job->behind->depth + (ptrdiff_t)y * grid->width + x;
    ptrdiff_t row = (ptrdiff_t)ABOUT * grid->width;
    float most = MOST_CHANGE * at[0];
    return x >= ABOUT && y >= ABOUT && x + ABOUT < grid->width && y + ABOUT < grid->height &&
           rlf_kernel_abs(at[-ABOUT] - at[0]) < most && rlf_kernel_abs(at[ABOUT] - at[0]) < most &&
           rlf_kernel_abs(at[-row] - at[0]) < most && rlf_kernel_abs(at[row] - at[0]) < most;
}

/* 0 where it is unknown. */
static float depth_behind(const fill_job *job, int32_t x, int32_t y)
{
    ptrdiff_t i = (ptrdiff_t)y * job->stage->grid.width + x;
    bool known = job->behind != NULL && job->behind->depth[i] > 0.0f;
    return known ? job->behind->depth[i] : 0.0f;
}

/* The pixel shows the background: it has its depth and its normal. */
static float show_behind(const fill_job *job, int32_t x, int32_t y)
{
    ptrdiff_t i = (ptrdiff_t)y * job->stage->grid.width + x;
    bool normals = job->normal != NULL && is_whole(job, x, y);
    for (int k = 0; k < 3 && normals; k++) {
        job->normal[k][i] = job->behind->normal[k][i];
    }
    return job->behind->depth[i];
}

/* Between two near ends that are far enough apart for a slit: what a driver takes away beside each
 * edge does not reach its middle. */
static bool is_slit(const fill_job *job, int32_t x, int32_t y, gap g)
{
    float farthest = g.before > g.after ? g.before : g.after;
    bool wide = g.to_before > EDGE_WIDTH && g.to_after > EDGE_WIDTH;
    return wide && depth_behind(job, x, y) > (1.0f + MOST_CHANGE) * farthest;
}

static window read_window(const fill_job *job, int32_t x, int32_t y)
{
    const rlf_grid *grid = &job->stage->grid;
    window w;
    bool inside = x >= REACH && y >= REACH && x + REACH < grid->width && y + REACH < grid->height;
    for (int32_t dy = -REACH; dy <= REACH; dy++) {
        const float *row = job->depth + (ptrdiff_t)(y + dy) * grid->width + x;
        for (int32_t dx = -REACH; dx <= REACH; dx++) {
            bool has = inside || (x + dx >= 0 && x + dx < grid->width && y + dy >= 0 &&
                                  y + dy < grid->height);
            w.z[dy + REACH][dx + REACH] = has ? row[dx] : 0.0f;
        }
    }
    return w;
}

/* Votes for the nearer side less those for the farther one. */
static float count_votes(const window *w, float middle)
{
    float balance = 0.0f;
    for (int32_t dy = 0; dy <= 2 * REACH; dy++) {
        for (int32_t dx = 0; dx <= 2 * REACH; dx++) {
            float z = w->z[dy][dx], vote = votes_at[dy][dx];
            balance += z > 0.0f ? (z < middle ? vote : -vote) : 0.0f;
        }
    }
    return balance;
}

static float choose_side(const fill_job *job, int32_t x, int32_t y, gap g)
{
    float middle = 2.0f / (1.0f / g.before + 1.0f / g.after);
    bool before_is_near = g.before < g.after;
    window w = read_window(job, x, y);
    float balance = count_votes(&w, middle);
    bool tie = rlf_kernel_abs(balance) < 0.05f; /* half of the smallest vote's difference */
    bool first = tie ? g.to_before <= g.to_after : (balance > 0.0f) == before_is_near;
    bool is_near = first == before_is_near, is_far = !is_near;
    side chosen = sum_side(&w, middle, is_near, first ? g.before : g.after);
    float z = continue_side(&chosen);
    bool is_behind = is_far && rlf_kernel_abs(depth_behind(job, x, y) - z) < MOST_CHANGE * z;
    return is_behind ? show_behind(job, x, y) : z;
}

static bool may_fill(uint8_t reason)
{
    return reason == RLF_REASON_NO_RETURN || reason == RLF_REASON_FLYING;
}

/* The shortest closed gap along the row, the column or, failing both, a diagonal. */
static float fill_pixel(const fill_job *job, int32_t x, int32_t y)
{
    const rlf_grid *grid = &job->stage->grid;
    const float *at = job->depth + (ptrdiff_t)y * grid->width + x;
    int32_t right = grid->width - 1 - x, down = grid->height - 1 - y;
    const line lines[4] = {{1, x, right},
                           {grid->width, y, down},
                           {grid->width + 1, rlf_least(x, y), rlf_least(right, down)},
                           {grid->width - 1, rlf_least(right, y), rlf_least(x, down)}};
    gap best = {0.0f, 0.0f, 0, 0};
    for (int k = 0; k < 4 && (k < 2 || !is_closed(best)); k++) {
        gap g = find_gap(at, lines[k]);
        bool shorter = g.to_before + g.to_after < best.to_before + best.to_after;
        bool fits = k < 2 || g.to_before + g.to_after <= DIAGONAL_GAP;
        if (is_closed(g) && fits && (!is_closed(best) || shorter)) {
            best = g;
        }
    }
    if (!is_closed(best)) {
        return 0.0f;
    }
    if (is_slit(job, x, y, best)) {
        return show_behind(job, x, y);
    }
    return is_edge(best) ? choose_side(job, x, y, best) : interpolate(best);
}

static void fill_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const fill_job *job = context;
    int32_t width = job->stage->grid.width;
    ptrdiff_t first = (ptrdiff_t)begin * width;
    memcpy(job->out + first, job->depth + first,
           (size_t)(end - begin) * (size_t)width * sizeof *job->out);
    for (int32_t y = begin; y < end; y++) {
        uint8_t *reason = job->reason + (ptrdiff_t)y * width; /* 0 = OK */
        for (int32_t x = 0; (x = rlf_kernel_next_mark(reason, x, width)) < width; x++) {
            ptrdiff_t i = (ptrdiff_t)y * width + x;
            if (!may_fill(reason[x])) { /* all others have depth or must not have one */
                continue;
            }
            job->out[i] = fill_pixel(job, x, y);
            if (job->out[i] > 0.0f) {
                reason[x] = RLF_REASON_FILLED;
            }
        }
    }
}

void rlf_fill_holes(const rlf_reconstruct *stage, const float *depth, rlf_slot *slot)
{
    int32_t newest = stage->background.newest;
    fill_job job = {.stage = stage,
                    .behind = newest < 0 ? NULL : &stage->background.sheets[newest],
                    .normal = stage->def.enable_smoothing ? slot->normal : NULL,
                    .depth = depth,
                    .out = slot->depth,
                    .reason = slot->reason};
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, fill_rows, &job);
}
