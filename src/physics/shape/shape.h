/* Shapes prepared for collision: size, signed distance, sample points and mass properties. */
#ifndef RLF_PHYSICS_SHAPE_SHAPE_H
#define RLF_PHYSICS_SHAPE_SHAPE_H

#include "relief/world.h"

#define PHYS_POINTS_MAX 64

/* Half space n.p <= d of a hull's face, body frame. */
typedef struct phys_plane {
    rlf_vec3 normal;
    double offset;
    int32_t triangle; /* of the hull */
} phys_plane;

typedef struct phys_shape {
    double radius;       /* bounding sphere about the origin, metres */
    double inner_radius; /* about the largest sphere about the origin that fits, metres */
    rlf_shape shape;
    phys_plane *planes; /* of a hull, owned; else NULL */
    int32_t plane_count;
    rlf_vec3 *points; /* PHYS_POINTS_MAX, borrowed: on the surface, body frame; vertices first */
    int32_t point_count;
    int32_t vertex_count;
} phys_shape;

/* A vector in the frame that R turns into it: R^T v. */
static inline rlf_vec3 phys_to_frame(const rlf_mat3 *R, rlf_vec3 v)
{
    return rlf_vec3_make(R->m[0][0] * v.x + R->m[1][0] * v.y + R->m[2][0] * v.z,
                         R->m[0][1] * v.x + R->m[1][1] * v.y + R->m[2][1] * v.z,
                         R->m[0][2] * v.x + R->m[1][2] * v.y + R->m[2][2] * v.z);
}

/* Whether there is a shape and, for a hull, its vertices and triangles. */
bool phys_shape_is_whole(const rlf_shape *shape);

/* RLF_OK or RLF_ERROR_INVALID with a line that names the field. */
rlf_result phys_shape_check(const rlf_shape *shape);

/* Fills `out` from a checked shape; `points` has room for PHYS_POINTS_MAX and lives as long.
 * RLF_ERROR_MEMORY when a hull's planes do not fit in memory. */
rlf_result phys_shape_init(phys_shape *out, const rlf_shape *shape, rlf_vec3 *points);
void phys_shape_finish(phys_shape *shape);

/* The plane of a hull's triangle; the zero normal when it has no area. */
phys_plane phys_plane_of_triangle(const rlf_hull *hull, int32_t triangle);

/* Signed distance of p (body frame) to the surface, negative inside, metres. out_gradient is the
 * unit direction in which it grows. */
double phys_shape_distance(const phys_shape *shape, rlf_vec3 p, rlf_vec3 *out_gradient);

/* Up to two core points of a shape (body frame): the surface point farthest along the unit
 * `direction` is core + *out_rounding * direction. Ball: its centre; capsule: the cap centres;
 * cylinder: of its two rim points, rounding 0 unless the direction is about level; a hull with more
 * vertices than it has sample points: its farthest one. Returns their number; 0 for a box and for
 * other hulls. */
int32_t phys_shape_support(const phys_shape *shape, rlf_vec3 direction, rlf_vec3 out[2],
                           double *out_rounding);

/* Whether balls of that rounding about a shape's core points are part of it, in any direction. */
static inline bool phys_shape_is_round(const phys_shape *shape)
{
    return shape->shape.type == RLF_SHAPE_SPHERE || shape->shape.type == RLF_SHAPE_CAPSULE;
}

#endif
