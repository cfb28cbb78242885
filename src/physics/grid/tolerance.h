/* The tolerances that this folder shares. Lengths are multiples of these, angles are cosines. */
#ifndef RLF_PHYSICS_GRID_TOLERANCE_H
#define RLF_PHYSICS_GRID_TOLERANCE_H

/* Distance kept ready for contacts that are not there yet, metres. */
#define GRID_MARGIN 0.004

/* What differs from a face by no more than this is noise, metres. */
#define GRID_NOISE_M 0.01

/* How far a body or a surface goes at 10 m/s between two searches, and some, metres. What is
 * thinner is thin. */
#define GRID_THIN_M 0.05

/* Cosines between normals: */
#define ONE_PLANE_COS 0.97 /* of one plane */
#define ONE_FACE_COS 0.95  /* side by side on a face that may be curved */
#define SAME_FACE_COS 0.9  /* of one face, with noise; of one direction of contact */
#define NOISY_FACE_COS 0.8 /* the same beside an edge */
#define APART_COS 0.7      /* what bends less may be one round face */
#define ASIDE_COS 0.3      /* square to each other, up to noise */

/* Cosine between a face's normal and the view ray: a face that is seen at a lower angle has no
 * plane that the ray meets. */
#define GRAZING_COS 0.02

#endif
