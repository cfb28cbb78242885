/* A camera of the sensor in the room. All cameras look along z of the depth camera's frame; they
 * differ in lens and place only, so a ray's parameter is the depth z. */
#ifndef RLF_SIM_VIEW_H
#define RLF_SIM_VIEW_H

#include "sim/shape.h"
#include "relief/camera.h"

typedef struct synth_view {
    rlf_camera camera; /* without distortion */
    rlf_vec3 origin;   /* in the depth camera's frame */
} synth_view;

/* Pixels x0 <= x < x1, y0 <= y < y1. */
typedef struct synth_rect {
    int32_t x0, y0, x1, y1;
} synth_rect;

static inline synth_ray synth_view_ray(const synth_view *view, double u, double v)
{
    const rlf_camera *c = &view->camera;
    synth_ray ray = {view->origin, {(u - c->cx) / c->fx, (v - c->cy) / c->fy, 1.0}};
    return ray;
}

static inline rlf_vec3 synth_ray_at(const synth_ray *ray, double t)
{
    return rlf_mad(ray->origin, ray->direction, t);
}

static inline bool synth_rect_is_empty(synth_rect r)
{
    return r.x0 >= r.x1 || r.y0 >= r.y1;
}

static inline bool synth_rect_has_row(synth_rect r, int32_t y)
{
    return y >= r.y0 && y < r.y1 && r.x0 < r.x1;
}

static inline synth_rect synth_rect_union(synth_rect a, synth_rect b)
{
    if (synth_rect_is_empty(a)) {
        return b;
    }
    if (synth_rect_is_empty(b)) {
        return a;
    }
    synth_rect r = {a.x0 < b.x0 ? a.x0 : b.x0, a.y0 < b.y0 ? a.y0 : b.y0, a.x1 > b.x1 ? a.x1 : b.x1,
                    a.y1 > b.y1 ? a.y1 : b.y1};
    return r;
}

/* Grown by `margin` pixels on each side, inside width x height; empty stays empty. */
static inline synth_rect synth_rect_grow(synth_rect a, int32_t margin, const rlf_camera *camera)
{
    synth_rect r = {a.x0 - margin, a.y0 - margin, a.x1 + margin, a.y1 + margin};
    if (synth_rect_is_empty(a)) {
        return a;
    }
    r.x0 = r.x0 < 0 ? 0 : r.x0;
    r.y0 = r.y0 < 0 ? 0 : r.y0;
    r.x1 = r.x1 > camera->width ? camera->width : r.x1;
    r.y1 = r.y1 > camera->height ? camera->height : r.y1;
    return r;
}

#endif
