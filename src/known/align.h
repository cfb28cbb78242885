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

#endif
