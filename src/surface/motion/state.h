/* The planes of velocity. */
#ifndef RLF_SURFACE_MOTION_STATE_H
#define RLF_SURFACE_MOTION_STATE_H

#include "base/arena.h"
#include "surface/frame.h"
#include "surface/thickness/state.h"

/* Keyframes at a time: see motion/keyframe.h. */
enum { RLF_KEYFRAMES = 48 };

typedef struct velocity_planes {
    float *seen;                   /* plane: of the frame before; 0 between frames */
    struct rlf_cell *cells;        /* of motion/cells.c */
    uint8_t *is_steady;            /* plane, scratch */
    struct rlf_keyframe *keyframe; /* RLF_KEYFRAMES */
    bool is_taken[RLF_PIECES + 1]; /* of each of the background's things: it has one ... */
    int32_t next_thing;            /* ... or it was not yet asked, from this one on */
} velocity_planes;

void velocity_allocate(velocity_planes *state, rlf_arena *arena, const image_grid *grid);

#endif
