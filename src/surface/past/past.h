/* What was seen of the moving foreground and is not seen now. */
#ifndef RLF_SURFACE_PAST_PAST_H
#define RLF_SURFACE_PAST_PAST_H

#include "kernel/flow.h"
#include "surface/stage.h"

#define RLF_PAST_PIXELS 128 /* that are looked at together */

void rlf_past_reset(rlf_past *past, const rlf_grid *grid);

/* Where what moved in the frame before is expected now though `depth` has nothing there: sets
 * past.is_ahead and past.ahead. */
void rlf_past_predict(rlf_reconstruct *stage, const rlf_slot *slot, const float *depth);

/* Depth of the thing that is lost in a gap about pixel i, 0 = none. The gap goes along `step` from
 * one valid pixel, so many steps before i, to another one so many after it; both show what is
 * behind the thing, the nearer one at depth `nearest`. */
float rlf_past_find_lost(const rlf_reconstruct *stage, ptrdiff_t i, ptrdiff_t step,
                         const int32_t to_ends[2], float nearest);

/* Something is known to be at pixel k of this frame, at depth z, if nothing is seen there. */
void rlf_past_know(rlf_past *past, ptrdiff_t k, float z);

/* What is lost shows no motion: where none was found it goes on as before. */
void rlf_past_keep_velocity(const rlf_reconstruct *stage, rlf_slot *slot);

/* past/move.c: how points go on for dt. */
rlf_kernel_motion rlf_past_motion(const rlf_grid *grid, float dt);
/* The slot's pixels from (x, y) on. */
rlf_kernel_moving_row rlf_past_row(const rlf_grid *grid, const rlf_slot *slot, int32_t x, int32_t y,
                                   int32_t count);
/* Whether the body that pixel k of the foreground shows is at most so many pixels wide there, along
 * its row or its column. */
bool rlf_past_is_narrow(const rlf_grid *grid, const rlf_slot *slot, ptrdiff_t k, int32_t most);
/* s since the frame before; 0 when there is none, or it is too long ago to follow anything. */
float rlf_past_elapsed(const rlf_reconstruct *stage, const rlf_slot *slot);

/* Whether something is expected at pixel k. */
static inline bool rlf_past_is_ahead(const rlf_past *past, ptrdiff_t k)
{
    return (past->is_ahead[k >> 3] >> (k & 7) & 1) != 0;
}

static inline bool rlf_past_is_front(const rlf_slot *slot, ptrdiff_t k)
{
    return slot->foreground[k] != 0 && slot->depth[k] > 0.0f;
}

#endif
