/* Relief: questions to a world and to the real surface: what does a ray meet, what is near a point?
 * They change nothing and allocate nothing, so threads may ask at once while nobody changes the
 * world or the grid. Values that are not finite and radii <= 0 give RLF_QUERY_INVALID.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_QUERY_H
#define RELIEF_QUERY_H

#include "relief/world.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Why a question has the answer it has. All but HIT say that nothing was met, and what is known of
 * the real world at the end of the ray or at the centre of the sphere. */
typedef enum rlf_query_reason {
    RLF_QUERY_MISS = 0,       /* free space that the camera sees, or no grid was given */
    RLF_QUERY_HIT = 1,        /* a body or the real surface */
    RLF_QUERY_OUTSIDE_VIEW,   /* the camera does not look there */
    RLF_QUERY_MISSING_DEPTH,  /* it does, but its pixel has no depth */
    RLF_QUERY_BEHIND_SURFACE, /* hidden behind what it sees */
    RLF_QUERY_INVALID         /* an argument is not finite or not positive */
} rlf_query_reason;

/* What a ray met first. */
typedef struct rlf_ray_hit {
    rlf_query_reason reason; /* HIT, or why nothing was met */
    rlf_contact_other other; /* what was hit; this and all below only when reason is HIT */
    rlf_body_id body;        /* null unless other is RLF_CONTACT_BODY */
    int32_t region_label;    /* of the surface; 0 for a body */
    double distance;         /* metres from the ray's origin */
    rlf_vec3 point, normal;  /* world; the normal is unit and points out of what was hit. A ray that
                                starts inside hits at distance 0 with the normal -direction */
} rlf_ray_hit;

/* First thing within `length` metres on the ray from `origin` along `direction` (world; need not be
 * unit). Bodies are where the last advance left them, the surface where `grid` shows it, without
 * extrapolation; grid NULL asks the bodies alone. Surface hits are exact to about a pixel across
 * the ray. */
RLF_API rlf_ray_hit rlf_world_cast_ray(const rlf_world *world, const rlf_grid *grid,
                                       rlf_vec3 origin, rlf_vec3 direction, double length);

/* What a sphere holds. The real surface counts where a part of it, or of the solid behind it, lies
 * within the sphere. */
typedef struct rlf_overlap {
    rlf_query_reason reason; /* HIT when anything overlaps */
    int32_t body_count;      /* bodies that overlap; may be more than the list holds */
    bool touches_background, touches_foreground; /* the real surface's two sheets */
} rlf_overlap;

/* What overlaps the sphere of `radius` metres at `centre` (world). The ids of the first `capacity`
 * bodies, in the order of their slots, go to `ids`, which may be NULL when capacity is 0. The
 * cost grows with the pixels that the sphere covers. */
RLF_API rlf_overlap rlf_world_overlap_sphere(const rlf_world *world, const rlf_grid *grid,
                                             rlf_vec3 centre, double radius, rlf_body_id *ids,
                                             int32_t capacity);

/* HIT when two shapes in the given poses overlap or touch, MISS when there is a gap between them,
 * INVALID for NULL, a shape that a body def could not have or a pose that is not finite. Exact to
 * 1e-7 m for any two kinds of shapes. Source: GJK (Gilbert, Johnson and Keerthi 1988). Thread-
 * safety: safe. */
RLF_API rlf_query_reason rlf_shapes_overlap(const rlf_shape *a, const rlf_pose *T_world_a,
                                            const rlf_shape *b, const rlf_pose *T_world_b);

#ifdef __cplusplus
}
#endif
#endif
