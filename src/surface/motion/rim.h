/* How much of a small window a thing fills that ends in it before something farther: from that its
 * outline is known to a part of a pixel. What continues the thing's plane is of it. */
#ifndef RLF_SURFACE_MOTION_RIM_H
#define RLF_SURFACE_MOTION_RIM_H

#include "kernel/kernel.h"
#include "surface/frame.h"

enum { RIM_RADIUS = 3, RIM_SIDE = 2 * RIM_RADIUS + 1 }; /* of a window, pixels */

/* Metres beyond a thing that what is behind it is at least. */
#define RIM_GAP_M 0.05
/* Half the pull of a straight outline through the window's middle: less is a corner. */
#define RIM_LEAST_PULL (0.5f * (float)(RIM_SIDE * RIM_SIDE * (RIM_RADIUS + 1)) / 4.0f)

typedef struct rim_window {
    float fill;      /* pixels */
    float x, y;      /* sums of their steps from the middle */
    int32_t between; /* pixels that may be the thing, or mixed, or something close behind it */
} rim_window;

/* Of the window about pixel (x, y), for a thing with normal n at p. False out of view, or where
 * something nearer is in it. */
bool rim_look(const image_grid *grid, const float *depth, const rlf_kernel_noise *noise, rlf_vec3 p,
              rlf_vec3 n, int32_t x, int32_t y, rim_window *out);

#endif
