/* Relief: vectors, quaternions, poses and boxes, and the few elementary functions the core needs.
 *
 * Values are double; image planes are float. The frame is the camera's: x right, y down, z forward,
 * right-handed. `T_a_b` maps points of b into a. Everything here is a pure function: thread-safe.
 * The elementary functions are Relief's own, so that results are the same bits with every C
 * library. SPDX-License-Identifier: MIT */
#ifndef RELIEF_MATH_H
#define RELIEF_MATH_H

#include "relief/base.h"

#include <math.h> /* sqrt only: correctly rounded by IEEE 754 */

#ifdef __cplusplus
extern "C" {
#endif

#define RLF_PI 3.14159265358979323846

/* sin, cos, exp, log, acos and atan2 of a double, to about 1e-15 relative (acos, atan2 1e-15
 * absolute). Arguments of sin and cos are radians, |x| <= 1e5. log of x <= 0 is -708. */
RLF_API double rlf_sin(double x);
RLF_API double rlf_cos(double x);
RLF_API double rlf_exp(double x);
RLF_API double rlf_log_e(double x);
RLF_API double rlf_acos(double x);
RLF_API double rlf_atan2(double y, double x);

static inline double rlf_min(double a, double b)
{
    return a < b ? a : b;
}
static inline double rlf_max(double a, double b)
{
    return a > b ? a : b;
}
static inline double rlf_clamp(double x, double low, double high)
{
    return x < low ? low : (x > high ? high : x);
}
/* False for NaN and infinities, without libm. */
static inline bool rlf_is_finite(double x)
{
    return x - x == 0.0;
}

/* ---- vec3 --------------------------------------------------------------------------------------
 */

typedef struct rlf_vec3 {
    double x, y, z;
} rlf_vec3;

static inline rlf_vec3 rlf_vec3_make(double x, double y, double z)
{
    rlf_vec3 v = {x, y, z};
    return v;
}
static inline rlf_vec3 rlf_add(rlf_vec3 a, rlf_vec3 b)
{
    return rlf_vec3_make(a.x + b.x, a.y + b.y, a.z + b.z);
}
static inline rlf_vec3 rlf_sub(rlf_vec3 a, rlf_vec3 b)
{
    return rlf_vec3_make(a.x - b.x, a.y - b.y, a.z - b.z);
}
static inline rlf_vec3 rlf_scale(rlf_vec3 a, double s)
{
    return rlf_vec3_make(a.x * s, a.y * s, a.z * s);
}
/* a + b * s */
static inline rlf_vec3 rlf_mad(rlf_vec3 a, rlf_vec3 b, double s)
{
    return rlf_vec3_make(a.x + b.x * s, a.y + b.y * s, a.z + b.z * s);
}
static inline rlf_vec3 rlf_neg(rlf_vec3 a)
{
    return rlf_vec3_make(-a.x, -a.y, -a.z);
}
static inline double rlf_dot(rlf_vec3 a, rlf_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline rlf_vec3 rlf_cross(rlf_vec3 a, rlf_vec3 b)
{
    return rlf_vec3_make(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static inline double rlf_length(rlf_vec3 a)
{
    return sqrt(rlf_dot(a, a));
}
/* Unit vector; the zero vector stays zero. */
static inline rlf_vec3 rlf_normalize(rlf_vec3 a)
{
    double length = rlf_length(a);
    return length > 0.0 ? rlf_scale(a, 1.0 / length) : a;
}
static inline rlf_vec3 rlf_vec3_min(rlf_vec3 a, rlf_vec3 b)
{
    return rlf_vec3_make(rlf_min(a.x, b.x), rlf_min(a.y, b.y), rlf_min(a.z, b.z));
}
static inline rlf_vec3 rlf_vec3_max(rlf_vec3 a, rlf_vec3 b)
{
    return rlf_vec3_make(rlf_max(a.x, b.x), rlf_max(a.y, b.y), rlf_max(a.z, b.z));
}
static inline bool rlf_vec3_is_finite(rlf_vec3 a)
{
    return rlf_is_finite(a.x) && rlf_is_finite(a.y) && rlf_is_finite(a.z);
}
/* Some unit vector perpendicular to the unit vector n. */
static inline rlf_vec3 rlf_perpendicular(rlf_vec3 n)
{
    rlf_vec3 axis = n.x * n.x < 0.34 ? rlf_vec3_make(1, 0, 0) : rlf_vec3_make(0, 1, 0);
    return rlf_normalize(rlf_cross(n, axis));
}

/* ---- mat3: rows, m[row][column] ----------------------------------------------------------------
 */

typedef struct rlf_mat3 {
    double m[3][3];
} rlf_mat3;

static inline rlf_mat3 rlf_mat3_diagonal(double x, double y, double z)
{
    rlf_mat3 r = {{{x, 0, 0}, {0, y, 0}, {0, 0, z}}};
    return r;
}
static inline rlf_vec3 rlf_mat3_mul_vec(const rlf_mat3 *a, rlf_vec3 v)
{
    return rlf_vec3_make(a->m[0][0] * v.x + a->m[0][1] * v.y + a->m[0][2] * v.z,
                         a->m[1][0] * v.x + a->m[1][1] * v.y + a->m[1][2] * v.z,
                         a->m[2][0] * v.x + a->m[2][1] * v.y + a->m[2][2] * v.z);
}
RLF_API rlf_mat3 rlf_mat3_mul(const rlf_mat3 *a, const rlf_mat3 *b);
RLF_API rlf_mat3 rlf_mat3_transpose(const rlf_mat3 *a);
/* Inverse; false (and the zero matrix) when |det| is 0 or not finite. */
RLF_API bool rlf_mat3_invert(const rlf_mat3 *a, rlf_mat3 *out);

/* ---- quaternion: x, y, z, w; rotation when of unit length --------------------------------------
 */

typedef struct rlf_quat {
    double x, y, z, w;
} rlf_quat;

static inline rlf_quat rlf_quat_identity(void)
{
    rlf_quat q = {0, 0, 0, 1};
    return q;
}
static inline rlf_quat rlf_quat_mul(rlf_quat a, rlf_quat b)
{
    rlf_quat r = {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                  a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                  a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
                  a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
    return r;
}
static inline rlf_quat rlf_quat_conjugate(rlf_quat q)
{
    rlf_quat r = {-q.x, -q.y, -q.z, q.w};
    return r;
}
/* Unit quaternion; a zero or non-finite one becomes the identity. */
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
static inline rlf_vec3 rlf_rotate(rlf_quat q, rlf_vec3 v)
{
    rlf_vec3 u = rlf_vec3_make(q.x, q.y, q.z);
    rlf_vec3 t = rlf_scale(rlf_cross(u, v), 2.0);
    return rlf_add(rlf_mad(v, t, q.w), rlf_cross(u, t));
}
/* Rotation by `angle` radians about the unit axis. */
RLF_API rlf_quat rlf_quat_from_axis_angle(rlf_vec3 axis, double angle);
/* Exponential map: rotation by |v| radians about v. */
RLF_API rlf_quat rlf_quat_from_rotation_vector(rlf_vec3 v);
RLF_API rlf_mat3 rlf_quat_to_mat3(rlf_quat q);
/* Nearest rotation for a matrix that is one up to rounding (Shepperd 1978). */
RLF_API rlf_quat rlf_quat_from_mat3(const rlf_mat3 *m);

/* ---- rigid pose --------------------------------------------------------------------------------
 */

/* Rigid transform: p_a = q p_b q* + p, named T_a_b. */
typedef struct rlf_pose {
    rlf_vec3 p; /* metres */
    rlf_quat q; /* unit */
} rlf_pose;

static inline rlf_pose rlf_pose_identity(void)
{
    rlf_pose pose = {{0, 0, 0}, {0, 0, 0, 1}};
    return pose;
}
static inline rlf_vec3 rlf_transform(const rlf_pose *T, rlf_vec3 v)
{
    return rlf_add(rlf_rotate(T->q, v), T->p);
}
/* Maps a point of a back into b: the inverse of rlf_transform. */
static inline rlf_vec3 rlf_transform_inverse(const rlf_pose *T, rlf_vec3 v)
{
    return rlf_rotate(rlf_quat_conjugate(T->q), rlf_sub(v, T->p));
}
/* T_a_c = T_a_b T_b_c */
static inline rlf_pose rlf_pose_mul(const rlf_pose *T_a_b, const rlf_pose *T_b_c)
{
    rlf_pose r;
    r.p = rlf_transform(T_a_b, T_b_c->p);
    r.q = rlf_quat_mul(T_a_b->q, T_b_c->q);
    return r;
}
static inline rlf_pose rlf_pose_invert(const rlf_pose *T_a_b)
{
    rlf_pose r;
    r.q = rlf_quat_conjugate(T_a_b->q);
    r.p = rlf_neg(rlf_rotate(r.q, T_a_b->p));
    return r;
}

/* ---- mat4: rows, m[row][column], p' = M p, for the graphics API --------------------------------
 */

typedef struct rlf_mat4 {
    double m[4][4];
} rlf_mat4;

RLF_API rlf_mat4 rlf_mat4_mul(const rlf_mat4 *a, const rlf_mat4 *b);
/* Rigid transform as a matrix (A.2 and the R, T part of A.3, as corrected: T R). */
RLF_API rlf_mat4 rlf_mat4_from_pose(const rlf_pose *T);
/* Model matrix T R S (A.3 as corrected: scale, then rotate, then translate). */
RLF_API rlf_mat4 rlf_mat4_model(const rlf_pose *T, rlf_vec3 scale);

/* ---- axis-aligned box --------------------------------------------------------------------------
 */

typedef struct rlf_aabb {
    rlf_vec3 min, max; /* metres; empty when min > max on some axis */
} rlf_aabb;

static inline rlf_aabb rlf_aabb_empty(void)
{
    rlf_aabb b = {{1e30, 1e30, 1e30}, {-1e30, -1e30, -1e30}};
    return b;
}
static inline void rlf_aabb_extend(rlf_aabb *box, rlf_vec3 p)
{
    box->min = rlf_vec3_min(box->min, p);
    box->max = rlf_vec3_max(box->max, p);
}
/* Squared distance from p to the box; 0 inside. */
static inline double rlf_aabb_distance2(const rlf_aabb *box, rlf_vec3 p)
{
    rlf_vec3 near = rlf_vec3_max(box->min, rlf_vec3_min(p, box->max));
    rlf_vec3 d = rlf_sub(p, near);
    return rlf_dot(d, d);
}

#ifdef __cplusplus
}
#endif
#endif
