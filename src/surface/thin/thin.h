/* Thin things that move, and are lost at times: a book in a hand, seen edge-on.
 *
 * A driver takes a band away on both sides of an edge; where a thing is a few pixels wide, the
 * bands meet and nothing of it is left. And what is seen of its edge does not say how far it goes
 * on behind that. So flat things are followed as boxes (slab.h), and what is narrow goes on as it
 * moved (lost.c). Once a frame thin_track says where both must be though nothing is seen; the hole
 * filling asks for it, and thin_write tells what a slab is known to be where it is seen. */
#ifndef RLF_SURFACE_THIN_THIN_H
#define RLF_SURFACE_THIN_THIN_H

#include "surface/stage.h"

/* What a frame is tracked from. Depth as the sensor gave it, mixed pixels off. */
typedef struct thin_in {
    const rlf_grid *grid;
    const rlf_depth_noise *noise;
    const rlf_slot *before; /* the surface of the frame before; NULL = there is none */
    float dt;               /* s since then; 0 = too long to follow anything */
    const float *depth;     /* plane */
    uint8_t *visited;       /* plane, scratch */
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
void thin_keep_velocity(const thin *state, const rlf_slot *before, const rlf_grid *grid,
                        rlf_slot *slot);
/* Makes the pixels of the slabs as thick as these are there and, edge-on, as fast. `behind`: depth
 * of the background, a plane. */
void thin_write(const thin *state, const rlf_grid *grid, const float *behind, rlf_slot *slot);

void thin_reset(thin *state, const rlf_grid *grid);

/* Whether something is expected at pixel k. */
static inline bool thin_is_expected(const thin *state, ptrdiff_t k)
{
    return state->expected_count > 0 && state->expected[k].depth > 0.0f;
}

#endif
