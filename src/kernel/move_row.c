/* Where the pixels of a row that move are a little later. */
#include "kernel/flow.h"

enum { CHUNK = 128 };

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

RLF_KERNEL void rlf_kernel_away_row(const rlf_kernel_moving_row *in, const float *const normal[3],
                                    float cosine, uint8_t *restrict away)
{
    const float *restrict nx = normal[0];
    const float *restrict ny = normal[1];
    const float *restrict nz = normal[2];
    const float *restrict depth = in->depth;
    const float *restrict ray_x = in->ray_x;
    const float *restrict ray_y = in->ray_y;
    const float *restrict vx = in->velocity[0];
    const float *restrict vy = in->velocity[1];
    const float *restrict vz = in->velocity[2];
    const uint8_t *restrict foreground = in->foreground;
    for (int32_t first = 0; first < in->count; first += CHUNK) {
        int32_t count = in->count - first < CHUNK ? in->count - first : CHUNK, is_away[CHUNK];
        for (int32_t k = 0; k < count; k++) {
            int32_t i = first + k;
            float along = nx[i] * ray_x[i] + ny[i] * ray_y[i] + nz[i];
            float length2 = ray_x[i] * ray_x[i] + ray_y[i] * ray_y[i] + 1.0f;
            float square = vx[i] * vx[i] + vy[i] * vy[i] + vz[i] * vz[i];
            int32_t moves = square > 0.0f ? 1 : 0, has_depth = depth[i] > 0.0f ? 1 : 0;
            is_away[k] = moves & has_depth & (along * along < cosine * cosine * length2 ? 1 : 0);
        }
        for (int32_t k = 0; k < count; k++) { /* apart, because bytes make longer vectors */
            away[first + k] = (uint8_t)(is_away[k] & (foreground[first + k] != 0 ? 1 : 0));
        }
    }
}
