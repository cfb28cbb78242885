/* The first steps of a frame: depth from the sensor's to what planes are fitted to. */
#ifndef RLF_SURFACE_DEPTH_DEPTH_H
#define RLF_SURFACE_DEPTH_DEPTH_H

#include "surface/stage.h"

/* ---- read.c: eq. 4.1 ---- */
/* Raw depth of the frame, every factor-th pixel, to metres with reasons. */
void depth_read(const rlf_reconstruct *stage, const rlf_frame *frame, float *raw, uint8_t *reason);

/* ---- flying.c ---- */
/* Depth without mixed pixels. */
void flying_remove(const rlf_reconstruct *stage, const float *raw, float *depth, uint8_t *reason);

/* ---- temporal_recall.c: dropped pixels from memory; `depth` holds what was seen ---- */
/* Something has moved about pixel (x, y) lately, up to the frame before; false in the first frames,
 * which cannot tell, and always true without averaging over time. */
bool temporal_may_move(const rlf_reconstruct *stage, int32_t x, int32_t y);
/* The next pixels of row y, from x on, of which that is true; x0 = x1 when there are none. */
rlf_span temporal_next_moving(const rlf_reconstruct *stage, int32_t x, int32_t y);
/* `raw`: the depth as it came. Pixels that are not recalled but believed after all are OK again.
 * `change`: a plane, scratch. */
void temporal_recall(const rlf_reconstruct *stage, const float *raw, float *depth, uint8_t *reason,
                     uint8_t *change);

/* ---- temporal_mean.c: depth that does not change is averaged over time ---- */
/* `lag`: a plane, scratch. */
void temporal_mean(rlf_reconstruct *stage, float *depth, const uint8_t *reason, int8_t *lag);
void temporal_reset(rlf_steady *steady, int32_t count);

/* ---- oversmooth.c ---- */
/* Takes back where a plane has put pixels of `smooth` away from what was `seen` there and about
 * them, and their normals: in blocks that may move. */
void oversmooth_undo(const rlf_reconstruct *stage, const float *seen, float *smooth,
                     float *const normal[3]);

#endif
