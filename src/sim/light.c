/* Direct light with a soft shadow from rays to an area lamp; ambient light dimmed by nearby
 * surfaces. */
#include "sim/material.h"

#define LAMP_HALF 0.16 /* metres */

/* Parts that some rays may meet. */
typedef struct few {
    int32_t index[SYNTH_PART_MAX];
    int32_t count;
} few;

/* Parts that may stand between the site and some point of the lamp. */
static void find_between(const synth_scene *scene, int32_t count, const synth_site *site, few *out)
{
    const rlf_vec3 way = rlf_sub(scene->lamp, site->p);
    const double length2 = rlf_dot(way, way);
    out->count = 0;
    for (int32_t i = 0; i < count; i++) {
        const synth_ball *ball = &scene->bounds[i];
        const rlf_vec3 to_centre = rlf_sub(ball->centre, site->p);
        const double along = rlf_clamp(rlf_dot(to_centre, way) / length2, 0.0, 1.0);
        const rlf_vec3 aside = rlf_mad(to_centre, way, -along);
        const double reach = ball->radius + 1.5 * LAMP_HALF; /* its corner, and the ray's offset */
        if (scene->statics[i].shape.type != SYNTH_HALF_SPACE &&
            rlf_dot(aside, aside) < reach * reach) {
            out->index[out->count++] = i;
        }
    }
}

static bool is_blocked(const synth_scene *scene, const few *parts, const synth_ray *ray)
{
    double length2 = rlf_dot(ray->direction, ray->direction);
    for (int32_t k = 0; k < parts->count; k++) {
        const synth_shape *shape = &scene->statics[parts->index[k]].shape;
        const synth_ball *ball = &scene->bounds[parts->index[k]];
        rlf_vec3 to_centre = rlf_sub(ball->centre, ray->origin);
        double along = rlf_clamp(rlf_dot(to_centre, ray->direction) / length2, 0.0, 1.0);
        rlf_vec3 aside = rlf_mad(to_centre, ray->direction, -along);
        synth_interval hit;
        if (rlf_dot(aside, aside) < ball->radius * ball->radius &&
            synth_shape_intersect(shape, ray, &hit) && hit.far > 0.0 && hit.near < 1.0) {
            return true;
        }
    }
    return false;
}

/* Blocked rays to an n x n grid over the lamp. */
static int count_blocked(const synth_scene *scene, const few *parts, const synth_site *site, int n)
{
    synth_ray ray = {.origin = rlf_mad(site->p, site->normal, 0.002)};
    int blocked = 0;
    for (int i = 0; i < n * n; i++) {
        double x = (2.0 * (i % n) + 1.0) / n - 1.0;
        double z = (2.0 * (i / n) + 1.0) / n - 1.0;
        rlf_vec3 target = rlf_add(scene->lamp, rlf_vec3_make(LAMP_HALF * x, 0, LAMP_HALF * z));
        ray.direction = rlf_sub(target, ray.origin);
        blocked += is_blocked(scene, parts, &ray) ? 1 : 0;
    }
    return blocked;
}

double synth_lamp_share(const synth_scene *scene, int32_t count, const synth_site *site)
{
    if (rlf_dot(site->normal, rlf_sub(scene->lamp, site->p)) <= 0.0) {
        return 0.0;
    }
    few parts;
    find_between(scene, count, site, &parts);
    int coarse = count_blocked(scene, &parts, site, 2);
    if (coarse == 0 || coarse == 4) {
        return 1.0 - coarse / 4.0;
    }
    return 1.0 - count_blocked(scene, &parts, site, 7) / 49.0;
}

static const double heights[3] = {0.03, 0.10, 0.28}; /* of probes, metres */

/* Parts that may be nearer to a probe than the site is: the distance changes by the way at most. */
static void find_near(const synth_scene *scene, int32_t count, const synth_site *site, few *out)
{
    const double most = 2.0 * heights[2];
    out->count = 0;
    for (int32_t i = 0; i < count; i++) {
        const double reach = scene->bounds[i].radius + most;
        const rlf_vec3 offset = rlf_sub(site->p, scene->bounds[i].centre);
        if (rlf_dot(offset, offset) < reach * reach &&
            synth_shape_gap(&scene->statics[i].shape, site->p) < most + 1e-6) {
            out->index[out->count++] = i;
        }
    }
}

/* Probes along the normal: a probe at height h that is nearer than h to some surface sees part of
 * the sky blocked (Evans 2006, "Fast approximations for global illumination on dynamic scenes"). */
double synth_sky_share(const synth_scene *scene, int32_t count, const synth_site *site)
{
    static const double weights[3] = {0.22, 0.30, 0.34};
    few near;
    find_near(scene, count, site, &near);
    double blocked = 0.0;
    for (int k = 0; k < 3; k++) {
        double h = heights[k];
        rlf_vec3 p = rlf_mad(site->p, site->normal, h);
        double nearest = h;
        for (int32_t i = 0; i < near.count; i++) {
            const synth_ball *ball = &scene->bounds[near.index[i]];
            const double radius = ball->radius + h;
            rlf_vec3 offset = rlf_sub(p, ball->centre);
            if (rlf_dot(offset, offset) < radius * radius) {
                nearest =
                    rlf_min(nearest, synth_shape_gap(&scene->statics[near.index[i]].shape, p));
            }
        }
        blocked += weights[k] * (1.0 - rlf_max(0.0, nearest) / h);
    }
    return rlf_max(0.0, 1.0 - blocked);
}
