/* Taking a keyframe: points all over the thing, and points of its outline. */
#include "surface/motion/keyframe.h"
#include "surface/motion/rim.h"

#include <math.h>
#include <string.h>

enum {
    LEAST_POINTS = 24,
    LEAST_RIMS = 12,
    INSIDE = 2, /* pixels from the outline: nearer ones are mixed */
    BEYOND = 3  /* between things there are pixels of none */
};

static bool is_of(const keyframe_view *view, int32_t x, int32_t y)
{
    const image_grid *grid = view->grid;
    return x >= 0 && y >= 0 && x < grid->width && y < grid->height &&
           view->member[(ptrdiff_t)y * grid->width + x] == view->number;
}

static bool is_within(const keyframe_view *view, int32_t x, int32_t y, int32_t by)
{
    return is_of(view, x - by, y) && is_of(view, x + by, y) && is_of(view, x, y - by) &&
           is_of(view, x, y + by);
}

static rlf_vec3 point_at(const keyframe_view *view, ptrdiff_t i)
{
    const double z = view->depth[i];
    return rlf_vec3_make(z * view->grid->ray_x[i], z * view->grid->ray_y[i], z);
}

static rlf_vec3 normal_at(const keyframe_view *view, ptrdiff_t i)
{
    return rlf_vec3_make(view->normal[0][i], view->normal[1][i], view->normal[2][i]);
}

static void store(float out[3], rlf_vec3 v)
{
    out[0] = (float)v.x;
    out[1] = (float)v.y;
    out[2] = (float)v.z;
}

/* Seen, and its face turned to the camera. */
static bool is_known(const keyframe_view *view, ptrdiff_t i)
{
    return view->depth[i] > 0.0f && rlf_dot(normal_at(view, i), point_at(view, i)) < 0.0;
}

static void take_points(const keyframe_view *view, const rlf_rect *rect, int32_t step,
                        rlf_keyframe *out)
{
    for (int32_t y = rect->y0; y < rect->y1; y += step) {
        for (int32_t x = rect->x0; x < rect->x1; x += step) {
            const ptrdiff_t i = (ptrdiff_t)y * view->grid->width + x;
            if (out->point_count < KEYFRAME_POINTS && is_of(view, x, y) &&
                is_within(view, x, y, INSIDE) && is_known(view, i)) {
                keyframe_point *point = &out->point[out->point_count++];
                store(point->p, point_at(view, i));
                store(point->n, normal_at(view, i));
                point->bias = 0.0f;
            }
        }
    }
}

/* Whether the thing ends at this pixel before something farther. */
static bool is_rim(const keyframe_view *view, int32_t x, int32_t y)
{
    static const int32_t ways[4][2] = {{0, -1}, {-1, 0}, {1, 0}, {0, 1}};
    const image_grid *grid = view->grid;
    const ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
    for (int32_t k = 0; k < 4; k++) {
        const int32_t u = x + BEYOND * ways[k][0], v = y + BEYOND * ways[k][1];
        if (is_of(view, x + ways[k][0], y + ways[k][1]) || is_of(view, u, v) || u < 0 || v < 0 ||
            u >= grid->width || v >= grid->height) {
            continue;
        }
        const float behind = view->depth[(ptrdiff_t)v * grid->width + u];
        if (behind > view->depth[i] + (float)RIM_GAP_M) {
            return true;
        }
    }
    return false;
}

static bool measure_rim(const keyframe_view *view, int32_t x, int32_t y,
                        const rlf_kernel_noise *noise, keyframe_rim *out)
{
    const ptrdiff_t i = (ptrdiff_t)y * view->grid->width + x;
    const rlf_vec3 p = point_at(view, i), n = normal_at(view, i);
    rim_window window;
    if (!is_known(view, i) ||
        !rim_look(view->grid, view->depth, noise, p, n, x, y, &window)) {
        return false;
    }
    const float pull = sqrtf(window.x * window.x + window.y * window.y);
    if (pull < RIM_LEAST_PULL) {
        return false; /* a corner */
    }
    const rlf_vec3 ray = rlf_normalize(p);
    const rlf_vec3 m = rlf_vec3_make(-window.x / pull, -window.y / pull, 0.0);
    store(out->p, p);
    store(out->n, n);
    store(out->out, rlf_normalize(rlf_mad(m, ray, -rlf_dot(m, ray))));
    out->fill = window.fill;
    return true;
}

/* Every step-th of them; twice that where they become too many. */
static void take_rims(const keyframe_view *view, const rlf_rect *rect,
                      const rlf_kernel_noise *noise, rlf_keyframe *out)
{
    int32_t seen = 0, step = 1;
    for (int32_t y = rect->y0; y < rect->y1; y++) {
        for (int32_t x = rect->x0; x < rect->x1; x++) {
            if (!is_of(view, x, y) || !is_rim(view, x, y) || seen++ % step != 0) {
                continue;
            }
            if (out->rim_count == KEYFRAME_RIMS) {
                for (int32_t k = 0; k < KEYFRAME_RIMS / 2; k++) {
                    out->rim[k] = out->rim[2 * k];
                }
                out->rim_count = KEYFRAME_RIMS / 2;
                step *= 2;
            }
            out->rim_count += measure_rim(view, x, y, noise, &out->rim[out->rim_count]) ? 1 : 0;
        }
    }
}

/* Points are told from the middle. */
static void centre(rlf_keyframe *key)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int32_t k = 0; k < key->point_count; k++) {
        for (int c = 0; c < 3; c++) {
            low[c] = fminf(low[c], key->point[k].p[c]);
            high[c] = fmaxf(high[c], key->point[k].p[c]);
        }
    }
    const float middle[3] = {0.5f * (low[0] + high[0]), 0.5f * (low[1] + high[1]),
                             0.5f * (low[2] + high[2])};
    key->centre = rlf_vec3_make(middle[0], middle[1], middle[2]);
    const rlf_vec3 size = {high[0] - low[0], high[1] - low[1], high[2] - low[2]};
    key->length = rlf_max(0.25 * rlf_length(size), 0.01);
    for (int c = 0; c < 3; c++) {
        for (int32_t k = 0; k < key->point_count; k++) {
            key->point[k].p[c] -= middle[c];
        }
        for (int32_t k = 0; k < key->rim_count; k++) {
            key->rim[k].p[c] -= middle[c];
        }
    }
}

bool keyframe_take(const keyframe_view *view, const rlf_rect *rect, int32_t size,
                   const rlf_kernel_noise *noise, rlf_keyframe *out)
{
    memset(out, 0, sizeof(*out));
    int32_t step = 1;
    while (size > KEYFRAME_POINTS * step * step) {
        step++;
    }
    take_points(view, rect, step, out);
    take_rims(view, rect, noise, out);
    if (out->point_count < LEAST_POINTS || out->rim_count < LEAST_RIMS) {
        return false;
    }
    centre(out);
    out->state = KEYFRAME_RESTS;
    out->rect = *rect;
    out->size = size;
    return true;
}
