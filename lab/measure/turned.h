/* A camera that is turned by quarters, or seen in a mirror: what is right for it is right for any.
 */
#ifndef RELIEF_APP_MEASURE_TURNED_H
#define RELIEF_APP_MEASURE_TURNED_H

#include "relief/frame.h"

enum { TURNS = 8 };

/* What turn k does to a picture, in this order: columns become rows, x runs backwards, y does. */
typedef struct turn {
    const char *name;
    bool swaps, mirrors_x, mirrors_y;
} turn;

extern const turn turns[TURNS];

/* The rig whose depth pictures are turned; it has no colour. */
rlf_rig turned_rig(const rlf_rig *rig, const turn *t);

/* Turns a frame's depth into `memory`, metres, as many as it has pixels. `rig` is turned_rig's. */
rlf_frame turned_frame(const rlf_frame *frame, const rlf_rig *rig, const turn *t, float *memory);

/* A direction in the turned camera's frame, and back. */
rlf_vec3 turned_vector(rlf_vec3 v, const turn *t);
rlf_vec3 unturned_vector(rlf_vec3 v, const turn *t);

#endif
