/* Shared by the ways to find a model's pose. */
#ifndef RLF_KNOWN_ALIGN_H
#define RLF_KNOWN_ALIGN_H

#include "relief/known.h"

/* Root mean square distance of points from their centre, metres. */
double known_spread(const rlf_vec3 *points, int32_t count);
/* True when the points lie on a line, or all at one place. */
bool known_is_line(const rlf_vec3 *points, int32_t count);

/* Least squares on a small motion (rotation vector, then shift) of a pose, about its own origin:
 * sums of squares of residuals, each r + J d with weight w. */
typedef struct known_normal {
    double a[6][6], b[6];
} known_normal;
void known_normal_add(known_normal *n, const double jacobian[6], double residual, double weight);
/* Moves *T by the motion with the least sum; false when the sums leave it open. */
bool known_normal_apply(const known_normal *n, rlf_pose *T);
/* rlf_known_refine, held at its start as firmly as `prior` says. */
void known_refine(const rlf_shape *shape, const rlf_known_view *view, const known_normal *prior,
                  rlf_known_fit *fit);

#endif
