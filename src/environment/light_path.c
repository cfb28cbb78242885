/* One ray to the light through the depth image. */
#include "environment/light.h"

#include "kernel/kernel.h"

#define NEAREST_M 0.1     /* to the camera */
#define BEFORE 1.00001f   /* depth over that of the ray: more is before it, whatever the rounding */
#define SHEET_M 0.05      /* solid behind a foreground pixel whose back is not known */
#define BACKGROUND_M 0.15 /* solid behind the background, as for collisions */
#define CLEAR_M 0.015     /* a body at rest touches what is below it */
#define SOFT_M 0.02       /* from where a thing begins to where it is opaque */
#define CROSSING 0.4f /* of the step between two taps that is left when it was halved so often */
#define HALVINGS 3
#define TAP_PX 3.0f
#define TAPS_MAX 40

enum { LANES = 16 }; /* taps at once */

/* A ray in the depth image: with s from 0 to 1, pixel and 1 / z are linear. */
typedef struct image_ray {
    float u, v, inverse_z;
    float du, dv, dinverse_z;
    float taps;
} image_ray;

/* The same of some rays. */
typedef struct ray_lanes {
    float u[LIGHT_PATH_RAYS], v[LIGHT_PATH_RAYS], inverse_z[LIGHT_PATH_RAYS];
    float du[LIGHT_PATH_RAYS], dv[LIGHT_PATH_RAYS], dinverse_z[LIGHT_PATH_RAYS];
    float taps[LIGHT_PATH_RAYS];
    int32_t is_in[LIGHT_PATH_RAYS]; /* 0 = the ray is not in the image */
} ray_lanes;

/* Of s in 0..1, as far as x + s step stays within 0..high. */
RLF_KERNEL_PART float clip(float x, float step, float high, float s)
{
    float end = step > 0.0f ? high : 0.0f;
    float most = step != 0.0f ? (end - x) / step : s;
    most = most > 0.0f ? most : 0.0f;
    return most < s ? most : s;
}

/* Metres that each ray is followed: not beyond the camera. */
RLF_KERNEL_PART float length_of(float z, float toward_light)
{
    float before = (z - (float)NEAREST_M) / -toward_light;
    float beyond = z + (float)LIGHT_PATH_REACH_M * toward_light;
    return beyond < (float)NEAREST_M ? before : (float)LIGHT_PATH_REACH_M;
}

/* Where the rays begin, and how far they go in the image: from x by dx in an axis of focal length f
 * and middle c, alike in both axes. */
RLF_KERNEL_PART void project_axis(const float *restrict p, const float *restrict z,
                                  const float toward_light[2], float f, float c, float *restrict x,
                                  float *restrict dx)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < LIGHT_PATH_RAYS; i++) {
        const float length = length_of(z[i], toward_light[1]);
        const float a = 1.0f / z[i];
        const float b = 1.0f / (z[i] + length * toward_light[1]);
        x[i] = f * p[i] * a + c + 0.5f;
        dx[i] = f * (p[i] + length * toward_light[0]) * b + c + 0.5f - x[i];
    }
}

RLF_KERNEL_PART void project_z(const float *restrict z, const int32_t *restrict is_some,
                               float toward_light, float *restrict inverse_z,
                               float *restrict dinverse_z, int32_t *restrict is_in)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < LIGHT_PATH_RAYS; i++) {
        const float length = length_of(z[i], toward_light);
        const float a = 1.0f / z[i];
        inverse_z[i] = a;
        dinverse_z[i] = 1.0f / (z[i] + length * toward_light) - a;
        is_in[i] = (is_some[i] != 0) & (z[i] > (float)NEAREST_M) & (length > 0.0f) ? 1 : 0;
    }
}

/* Ends the rays at the image's border. */
RLF_KERNEL_PART void clip_rays(const rlf_camera *k, ray_lanes *r)
{
    const float width = (float)k->width;
    const float height = (float)k->height;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < LIGHT_PATH_RAYS; i++) {
        float s = clip(r->u[i], r->du[i], width - 0.01f, 1.0f);
        s = clip(r->v[i], r->dv[i], height - 0.01f, s);
        bool is_in = (r->u[i] >= 0.0f) & (r->u[i] < width) & (r->v[i] >= 0.0f) & (r->v[i] < height);
        r->is_in[i] &= is_in ? 1 : 0;
        r->du[i] *= s;
        r->dv[i] *= s;
        r->dinverse_z[i] *= s;
        float wide = r->du[i] > 0.0f ? r->du[i] : -r->du[i];
        float high = r->dv[i] > 0.0f ? r->dv[i] : -r->dv[i];
        float taps = (wide > high ? wide : high) * (1.0f / TAP_PX) + 1.0f;
        r->taps[i] = (float)(int32_t)(taps < TAPS_MAX ? taps : TAPS_MAX);
    }
}

RLF_KERNEL static void project_rays(const rlf_camera *k, const light_path_points *points,
                                    const float to_light[3], ray_lanes *out)
{
    const float across[2] = {to_light[0], to_light[2]};
    const float down[2] = {to_light[1], to_light[2]};
    const float *z = points->p[2];
    project_z(z, points->is_some, to_light[2], out->inverse_z, out->dinverse_z, out->is_in);
    project_axis(points->p[0], z, across, (float)k->fx, (float)k->cx, out->u, out->du);
    project_axis(points->p[1], z, down, (float)k->fy, (float)k->cy, out->v, out->dv);
    clip_rays(k, out);
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

/* Share of the light that is lost along the ray. */
static float lost_along(const rlf_surface *surface, const image_ray *ray)
{
    const image_ray r = *ray;
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

void light_path_lost(const rlf_surface *surface, const light_path_points *points,
                     const float to_light[3], int32_t count, float *out)
{
    ray_lanes lanes;
    project_rays(&surface->camera, points, to_light, &lanes);
    for (int32_t i = 0; i < count; i++) {
        const image_ray ray = {lanes.u[i],  lanes.v[i],          lanes.inverse_z[i], lanes.du[i],
                               lanes.dv[i], lanes.dinverse_z[i], lanes.taps[i]};
        bool loses = lanes.is_in[i] != 0 && passes_behind(surface, &ray);
        out[i] = loses ? lost_along(surface, &ray) : 0.0f;
    }
}
