/* What real things keep of the directed light on its path to a point: rays from there to the light
 * are followed through the depth image. Each pixel is solid from its depth to its estimated back,
 * and so is the background behind it. */
#ifndef RLF_ENVIRONMENT_LIGHT_PATH_H
#define RLF_ENVIRONMENT_LIGHT_PATH_H

#include "environment/depth_tiles.h"

#define LIGHT_PATH_REACH_M 2.5 /* beyond this nothing casts a shadow: lamps are wide */

enum { LIGHT_PATH_RAYS = 16 }; /* at once */

/* Points in the depth camera's frame, metres. */
typedef struct light_path_points {
    float p[3][LIGHT_PATH_RAYS];
    int32_t is_some[LIGHT_PATH_RAYS]; /* 0 = none: p is of no use */
} light_path_points;

/* Shares of the light that are lost between the first `count` points and the light; 0 where there
 * is none. `to_light` is a unit vector. */
void light_path_lost(const rlf_surface *surface, const light_path_points *points,
                     const float to_light[3], int32_t count, float *out);

/* In the depth camera's frame, metres. */
typedef struct light_path_ball {
    float center[3], radius;
} light_path_ball;

/* light_path_ball.c: false when no ray from the ball to the light goes behind anything: no light is
 * lost. `tiles` are the surface's. */
bool light_path_may_lose(const rlf_surface *surface, const depth_tiles *tiles,
                         const light_path_ball *ball, const float to_light[3]);

#endif
