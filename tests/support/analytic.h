/* Analytic depth for tests of the surface stage: planes and spheres seen by a camera, and a seeded
 * noise source. */
#ifndef RLF_TEST_ANALYTIC_H
#define RLF_TEST_ANALYTIC_H

#include "relief/reconstruct.h"
#include "pinhole.h"

#include <stdlib.h>
#include <string.h>

/* A Kinect-like rig of any size. */
static inline rlf_rig analytic_rig(int32_t width, int32_t height)
{
    rlf_rig rig;
    memset(&rig, 0, sizeof rig);
    rig.depth = pinhole(width, height, 0.714 * width);
    rig.T_color_depth = rlf_pose_identity();
    rig.depth_min_m = 0.5;
    rig.depth_max_m = 4.5;
    rig.noise = (rlf_depth_noise){0.0015, -0.0005, 0.0003};
    return rig;
}

/* Depth along the ray (x, y, 1) of the plane n.p = d. */
static inline double plane_depth(rlf_vec3 n, double d, double x, double y)
{
    return d / (n.x * x + n.y * y + n.z);
}

/* Where a ray from `from` along `way` enters a sphere and leaves it, in lengths of `way`; false
 * when it misses. */
static inline bool sphere_ray(rlf_vec3 centre, double radius, rlf_vec3 from, rlf_vec3 way,
                              double *in, double *leave)
{
    rlf_vec3 to = rlf_sub(centre, from);
    double a = rlf_dot(way, way), b = rlf_dot(way, to);
    double root = b * b - a * (rlf_dot(to, to) - radius * radius);
    if (!(root > 0.0)) {
        return false;
    }
    *in = (b - sqrt(root)) / a;
    *leave = (b + sqrt(root)) / a;
    return true;
}

/* Depth of the near side of a sphere along the ray (x, y, 1); 0 where it misses. */
static inline double sphere_depth(rlf_vec3 centre, double radius, double x, double y)
{
    double in, leave;
    const rlf_vec3 eye = {0.0, 0.0, 0.0}, way = {x, y, 1.0};
    return sphere_ray(centre, radius, eye, way, &in, &leave) ? in : 0.0;
}

/* Where a ray from `from` along `way` enters a box and leaves it, in lengths of `way`; false when
 * it misses, or only what is behind it. */
static inline bool box_ray(const rlf_aabb *box, rlf_vec3 from, rlf_vec3 way, double *in,
                           double *leave)
{
    const double f[3] = {from.x, from.y, from.z}, w[3] = {way.x, way.y, way.z};
    const double low[3] = {box->min.x, box->min.y, box->min.z};
    const double high[3] = {box->max.x, box->max.y, box->max.z};
    *in = -1e9;
    *leave = 1e9;
    for (int k = 0; k < 3; k++) {
        const double by = w[k] > -1e-12 && w[k] < 1e-12 ? 1e-12 : w[k];
        const double a = (low[k] - f[k]) / by, b = (high[k] - f[k]) / by;
        *in = rlf_max(*in, rlf_min(a, b));
        *leave = rlf_min(*leave, rlf_max(a, b));
    }
    return *in<*leave && * leave> 0.0;
}

/* xorshift64* (Vigna 2016) and the sum of 12 uniforms: about normal, no library needed. */
typedef struct analytic_random {
    uint64_t state;
} analytic_random;

static inline double random_uniform(analytic_random *r)
{
    r->state ^= r->state >> 12;
    r->state ^= r->state << 25;
    r->state ^= r->state >> 27;
    return (double)((r->state * 2685821657736338717ull) >> 11) / 9007199254740992.0;
}
static inline double random_normal(analytic_random *r)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++) {
        sum += random_uniform(r);
    }
    return sum;
}

/* A frame of float depth without padding. */
static inline rlf_frame analytic_frame(const rlf_rig *rig, const float *depth, int32_t number)
{
    rlf_frame frame;
    memset(&frame, 0, sizeof frame);
    frame.sequence = (uint64_t)number;
    frame.time_ns = (int64_t)number * 33333333;
    frame.rig = rig;
    frame.depth_f32 = depth;
    frame.depth_stride = (ptrdiff_t)sizeof(float) * rig->depth.width;
    return frame;
}

/* Ray planes of a camera; the caller frees both with rlf_free. */
static inline void analytic_rays(const rlf_camera *camera, float **out_x, float **out_y)
{
    size_t count = (size_t)camera->width * (size_t)camera->height;
    *out_x = rlf_alloc_array(count, sizeof(float));
    *out_y = rlf_alloc_array(count, sizeof(float));
    for (int32_t y = 0; y < camera->height; y++) {
        for (int32_t x = 0; x < camera->width; x++) {
            rlf_vec3 ray;
            size_t i = (size_t)y * (size_t)camera->width + (size_t)x;
            if (rlf_camera_unproject(camera, x, y, &ray)) {
                (*out_x)[i] = (float)ray.x;
                (*out_y)[i] = (float)ray.y;
            }
        }
    }
}

/* Angle between two unit vectors, degrees, accurate near 0. */
static inline double angle_deg(rlf_vec3 a, rlf_vec3 b)
{
    return rlf_atan2(rlf_length(rlf_cross(a, b)), rlf_dot(a, b)) * 180.0 / RLF_PI;
}

#endif
