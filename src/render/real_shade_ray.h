/* Inside real_shade: rays from bodies to the light through the depth image. */
#ifndef RLF_RENDER_REAL_SHADE_RAY_H
#define RLF_RENDER_REAL_SHADE_RAY_H

#include "relief/compositor.h"

#define REAL_SHADE_REACH_M 2.5 /* beyond this nothing casts a shadow: lamps are wide */

enum { REAL_SHADE_RAYS = 16 }; /* at once */

/* Points in the depth camera's frame, metres. */
typedef struct real_shade_points {
    float p[3][REAL_SHADE_RAYS];
    int32_t is_some[REAL_SHADE_RAYS]; /* 0 = none: p is of no use */
} real_shade_points;

/* Shares of the light that are lost between the first `count` points and the light; 0 where there
 * is none. */
void real_shade_lost(const rlf_surface *surface, const real_shade_points *points,
                     const float to_light[3], int32_t count, float *out);

#endif
