/* The first steps of a frame: depth from the sensor's to what planes are fitted to. */
#ifndef RLF_SURFACE_DEPTH_DEPTH_H
#define RLF_SURFACE_DEPTH_DEPTH_H

#include "surface/stage.h"

/* ---- frame.c: the steps in their order ---- */
/* `raw`: depth as it came; `kept`: without mixed pixels. */
void depth_read_frame(rlf_reconstruct *stage, const rlf_frame *frame, float *raw, float *kept,
                      uint8_t *reason);
/* Says where thin things must be though `kept` has nothing. */
void depth_track_thin(rlf_reconstruct *stage, const float *kept, const rlf_slot *slot);
/* In `kept` dropped pixels are recalled, and noise is averaged over time. */
void depth_average(rlf_reconstruct *stage, const float *raw, float *kept, uint8_t *reason);
/* Small holes of the slot's depth are filled. `was_seen`: 1 where there was a depth before. */
void depth_fill(rlf_reconstruct *stage, const rlf_frame *frame, const float *kept, rlf_slot *slot,
                uint8_t *was_seen);

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
/* `raw`: the depth as it came. Pixels that are not recalled but believed after all are OK again. */
void temporal_recall(const rlf_reconstruct *stage, const float *raw, float *depth, uint8_t *reason);

/* ---- temporal_mean.c: depth that does not change is averaged over time ---- */
void temporal_mean(rlf_reconstruct *stage, float *depth, const uint8_t *reason);

/* ---- oversmooth.c ---- */
/* Takes back where a plane has put pixels of `smooth` away from what was `seen` there and about
 * them, and their normals: in blocks that may move. */
void oversmooth_undo(const rlf_reconstruct *stage, const float *seen, float *smooth,
                     float *const normal[3]);

#endif
