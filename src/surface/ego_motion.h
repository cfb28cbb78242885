/* Whether the camera itself moves. */
#ifndef RLF_SURFACE_EGO_MOTION_H
#define RLF_SURFACE_EGO_MOTION_H

#include "surface/stage.h"

void rlf_ego_motion_reset(rlf_ego_motion *ego);

/* Sets stage->ego.moves by a frame's depth as it came: a plane. */
void rlf_ego_motion_watch(rlf_reconstruct *stage, const float *depth);

/* The frame that was just made may be the one that later ones are compared with. */
void rlf_ego_motion_remember(rlf_reconstruct *stage, const rlf_slot *slot);

#endif
