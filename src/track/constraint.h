/* Which direction of motion the points determine least. */
#ifndef RLF_TRACK_CONSTRAINT_H
#define RLF_TRACK_CONSTRAINT_H

#include "track/normal_equations.h"

/* Directions are unit vectors in the prediction's frame. */
typedef struct track_constraint {
    double share[3]; /* of all information, for each direction; the rotation is free */
    rlf_vec3 way[3];
} track_constraint;

/* Eigenvalues of what is left of the translation's part after the rotation is eliminated (Schur
 * complement), as shares of the information. Sum at most 1. */
track_constraint track_constraint_of(const track_sums *sums);

#endif
