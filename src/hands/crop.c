/* A hand's pixels by a flood from its palm, and the way back to them from every pixel beside. */
#include "hands/fit.h"

#include <string.h>

#define HALF_M 0.135   /* of the crop's side: to the sides of the palm's middle */
#define AHEAD_M 0.03   /* its own middle is so far along the arm: fingers reach farther */
#define REACH_M 0.155  /* no part of a hand of 0.205 m is farther from its palm's middle */
#define BEHIND_M 0.105 /* along the forearm: half a palm, and some of the forearm */
#define STEP_M 0.015   /* in depth between neighbours; a finger before the palm is farther */
#define PIXELS_LEAST 40
/* Ends of fingers have few pixels and tell most: so far from the palm, within so much more. */
#define ENDS_MORE 2.0
#define ENDS_FROM_M 0.05
#define ENDS_TO_M 0.03

static int32_t clamped(double x, int32_t low, int32_t high)
{
    const int32_t i = (int32_t)x;
    return i < low ? low : (i > high ? high : i);
}

static bool place(hand_crop *c, const rlf_surface *s, rlf_vec3 middle)
{
    const rlf_camera *camera = &s->camera;
    const double half = HALF_M * camera->fx / middle.z;
    const double u = camera->fx * middle.x / middle.z + camera->cx;
    const double v = camera->fy * middle.y / middle.z + camera->cy;
    if (!(half < 4096.0 && u > -4096.0 && v > -4096.0 && u < 20480.0 && v < 20480.0)) {
        return false;
    }
    c->step = (int32_t)(2.0 * half / CROP_SIDE) + 1;
    c->x0 = clamped(u - half, 0, s->width - 1);
    c->y0 = clamped(v - half, 0, s->height - 1);
    c->width = (clamped(u + half, c->x0, s->width - 1) - c->x0) / c->step + 1;
    c->height = (clamped(v + half, c->y0, s->height - 1) - c->y0) / c->step + 1;
    c->width = c->width < CROP_SIDE ? c->width : CROP_SIDE;
    c->height = c->height < CROP_SIDE ? c->height : CROP_SIDE;
    c->fx = camera->fx / c->step;
    c->fy = camera->fy / c->step;
    c->cx = (camera->cx - c->x0) / c->step;
    c->cy = (camera->cy - c->y0) / c->step;
    c->noise = (float)rlf_depth_noise_sigma(&s->noise, middle.z);
    return true;
}

static void read_depth(hand_crop *c, const rlf_surface *s)
{
    for (int32_t y = 0; y < c->height; y++) {
        const ptrdiff_t row = (ptrdiff_t)(c->y0 + y * c->step) * s->width + c->x0;
        for (int32_t x = 0; x < c->width; x++) {
            c->z[y * c->width + x] = s->depth[row + x * c->step];
        }
    }
}

static rlf_vec3 point_of(const hand_crop *c, int32_t i)
{
    const double z = (double)c->z[i];
    return rlf_vec3_make(z * (i % c->width - c->cx) / c->fx,
                         z * ((double)(i / c->width) - c->cy) / c->fy, z);
}

static bool is_foreground(const hand_crop *c, const rlf_surface *s, int32_t i)
{
    const int32_t x = c->x0 + i % c->width * c->step, y = c->y0 + i / c->width * c->step;
    return c->z[i] > 0.0f && s->foreground[y * s->width + x] != 0;
}

/* The foreground pixel at the palm, or beside it. -1: none. */
static int32_t first_pixel(const hand_crop *c, const rlf_surface *s, rlf_vec3 palm)
{
    const int32_t x = clamped(c->fx * palm.x / palm.z + c->cx + 0.5, 0, c->width - 1);
    const int32_t y = clamped(c->fy * palm.y / palm.z + c->cy + 0.5, 0, c->height - 1);
    int32_t best = -1, least = 26;
    for (int32_t k = 0; k < 49; k++) {
        const int32_t dx = k % 7 - 3, dy = k / 7 - 3, far = dx * dx + dy * dy;
        const bool is_inside =
            x + dx >= 0 && y + dy >= 0 && x + dx < c->width && y + dy < c->height;
        const int32_t i = is_inside ? (y + dy) * c->width + x + dx : 0;
        if (is_inside && far < least && is_foreground(c, s, i)) {
            const double off = (double)c->z[i] - palm.z;
            if (off < 0.04 && off > -0.04) {
                best = i;
                least = far;
            }
        }
    }
    return best;
}

static void flood(hand_crop *c, const rlf_surface *s, int32_t first, rlf_vec3 palm, rlf_vec3 arm)
{
    const float step = (float)STEP_M + 4.0f * c->noise;
    memset(c->is_hand, 0, (size_t)c->width * (size_t)c->height);
    c->pixel[0] = first;
    c->is_hand[first] = 1;
    c->pixel_count = 1;
    for (int32_t head = 0; head < c->pixel_count; head++) {
        const int32_t i = c->pixel[head], x = i % c->width, y = i / c->width;
        const int32_t at[4] = {x > 0 ? i - 1 : i, x < c->width - 1 ? i + 1 : i,
                               y > 0 ? i - c->width : i, y < c->height - 1 ? i + c->width : i};
        for (int32_t k = 0; k < 4; k++) {
            const float rise = c->z[at[k]] - c->z[i];
            if (c->is_hand[at[k]] != 0 || rise > step || rise < -step ||
                !is_foreground(c, s, at[k])) {
                continue;
            }
            const rlf_vec3 off = rlf_sub(point_of(c, at[k]), palm);
            if (rlf_dot(off, off) < REACH_M * REACH_M && rlf_dot(off, arm) > -BEHIND_M) {
                c->is_hand[at[k]] = 1;
                c->pixel[c->pixel_count++] = at[k];
            }
        }
    }
}

static int32_t far_from(const hand_crop *c, int32_t i, int32_t at)
{
    const int32_t dx = i % c->width - at % c->width, dy = i / c->width - at / c->width;
    return dx * dx + dy * dy;
}

static void take_nearer(hand_crop *c, int32_t i, int32_t beside)
{
    const int32_t at = c->nearest[beside];
    if (at >= 0 && (c->nearest[i] < 0 || far_from(c, i, at) < far_from(c, i, c->nearest[i]))) {
        c->nearest[i] = at;
    }
}

/* Two passes; off by less than a pixel. */
static void find_nearest(hand_crop *c)
{
    const int32_t w = c->width, n = c->width * c->height;
    for (int32_t i = 0; i < n; i++) {
        c->nearest[i] = c->is_hand[i] != 0 ? i : -1;
    }
    for (int32_t pass = 0; pass < 2; pass++) {
        const int32_t by = pass == 0 ? 1 : -1;
        for (int32_t k = 0, i = pass == 0 ? 0 : n - 1; k < n; k++, i += by) {
            if (c->nearest[i] == i) {
                continue;
            }
            const int32_t x = pass == 0 ? i % w : w - 1 - i % w;
            if (x > 0) {
                take_nearer(c, i, i - by);
            }
            if (k >= w) {
                take_nearer(c, i, i - by * w);
                take_nearer(c, i, x > 0 ? i - by * (w + 1) : i - by * w);
                take_nearer(c, i, x < w - 1 ? i - by * (w - 1) : i - by * w);
            }
        }
    }
}

/* One of each of `count` equal parts of the hand's pixels; which one changes with `turn`. */
static void sample(hand_crop *c, rlf_vec3 palm, uint32_t turn)
{
    c->count = c->pixel_count < CROP_SAMPLES ? c->pixel_count : CROP_SAMPLES;
    for (int32_t k = 0; k < c->count; k++) {
        const uint32_t share = ((uint32_t)k * 40503u + turn * 26125u) & 0xffffu;
        const int64_t place = ((int64_t)k << 16) + share;
        const int32_t i = c->pixel[(int32_t)((place * c->pixel_count / c->count) >> 16)];
        const rlf_vec3 p = point_of(c, i), way = rlf_normalize(p);
        c->x[k] = (float)p.x;
        c->y[k] = (float)p.y;
        c->p_z[k] = (float)p.z;
        c->way_x[k] = (float)way.x;
        c->way_y[k] = (float)way.y;
        c->way_z[k] = (float)way.z;
        const double far = rlf_length(rlf_sub(p, palm));
        c->share[k] =
            (float)(1.0 + ENDS_MORE * rlf_clamp((far - ENDS_FROM_M) / ENDS_TO_M, 0.0, 1.0));
    }
}

bool hand_crop_read(hand_crop *c, const rlf_surface *s, rlf_vec3 palm, rlf_vec3 arm, uint32_t turn)
{
    const rlf_vec3 middle = rlf_mad(palm, arm, AHEAD_M);
    if (!(palm.z > 0.05 && middle.z > 0.05) || !place(c, s, middle)) {
        return false;
    }
    read_depth(c, s);
    const int32_t first = first_pixel(c, s, palm);
    if (first < 0) {
        return false;
    }
    flood(c, s, first, palm, arm);
    if (c->pixel_count < PIXELS_LEAST) {
        return false;
    }
    find_nearest(c);
    sample(c, palm, turn);
    return true;
}
