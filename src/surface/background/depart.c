/* What stood since the first frame and starts to move. Most of it shows the background's depth
 * still: a box that is pushed differs at two of its edges alone, one that is lifted by less than
 * the noise of a pixel. So it is decided for a whole thing of the background
 * (thickness/static_pieces.c):
 *
 * - it went aside: something farther is seen where it was, and something nearer beside it, which
 *   goes on with it;
 * - it came nearer: a good part of it did in the same frames, and by the same way along its
 *   normals. What comes before it instead comes over it from its edge.
 *
 * All of it becomes foreground at once, and the background has nothing there until it is seen past:
 * no solid stays where it was. */
#include "surface/depth_step.h"
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <string.h>

enum {
    LOST = 1,
    RISEN = 2,
    LEAST_EDGE = 12,  /* pixels that went, and that came, at its edges ... */
    EDGE_SHARE = 12,  /* ... and of the width and height of its rectangle one of so many */
    MOST_UNLIKE = 8,  /* times as many of one as of the other */
    GAP = 3,          /* pixels between things, at most */
    LEAST_RISEN = 50, /* pixels that came nearer */
    IMAGE_SHARE = 5   /* what fills more than one of so many parts of the image is the room */
};

static const float own_sigmas = 1.2533141f; /* per mean deviation: sqrt(pi / 2) */
static const float opposite = 0.7f;         /* of the thing's extent: from one side to the other */
static const float risen_share = 0.3f;      /* of a thing's pixels, and of them in this frame */
static const float even = 0.3f;        /* of the mean way along the normals: standard deviation */
static const float slowest = 0.05f;    /* of that way: in this frame */
static const float farthest_m = 0.07f; /* in one frame */

typedef struct edge_tally {
    int32_t count, x, y; /* pixels; sums of their columns and rows */
} edge_tally;

typedef struct tally {
    edge_tally lost, gained;
    int32_t risen, fresh;
    float way, square, step; /* of what has risen, along its normals; in this frame */
} tally;

static void widen(rlf_rect *w, int32_t x, int32_t y)
{
    w->x0 = x < w->x0 ? x : w->x0;
    w->x1 = x + 1 > w->x1 ? x + 1 : w->x1;
    w->y0 = y < w->y0 ? y : w->y0;
    w->y1 = y + 1;
}

/* Extent and size of each thing. */
static void measure_things(const image_grid *grid, rlf_depart *depart)
{
    for (int32_t k = 0; k <= RLF_PIECES; k++) {
        depart->extent[k] = (rlf_rect){grid->width, grid->height, 0, 0};
        depart->size[k] = 0;
    }
    for (int32_t y = 0; y < grid->height; y++) {
        const uint8_t *row = depart->thing + (ptrdiff_t)y * grid->width;
        int32_t x = rlf_kernel_next_mark(row, 0, grid->width);
        for (; x < grid->width; x = rlf_kernel_next_mark(row, x + 1, grid->width)) {
            widen(&depart->extent[row[x]], x, y);
            depart->size[row[x]]++;
        }
    }
}

void rlf_depart_take(rlf_reconstruct *stage)
{
    rlf_depart *depart = &stage->background.depart;
    size_t n = (size_t)stage->grid.count;
    memcpy(depart->thing, stage->background.thick.piece, n);
    memcpy(depart->depth, stage->background.thick.depth, n * sizeof *depart->depth);
    measure_things(&stage->grid, depart);
}

/* What has left shows what is there now, be it nearer or farther by a little. */
static void follow(rlf_reconstruct *stage, const rlf_slot *slot, int32_t i, uint8_t *seen)
{
    rlf_background *background = &stage->background;
    float z = slot->depth[i], off = z - background->mean[i];
    if (!(z > 0.0f)) {
        return;
    }
    if (background->weight[i] < RLF_LEFT_WEIGHT) { /* seen past for long enough */
        background->depart.left[i] = 0;
        return;
    }
    float gate = rlf_background_gate(&stage->def, z);
    if (off <= gate) {
        seen[i] = RLF_SEEN_FOREGROUND;
        if (-off <= gate) {
            background->mean[i] = z;
            background->weight[i] = RLF_LEFT_WEIGHT;
            background->deviation[i] = 0.0f;
        }
    }
}

void rlf_depart_follow(rlf_reconstruct *stage, const rlf_slot *slot, uint8_t *seen)
{
    const uint8_t *left = stage->background.depart.left;
    int32_t count = left == NULL ? 0 : stage->grid.count;
    for (int32_t i = 0; (i = rlf_kernel_next_mark(left, i, count)) < count; i++) {
        follow(stage, slot, i, seen);
    }
}

/* Metres that pixel i came nearer along the normal that it had, from depth `from`. */
static float way_from(const rlf_reconstruct *stage, const background_image *image, int32_t i,
                      float from, float to)
{
    const image_grid *grid = &stage->grid;
    float facing = -(image->normal[0][i] * grid->ray_x[i] + image->normal[1][i] * grid->ray_y[i] +
                     image->normal[2][i]);
    return (from - to) * facing;
}

static void add_risen(const rlf_reconstruct *stage, const rlf_slot *slot, int32_t i, tally *t)
{
    float z = slot->depth[i], stood = stage->background.depart.depth[i];
    const rlf_slot *before = stage->previous;
    float way = way_from(stage, background_image_newest(stage), i, stood, z);
    t->risen++;
    t->fresh += before->foreground[i] == 0;
    t->way += way;
    t->square += way * way;
    if (before->depth[i] > 0.0f) {
        t->step += way_from(stage, background_image_newest(stage), i, before->depth[i], z);
    }
}

/* The other thing, from pixel i on in one of four ways, that is as deep; 0: none. Between things
 * there are pixels of none. */
static uint8_t thing_on(const rlf_reconstruct *stage, const float *depth, int32_t i, int32_t way)
{
    const image_grid *grid = &stage->grid;
    const uint8_t *thing = stage->background.depart.thing;
    static const int32_t ways[4][2] = {{0, -1}, {-1, 0}, {1, 0}, {0, 1}};
    const depth_step step = depth_step_make(&stage->def.rig.noise, grid->camera.fx);
    for (int32_t r = 1; r <= GAP; r++) {
        int32_t x = i % grid->width + r * ways[way][0], y = i / grid->width + r * ways[way][1];
        int32_t j = y * grid->width + x;
        if (x < 0 || y < 0 || x >= grid->width || y >= grid->height) {
            return 0;
        }
        if (thing[j] != 0 && thing[j] != thing[i]) {
            bool is_there = depth[j] > 0.0f && stage->background.depart.lost[j] != LOST;
            bool is_one = !depth_step_is(&step, depth[j], depth[i], DEPTH_STEP_STEEPEST, (float)r);
            return is_there && is_one ? thing[j] : 0;
        }
    }
    return 0;
}

/* The first of them all round; 0: none. */
static uint8_t thing_beside(const rlf_reconstruct *stage, const float *depth, int32_t i)
{
    uint8_t thing = 0;
    for (int32_t way = 0; way < 4 && thing == 0; way++) {
        thing = thing_on(stage, depth, i, way);
    }
    return thing;
}

/* Marks where a thing may be gone, being seen past by more than the least gate, or has come
 * nearer. */
RLF_KERNEL static void mark_row(const float *restrict depth, const float *restrict stood,
                                const uint8_t *restrict thing, const uint8_t *restrict front,
                                const uint8_t *restrict reason, float gate, int32_t count,
                                uint8_t *restrict mark)
{
    for (int32_t i = 0; i < count; i++) {
        int32_t is_seen = (depth[i] > 0.0f) & (thing[i] != 0) & (reason[i] == RLF_REASON_OK);
        int32_t is_past = depth[i] - stood[i] > gate ? LOST : 0;
        int32_t is_risen = front[i] == RLF_SEEN_FOREGROUND ? RISEN : 0;
        mark[i] = (uint8_t)(is_seen != 0 ? is_past | is_risen : 0);
    }
}

/* Seen past by more than the sensor's noise, or the pixel's own where that is larger. */
static bool is_past(const rlf_reconstruct *stage, float z, int32_t i)
{
    const rlf_background *background = &stage->background;
    float off = z - background->depart.depth[i];
    float own = own_sigmas * (float)stage->def.foreground_sigmas * background->deviation[i];
    return off > rlf_background_gate(&stage->def, z) && off > own;
}

static void count_things(const rlf_reconstruct *stage, const rlf_slot *slot, tally *tallies)
{
    const rlf_depart *depart = &stage->background.depart;
    int32_t count = stage->grid.count;
    uint8_t *mark = stage->background.depart.lost;
    mark_row(slot->depth, depart->depth, depart->thing, slot->foreground, slot->reason,
             (float)stage->def.foreground_min_m, count, mark);
    for (int32_t i = 0; (i = rlf_kernel_next_mark(mark, i, count)) < count; i++) {
        bool is_lost = (mark[i] & LOST) != 0 && is_past(stage, slot->depth[i], i);
        if ((mark[i] & RISEN) != 0 && stage->previous != NULL) {
            add_risen(stage, slot, i, &tallies[depart->thing[i]]);
        }
        mark[i] = is_lost ? LOST : 0;
    }
}

static void add_edge(edge_tally *edge, int32_t x, int32_t y)
{
    edge->count++;
    edge->x += x;
    edge->y += y;
}

/* What went, at the edges: no single pixels, which noise makes. True when it is enough of one. */
static bool count_lost(const rlf_reconstruct *stage, tally *tallies)
{
    const image_grid *grid = &stage->grid;
    const uint8_t *lost = stage->background.depart.lost, *thing = stage->background.depart.thing;
    bool is_enough = false;
    for (int32_t i = grid->width; (i = rlf_kernel_next_mark(lost, i, grid->count)) < grid->count;
         i++) {
        int32_t x = i % grid->width, above = i - grid->width;
        if (x > 0 && lost[i - 1] == LOST && lost[above] == LOST && lost[above - 1] == LOST) {
            edge_tally *edge = &tallies[thing[i]].lost;
            add_edge(edge, x, i / grid->width);
            is_enough = is_enough || edge->count >= LEAST_EDGE;
        }
    }
    return is_enough;
}

/* What came beside them. */
static void count_gained(const rlf_reconstruct *stage, const rlf_slot *slot, tally *tallies)
{
    const image_grid *grid = &stage->grid;
    const uint8_t *front = slot->foreground;
    for (int32_t i = grid->width; (i = rlf_kernel_next_mark(front, i, grid->count)) < grid->count;
         i++) {
        int32_t x = i % grid->width;
        if (x > 0 && front[i] != RLF_SEEN_PAST) {
            add_edge(&tallies[thing_beside(stage, slot->depth, i)].gained, x, i / grid->width);
        }
    }
}

/* From the middle of what went to the middle of what came, in widths and heights of the thing. */
static float way_aside(const tally *t, const rlf_rect *extent)
{
    float lost = (float)t->lost.count, gained = (float)t->gained.count;
    float x = (float)t->gained.x / gained - (float)t->lost.x / lost;
    float y = (float)t->gained.y / gained - (float)t->lost.y / lost;
    return rlf_kernel_abs(x) / (float)(extent->x1 - extent->x0) +
           rlf_kernel_abs(y) / (float)(extent->y1 - extent->y0);
}

/* A thing that moves loses at one side as much as it gains at the other. Who walks by gains on one
 * side, or all round, and noise loses all round. */
static bool went_aside(const tally *t, const rlf_rect *extent)
{
    int32_t round = extent->x1 - extent->x0 + extent->y1 - extent->y0;
    int32_t least = round / EDGE_SHARE > LEAST_EDGE ? round / EDGE_SHARE : LEAST_EDGE;
    int32_t lost = t->lost.count, gained = t->gained.count;
    return lost >= least && gained >= least && lost <= MOST_UNLIKE * gained &&
           gained <= MOST_UNLIKE * lost && way_aside(t, extent) > opposite;
}

static bool came_nearer(const rlf_reconstruct *stage, const tally *t, int32_t size)
{
    float n = (float)t->risen;
    if (t->risen < LEAST_RISEN || n < risen_share * (float)size ||
        (float)t->fresh < risen_share * n) {
        return false;
    }
    float mean = t->way / n, variance = t->square / n - mean * mean;
    float most = even * mean + 0.25f * (float)stage->def.foreground_min_m;
    return mean > 0.0f && mean < farthest_m && variance < most * most && t->step > slowest * t->way;
}

static bool has_departed(const rlf_reconstruct *stage, const tally *t, int32_t k)
{
    const rlf_depart *depart = &stage->background.depart;
    const rlf_rect *e = &depart->extent[k];
    bool is_room = (e->x1 - e->x0) * (e->y1 - e->y0) > stage->grid.count / IMAGE_SHARE;
    return depart->size[k] > 0 && !is_room &&
           (went_aside(t, e) || came_nearer(stage, t, depart->size[k]));
}

static void leave(rlf_reconstruct *stage, rlf_slot *slot, int32_t i)
{
    rlf_background *background = &stage->background;
    int32_t width = stage->grid.width;
    float z = slot->depth[i];
    bool is_lost = stage->background.depart.lost[i] == LOST;
    background->depart.left[i] = !is_lost;
    background->mean[i] = z > 0.0f ? z : background->mean[i];
    background->weight[i] = is_lost ? 1 : RLF_LEFT_WEIGHT;
    background->deviation[i] = 0.0f;
    background->beyond[i] = 0;
    background->beneath[i] = 0.0f;
    background_image_changed(background, &stage->grid, i % width, i / width, 1);
    slot->foreground[i] = !is_lost && z > 0.0f ? RLF_SEEN_FOREGROUND : slot->foreground[i];
}

/* A pixel of no thing belongs to the ones beside it that have left, if no other is as deep: it is
 * at their outline, and not where they stand. */
static bool is_outline(const rlf_reconstruct *stage, const uint8_t *departed, int32_t i)
{
    int32_t own = 0, others = 0;
    for (int32_t way = 0; way < 4 && stage->background.mean[i] > 0.0f; way++) {
        uint8_t thing = thing_on(stage, stage->background.mean, i, way);
        own += departed[thing];
        others += thing != 0 && !departed[thing];
    }
    return own > 0 && others == 0;
}

/* The spans of rows are those of the foreground as it is then. */
static void leave_all(rlf_reconstruct *stage, rlf_slot *slot, const uint8_t *departed)
{
    const image_grid *grid = &stage->grid;
    uint8_t *thing = stage->background.depart.thing;
    for (int32_t i = 0; i < grid->count; i++) {
        if (departed[thing[i]] || (thing[i] == 0 && is_outline(stage, departed, i))) {
            leave(stage, slot, i);
        }
    }
    for (int32_t i = 0; i < grid->count; i++) {
        thing[i] = departed[thing[i]] ? 0 : thing[i];
    }
    for (int32_t y = 0; y < grid->height; y++) {
        stage->work.front[y] =
            rlf_background_span(slot->foreground + (ptrdiff_t)y * grid->width, grid->width);
    }
}

void rlf_depart_find(rlf_reconstruct *stage, rlf_slot *slot)
{
    rlf_depart *depart = &stage->background.depart;
    tally tallies[RLF_PIECES + 1] = {0};
    uint8_t departed[RLF_PIECES + 1] = {0};
    depart->is_urgent = false;
    if (depart->thing == NULL || background_image_newest(stage) == NULL) {
        return;
    }
    count_things(stage, slot, tallies);
    if (count_lost(stage, tallies)) {
        count_gained(stage, slot, tallies);
    }
    for (int32_t k = 1; k <= RLF_PIECES; k++) {
        departed[k] = has_departed(stage, &tallies[k], k);
        depart->is_urgent = depart->is_urgent || departed[k];
    }
    if (depart->is_urgent) {
        leave_all(stage, slot, departed);
    }
}
