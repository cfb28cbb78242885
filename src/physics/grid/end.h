/* Where the face ends that a ball all but touches. */
#ifndef RLF_PHYSICS_GRID_END_H
#define RLF_PHYSICS_GRID_END_H

#include "physics/grid/corner.h"

/* On a line from `begin` to `end` about its point under the ball's centre; where faces meet, the
 * corner instead. */
typedef struct patch_end {
    patch_corner corner;   /* of one face or none: the line */
    rlf_vec3 point, along; /* unit */
    double begin, end;     /* metres along; both 0: a point */
} patch_end;

/* Replaces the mean's plane by the one near the nearest sample that holds most samples. */
void patch_find_face(const grid_patch *p, patch_mean *mean);

/* The end of a face that ends before its point under the ball's centre; the nearest sample where it
 * is on no line. Pixels that are no averages over time are not asked for their planes' corner. */
void patch_find_end(const grid_patch *p, const patch_mean *mean, bool is_averaged, patch_end *out);

/* The end's point that is nearest to the ball's centre. */
rlf_vec3 patch_end_nearest(const patch_end *end, rlf_vec3 centre);

#endif
