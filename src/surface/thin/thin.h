/* Thin things that move, and are lost at times: a book in a hand, seen edge-on.
 *
 * A driver takes a band away on both sides of an edge; where a thing is a few pixels wide, the
 * bands meet and nothing of it is left. And what is seen of its edge does not say how far it goes
 * on behind that. So flat things are followed as boxes (slab.h). Once a frame thin_track says where
 * they must be though nothing is seen; the hole filling asks for it, and thin_write tells what a
 * slab is known to be where it is seen. */
#ifndef RLF_SURFACE_THIN_THIN_H
#define RLF_SURFACE_THIN_THIN_H

#include "base/arena.h"
#include "surface/frame.h"

/* Metres. What is farther off is another thing; half a slab's width at least, and its thickness at
 * most. */
#define THIN_STEP_M 0.04
/* Metres: what is seen so near a slab is it. */
#define THIN_NEAR_M 0.03
/* Metres: nothing is seen nearer than this. */
#define THIN_LEAST_Z 0.1

/* A thin flat thing that moves, as a box: see slab.h. */
enum { SLAB_UNKNOWNS = 9, SLABS = 4, SLAB_PATCH = 4096 };

typedef struct slab {
    rlf_pose pose;                              /* T_camera_slab; its face is square to z */
    double half[3];                             /* half its extents, metres */
    rlf_vec3 speed, spin;                       /* m/s, rad/s */
    double doubt[SLAB_UNKNOWNS][SLAB_UNKNOWNS]; /* covariance of place, rotation and `half` */
    double age_s, lost_s, passed_s; /* since it was found; since it was seen; how long the camera
                                       has seen past it */
} slab;

/* NULL planes when they are not wanted. */
typedef struct thin {
    slab item[SLABS];
    int32_t count;
    int32_t frame;           /* of some, see thin/find.c */
    int32_t region;          /* of the foreground at which the next search begins */
    int32_t *patch;          /* SLAB_PATCH pixels */
    float *expected;         /* plane: depth of the slab that must be there; 0 = none */
    int32_t *expected_pixel; /* where there is one */
    int32_t expected_count;
    uint8_t *visited; /* plane, scratch of thin/find.c */
} thin;

/* What a frame is tracked from. Depth as the sensor gave it, mixed pixels off. */
typedef struct thin_in {
    const image_grid *grid;
    const rlf_depth_noise *noise;
    const rlf_slot *before; /* the surface of the frame before; NULL = there is none */
    float dt;               /* s since then; 0 = too long to follow anything */
    const float *depth;     /* plane */
} thin_in;

/* Finds, follows and forgets slabs; says where they must be though nothing is seen. */
void thin_track(const thin_in *in, thin *state);

/* Depth of the slab that is lost at pixel i of a gap, whose nearer end is at depth `nearest`; 0 =
 * none. */
float thin_find_lost(const thin *state, ptrdiff_t i, float nearest);

/* Makes the pixels of the slabs as thick as these are there and, edge-on, as fast. `behind`: depth
 * of the background, a plane. */
void thin_write(const thin *state, const image_grid *grid, const float *behind, rlf_slot *slot);

void thin_allocate(thin *state, rlf_arena *arena, const rlf_reconstruct_def *def,
                   const image_grid *grid);
void thin_reset(thin *state, const image_grid *grid);

/* Whether something is expected at pixel k. */
static inline bool thin_is_expected(const thin *state, ptrdiff_t k)
{
    return state->expected_count > 0 && state->expected[k] > 0.0f;
}

#endif
