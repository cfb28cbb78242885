/* Direct light with a soft shadow from rays to an area lamp; ambient light dimmed by nearby
 * surfaces. */
#include "capture/synthetic/light.h"

#define LAMP_HALF 0.16 /* metres */

static bool is_blocked(const synth_scene *scene, int32_t count, const synth_ray *ray)
{
    double length2 = rlf_dot(ray->direction, ray->direction);
    for (int32_t i = 0; i < count; i++) {
        const synth_shape *shape = &scene->statics[i].shape;
        if (shape->type == SYNTH_HALF_SPACE) {
            continue;
        }
        rlf_vec3 centre;
        double radius = synth_shape_bound(shape, &centre);
        rlf_vec3 to_centre = rlf_sub(centre, ray->origin);
        double along = rlf_clamp(rlf_dot(to_centre, ray->direction) / length2, 0.0, 1.0);
        rlf_vec3 aside = rlf_mad(to_centre, ray->direction, -along);
        synth_interval hit;
        if (rlf_dot(aside, aside) < radius * radius && synth_shape_intersect(shape, ray, &hit) &&
            hit.far > 0.0 && hit.near < 1.0) {
            return true;
        }
    }
    return false;
}

/* Blocked rays to an n x n grid over the lamp. */
static int count_blocked(const synth_scene *scene, int32_t count, const synth_site *site, int n)
{
    synth_ray ray = {.origin = rlf_mad(site->p, site->normal, 0.002)};
    int blocked = 0;
    for (int i = 0; i < n * n; i++) {
        double x = (2.0 * (i % n) + 1.0) / n - 1.0;
        double z = (2.0 * (i / n) + 1.0) / n - 1.0;
        rlf_vec3 target = rlf_add(scene->lamp, rlf_vec3_make(LAMP_HALF * x, 0, LAMP_HALF * z));
        ray.direction = rlf_sub(target, ray.origin);
        blocked += is_blocked(scene, count, &ray) ? 1 : 0;
    }
    return blocked;
}

double synth_lamp_share(const synth_scene *scene, int32_t count, const synth_site *site)
{
    if (rlf_dot(site->normal, rlf_sub(scene->lamp, site->p)) <= 0.0) {
        return 0.0;
    }
    int coarse = count_blocked(scene, count, site, 2);
    if (coarse == 0 || coarse == 4) {
        return 1.0 - coarse / 4.0;
    }
    return 1.0 - count_blocked(scene, count, site, 7) / 49.0;
}

/* Probes along the normal: a probe at height h that is nearer than h to some surface sees part of
 * the sky blocked (Evans 2006, "Fast approximations for global illumination on dynamic scenes"). */
double synth_sky_share(const synth_scene *scene, int32_t count, const synth_site *site)
{
    static const double heights[3] = {0.03, 0.10, 0.28};
    static const double weights[3] = {0.22, 0.30, 0.34};
    double blocked = 0.0;
    for (int k = 0; k < 3; k++) {
        double h = heights[k];
        rlf_vec3 p = rlf_mad(site->p, site->normal, h);
        double nearest = h;
        for (int32_t i = 0; i < count; i++) {
            const synth_shape *shape = &scene->statics[i].shape;
            rlf_vec3 centre;
            double radius = synth_shape_bound(shape, &centre) + h;
            rlf_vec3 offset = rlf_sub(p, centre);
            if (rlf_dot(offset, offset) < radius * radius) {
                rlf_vec3 normal;
                nearest = rlf_min(nearest, synth_shape_distance(shape, p, &normal));
            }
        }
        blocked += weights[k] * (1.0 - rlf_max(0.0, nearest) / h);
    }
    return rlf_max(0.0, 1.0 - blocked);
}
