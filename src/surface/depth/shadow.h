/* Where the sensor's own shadow lies beside near things: see shadow.c. */
#ifndef RLF_SURFACE_DEPTH_SHADOW_H
#define RLF_SURFACE_DEPTH_SHADOW_H

#include "base/arena.h"
#include "surface/frame.h"

/* The shadow that the sensor's projector leaves beside near things: see shadow.c. Two sides of a
 * thing: left, right. */
enum { RLF_SHADOW_BINS = 32 };

typedef struct rlf_shadow {
    float told[2][RLF_SHADOW_BINS]; /* by how many runs without depth, per baseline */
    float baseline[2];              /* metres; 0 = none there */
    bool is_known;                  /* enough was told */
    int32_t next_row;               /* the first that is asked next */
} rlf_shadow;

/* The side of a near thing on which it lies. */
typedef enum rlf_shadow_side { RLF_SHADOW_LEFT = 0, RLF_SHADOW_RIGHT = 1 } rlf_shadow_side;

void rlf_shadow_reset(rlf_shadow *shadow);
/* Reads some rows of a frame's depth as it was seen, before holes are filled. */
void rlf_shadow_learn(rlf_reconstruct *stage, const float *depth);
/* Pixels; while the sensor is not known, as wide as of any, on both sides. */
float rlf_shadow_width(const rlf_reconstruct *stage, rlf_shadow_side side, float near_z,
                       float far_z);

#endif
