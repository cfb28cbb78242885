/* Taking a keyframe: points all over the thing, and points of its outline. */
#include "surface/motion/keyframe.h"

#include <math.h>
#include <string.h>

enum {
    LEAST_POINTS = 24,
    LEAST_RIMS = 12,
    INSIDE = 2, /* pixels from the outline: nearer ones are mixed */
    BEYOND = 3, /* between things there are pixels of none */
    LINES = 40  /* rows, and columns, in which its outline is looked for */
};

enum { MOST_NEARER = 2 }; /* pixels of a window by which nothing is hidden */

/* Metres beyond the noise: from there on it is no longer the thing. */
#define FULL_M 0.01f
#define EMPTY_M 0.05f
/* Share of a pixel's depth that the plane's depth may change in a pixel: more is seen edge-on. */
#define STEEPEST 0.03f

bool rim_look(const image_grid *grid, const float *depth, const rlf_kernel_noise *noise, rlf_vec3 p,
              rlf_vec3 n, int32_t x, int32_t y, rim_window *out)
{
    memset(out, 0, sizeof(*out));
    if (x < RIM_RADIUS || y < RIM_RADIUS || x >= grid->width - RIM_RADIUS ||
        y >= grid->height - RIM_RADIUS) {
        return false;
    }
    /* the plane's inverse depth is even in the image */
    const double off = rlf_dot(n, p);
    const ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
    const float z = (float)p.z, least = 4.0f * rlf_kernel_sigma(*noise, z);
    float w = (float)((n.x * grid->ray_x[i] + n.y * grid->ray_y[i] + n.z) / off);
    float wx = (float)(n.x / (off * grid->camera.fx)), wy = (float)(n.y / (off * grid->camera.fy));
    const float steep = STEEPEST * w;
    wx = wx > steep ? steep : wx < -steep ? -steep : wx;
    wy = wy > steep ? steep : wy < -steep ? -steep : wy;
    int32_t nearer = 0;
    for (int32_t v = -RIM_RADIUS; v <= RIM_RADIUS; v++) {
        const float *row = depth + i + (ptrdiff_t)v * grid->width;
        for (int32_t u = -RIM_RADIUS; u <= RIM_RADIUS; u++) {
            const float d = row[u];
            const float beyond = (d * (w + wx * (float)u + wy * (float)v) - 1.0f) * z;
            const float part = (EMPTY_M + least - beyond) / (EMPTY_M - FULL_M);
            const float is = !(d > 0.0f) || part <= 0.0f ? 0.0f : part >= 1.0f ? 1.0f : part;
            nearer += d > 0.0f && beyond < -FULL_M - least ? 1 : 0;
            out->between += is > 0.0f && is < 1.0f ? 1 : 0;
            out->fill += is;
            out->x += is * (float)u;
            out->y += is * (float)v;
        }
    }
    return nearer <= MOST_NEARER;
}

static bool is_of(const keyframe_view *view, int32_t x, int32_t y)
{
    const image_grid *grid = view->grid;
    if (x < 0 || y < 0 || x >= grid->width || y >= grid->height) {
        return false;
    }
    const ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
    return view->thing != NULL ? view->thing[i] == view->number : view->label[i] == view->number;
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

/* Whether something farther is beyond the pixel's next ones in a direction. */
static bool is_before(const keyframe_view *view, int32_t x, int32_t y, int32_t dx, int32_t dy)
{
    const image_grid *grid = view->grid;
    const int32_t u = x + BEYOND * dx, v = y + BEYOND * dy;
    if (u < 0 || v < 0 || u >= grid->width || v >= grid->height || is_of(view, u, v)) {
        return false;
    }
    const float z = view->depth[(ptrdiff_t)y * grid->width + x];
    return view->depth[(ptrdiff_t)v * grid->width + u] > z + (float)RIM_GAP_M;
}

/* Every second one is enough where they become too many. */
static void thin_out(rlf_keyframe *key)
{
    for (int32_t k = 0; k < KEYFRAME_RIMS / 2; k++) {
        key->rim[k] = key->rim[2 * k];
    }
    key->rim_count = KEYFRAME_RIMS / 2;
}

static void measure_rim(const keyframe_view *view, int32_t x, int32_t y, rlf_keyframe *key)
{
    const ptrdiff_t i = (ptrdiff_t)y * view->grid->width + x;
    const rlf_vec3 p = point_at(view, i), n = normal_at(view, i);
    rim_window window;
    if (!is_known(view, i) ||
        !rim_look(view->grid, view->seen, &view->noise, p, n, x, y, &window)) {
        return;
    }
    const float pull = sqrtf(window.x * window.x + window.y * window.y);
    if (pull < RIM_LEAST_PULL) {
        return; /* a corner */
    }
    const rlf_vec3 ray = rlf_normalize(p);
    const rlf_vec3 m = rlf_vec3_make(-window.x / pull, -window.y / pull, 0.0);
    if (key->rim_count == KEYFRAME_RIMS) {
        thin_out(key);
    }
    keyframe_rim *rim = &key->rim[key->rim_count++];
    store(rim->p, p);
    store(rim->n, n);
    store(rim->out, rlf_normalize(rlf_mad(m, ray, -rlf_dot(m, ray))));
    rim->fill = window.fill;
    rim->between = window.between;
}

/* Where a line of pixels, from (x, y) on, enters and leaves the thing. */
static void take_line(const keyframe_view *view, int32_t x, int32_t y, int32_t dx, int32_t dy,
                      int32_t count, rlf_keyframe *out)
{
    bool was_of = false;
    for (int32_t k = 0; k <= count; k++, x += dx, y += dy) {
        const bool is = k < count && is_of(view, x, y);
        const int32_t back = is ? 0 : 1, sign = is ? -1 : 1;
        const int32_t u = x - back * dx, v = y - back * dy;
        if (is != was_of && is_before(view, u, v, sign * dx, sign * dy)) {
            measure_rim(view, u, v, out);
        }
        was_of = is;
    }
}

/* Along some rows and columns. */
static void take_rims(const keyframe_view *view, const rlf_rect *rect, rlf_keyframe *out)
{
    const int32_t width = rect->x1 - rect->x0, height = rect->y1 - rect->y0;
    const int32_t dx = 1 + width / LINES, dy = 1 + height / LINES;
    for (int32_t y = rect->y0 + dy / 2; y < rect->y1; y += dy) {
        take_line(view, rect->x0, y, 1, 0, width, out);
    }
    for (int32_t x = rect->x0 + dx / 2; x < rect->x1; x += dx) {
        take_line(view, x, rect->y0, 0, 1, height, out);
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

bool keyframe_take(const keyframe_view *view, const rlf_rect *rect, int32_t size, rlf_keyframe *out)
{
    memset(out, 0, sizeof(*out));
    out->turn = rlf_quat_identity();
    int32_t step = 1;
    while (size > KEYFRAME_POINTS * step * step) {
        step++;
    }
    take_points(view, rect, step, out);
    take_rims(view, rect, out);
    if (out->point_count < LEAST_POINTS || out->rim_count < LEAST_RIMS) {
        return false;
    }
    centre(out);
    out->state = KEYFRAME_RESTS;
    out->rect = *rect;
    out->size = size;
    return true;
}
