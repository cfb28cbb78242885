/* The planes of velocity. */
#ifndef RLF_SURFACE_MOTION_STATE_H
#define RLF_SURFACE_MOTION_STATE_H

#include "surface/arena.h"
#include "surface/frame.h"

typedef struct velocity_planes {
    float *seen;            /* plane: of the frame before; 0 between frames */
    struct rlf_cell *cells; /* of motion/cells.c */
    uint8_t *is_steady;     /* plane, scratch */
    uint8_t *is_contour;    /* plane, scratch: a region's outline may be here */
} velocity_planes;

void velocity_allocate(velocity_planes *state, rlf_arena *arena, const image_grid *grid);

#endif
