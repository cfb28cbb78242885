#include "surface/motion/keyframe.h"

#include <string.h>

enum { MOST_NEARER = 2 }; /* pixels of a window by which nothing is hidden */

/* Metres beyond the noise: from there on it is no longer the thing. */
#define FULL_M 0.01f
#define EMPTY_M 0.05f
/* Share of a pixel's depth that the plane's depth may change in a pixel: more is seen edge-on. */
#define STEEPEST 0.03f

bool rim_look(const image_grid *grid, const float *depth, const rlf_kernel_noise *noise, rlf_vec3 p,
              rlf_vec3 n, int32_t x, int32_t y, rim_window *out)
{
    memset(out, 0, sizeof(*out));
    if (x < RIM_RADIUS || y < RIM_RADIUS || x >= grid->width - RIM_RADIUS ||
        y >= grid->height - RIM_RADIUS) {
        return false;
    }
    /* the plane's inverse depth is even in the image */
    const double off = rlf_dot(n, p);
    const ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
    const float z = (float)p.z, least = 4.0f * rlf_kernel_sigma(*noise, z);
    float w = (float)((n.x * grid->ray_x[i] + n.y * grid->ray_y[i] + n.z) / off);
    float wx = (float)(n.x / (off * grid->camera.fx)), wy = (float)(n.y / (off * grid->camera.fy));
    const float steep = STEEPEST * w;
    wx = wx > steep ? steep : wx < -steep ? -steep : wx;
    wy = wy > steep ? steep : wy < -steep ? -steep : wy;
    int32_t nearer = 0;
    for (int32_t v = -RIM_RADIUS; v <= RIM_RADIUS; v++) {
        const float *row = depth + i + (ptrdiff_t)v * grid->width;
        for (int32_t u = -RIM_RADIUS; u <= RIM_RADIUS; u++) {
            const float d = row[u];
            const float beyond = (d * (w + wx * (float)u + wy * (float)v) - 1.0f) * z;
            const float part = (EMPTY_M + least - beyond) / (EMPTY_M - FULL_M);
            const float is = !(d > 0.0f) || part <= 0.0f ? 0.0f : part >= 1.0f ? 1.0f : part;
            nearer += d > 0.0f && beyond < -FULL_M - least ? 1 : 0;
            out->fill += is;
            out->x += is * (float)u;
            out->y += is * (float)v;
        }
    }
    return nearer <= MOST_NEARER;
}
