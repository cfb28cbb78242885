/* Convex shapes known by their farthest points: how far two of them are apart, how deep one is in
 * the other. A shape is a core and a rounding: a ball is a point, a capsule a segment, both with
 * their radius about them; the others are their own cores. */
#ifndef RLF_PHYSICS_SHAPE_CONVEX_H
#define RLF_PHYSICS_SHAPE_CONVEX_H

#include "relief/snapshot.h"

/* A shape's core where it is. Coordinates are relative to an origin near both shapes of a pair. */
typedef struct convex_core {
    const rlf_shape *shape;
    rlf_mat3 R;  /* shape frame to the pair's */
    rlf_vec3 at; /* of the shape's origin, metres */
} convex_core;

/* A corner of the difference a - b and the two points that it comes from. */
typedef struct convex_corner {
    rlf_vec3 on_a, on_b, p; /* p = on_a - on_b */
} convex_corner;

typedef struct convex_simplex {
    convex_corner corner[4];
    double weight[4]; /* of the point that is nearest to the origin */
    int32_t count;
} convex_simplex;

/* The nearest points of two cores, or the deepest ones. */
typedef struct convex_gap {
    rlf_vec3 on_a, on_b;
    rlf_vec3 normal; /* unit, from b to a */
    double distance; /* metres, negative when the cores overlap */
} convex_gap;

/* Radius about the core, metres. */
double convex_rounding(const rlf_shape *shape);

/* Point of the core that is farthest along d (need not be of unit length), shape frame. */
rlf_vec3 convex_farthest(const rlf_shape *shape, rlf_vec3 d);

/* Corner of the difference that is farthest along d. */
convex_corner convex_difference(const convex_core *a, const convex_core *b, rlf_vec3 d);

/* Distance of the cores (Gilbert, Johnson and Keerthi 1988; the nearest part of the simplex by
 * Ericson 2005, 5.1). False when they overlap, or touch to within rounding: `simplex` is then what
 * holds the origin. Of cores that are farther apart than `enough` a lower bound above it may be
 * told. */
bool convex_distance(const convex_core *a, const convex_core *b, double enough, convex_gap *out,
                     convex_simplex *simplex);

/* The point of a triangle that is nearest to the origin (Ericson 2005, 5.1.5). */
rlf_vec3 convex_nearest_of_triangle(const rlf_vec3 corner[3]);

/* How deep two cores overlap, from the simplex that convex_distance left (van den Bergen 2001, the
 * expanding polytope). False when neither core has a volume. */
bool convex_depth(const convex_core *a, const convex_core *b, const convex_simplex *simplex,
                  convex_gap *out);

#endif
