/* Rays from bodies to the light through the depth image. */
#include "real_shade.h"

#define REACH_M 2.5       /* beyond this nothing casts a shadow: lamps are wide */
#define NEAREST_M 0.1     /* to the camera */
#define SHEET_M 0.05      /* solid behind a foreground pixel whose back is not known */
#define BACKGROUND_M 0.15 /* solid behind the background, as for collisions */
#define CLEAR_M 0.015     /* a body at rest touches what is below it */
#define SOFT_M 0.02       /* from where a thing begins to where it is opaque */
#define CROSSING 0.4f /* of the step between two taps that is left when it was halved so often */
#define HALVINGS 3
#define BEFORE 1.00001f /* depth over that of the ray: more is before it, whatever the rounding */
#define TAP_PX 3.0f
#define TAPS_MAX 40
#define STEPS_TO_BODY 8
#define MIDDLE (0.5f * (REAL_SHADE_SIDE - 1))

#define LARGE_PX 40.0 /* radius: a body to be looked at closely, */
#define SMALL_PX 12.0 /* and one of which less will do */

enum {
    LANES = 16, /* taps at once */
    COARSE = 4,
    UNKNOWN = -1,
    ENOUGH = 4 /* cells that agree, for the whole body */
};

/* ---- one ray -------------------------------------------------------------------------------- */

/* A ray in the depth image: with s from 0 to 1, pixel and 1 / z are linear. */
typedef struct image_ray {
    float u, v, inverse_z;
    float du, dv, dinverse_z;
    float z, dz; /* along the ray, per metre */
    float taps;
} image_ray;

/* Of s in 0..1, as far as x + s step stays within 0..high. */
static float clip(float x, float step, float high, float s)
{
    float end = step > 0.0f ? high : 0.0f;
    float most = step != 0.0f ? (end - x) / step : s;
    return most < s ? (most > 0.0f ? most : 0.0f) : s;
}

/* False when the ray is not in the image. */
static bool project_ray(const rlf_camera *k, const float p[3], const float to_light[3],
                        image_ray *out)
{
    float length = (float)REACH_M;
    if (p[2] + length * to_light[2] < (float)NEAREST_M) {
        length = (p[2] - (float)NEAREST_M) / -to_light[2];
    }
    if (!(p[2] > (float)NEAREST_M) || !(length > 0.0f)) {
        return false;
    }
    const float fx = (float)k->fx;
    const float fy = (float)k->fy;
    const float a = 1.0f / p[2];
    const float b = 1.0f / (p[2] + length * to_light[2]);
    out->u = fx * p[0] * a + (float)k->cx + 0.5f;
    out->v = fy * p[1] * a + (float)k->cy + 0.5f;
    out->inverse_z = a;
    out->du = fx * (p[0] + length * to_light[0]) * b + (float)k->cx + 0.5f - out->u;
    out->dv = fy * (p[1] + length * to_light[1]) * b + (float)k->cy + 0.5f - out->v;
    out->dinverse_z = b - a;
    if (!(out->u >= 0.0f && out->u < (float)k->width && out->v >= 0.0f &&
          out->v < (float)k->height)) {
        return false;
    }
    float s = clip(out->u, out->du, (float)k->width - 0.01f, 1.0f);
    s = clip(out->v, out->dv, (float)k->height - 0.01f, s);
    out->du *= s;
    out->dv *= s;
    out->dinverse_z *= s;
    float wide = out->du > 0.0f ? out->du : -out->du;
    float high = out->dv > 0.0f ? out->dv : -out->dv;
    float taps = (wide > high ? wide : high) * (1.0f / TAP_PX) + 1.0f;
    out->taps = (float)(int32_t)(taps < TAPS_MAX ? taps : TAPS_MAX);
    return true;
}

/* How far the ray is behind what is seen, and how much that hides there, 0..1. Of planes, 1 / z is
 * linear in the image, and so is `behind`. */
typedef struct tap {
    float behind; /* 1 / z of what is seen less that of the ray; 0 where nothing is known */
    float clear;  /* of that: may be noise */
    float hidden;
    float at; /* along the ray, 0..1 */
    bool is_foreground;
    bool is_known; /* to be before or behind */
} tap;

static float within(float behind, float thickness)
{
    float in = (behind - (float)CLEAR_M) * (float)(1.0 / SOFT_M);
    float out = (thickness - behind) * (float)(1.0 / SOFT_M);
    float least = in < out ? in : out;
    return least < 0.0f ? 0.0f : (least < 1.0f ? least : 1.0f);
}

static tap tap_at(const rlf_surface *surface, const image_ray *r, float s)
{
    int32_t x = (int32_t)(r->u + s * r->du);
    int32_t y = (int32_t)(r->v + s * r->dv);
    float inverse_z = r->inverse_z + s * r->dinverse_z;
    float z = 1.0f / inverse_z;
    int32_t i = y * surface->width + x;
    float front = surface->depth[i];
    float back = surface->background_depth != NULL ? surface->background_depth[i] : front;
    bool is_foreground = surface->foreground != NULL && surface->foreground[i] != 0;
    float thickness = surface->thickness != NULL ? surface->thickness[i] : 0.0f;
    float least = is_foreground ? (float)SHEET_M : (float)BACKGROUND_M;
    thickness = thickness > least ? thickness : least;
    float hidden = front > 0.0f ? within(z - front, thickness) : 0.0f;
    float behind = back > 0.0f ? within(z - back, (float)BACKGROUND_M) : 0.0f;
    float seen = front > 0.0f ? front : back;
    tap t = {.hidden = hidden > behind ? hidden : behind,
             .behind = seen > 0.0f ? 1.0f / seen - inverse_z : 0.0f,
             .clear = (float)CLEAR_M * inverse_z * inverse_z,
             .at = s,
             .is_foreground = is_foreground && front > 0.0f};
    t.is_known = t.behind > t.clear || t.behind < -t.clear;
    return t;
}

/* True when the ray goes through what is seen between two taps, and not past its silhouette: then
 * what is behind becomes what is before in small steps. */
static bool crosses(const rlf_surface *surface, const image_ray *r, const tap *first,
                    const tap *end)
{
    if (!first->is_known || !end->is_known || (first->behind > 0.0f) == (end->behind > 0.0f)) {
        return false;
    }
    tap a = *first;
    tap b = *end;
    for (int i = 0; i < HALVINGS; i++) {
        tap middle = tap_at(surface, r, 0.5f * (a.at + b.at));
        if ((middle.behind > 0.0f) == (a.behind > 0.0f)) {
            a = middle;
        } else {
            b = middle;
        }
    }
    float gap = first->behind - end->behind;
    float rest = a.behind - b.behind;
    gap = gap > 0.0f ? gap : -gap;
    rest = rest > 0.0f ? rest : -rest;
    return rest < CROSSING * gap + 2.0f * end->clear;
}

/* False when every tap is before all that is known there: no light is lost. */
RLF_KERNEL static bool passes_behind(const rlf_surface *surface, const image_ray *ray)
{
    const image_ray r = *ray;
    const float step = 1.0f / r.taps;
    const int32_t width = surface->width;
    const float *restrict depth = surface->depth;
    const float *restrict back =
        surface->background_depth != NULL ? surface->background_depth : depth;
    int32_t any[LANES] = {0};
    for (float first = 0.0f; first <= r.taps; first += LANES) {
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < LANES; i++) {
            float k = first + (float)i;
            float s = (k < r.taps ? k : r.taps) * step;
            int32_t x = (int32_t)(r.u + s * r.du);
            int32_t y = (int32_t)(r.v + s * r.dv);
            float inverse_z = r.inverse_z + s * r.dinverse_z;
            float front = depth[y * width + x];
            float behind = back[y * width + x];
            int32_t is_behind_front = (front > 0.0f) & (front * inverse_z < BEFORE);
            any[i] |= is_behind_front | ((behind > 0.0f) & (behind * inverse_z < BEFORE));
        }
    }
    int32_t sum = 0;
    for (int32_t i = 0; i < LANES; i++) {
        sum |= any[i];
    }
    return sum != 0;
}

/* Share of the light that is lost between p and the light, both in the depth camera's frame. */
static float lost_along(const rlf_surface *surface, const float p[3], const float to_light[3])
{
    image_ray r;
    if (!project_ray(&surface->camera, p, to_light, &r) || !passes_behind(surface, &r)) {
        return 0.0f;
    }
    const float step = 1.0f / r.taps;
    tap last = {0};
    /* Gone into the background: a thing, if the ray comes out again; the room's wall, behind which
     * no lamp is, if it does not. */
    bool is_inside = false;
    float most = 0.0f;
    for (float k = 0.0f; k <= r.taps && most < 1.0f; k += 1.0f) {
        tap now = tap_at(surface, &r, k * step);
        bool is_through = crosses(surface, &r, &last, &now);
        bool enters = is_through && now.behind > 0.0f && !now.is_foreground;
        bool leaves = is_inside && now.is_known && now.behind < 0.0f;
        is_inside = enters || (is_inside && !leaves);
        float hidden = leaves || (is_through && !enters) ? 1.0f : now.hidden;
        most = hidden > most && !is_inside ? hidden : most;
        last = now.is_known ? now : last;
    }
    return most;
}

/* ---- a body's map --------------------------------------------------------------------------- */

/* The body and the light in the depth camera's frame. */
typedef struct shade_job {
    const rlf_surface *surface;
    const caster *body;
    float center[3], axis[3][3], to_light[3], across[3], down[3];
    float spacing; /* of cells, metres */
} shade_job;

/* Distance from v, from the centre, to the body. */
static float distance_to(const shade_job *j, const float v[3])
{
    float sum = 0.0f;
    for (int i = 0; i < 3; i++) {
        const float *axis = j->axis[i];
        float q = axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2];
        float beyond = (q < 0.0f ? -q : q) - j->body->half[i];
        sum += beyond > 0.0f ? beyond * beyond : 0.0f;
    }
    return sqrtf(sum) - j->body->round;
}

/* Where the light of a cell first meets the body; false when it passes by. */
static bool find_lit(const shade_job *j, int32_t column, int32_t row, float out[3])
{
    const float x = ((float)column - MIDDLE) * j->spacing;
    const float y = ((float)row - MIDDLE) * j->spacing;
    float v[3];
    for (int i = 0; i < 3; i++) {
        v[i] = x * j->across[i] + y * j->down[i] + j->body->radius * j->to_light[i];
    }
    if (x * x + y * y > j->body->radius * j->body->radius) {
        return false;
    }
    float gap = distance_to(j, v);
    for (int k = 0; k < STEPS_TO_BODY && gap > 0.0f; k++) {
        for (int i = 0; i < 3; i++) {
            v[i] -= gap * j->to_light[i];
        }
        gap = distance_to(j, v);
    }
    for (int i = 0; i < 3; i++) {
        out[i] = j->center[i] + v[i];
    }
    return gap < 0.1f * j->body->radius;
}

static float follow(const shade_job *j, int32_t column, int32_t row)
{
    float p[3];
    if (!find_lit(j, column, row, p)) {
        return UNKNOWN;
    }
    return 1.0f - lost_along(j->surface, p, j->to_light);
}

/* Cells `step` apart between those twice as far apart: what these agree about, or followed. */
static void refine(const shade_job *j, int32_t step, real_shade *out)
{
    for (int32_t i = 0; i < REAL_SHADE_CELLS; i++) {
        int32_t x = i % REAL_SHADE_SIDE;
        int32_t y = i / REAL_SHADE_SIDE;
        if (x % step != 0 || y % step != 0 || (x % (2 * step) == 0 && y % (2 * step) == 0)) {
            continue;
        }
        int32_t left = x / (2 * step) * (2 * step);
        int32_t top = y / (2 * step) * (2 * step);
        int32_t right = x % (2 * step) != 0 ? left + 2 * step : left;
        int32_t below = y % (2 * step) != 0 ? top + 2 * step : top;
        const float a = out->left[top * REAL_SHADE_SIDE + left];
        const float b = out->left[top * REAL_SHADE_SIDE + right];
        const float c = out->left[below * REAL_SHADE_SIDE + left];
        const float d = out->left[below * REAL_SHADE_SIDE + right];
        bool agree = a >= 0.0f && a == b && b == c && c == d;
        out->left[i] = agree ? a : follow(j, x, y);
    }
}

/* Cells between those `step` apart. */
static void spread(int32_t step, real_shade *out)
{
    for (int32_t i = 0; i < REAL_SHADE_CELLS; i++) {
        int32_t x = i % REAL_SHADE_SIDE;
        int32_t y = i / REAL_SHADE_SIDE;
        const float *at = out->left + y / step * step * REAL_SHADE_SIDE + x / step * step;
        int32_t right = x % step != 0 ? step : 0;
        int32_t below = y % step != 0 ? step * REAL_SHADE_SIDE : 0;
        float u = (float)(x % step) / (float)step;
        float v = (float)(y % step) / (float)step;
        float top = at[0] + (at[right] - at[0]) * u;
        float bottom = at[below] + (at[below + right] - at[below]) * u;
        out->left[i] = top + (bottom - top) * v;
    }
}

/* Cells that pass by the body take the mean of their neighbours' light, ring by ring. */
static void fill_outside(int32_t step, real_shade *out)
{
    bool has_unknown = true;
    for (int32_t ring = 0; has_unknown && ring < REAL_SHADE_SIDE / step; ring++) {
        has_unknown = false;
        float next[REAL_SHADE_CELLS];
        for (int32_t i = 0; i < REAL_SHADE_CELLS; i++) {
            next[i] = out->left[i];
            int32_t x = i % REAL_SHADE_SIDE;
            int32_t y = i / REAL_SHADE_SIDE;
            if (x % step != 0 || y % step != 0 || out->left[i] >= 0.0f) {
                continue;
            }
            float sum = 0.0f;
            float count = 0.0f;
            for (int32_t k = 0; k < 9; k++) {
                int32_t u = x + (k % 3 - 1) * step;
                int32_t v = y + (k / 3 - 1) * step;
                bool is_in = u >= 0 && u < REAL_SHADE_SIDE && v >= 0 && v < REAL_SHADE_SIDE;
                float value = is_in ? out->left[v * REAL_SHADE_SIDE + u] : UNKNOWN;
                sum += value >= 0.0f ? value : 0.0f;
                count += value >= 0.0f ? 1.0f : 0.0f;
            }
            next[i] = count > 0.0f ? sum / count : UNKNOWN;
            has_unknown = true;
        }
        memcpy(out->left, next, sizeof(next));
    }
    for (int32_t i = 0; i < REAL_SHADE_CELLS; i++) {
        out->left[i] = out->left[i] >= 0.0f ? out->left[i] : 1.0f;
    }
}

/* True when the cells `step` apart that meet the body all have the same light, *out. */
static bool agree(const real_shade *shade, int32_t step, float *out)
{
    int32_t count = 0;
    *out = 1.0f;
    for (int32_t y = 0; y < REAL_SHADE_SIDE; y += step) {
        for (int32_t x = 0; x < REAL_SHADE_SIDE; x += step) {
            const float left = shade->left[y * REAL_SHADE_SIDE + x];
            if (left >= 0.0f && count > 0 && left != *out) {
                return false;
            }
            *out = left >= 0.0f ? left : *out;
            count += left >= 0.0f ? 1 : 0;
        }
    }
    return count >= ENOUGH;
}

static void to_floats(rlf_vec3 v, float out[3])
{
    out[0] = (float)v.x;
    out[1] = (float)v.y;
    out[2] = (float)v.z;
}

static rlf_vec3 from_floats(const float v[3])
{
    return rlf_vec3_make((double)v[0], (double)v[1], (double)v[2]);
}

/* Two directions across the light, any will do. */
static void place_map(const real_shade_world *world, const caster *body, shade_job *j,
                      real_shade *out)
{
    rlf_vec3 l = world->to_light;
    rlf_vec3 across = rlf_perpendicular(l);
    rlf_vec3 down = rlf_cross(l, across);
    rlf_quat q = world->T_depth_picture.q;
    *j = (shade_job){.surface = world->surface, .body = body};
    j->spacing = body->radius / MIDDLE;
    to_floats(rlf_transform(&world->T_depth_picture, from_floats(body->center)), j->center);
    for (int i = 0; i < 3; i++) {
        to_floats(rlf_rotate(q, from_floats(body->axis[i])), j->axis[i]);
        out->center[i] = body->center[i];
    }
    to_floats(rlf_rotate(q, l), j->to_light);
    to_floats(rlf_rotate(q, across), j->across);
    to_floats(rlf_rotate(q, down), j->down);
    const double per_cell = 1.0 / (double)j->spacing;
    to_floats(rlf_scale(across, per_cell), out->across);
    to_floats(rlf_scale(down, per_cell), out->down);
}

void real_shade_make(const real_shade_world *world, const caster *body, real_shade *out)
{
    out->takes = false;
    if (!(body->near_m > 0.0f) || world->surface->depth == NULL) {
        return;
    }
    shade_job job;
    place_map(world, body, &job, out);
    double radius_px = world->focal_px * (double)body->radius / (double)body->center[2];
    const int32_t finest = radius_px > LARGE_PX ? 1 : (radius_px > SMALL_PX ? 2 : COARSE);
    const int32_t sure = radius_px > LARGE_PX ? COARSE / 2 : COARSE;
    for (int32_t y = 0; y < REAL_SHADE_SIDE; y += COARSE) {
        for (int32_t x = 0; x < REAL_SHADE_SIDE; x += COARSE) {
            out->left[y * REAL_SHADE_SIDE + x] = follow(&job, x, y);
        }
    }
    float same = 1.0f;
    int32_t step = COARSE;
    while (step > finest && !(step <= sure && agree(out, step, &same))) {
        step /= 2;
        refine(&job, step, out);
    }
    if (step <= sure && agree(out, step, &same) && same == 1.0f) {
        return;
    }
    fill_outside(step, out);
    spread(step, out);
    out->takes = true;
}

/* ---- light ---------------------------------------------------------------------------------- */

RLF_KERNEL_PART float limit(float x, float low, float high)
{
    x = x > low ? x : low;
    return x < high ? x : high;
}

/* Bilinear. */
RLF_KERNEL_PART void take(const real_shade *shade, const float *restrict ray_x,
                          const float *restrict ray_y, const float *restrict z, int32_t count,
                          float share, float *restrict left)
{
    const float *restrict map = shade->left;
    const float *across = shade->across;
    const float *down = shade->down;
    const float last = REAL_SHADE_SIDE - 1.001f;
    for (int32_t i = 0; i < count; i++) {
        float px = ray_x[i] * z[i] - shade->center[0];
        float py = ray_y[i] * z[i] - shade->center[1];
        float pz = z[i] - shade->center[2];
        float x = limit(across[0] * px + across[1] * py + across[2] * pz + MIDDLE, 0.0f, last);
        float y = limit(down[0] * px + down[1] * py + down[2] * pz + MIDDLE, 0.0f, last);
        int32_t column = (int32_t)x;
        int32_t row = (int32_t)y;
        float u = x - (float)column;
        float v = y - (float)row;
        int32_t at = row * REAL_SHADE_SIDE + column;
        float top = map[at] + (map[at + 1] - map[at]) * u;
        float below = map[at + REAL_SHADE_SIDE];
        float bottom = below + (map[at + REAL_SHADE_SIDE + 1] - below) * u;
        left[i] *= 1.0f - share * (1.0f - (top + (bottom - top) * v));
    }
}

RLF_KERNEL void real_shade_take(const real_shade *shade, const caster_points *p, float share,
                                float *left)
{
    take(shade, p->x, p->y, p->z, p->count, share, left);
}
