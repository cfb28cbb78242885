/* What was seen of a thin thing, and is hidden by its own front now, is still there.
 *
 * A face that turns away from the camera is seen at a lower and lower angle, and then not at all:
 * a book that is held edge-on. Its points go on with the front that hides them. Where they are
 * behind it without a gap, the thing is at least that thick. A point that the camera would see, or
 * sees past, is forgotten at once, others when nothing bounds any more how far off they are. What
 * is as wide as an arm shows by its shape how thick it is (thickness/thickness.c). */
#include "surface/past/past.h"

#include <string.h>

static const float low_angle = 0.35f; /* cosine between a face's normal and the ray */
static const float widest_m = 0.08f;  /* of a thin thing */
static const float bin_m = 0.02f;     /* of depth behind the front */
static const float longest_s = 2.0f;  /* a point is remembered */
static const float most_doubt_m = 0.05f;
static const float snap_doubt = 0.6f;   /* of the way to the front that hides a point after all */
static const float follow_share = 0.5f; /* of a change of velocity: one frame's may be off */
static const float other_speed = 1.2f;  /* m/s between a point and what moves with it */
#define ALL_BINS 0xffffffu              /* of past.behind */
#define THICKENED 0x1000000u            /* in past.behind: this pixel has been */
enum { BINS = 24, GAP_BINS = 3, PIXELS_PER_POINT = 8, SNAP_PX = 3 };

size_t rlf_past_capacity(const rlf_grid *grid)
{
    return (size_t)grid->count / PIXELS_PER_POINT + 1;
}

void rlf_past_reset(rlf_past *past, const rlf_grid *grid)
{
    past->count = past->ahead_count = 0;
    if (past->points != NULL) {
        memset(past->behind, 0, (size_t)grid->count * sizeof *past->behind);
        memset(past->is_ahead, 0, (size_t)grid->count / 8 + 1);
        memset(past->lost_ticks, 0, (size_t)grid->count);
    }
}

/* Narrower than an arm. */
static bool is_thin(const rlf_grid *grid, const rlf_slot *slot, ptrdiff_t k)
{
    return rlf_past_is_narrow(grid, slot, k,
                              (int32_t)(widest_m * (float)grid->camera.fx / slot->depth[k]));
}

static bool hides(const rlf_slot *slot, ptrdiff_t k, const rlf_past_point *p)
{
    float behind = p->at.z - slot->depth[k];
    return rlf_past_is_front(slot, k) && behind > bin_m && behind < BINS * bin_m;
}

/* The pixel that hides the point: its own or, as velocity is not exact and outlines flicker, the
 * nearest in its row or those beside; -1 = none. */
static ptrdiff_t find_front(const rlf_grid *grid, const rlf_slot *slot, ptrdiff_t k,
                            const rlf_past_point *p)
{
    if (hides(slot, k, p)) {
        return k;
    }
    int32_t x0 = (int32_t)(k % grid->width), y0 = (int32_t)(k / grid->width);
    ptrdiff_t best = -1;
    float least = 0.0f;
    for (int32_t y = y0 - 1; y <= y0 + 1; y++) {
        for (int32_t x = x0 - SNAP_PX; x <= x0 + SNAP_PX; x++) {
            float du = (float)x - p->at.u, dv = (float)y - p->at.v, far2 = du * du + dv * dv;
            ptrdiff_t n = (ptrdiff_t)y * grid->width + x;
            bool inside = x >= 0 && y >= 0 && x < grid->width && y < grid->height;
            if (inside && (best < 0 || far2 < least) && hides(slot, n, p)) {
                least = far2;
                best = n;
            }
        }
    }
    return best;
}

static void put_at(const rlf_grid *grid, ptrdiff_t k, rlf_past_point *p)
{
    float dx = p->at.z * grid->ray_x[k] - p->at.x, dy = p->at.z * grid->ray_y[k] - p->at.y;
    p->doubt += snap_doubt * (float)sqrt((double)(dx * dx + dy * dy));
    p->at.x += dx;
    p->at.y += dy;
    p->at.u = (float)(k % grid->width);
    p->at.v = (float)(k / grid->width);
}

/* The point goes on with the front at pixel k, unless that is another thing's. */
static void follow(rlf_past *past, const rlf_slot *slot, ptrdiff_t k, float dt, rlf_past_point *p)
{
    float square = 0.0f;
    for (int c = 0; c < 3; c++) {
        float off = slot->velocity[c][k] - p->velocity[c];
        square += off * off;
    }
    if (square > other_speed * other_speed) {
        p->doubt += (float)sqrt((double)square) * dt;
        return;
    }
    for (int c = 0; c < 3; c++) {
        p->velocity[c] += follow_share * (slot->velocity[c][k] - p->velocity[c]);
    }
    past->behind[k] |= 1u << (int32_t)((p->at.z - slot->depth[k]) / bin_m);
}

/* Follows what hides the point and marks it there; false when it is forgotten. */
static bool look(rlf_reconstruct *stage, const rlf_slot *slot, const rlf_kernel_motion *motion,
                 rlf_past_point *p)
{
    const rlf_grid *grid = &stage->grid;
    ptrdiff_t k = rlf_kernel_pixel_of(motion, &p->at);
    if (k < 0 || p->age > longest_s || p->doubt > most_doubt_m) {
        return false;
    }
    ptrdiff_t front = find_front(grid, slot, k, p);
    if (front < 0) { /* nothing seen there, or something else before it: it may well be there */
        bool is_seen = slot->depth[k] > 0.0f && slot->reason[k] == RLF_REASON_OK;
        return !is_seen || (slot->foreground[k] == 0 && slot->depth[k] < p->at.z);
    }
    if (front != k) {
        put_at(grid, front, p);
    }
    follow(&stage->past, slot, front, motion->dt, p);
    return true;
}

static void look_at_old(rlf_reconstruct *stage, const rlf_slot *slot,
                        const rlf_kernel_motion *motion)
{
    rlf_past *past = &stage->past;
    int32_t kept = 0;
    for (int32_t i = 0; i < past->count; i++) {
        rlf_past_point p = past->points[i];
        rlf_past_advance(motion, &p);
        if (look(stage, slot, motion, &p)) {
            past->points[kept++] = p;
        }
    }
    past->count = kept;
}

/* Adds the pixel of the frame before, whose face is seen at a low angle, if a thin front hides it
 * now. */
static void look_at_pixel(rlf_reconstruct *stage, const rlf_slot *slot, int32_t x, int32_t y,
                          const rlf_kernel_motion *motion)
{
    const rlf_grid *grid = &stage->grid;
    rlf_past *past = &stage->past;
    rlf_past_point p;
    if (past->count == past->capacity ||
        !rlf_past_move_pixel(grid, stage->previous, x, y, motion, &p)) {
        return;
    }
    ptrdiff_t k = rlf_kernel_pixel_of(motion, &p.at);
    ptrdiff_t front = k >= 0 ? find_front(grid, slot, k, &p) : -1;
    if (front >= 0 && is_thin(grid, slot, front) && look(stage, slot, motion, &p)) {
        past->points[past->count++] = p;
    }
}

static void look_at_row(rlf_reconstruct *stage, const rlf_slot *slot, int32_t y,
                        const rlf_kernel_motion *motion)
{
    const rlf_grid *grid = &stage->grid;
    const rlf_slot *before = stage->previous;
    const rlf_span moved = before->moved[y];
    uint8_t away[RLF_PAST_PIXELS];
    const uint8_t *front = before->foreground + (ptrdiff_t)y * grid->width;
    for (int32_t x = moved.x0; (x = rlf_kernel_next_mark(front, x, moved.x1)) < moved.x1;
         x += RLF_PAST_PIXELS) {
        int32_t count = moved.x1 - x < RLF_PAST_PIXELS ? moved.x1 - x : RLF_PAST_PIXELS;
        const rlf_kernel_moving_row row = rlf_past_row(grid, before, x, y, count);
        ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
        const float *const normal[3] = {before->normal[0] + i, before->normal[1] + i,
                                        before->normal[2] + i};
        rlf_kernel_away_row(&row, normal, low_angle, away);
        for (int32_t k = 0; (k = rlf_kernel_next_mark(away, k, count)) < count; k++) {
            look_at_pixel(stage, slot, x + k, y, motion);
        }
    }
}

/* The marks of pixel k as they are behind the front at depth z. */
static uint32_t bins_from(const rlf_past *past, const rlf_slot *slot, ptrdiff_t k, float z)
{
    uint32_t bins = past->behind[k] & ALL_BINS;
    float step = (slot->depth[k] - z) / bin_m;
    int32_t shift = (int32_t)(step + (step < 0.0f ? -0.5f : 0.5f));
    if (bins == 0 || shift <= -BINS || shift >= BINS) {
        return 0;
    }
    return shift < 0 ? bins >> -shift : (bins << shift) & ALL_BINS;
}

/* How far the solid goes on behind the front without a gap. */
static float reach_of(uint32_t bins, float thickness)
{
    float reach = thickness;
    int32_t gap = 0;
    for (int32_t bin = (int32_t)(thickness / bin_m); bin < BINS && gap < GAP_BINS; bin++) {
        bool has = (bins >> bin & 1u) != 0;
        float middle = bin_m * ((float)bin + 0.5f);
        gap = has ? 0 : gap + 1;
        reach = has && middle > reach ? middle : reach;
    }
    return reach;
}

static void thicken_pixel(const rlf_reconstruct *stage, rlf_slot *slot, int32_t x, int32_t y)
{
    const rlf_grid *grid = &stage->grid;
    ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
    uint32_t bins = 0;
    if (!rlf_past_is_front(slot, i) || slot->label[i] == 0 || !is_thin(grid, slot, i)) {
        return;
    }
    for (int32_t v = y - 1; v <= y + 1; v++) {
        for (int32_t u = x - 1; u <= x + 1; u++) {
            if (u >= 0 && v >= 0 && u < grid->width && v < grid->height) {
                ptrdiff_t k = (ptrdiff_t)v * grid->width + u;
                bins |= bins_from(&stage->past, slot, k, slot->depth[i]);
            }
        }
    }
    float reach = reach_of(bins, slot->thickness[i]), behind = stage->background.mean[i];
    float room = behind > slot->depth[i] ? behind - slot->depth[i] : 0.0f;
    slot->thickness[i] = behind > 0.0f && reach > room ? room : reach;
}

/* Each pixel about the points once. */
static void thicken_about(const rlf_reconstruct *stage, rlf_slot *slot, ptrdiff_t k)
{
    const rlf_grid *grid = &stage->grid;
    int32_t x0 = (int32_t)(k % grid->width), y0 = (int32_t)(k / grid->width);
    for (int32_t y = y0 - 1; y <= y0 + 1; y++) {
        for (int32_t x = x0 - 1; x <= x0 + 1; x++) {
            if (x >= 0 && y >= 0 && x < grid->width && y < grid->height) {
                uint32_t *behind = &stage->past.behind[(ptrdiff_t)y * grid->width + x];
                if ((*behind & THICKENED) == 0) {
                    *behind |= THICKENED;
                    thicken_pixel(stage, slot, x, y);
                }
            }
        }
    }
}

static void clear_about(const rlf_reconstruct *stage, ptrdiff_t k)
{
    const rlf_grid *grid = &stage->grid;
    int32_t x0 = (int32_t)(k % grid->width), y0 = (int32_t)(k / grid->width);
    int32_t left = x0 > 0 ? x0 - 1 : 0, right = x0 + 1 < grid->width ? x0 + 1 : x0;
    for (int32_t y = y0 - 1; y <= y0 + 1; y++) {
        if (y >= 0 && y < grid->height) {
            uint32_t *row = stage->past.behind + (ptrdiff_t)y * grid->width;
            memset(row + left, 0, (size_t)(right - left + 1) * sizeof *row);
        }
    }
}

void rlf_past_thicken(rlf_reconstruct *stage, rlf_slot *slot)
{
    rlf_past *past = &stage->past;
    float dt = rlf_past_elapsed(stage, slot);
    if (dt == 0.0f) {
        past->count = 0;
        return;
    }
    const rlf_kernel_motion motion = rlf_past_motion(&stage->grid, dt);
    look_at_old(stage, slot, &motion);
    for (int32_t y = 0; y < stage->grid.height; y++) {
        look_at_row(stage, slot, y, &motion);
    }
    for (int32_t i = 0; i < past->count; i++) {
        ptrdiff_t k = rlf_kernel_pixel_of(&motion, &past->points[i].at);
        if ((past->behind[k] & ALL_BINS) != 0) {
            thicken_about(stage, slot, k);
        }
    }
    for (int32_t i = 0; i < past->count; i++) {
        clear_about(stage, rlf_kernel_pixel_of(&motion, &past->points[i].at));
    }
}
