/* What the ways to find velocity share. */
#ifndef RLF_SURFACE_MOTION_MOTION_H
#define RLF_SURFACE_MOTION_MOTION_H

#include "kernel/flow.h"
#include "surface/steps.h"

/* Two frames. */
typedef struct rlf_flow {
    const rlf_reconstruct *stage;
    const rlf_slot *before;
    rlf_slot *now;
    float dt;
    rlf_kernel_noise noise;
    rlf_kernel_flow_view view; /* of the frame before */
} rlf_flow;

/* A rigid motion about a centre; w in units of 1 / length, so that all six unknowns are speeds. */
typedef struct rlf_twist {
    rlf_vec3 centre;
    double length;
    double x[6];
    double explained, noise; /* squared speeds */
    int32_t stride;          /* every stride-th pixel of every stride-th row is looked at */
    int32_t samples, inliers;
    double reach; /* metres about the centre within which a keyframe tells it; 0 = none does */
} rlf_twist;

/* Angular velocity, and with it the velocity at p. */
static inline rlf_vec3 rlf_twist_spin(const rlf_twist *t)
{
    return rlf_scale(rlf_vec3_make(t->x[3], t->x[4], t->x[5]), 1.0 / t->length);
}

static inline rlf_vec3 rlf_twist_velocity(const rlf_twist *t, rlf_vec3 p)
{
    return rlf_add(rlf_vec3_make(t->x[0], t->x[1], t->x[2]),
                   rlf_cross(rlf_twist_spin(t), rlf_sub(p, t->centre)));
}

typedef struct rlf_velocity {
    float v[3]; /* m/s */
} rlf_velocity;

static inline rlf_velocity rlf_velocity_make(double x, double y, double z)
{
    return (rlf_velocity){{(float)x, (float)y, (float)z}};
}

/* Velocity of a region's pixels; `twist` is its motion as a whole, 0 unless it `moves`. */
void rlf_velocity_cells(const rlf_flow *job, const rlf_region *region, const rlf_twist *twist,
                        bool moves);

/* Half of a limb's breadth: within a window, what is farther off is another limb; a limb that is so
 * far beside where it was still fits it. */
static const float rlf_flow_limb_m = 0.05f;
/* Share of the mean diagonal of normal equations: what nothing is seen of is 0. */
static const float rlf_flow_ridge = 0.01f;
/* Noise of neighbouring pixels is correlated by the drivers' 3x3 filters: 2 of every second pixel
 * count as one. */
static const float rlf_flow_correlated = 2.0f;

static inline rlf_vec3 rlf_flow_point(const image_grid *grid, const float *depth, ptrdiff_t i)
{
    double z = depth[i];
    return rlf_vec3_make(z * grid->ray_x[i], z * grid->ray_y[i], z);
}

static inline rlf_vec3 rlf_flow_normal(const rlf_slot *slot, ptrdiff_t i)
{
    return rlf_vec3_make(slot->normal[0][i], slot->normal[1][i], slot->normal[2][i]);
}

/* Pixel that sees point p, which is near pixel i; -1 = none. The step from i is measured with the
 * focal length: what distortion makes of it moves the pixel a little along the surface, where the
 * same normal makes the same of it. */
static inline ptrdiff_t rlf_flow_pixel(const image_grid *grid, ptrdiff_t i, rlf_vec3 p)
{
    if (!(p.z > 0.0)) {
        return -1;
    }
    const double u = i % grid->width + (p.x / p.z - grid->ray_x[i]) * grid->camera.fx;
    const double v = i / grid->width + (p.y / p.z - grid->ray_y[i]) * grid->camera.fy;
    const bool is_in = u > -0.5 && v > -0.5 && u < grid->width - 0.5 && v < grid->height - 0.5;
    return is_in ? (ptrdiff_t)(v + 0.5) * grid->width + (ptrdiff_t)(u + 0.5) : -1;
}

#endif
