/* Where the pixels of a row that move are a little later. */
#include "kernel/flow.h"

RLF_KERNEL void rlf_kernel_move_row(const rlf_kernel_motion *motion,
                                    const rlf_kernel_moving_row *in, const float *restrict seen,
                                    float *restrict z, int32_t *restrict to)
{
    const rlf_kernel_motion m = *motion;
    const float *restrict depth = in->depth;
    const float *restrict ray_x = in->ray_x;
    const float *restrict ray_y = in->ray_y;
    const float *restrict vx = in->velocity[0];
    const float *restrict vy = in->velocity[1];
    const float *restrict vz = in->velocity[2];
    const uint8_t *restrict foreground = in->foreground;
    int32_t x0 = in->x, count = in->count;
    float row = (float)in->y;
    for (int32_t i = 0; i < count; i++) {
        float at = depth[i], square = vx[i] * vx[i] + vy[i] * vy[i] + vz[i] * vz[i];
        bool moves = (square > 0.0f) & (at > m.least_z);
        at = moves ? at : 1.0f;
        rlf_kernel_point p = {at * ray_x[i], at * ray_y[i], at, (float)(x0 + i), row};
        p = rlf_kernel_move(&m, p, vx[i], vy[i], vz[i]);
        int32_t pixel = rlf_kernel_pixel_of(&m, &p);
        z[i] = p.z;
        to[i] = moves ? pixel : -1;
    }
    for (int32_t i = 0; i < count; i++) { /* apart: it reads here and there, and bytes */
        int32_t pixel = foreground[i] != 0 ? to[i] : -1;
        to[i] = seen[pixel < 0 ? 0 : pixel] > 0.0f ? -1 : pixel;
    }
}
