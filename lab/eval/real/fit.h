/* The baselines' tools: planes by least squares and RANSAC. */
#ifndef RELIEF_APP_EVAL_REAL_FIT_H
#define RELIEF_APP_EVAL_REAL_FIT_H

#include "relief/surface.h"

/* Points n.p = d with unit n towards the camera, so d < 0. */
typedef struct real_plane {
    rlf_vec3 n;
    double d;
    int32_t inliers;
} real_plane;

/* A depth picture with the rays of its pixels; depth 0 = missing. Borrowed. */
typedef struct real_points {
    int32_t width, height;
    const float *ray_x, *ray_y, *depth;
} real_points;

static inline rlf_vec3 real_point(const real_points *p, int32_t i)
{
    double z = p->depth[i];
    return rlf_vec3_make(z * p->ray_x[i], z * p->ray_y[i], z);
}

/* True when the point of pixel i is on the plane: within 3 sigma of the sensor's noise there. */
bool real_plane_holds(const real_points *p, const real_plane *plane, const rlf_depth_noise *noise,
                      int32_t i);
/* The plane with most of the points that `is_free` marks (NULL = all): 200 draws, then least
 * squares over those on it, twice. False when there are fewer than 100. */
bool real_plane_find(const real_points *p, const uint8_t *is_free, const rlf_depth_noise *noise,
                     real_plane *out);
/* Unit normal of the 5x5 window around a pixel by least squares of inverse depth; (0,0,0) without
 * 6 points, or at the border. */
rlf_vec3 real_window_normal(const real_points *p, int32_t i);

#endif
