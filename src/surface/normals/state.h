/* What is kept of normals from frame to frame, and planes that they need. */
#ifndef RLF_SURFACE_NORMALS_STATE_H
#define RLF_SURFACE_NORMALS_STATE_H

#include "base/arena.h"
#include "surface/frame.h"

enum { RLF_VOTE_MOST = 32 }; /* a second: as long may what was stay */

/* The normal that most frames agree on at a pixel: see normals/vote.c. */
typedef struct rlf_vote {
    float normal[3], depth; /* the candidate */
    int32_t count;          /* votes for the candidate, less those against it; 0 = there is none */
} rlf_vote;

/* How much of the noise stays in any mean: see normals/lasting.c. */
enum { RLF_LASTING_BINS = 64, RLF_LASTING_ALL = 1000 };

typedef struct rlf_lasting {
    float sigma;                     /* of inverse depth, 1/m; RLF_LASTING_ALL = not known yet */
    int32_t count[RLF_LASTING_BINS]; /* of windows, by what they leave */
    int32_t phase;                   /* which rows of windows are next */
    int32_t frame;                   /* since some were looked at */
} rlf_lasting;

/* Coarser pictures of a frame, each of half the resolution of the one before: see normals/wide.c.
 */
enum { RLF_WIDE_LEVELS = 2 };

/* Planes; NULL when they are not wanted. */
typedef struct rlf_wide {
    int32_t width, height;
    float *ray_x, *ray_y;
    float *depth, *frames, *smooth, *normal[3];
} rlf_wide;

/* See normals/vote.c; NULL planes when normals at edges are not wanted. */
typedef struct normals_votes {
    rlf_vote *votes; /* plane */
    uint8_t *watch;  /* plane: frames that a pixel votes in from now on */
} normals_votes;

/* Planes of normals/contour.c, scratch. */
typedef struct contour_scratch {
    float *normal[3]; /* where it is marked */
    uint8_t *mark, *front;
} contour_scratch;

typedef struct normals_state {
    normals_votes vote;
    rlf_lasting lasting;
    rlf_wide wide[RLF_WIDE_LEVELS];
    contour_scratch contour;
    uint8_t *bent; /* plane, scratch of normals/crease.c */
    float *front;  /* plane, scratch of normals/frame.c */
} normals_state;

void normals_allocate(normals_state *state, rlf_arena *arena, const rlf_reconstruct_def *def,
                      const image_grid *grid);
void normals_reset(normals_state *state, const image_grid *grid);

#endif
