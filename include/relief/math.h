/* Relief: vectors, quaternions, poses and boxes, and the few elementary functions the core needs.
 *
 * Values are double; image planes are float. The frame is the camera's: x right, y down, z forward,
 * right-handed. `T_a_b` maps points of b into a. Everything here is a pure function: thread-safe.
 *
 * Names of poses say what they do, so that a chain can be checked by reading it:
 *
 *   p_world = rlf_transform(&T_world_camera, p_camera)          letters next to each other agree
 *   T_world_body = rlf_pose_mul(&T_world_camera, &T_camera_body)
 *   T_camera_world = rlf_pose_invert(&T_world_camera)
 *   p_camera = rlf_transform_inverse(&T_world_camera, p_world)  the same without the inverse
 *
 * A direction (a normal, a velocity) has no place: it is turned by rlf_rotate(T.q, v) alone.
 *
 * Same bits everywhere: the library and these inline functions are to be compiled with
 * -ffp-contract=off and without -ffast-math. Sums go from left to right. Beyond + - * / and sqrt,
 * which IEEE 754 rounds correctly, all functions are Relief's own, since C libraries differ.
 *
 * Numbers are not checked: NaN comes out where NaN goes in. What comes from a user or a file is
 * looked at where it enters (rlf_is_finite, rlf_vec3_is_finite). A pointer that is NULL breaks the
 * contract (RLF_ASSERT) and gives zeros, or no rotation.
 *
 * Small functions are inline, for they are called per pixel; the larger ones are in src/math.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_MATH_H
#define RELIEF_MATH_H

#include "relief/base.h"

#include <math.h> /* sqrt only: correctly rounded by IEEE 754 */

#ifdef __cplusplus
extern "C" {
#endif

/* The circle's half circumference over its radius, rounded to double. */
#define RLF_PI 3.14159265358979323846

/* Elementary functions of a double. Errors: about 1e-15, relative, but of acos and atan2 absolute.
 * None sets errno. Source: argument reduction and series, src/math/elementary.c.
 *
 * Sine of x radians, |x| <= 1e5: beyond that the argument's reduction loses digits. */
RLF_API double rlf_sin(double x);
/* Cosine of x radians, |x| <= 1e5. */
RLF_API double rlf_cos(double x);
/* e to the power x. 0 for x <= -708 and NaN; of x > 709 as of 709, so it is never infinite. */
RLF_API double rlf_exp(double x);
/* Natural logarithm. Of x <= 0 it is -708, the smallest that exp gives back, and no NaN. */
RLF_API double rlf_log_e(double x);
/* Angle in 0 .. pi radians whose cosine is x. x beyond -1 .. 1 by rounding counts as the bound. */
RLF_API double rlf_acos(double x);
/* Angle of the point (x, y) in -pi .. pi radians, from the x axis towards the y axis. 0 at the
 * origin. */
RLF_API double rlf_atan2(double y, double x);

/* The smaller of two. When either is NaN it is b: put the value that may be NaN first to be rid of
 * it. */
static inline double rlf_min(double a, double b) { return a < b ? a : b; }
/* The larger of two. When either is NaN it is b. */
static inline double rlf_max(double a, double b) { return a > b ? a : b; }
/* x, but at least `low` and at most `high`, which must be in order. A NaN stays NaN. */
static inline double rlf_clamp(double x, double low, double high)
{
    return x < low ? low : (x > high ? high : x);
}
/* False for NaN and infinities, without libm: the difference of such a value to itself is NaN. Not
 * to be compiled with -ffast-math, which takes every value for finite. */
static inline bool rlf_is_finite(double x) { return x - x == 0.0; }

/* ---- vec3 --------------------------------------------------------------------------------------
 *
 * Passed by value: compilers keep it in registers. */

/* Three coordinates: a point, a direction or a velocity. What it is and its unit stand where it is
 * used; the frame is that of the field's or argument's description. 24 bytes, no padding. */
typedef struct rlf_vec3 {
    double x, y, z; /* metres, unless a comment says otherwise */
} rlf_vec3;

/* A vector of its coordinates, for expressions in which C has no literal. */
static inline rlf_vec3 rlf_vec3_make(double x, double y, double z)
{
    rlf_vec3 v = {x, y, z};
    return v;
}
/* a + b. Added coordinate by coordinate, never fused with a product. */
static inline rlf_vec3 rlf_add(rlf_vec3 a, rlf_vec3 b)
{
    return rlf_vec3_make(a.x + b.x, a.y + b.y, a.z + b.z);
}
/* a - b: the way from point b to point a. */
static inline rlf_vec3 rlf_sub(rlf_vec3 a, rlf_vec3 b)
{
    return rlf_vec3_make(a.x - b.x, a.y - b.y, a.z - b.z);
}
/* a s: as long as a times |s|, turned round where s < 0. */
static inline rlf_vec3 rlf_scale(rlf_vec3 a, double s)
{
    return rlf_vec3_make(a.x * s, a.y * s, a.z * s);
}
/* a + b s: the point that lies s times the way b from a. Product and sum round one after the other,
 * on machines with a fused multiply-add, too. */
static inline rlf_vec3 rlf_mad(rlf_vec3 a, rlf_vec3 b, double s)
{
    return rlf_vec3_make(a.x + b.x * s, a.y + b.y * s, a.z + b.z * s);
}
/* -a: the opposite direction. Zeros change their sign bit, which counts for hashes of bits. */
static inline rlf_vec3 rlf_neg(rlf_vec3 a) { return rlf_vec3_make(-a.x, -a.y, -a.z); }
/* Scalar product: |a| |b| cos of the angle between them. Of unit vectors > 0 where they are less
 * than a right angle apart. */
static inline double rlf_dot(rlf_vec3 a, rlf_vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
/* Vector product: perpendicular to both, |a| |b| sin of the angle long. x cross y is z; in the
 * camera's frame right cross down is forward. */
static inline rlf_vec3 rlf_cross(rlf_vec3 a, rlf_vec3 b)
{
    return rlf_vec3_make(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
/* Length, in the unit of the coordinates. Squares overflow beyond 1e154 and vanish below 1e-162,
 * far outside of any room. */
static inline double rlf_length(rlf_vec3 a) { return sqrt(rlf_dot(a, a)); }
/* Vector of length 1 (to rounding) along a. The zero vector has no direction and stays zero:
 * callers test for it where it can come. */
static inline rlf_vec3 rlf_normalize(rlf_vec3 a)
{
    double length = rlf_length(a);
    return length > 0.0 ? rlf_scale(a, 1.0 / length) : a;
}
/* Smaller coordinate on each axis by itself: the lower corner of the box around two points. */
static inline rlf_vec3 rlf_vec3_min(rlf_vec3 a, rlf_vec3 b)
{
    return rlf_vec3_make(rlf_min(a.x, b.x), rlf_min(a.y, b.y), rlf_min(a.z, b.z));
}
/* Larger coordinate on each axis by itself: the upper corner of the box around two points. */
static inline rlf_vec3 rlf_vec3_max(rlf_vec3 a, rlf_vec3 b)
{
    return rlf_vec3_make(rlf_max(a.x, b.x), rlf_max(a.y, b.y), rlf_max(a.z, b.z));
}
/* False when any coordinate is NaN or infinite. The check for what a caller or a file hands in. */
static inline bool rlf_vec3_is_finite(rlf_vec3 a)
{
    return rlf_is_finite(a.x) && rlf_is_finite(a.y) && rlf_is_finite(a.z);
}
/* Some unit vector perpendicular to the unit vector n: n crossed with the x axis or, where that is
 * near n (|n_x| > 0.58), with the y axis. It jumps where the axis changes, so it is no smooth
 * field. */
static inline rlf_vec3 rlf_perpendicular(rlf_vec3 n)
{
    rlf_vec3 axis = n.x * n.x < 0.34 ? rlf_vec3_make(1, 0, 0) : rlf_vec3_make(0, 1, 0);
    return rlf_normalize(rlf_cross(n, axis));
}

/* ---- mat3: rows, m[row][column] ----------------------------------------------------------------
 *
 * Passed by pointer, for 72 bytes are much to copy. */

/* Nine numbers: a rotation, an inertia tensor or a covariance. m[1][2] is the second row's third.
 * Vectors are columns and stand to its right. */
typedef struct rlf_mat3 {
    double m[3][3]; /* m[row][column] */
} rlf_mat3;

/* Zero but for the diagonal. Ones make the identity; the principal moments make the inertia of a
 * body in its own axes. */
static inline rlf_mat3 rlf_mat3_diagonal(double x, double y, double z)
{
    rlf_mat3 r = {{{x, 0, 0}, {0, y, 0}, {0, 0, z}}};
    return r;
}
/* a v. Each coordinate is a sum from left to right, so its bits do not depend on the compiler. Of a
 * rotation: the turned vector. */
static inline rlf_vec3 rlf_mat3_mul_vec(const rlf_mat3 *a, rlf_vec3 v)
{
    if (!RLF_ASSERT(a != NULL)) {
        return rlf_vec3_make(0, 0, 0);
    }
    return rlf_vec3_make(a->m[0][0] * v.x + a->m[0][1] * v.y + a->m[0][2] * v.z,
                         a->m[1][0] * v.x + a->m[1][1] * v.y + a->m[1][2] * v.z,
                         a->m[2][0] * v.x + a->m[2][1] * v.y + a->m[2][2] * v.z);
}
/* a b: what b does first and a then. a and b may be the same matrix. */
RLF_API rlf_mat3 rlf_mat3_mul(const rlf_mat3 *a, const rlf_mat3 *b);
/* Rows become columns. Of a rotation that is the inverse. */
RLF_API rlf_mat3 rlf_mat3_transpose(const rlf_mat3 *a);
/* Inverse, by cofactors; false (and the zero matrix) when |det| is 0 or not finite. There is no
 * limit for badly conditioned ones: who solves with them looks at the eigenvalues. `out` may be
 * `a`. */
RLF_API bool rlf_mat3_invert(const rlf_mat3 *a, rlf_mat3 *out);

/* ---- quaternion: x, y, z, w; rotation when of unit length --------------------------------------
 */

/* Hamilton's convention: x, y, z are the axis times sin(angle / 2), w is cos(angle / 2), and i j =
 * k. q and -q are the same rotation. */
typedef struct rlf_quat {
    double x, y, z, w; /* w is the real part; unit length */
} rlf_quat;

/* No rotation. A zeroed struct is not one: it is no rotation's quaternion at all. */
static inline rlf_quat rlf_quat_identity(void)
{
    rlf_quat q = {0, 0, 0, 1};
    return q;
}
/* a b: the rotation b first, then a. Rounding lets the length drift by some 1e-16 each time, so
 * what multiplies up over frames is normalised once a step. */
static inline rlf_quat rlf_quat_mul(rlf_quat a, rlf_quat b)
{
    rlf_quat r = {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                  a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                  a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
                  a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
    return r;
}
/* The opposite rotation of a unit quaternion. */
static inline rlf_quat rlf_quat_conjugate(rlf_quat q)
{
    rlf_quat r = {-q.x, -q.y, -q.z, q.w};
    return r;
}
/* Unit quaternion along q. A zero or non-finite one becomes the identity, so a body never gets an
 * orientation that is none. */
static inline rlf_quat rlf_quat_normalize(rlf_quat q)
{
    double n = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    if (!(n > 0.0) || !rlf_is_finite(n)) {
        return rlf_quat_identity();
    }
    double s = 1.0 / sqrt(n);
    rlf_quat r = {q.x * s, q.y * s, q.z * s, q.w * s};
    return r;
}
/* v turned by the unit quaternion q: v + 2 w (u x v) + 2 u x (u x v), u being q's vector part. Does
 * not check the length of q. */
static inline rlf_vec3 rlf_rotate(rlf_quat q, rlf_vec3 v)
{
    rlf_vec3 u = rlf_vec3_make(q.x, q.y, q.z);
    rlf_vec3 t = rlf_scale(rlf_cross(u, v), 2.0);
    return rlf_add(rlf_mad(v, t, q.w), rlf_cross(u, t));
}
/* Rotation by `angle` radians about the unit axis, right-handed: with the camera's axes a positive
 * turn about y (down) turns what is ahead to the right. */
RLF_API rlf_quat rlf_quat_from_axis_angle(rlf_vec3 axis, double angle);
/* Exponential map: rotation by |v| radians about v. Exact down to v = 0, where it is the identity:
 * an angular velocity times a time step can be put in as it is. */
RLF_API rlf_quat rlf_quat_from_rotation_vector(rlf_vec3 v);
/* The same rotation as a matrix; q must be of unit length. Worth it for more than two vectors. */
RLF_API rlf_mat3 rlf_quat_to_mat3(rlf_quat q);
/* Nearest rotation for a matrix that is one up to rounding (Shepperd 1978: divides by the largest
 * of the four terms). A matrix that is no rotation gives a unit quaternion that means nothing. */
RLF_API rlf_quat rlf_quat_from_mat3(const rlf_mat3 *m);

/* ---- rigid pose --------------------------------------------------------------------------------
 */

/* Rigid transform: p_a = q p_b q* + p, named T_a_b. Also the place and orientation of frame b's
 * axes as frame a sees them. */
typedef struct rlf_pose {
    rlf_vec3 p; /* metres */
    rlf_quat q; /* unit */
} rlf_pose;

/* Both frames are the same. */
static inline rlf_pose rlf_pose_identity(void)
{
    rlf_pose pose = {{0, 0, 0}, {0, 0, 0, 1}};
    return pose;
}
/* Maps a point of b into a. For directions and velocities, which do not move with the origin, use
 * rlf_rotate with T->q. */
static inline rlf_vec3 rlf_transform(const rlf_pose *T, rlf_vec3 v)
{
    if (!RLF_ASSERT(T != NULL)) {
        return rlf_vec3_make(0, 0, 0);
    }
    return rlf_add(rlf_rotate(T->q, v), T->p);
}
/* Maps a point of a back into b: the inverse of rlf_transform, without making the inverse pose. */
static inline rlf_vec3 rlf_transform_inverse(const rlf_pose *T, rlf_vec3 v)
{
    if (!RLF_ASSERT(T != NULL)) {
        return rlf_vec3_make(0, 0, 0);
    }
    return rlf_rotate(rlf_quat_conjugate(T->q), rlf_sub(v, T->p));
}
/* T_a_c = T_a_b T_b_c: the inner letters must be the same and cancel. The quaternion is not
 * normalised again; see rlf_quat_mul. */
static inline rlf_pose rlf_pose_mul(const rlf_pose *T_a_b, const rlf_pose *T_b_c)
{
    rlf_pose r = rlf_pose_identity();
    if (!RLF_ASSERT(T_a_b != NULL && T_b_c != NULL)) {
        return r;
    }
    r.p = rlf_transform(T_a_b, T_b_c->p);
    r.q = rlf_quat_mul(T_a_b->q, T_b_c->q);
    return r;
}
/* T_b_a: where frame a is, seen from b. */
static inline rlf_pose rlf_pose_invert(const rlf_pose *T_a_b)
{
    rlf_pose r = rlf_pose_identity();
    if (!RLF_ASSERT(T_a_b != NULL)) {
        return r;
    }
    r.q = rlf_quat_conjugate(T_a_b->q);
    r.p = rlf_neg(rlf_rotate(r.q, T_a_b->p));
    return r;
}

/* ---- mat4: rows, m[row][column], p' = M p, for the graphics API --------------------------------
 */

/* Homogeneous transform of column vectors. OpenGL wants columns one after the other: transpose it,
 * or upload it with GL_TRUE. */
typedef struct rlf_mat4 {
    double m[4][4]; /* m[row][column]; points are columns */
} rlf_mat4;

/* a b: what b does first and a then. */
RLF_API rlf_mat4 rlf_mat4_mul(const rlf_mat4 *a, const rlf_mat4 *b);
/* Rigid transform as a matrix, for shaders: the upper left 3 x 3 is the rotation, the last column
 * the place (A.2 and the R, T part of A.3, as corrected: T R). */
RLF_API rlf_mat4 rlf_mat4_from_pose(const rlf_pose *T);
/* Model matrix T R S of a body with its sizes: the unit shape's vertices go into frame a (A.3 as
 * corrected: scale, then rotate, then translate). */
RLF_API rlf_mat4 rlf_mat4_model(const rlf_pose *T, rlf_vec3 scale);

/* ---- axis-aligned box --------------------------------------------------------------------------
 */

/* Box along the axes of a frame, which is named where the box is used. */
typedef struct rlf_aabb {
    rlf_vec3 min, max; /* metres; empty when min > max on some axis */
} rlf_aabb;

/* What a ball sweeps from a to b while its radius changes evenly. */
typedef struct rlf_round_cone {
    rlf_vec3 a, b;             /* the ball's middle at both ends */
    double radius_a, radius_b; /* metres */
} rlf_round_cone;

/* A box that holds no point: the start for rlf_aabb_extend. Its bounds are 1e30 m, which floats
 * hold. */
static inline rlf_aabb rlf_aabb_empty(void)
{
    rlf_aabb b = {{1e30, 1e30, 1e30}, {-1e30, -1e30, -1e30}};
    return b;
}
/* Grows the box just so that it holds p, which must be finite: a NaN would stay in the box. */
static inline void rlf_aabb_extend(rlf_aabb *box, rlf_vec3 p)
{
    if (RLF_ASSERT(box != NULL)) {
        box->min = rlf_vec3_min(box->min, p);
        box->max = rlf_vec3_max(box->max, p);
    }
}
/* Squared distance from p to the box, m^2; 0 inside. Squared, for comparing needs no root. */
static inline double rlf_aabb_distance2(const rlf_aabb *box, rlf_vec3 p)
{
    if (!RLF_ASSERT(box != NULL)) {
        return 0.0;
    }
    rlf_vec3 near = rlf_vec3_max(box->min, rlf_vec3_min(p, box->max));
    rlf_vec3 d = rlf_sub(p, near);
    return rlf_dot(d, d);
}

#ifdef __cplusplus
}
#endif
#endif
