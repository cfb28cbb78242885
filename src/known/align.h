/* Shared by the ways to find a model's pose. */
#ifndef RLF_KNOWN_ALIGN_H
#define RLF_KNOWN_ALIGN_H

#include "math/rigid.h"
#include "relief/known.h"

/* Root mean square distance of points from their centre, metres. */
double known_spread(const rlf_vec3 *points, int32_t count);
/* True when the points lie on a line, or all at one place. */
bool known_is_line(const rlf_vec3 *points, int32_t count);

/* Sums are about a small motion of a pose about its own origin. */
/* Moves *T by the motion with the least sum; false when the sums leave it open. */
bool known_step(const math_rigid_sums *n, rlf_pose *T);
/* rlf_known_refine, held at its start as firmly as `prior` says. */
void known_refine(const rlf_shape *shape, const rlf_known_view *view, const math_rigid_sums *prior,
                  rlf_known_fit *fit);

/* ---- picks.c: picked points as the camera saw them. */

typedef struct known_pick {
    rlf_vec3 model;
    bool has_pixel; /* ray is set */
    bool has_depth; /* world is set; with a pixel z too */
    rlf_vec3 ray;   /* (x, y, 1), picture camera frame */
    double z;       /* metres in that frame: the middle of what is sensed around it, */
    double z_half;  /* which goes on by this to both sides */
    rlf_vec3 world;
} known_pick;

/* The picture that pixels are of. */
typedef struct known_sight {
    rlf_camera picture;
    rlf_pose T_picture_world;
    rlf_depth_noise noise;
} known_sight;

/* Rays and depths of a def's points. Depth at a pixel is that of the nearest thing around it: who
 * picks a corner misses it by a pixel or two. `view` may be NULL without pixels. Allocates. */
rlf_result known_look_up(const rlf_known_def *def, const rlf_known_view *view,
                         known_pick picks[RLF_KNOWN_POINTS_MAX], known_sight *out_sight);

#endif
