/* The tolerances that this folder shares: lengths in metres, angles as cosines. */
#ifndef RLF_PHYSICS_GRID_TOLERANCE_H
#define RLF_PHYSICS_GRID_TOLERANCE_H

/* Distance kept ready for contacts that are not there yet, metres. */
#define GRID_MARGIN 0.004

/* What differs from a face by no more than this is noise, metres. */
#define GRID_NOISE_M 0.01

/* Thinner than this a solid is thin: a body may get through it between two searches, metres. */
#define GRID_THIN_M 0.05

/* Cosines between normals: of one face; nearly; square to each other, up to noise. */
#define SAME_FACE_COS 0.9
#define ASIDE_COS 0.3

#endif
