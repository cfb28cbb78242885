/* Thin things that move, and are lost at times: a book in a hand, seen edge-on.
 *
 * A driver takes a band away on both sides of an edge; where a thing is a few pixels wide, the
 * bands meet and nothing of it is left. And what is seen of its edge does not say how far it goes
 * on behind that. So flat things are followed as boxes (slab.h), and what is narrow goes on as it
 * moved (lost.c). Once a frame thin_track says where both must be though nothing is seen; the hole
 * filling asks for it, and thin_write tells what a slab is known to be where it is seen. */
#ifndef RLF_SURFACE_THIN_THIN_H
#define RLF_SURFACE_THIN_THIN_H

#include "base/arena.h"
#include "surface/frame.h"

/* Metres. What is farther off is another thing; half a slab's width at least, and its thickness at
 * most. */
#define THIN_STEP_M 0.04
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

/* A thing that must be where nothing is seen. */
typedef struct thin_expected {
    float depth;   /* 0 = none */
    int32_t from;  /* its pixel in the frame before */
    int32_t ticks; /* 1/100 s in which it was not seen */
} thin_expected;

/* NULL planes when they are not wanted. */
typedef struct thin {
    slab item[SLABS];
    int32_t count;
    int32_t frame;           /* of some, see thin/find.c */
    int32_t region;          /* of the foreground at which the next search begins */
    int32_t *patch;          /* SLAB_PATCH pixels */
    thin_expected *expected; /* plane */
    int32_t *expected_pixel; /* where there is something in it */
    int32_t expected_count;
    uint8_t *lost_ticks; /* plane: `ticks` of what a gap was filled with */
    int32_t *lost_from;  /* plane: and `from` */
    uint8_t *visited;    /* plane, scratch of thin/find.c */
} thin;

/* What a frame is tracked from. Depth as the sensor gave it, mixed pixels off. */
typedef struct thin_in {
    const image_grid *grid;
    const rlf_depth_noise *noise;
    const rlf_slot *before; /* the surface of the frame before; NULL = there is none */
    float dt;               /* s since then; 0 = too long to follow anything */
    const float *depth;     /* plane */
} thin_in;

/* Finds, follows and forgets slabs; says where they and what else is narrow must be. */
void thin_track(const thin_in *in, thin *state);

/* Depth of the thing that is lost in a gap about pixel i, 0 = none. The gap goes along `step` from
 * one valid pixel, so many steps before i, to another one so many after it; both show what is
 * behind the thing, the nearer one at depth `nearest`. Pixels of other rows may be asked at the
 * same time. */
float thin_find_lost(const thin *state, ptrdiff_t i, ptrdiff_t step, const int32_t to_ends[2],
                     float nearest);

/* What is lost shows no motion: where none was found it goes on as `before`. */
void thin_keep_velocity(const thin *state, const rlf_slot *before, const image_grid *grid,
                        rlf_slot *slot);
/* Makes the pixels of the slabs as thick as these are there and, edge-on, as fast. `behind`: depth
 * of the background, a plane. */
void thin_write(const thin *state, const image_grid *grid, const float *behind, rlf_slot *slot);

void thin_allocate(thin *state, rlf_arena *arena, const rlf_reconstruct_def *def,
                   const image_grid *grid);
void thin_reset(thin *state, const image_grid *grid);

/* Whether something is expected at pixel k. */
static inline bool thin_is_expected(const thin *state, ptrdiff_t k)
{
    return state->expected_count > 0 && state->expected[k].depth > 0.0f;
}

#endif
