/* How much the depth of what does not move differs from frame to frame. */
#ifndef RELIEF_APP_INFO_STILLNESS_H
#define RELIEF_APP_INFO_STILLNESS_H

#include "info/depth_plane.h"

#define STILLNESS_FRAMES_MIN 8
#define STILLNESS_FRAMES_MAX 60
#define STILLNESS_MOST_M 0.2 /* a deviation of that is this or more */

typedef struct stillness stillness;

/* Of pixels that stay, in one range of distances. */
typedef struct stillness_bin {
    int64_t pixels;
    double median_m, most_m; /* standard deviation of half and of 90 % of the pixels, at most */
} stillness_bin;

typedef struct stillness_result {
    int32_t frames;
    double still_percent; /* of the pixels seen in nearly all frames */
    stillness_bin bins[INFO_BINS];
} stillness_result;

/* NULL without memory. */
stillness *stillness_create(const rlf_rig *rig);
void stillness_destroy(stillness **s);
/* Adds one frame, metres, 0 = missing; those after STILLNESS_FRAMES_MAX are not looked at. */
void stillness_add(stillness *s, const float *depth);
/* Without STILLNESS_FRAMES_MIN frames all is 0. */
void stillness_get(const stillness *s, stillness_result *out);

#endif
