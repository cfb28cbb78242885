/* What stood since the first frame and starts to move: its keyframe tells (motion/watch.c). Most
 * of it shows the background's depth still: a box that is pushed differs at two of its edges alone.
 * So a whole thing of the background (thickness/static_pieces.c) becomes foreground at once, and
 * the background has nothing there until it is seen past: no solid stays where it was. */
#include "surface/depth_step.h"
#include "surface/motion/keyframe.h"
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <string.h>

enum {
    GAP = 3 /* pixels between things, at most */
};

static const float own_sigmas = 1.2533141f; /* per mean deviation: sqrt(pi / 2) */

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
            rlf_rect_add(&depart->extent[row[x]], x, y);
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
    keyframes_take_things(stage);
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

/* The other thing, from pixel i on in one of eight ways (four straight ones first), that is as
 * deep; 0: none. Between things there are pixels of none. */
static uint8_t thing_on(const rlf_reconstruct *stage, const float *depth, int32_t i, int32_t way)
{
    const image_grid *grid = &stage->grid;
    const uint8_t *thing = stage->background.depart.thing;
    static const int32_t ways[8][2] = {{0, -1},  {-1, 0}, {1, 0},  {0, 1},
                                       {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    const depth_step step = depth_step_make(&stage->def.rig.noise, grid->camera.fx);
    for (int32_t r = 1; r <= GAP; r++) {
        int32_t x = i % grid->width + r * ways[way][0], y = i / grid->width + r * ways[way][1];
        int32_t j = y * grid->width + x;
        if (x < 0 || y < 0 || x >= grid->width || y >= grid->height) {
            return 0;
        }
        if (thing[j] != 0 && thing[j] != thing[i]) {
            bool is_one = !depth_step_is(&step, depth[j], depth[i], DEPTH_STEP_STEEPEST, (float)r);
            return depth[j] > 0.0f && is_one ? thing[j] : 0;
        }
    }
    return 0;
}

/* Seen past by more than the sensor's noise, or the pixel's own where that is larger. */
static bool is_past(const rlf_reconstruct *stage, float z, int32_t i)
{
    const rlf_background *background = &stage->background;
    float off = z - background->depart.depth[i];
    float own = own_sigmas * (float)stage->def.foreground_sigmas * background->deviation[i];
    return off > rlf_background_gate(&stage->def, z) && off > own;
}

/* What was told of the pixels around i, on which side of the outline each is, is no longer so. */
static void forget_sides(rlf_reconstruct *stage, int32_t i)
{
    const image_grid *grid = &stage->grid;
    const int32_t x = i % grid->width, y = i / grid->width;
    rlf_vote *votes = stage->normals.vote.votes;
    for (int32_t v = y - GAP; v <= y + GAP; v++) {
        for (int32_t u = x - GAP; u <= x + GAP; u++) {
            if (u >= 0 && v >= 0 && u < grid->width && v < grid->height) {
                background_image_changed(&stage->background, grid, u, v, 1);
                if (votes != NULL) {
                    votes[v * grid->width + u].count = 0;
                }
            }
        }
    }
}

static void leave(rlf_reconstruct *stage, rlf_slot *slot, int32_t i)
{
    rlf_background *background = &stage->background;
    float z = slot->depth[i];
    bool is_lost = is_past(stage, z, i);
    background->depart.left[i] = !is_lost;
    background->beneath[i] = 0.0f;
    background_put(stage, i, z > 0.0f ? z : background->mean[i], is_lost ? 1 : RLF_LEFT_WEIGHT);
    forget_sides(stage, i);
    slot->foreground[i] = !is_lost && z > 0.0f ? RLF_SEEN_FOREGROUND : slot->foreground[i];
}

/* A pixel of no thing belongs to the ones beside it that have left, if no other is as deep: it is
 * at their outline, and not where they stand. */
static bool is_outline(const rlf_reconstruct *stage, const float *depth, const uint8_t *departed,
                       int32_t i)
{
    int32_t own = 0, others = 0;
    for (int32_t way = 0; way < 8 && depth[i] > 0.0f; way++) {
        uint8_t thing = thing_on(stage, depth, i, way);
        own += departed[thing];
        others += way < 4 && thing != 0 && !departed[thing];
    }
    return own > 0 && others == 0;
}

/* The spans of rows are those of the foreground as it is then. */
static void leave_all(rlf_reconstruct *stage, rlf_slot *slot, const uint8_t *departed)
{
    const image_grid *grid = &stage->grid;
    uint8_t *thing = stage->background.depart.thing;
    const float *stood = stage->background.depart.depth;
    for (int32_t i = 0; i < grid->count; i++) {
        bool is_filled = slot->reason[i] == RLF_REASON_FILLED; /* as deep as the thing, it may be */
        if (departed[thing[i]] || (thing[i] == 0 && is_outline(stage, stood, departed, i)) ||
            (is_filled && is_outline(stage, slot->depth, departed, i))) {
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
    uint8_t departed[RLF_PIECES + 1] = {0};
    depart->is_urgent = false;
    if (depart->thing == NULL || background_image_newest(stage) == NULL) {
        return;
    }
    keyframes_watch(stage, slot, departed);
    departed[0] = 0;
    depart->is_urgent = memchr(departed, 1, sizeof(departed)) != NULL;
    if (depart->is_urgent) {
        leave_all(stage, slot, departed);
    }
}
