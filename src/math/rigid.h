/* Least squares of a small rigid motion, by steps of Gauss and Newton. */
#ifndef RLF_MATH_RIGID_H
#define RLF_MATH_RIGID_H

#include "relief/math.h"

/* Sums over rows about six unknowns: a shift, then a turn (a rotation vector). */
typedef struct math_rigid_sums {
    double a[6][6]; /* information: the lower triangle */
    double b[6];
    double weight; /* of all rows */
} math_rigid_sums;

/* One row: along n it should move by `off`. turn: how far unit turns move it along n, which is its
 * arm from the centre x n. */
void math_rigid_add(math_rigid_sums *sums, rlf_vec3 n, rlf_vec3 turn, double off, double weight);
/* The motion of which the squares are least, by Cholesky's L L^T. False when of what is known about
 * an unknown no more than the share `least` is left by those before it: then nothing tells it from
 * them. */
bool math_rigid_solve(const math_rigid_sums *sums, double least, double x[6]);

/* The axis of a turn times its angle, 0 to pi. */
rlf_vec3 math_rotation_vector(rlf_quat q);

/* Finite, and its quaternion of unit length, to 1 %. */
bool math_pose_is_sound(const rlf_pose *T);

#endif
