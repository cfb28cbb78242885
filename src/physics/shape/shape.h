/* Shapes prepared for collision: size, signed distance, sample points and mass properties. */
#ifndef RLF_PHYSICS_SHAPE_SHAPE_H
#define RLF_PHYSICS_SHAPE_SHAPE_H

#include "relief/world.h"

#define PHYS_POINTS_MAX 64

/* Half space n.p <= d of a hull's face, body frame. */
typedef struct phys_plane {
    rlf_vec3 normal;
    double offset;
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

/* RLF_OK or RLF_ERROR_INVALID with a line that names the field. */
rlf_result phys_shape_check(const rlf_shape *shape);

/* Fills `out` from a checked shape; `points` has room for PHYS_POINTS_MAX and lives as long.
 * RLF_ERROR_MEMORY when a hull's planes do not fit in memory. */
rlf_result phys_shape_init(phys_shape *out, const rlf_shape *shape, rlf_vec3 *points);
void phys_shape_finish(phys_shape *shape);

/* Signed distance of p (body frame) to the surface, negative inside, metres. out_gradient is the
 * unit direction in which it grows. Exact but for a hull outside near an edge, where it is the
 * distance to the farthest face's plane, a lower bound. */
double phys_shape_distance(const phys_shape *shape, rlf_vec3 p, rlf_vec3 *out_gradient);

/* Up to two core points of a round shape (body frame): the surface point farthest along the unit
 * `direction` is core + *out_rounding * direction. Ball: its centre; capsule: the cap centres;
 * cylinder: the two rim points, rounding 0. Returns their number; 0 for box and hull. */
int32_t phys_shape_support(const phys_shape *shape, rlf_vec3 direction, rlf_vec3 out[2],
                           double *out_rounding);

#endif
