/* The solids that the synthetic room is made of: where a ray enters and leaves them, and how far a
 * point is from them. Both in closed form (the ellipsoid's distance by a safeguarded Newton
 * iteration), so that one can be checked against the other. */
#ifndef RLF_SIM_SHAPE_H
#define RLF_SIM_SHAPE_H

#include "relief/math.h"

typedef enum synth_shape_type {
    SYNTH_HALF_SPACE = 0, /* local y >= 0: solid below the plane y = 0 */
    SYNTH_BOX = 1,        /* |local| <= size */
    SYNTH_CONE = 2,       /* round cone: hull of two spheres, at 0 and at (0, length, 0) */
    SYNTH_ELLIPSOID = 3,  /* |local / size| <= 1 */
    SYNTH_FRUSTUM = 4     /* flat ends: discs at 0 and at (0, length, 0), straight between */
} synth_shape_type;

typedef struct synth_shape {
    synth_shape_type type;
    rlf_pose T_camera_shape;
    rlf_vec3 size;             /* half extents or radii, metres */
    double length;             /* of the axis, metres; of a round cone > |radius_a - radius_b| */
    double radius_a, radius_b; /* of a cone's spheres or discs at local y = 0 and y = length */
} synth_shape;

/* Where a ray is inside a solid: origin + t direction for near <= t <= far. */
typedef struct synth_interval {
    double near, far;
} synth_interval;

/* A ray in the camera frame; the direction need not be of unit length. */
typedef struct synth_ray {
    rlf_vec3 origin, direction;
} synth_ray;

/* False when the ray's line misses the solid. near may be negative. */
bool synth_shape_intersect(const synth_shape *shape, const synth_ray *ray, synth_interval *out);

/* The same for rays that begin at one place, `o` in the shape's frame. */
bool synth_shape_meet(const synth_shape *shape, rlf_vec3 o, rlf_vec3 direction,
                      synth_interval *out);

/* Outward unit normal at a point on (or very near) the surface. */
rlf_vec3 synth_shape_normal(const synth_shape *shape, rlf_vec3 p);

/* Signed distance from p, negative inside, and the outward unit normal at the nearest point. */
double synth_shape_distance(const synth_shape *shape, rlf_vec3 p, rlf_vec3 *out_normal);

/* The distance alone. */
double synth_shape_gap(const synth_shape *shape, rlf_vec3 p);

/* Radius of a sphere about out_centre that encloses the solid; 1e9 for the half space. */
double synth_shape_bound(const synth_shape *shape, rlf_vec3 *out_centre);

#endif
