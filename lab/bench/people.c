/* People of the analytic room: where they are, and what a ray meets of them. */
#include "bench/people.h"

#include <math.h>

#define NEAREST_M 0.3
#define HIP_M 0.1 /* below the camera: about there the legs swing */

/* Upright and seen from the front; y is from the camera's height down, the floor is at 1. */
static const people_part person[PEOPLE_PARTS] = {
    {.middle = {0, -0.65, 0}, .half = {0.080, 0.115, 0.095}, .cloth = PEOPLE_SKIN},
    {.middle = {0, -0.52, 0}, .half = {0.055, 0.080, 0.055}, .cloth = PEOPLE_SKIN},
    {.middle = {0, -0.40, 0}, .half = {0.215, 0.075, 0.075}, .cloth = PEOPLE_SHIRT},
    {.middle = {0, -0.22, 0}, .half = {0.170, 0.260, 0.120}, .cloth = PEOPLE_SHIRT},
    {.middle = {0, 0.08, 0}, .half = {0.165, 0.140, 0.120}, .cloth = PEOPLE_TROUSERS},
    {.middle = {-0.09, 0.34, 0},
     .half = {0.085, 0.290, 0.085},
     .lean = 1,
     .cloth = PEOPLE_TROUSERS},
    {.middle = {0.09, 0.34, 0},
     .half = {0.085, 0.290, 0.085},
     .lean = -1,
     .cloth = PEOPLE_TROUSERS},
    {.middle = {-0.09, 0.73, 0},
     .half = {0.060, 0.250, 0.060},
     .lean = 1,
     .cloth = PEOPLE_TROUSERS},
    {.middle = {0.09, 0.73, 0},
     .half = {0.060, 0.250, 0.060},
     .lean = -1,
     .cloth = PEOPLE_TROUSERS},
    {.middle = {-0.09, 0.96, -0.06},
     .half = {0.045, 0.040, 0.130},
     .lean = 1,
     .cloth = PEOPLE_SHOE},
    {.middle = {0.09, 0.96, -0.06},
     .half = {0.045, 0.040, 0.130},
     .lean = -1,
     .cloth = PEOPLE_SHOE},
};

/* Rays along one axis to something between these ends, at depths from `near` to `far`. */
static void bound(double from, double to, double near, double far, double *out_least,
                  double *out_most)
{
    *out_least = from / (from < 0.0 ? near : far);
    *out_most = to / (to < 0.0 ? far : near);
}

static void set_bounds(people_part *p)
{
    double wide = p->half.x + fabs(p->lean) * p->half.y;
    double near = p->middle.z - p->half.z, far = p->middle.z + p->half.z;
    bound(p->middle.x - wide, p->middle.x + wide, near, far, &p->x0, &p->x1);
    bound(p->middle.y - p->half.y, p->middle.y + p->half.y, near, far, &p->y0, &p->y1);
    if (near < NEAREST_M) {
        p->x1 = p->x0 - 1.0; /* too near: nothing meets it */
    }
}

void people_add(people *to, double x, double z, double stride)
{
    for (int32_t k = 0; k < PEOPLE_PARTS && to->count < PEOPLE_MOST * PEOPLE_PARTS; k++) {
        people_part *p = &to->part[to->count++];
        *p = person[k];
        p->lean *= stride;
        p->middle.x += x + p->lean * (p->middle.y - HIP_M);
        p->middle.z += z;
        set_bounds(p);
    }
}

void people_shift(people *p, double x)
{
    for (int32_t k = 0; k < p->count; k++) {
        p->part[k].middle.x -= x;
        set_bounds(&p->part[k]);
    }
}

/* 0 where the ray does not meet it. */
static double hit_part(const people_part *p, rlf_vec3 ray)
{
    if (ray.x < p->x0 || ray.x > p->x1 || ray.y < p->y0 || ray.y > p->y1) {
        return 0.0;
    }
    const rlf_vec3 along = {(ray.x - p->lean * ray.y) / p->half.x, ray.y / p->half.y,
                            1.0 / p->half.z};
    const rlf_vec3 to = {(p->middle.x - p->lean * p->middle.y) / p->half.x, p->middle.y / p->half.y,
                         p->middle.z / p->half.z};
    double a = rlf_dot(along, along), b = rlf_dot(along, to);
    double root = b * b - a * (rlf_dot(to, to) - 1.0);
    return root > 0.0 ? (b - sqrt(root)) / a : 0.0;
}

double people_hit(const people *p, rlf_vec3 ray, people_cloth *out_cloth)
{
    double nearest = 0.0;
    *out_cloth = PEOPLE_NOBODY;
    for (int32_t k = 0; k < p->count; k++) {
        double depth = hit_part(&p->part[k], ray);
        if (depth > 0.0 && (nearest == 0.0 || depth < nearest)) {
            nearest = depth;
            *out_cloth = p->part[k].cloth;
        }
    }
    return nearest;
}
