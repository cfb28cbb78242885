/* A frame's depth in metres, and how far two neighbours may differ on one surface. */
#ifndef RELIEF_APP_INFO_DEPTH_PLANE_H
#define RELIEF_APP_INFO_DEPTH_PLANE_H

#include "relief/frame.h"

/* Of a range of distances that are told apart. */
#define INFO_BINS 10
#define INFO_BIN_M                                                                                 \
    0.5 /* bin b is from b / 2 to (b + 1) / 2 metres; the last one takes the rest                  \
         */

static inline int32_t info_bin(double z)
{
    const int32_t bin = (int32_t)(z / INFO_BIN_M);
    return bin < INFO_BINS - 1 ? bin : INFO_BINS - 1;
}

/* Rows of width * height metres; 0 = missing. What is out of the rig's range stays. */
void info_depth_plane(const rlf_frame *frame, float *out);

/* Depth difference over `pixels` pixels that a surface tilted by up to 63 degrees (a slope of 2)
 * and its noise explain, metres; what differs by more is a depth step. */
static inline double info_step(const rlf_rig *rig, double z, int32_t pixels)
{
    return 6.0 * rlf_depth_noise_sigma(&rig->noise, z) + 2.0 * pixels * z / rig->depth.fx;
}

#endif
