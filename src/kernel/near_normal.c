/* Sum of the normals about a pixel: see surface/normals/near.c. */
#include "kernel/kernel.h"

enum { SIDE = 5, LANES = RLF_NEAR_LANES };

static const float most_apart = 0.02f; /* share of the depth, of pixels of one surface */

/* Inverse fourth power of the distance: beside a crease the nearest pixels are most likely of the
 * same face. 0 beyond the window. */
static const float nearness[SIDE][LANES] = {{0.015625f, 0.04f, 0.0625f, 0.04f, 0.015625f},
                                            {0.04f, 0.25f, 1.0f, 0.25f, 0.04f},
                                            {0.0625f, 1.0f, 0.0f, 1.0f, 0.0625f},
                                            {0.04f, 0.25f, 1.0f, 0.25f, 0.04f},
                                            {0.015625f, 0.04f, 0.0625f, 0.04f, 0.015625f}};

RLF_KERNEL_PART float sum_lanes(const float *lanes)
{
    return ((lanes[0] + lanes[4]) + (lanes[1] + lanes[3])) + lanes[2];
}

RLF_KERNEL void rlf_kernel_near_normal(const rlf_kernel_near *restrict about, float *restrict out)
{
    const float *restrict depth = about->depth;
    const float *restrict nx = about->normal[0];
    const float *restrict ny = about->normal[1];
    const float *restrict nz = about->normal[2];
    ptrdiff_t stride = about->stride;
    float x[LANES], y[LANES], z[LANES], w[LANES];
    float middle = depth[2 * stride + 2], most = most_apart * middle;
    for (int32_t c = 0; c < LANES; c++) {
        float sum_x = 0.0f, sum_y = 0.0f, sum_z = 0.0f, sum_w = 0.0f;
        for (int32_t r = 0; r < SIDE; r++) {
            ptrdiff_t i = r * stride + c;
            float apart = rlf_kernel_abs(depth[i] - middle);
            float weight = apart <= most ? nearness[r][c] : 0.0f;
            sum_x += weight * nx[i];
            sum_y += weight * ny[i];
            sum_z += weight * nz[i];
            sum_w += weight * (nx[i] * nx[i] + ny[i] * ny[i] + nz[i] * nz[i]);
        }
        x[c] = sum_x;
        y[c] = sum_y;
        z[c] = sum_z;
        w[c] = sum_w;
    }
    out[0] = sum_lanes(x);
    out[1] = sum_lanes(y);
    out[2] = sum_lanes(z);
    out[3] = sum_lanes(w);
}

RLF_KERNEL void rlf_kernel_bare_row(const float *restrict depth, const float *restrict normal_z,
                                    int32_t count, uint8_t *restrict bare)
{
    for (int32_t i = 0; i < count; i++) {
        float z = depth[i], n = normal_z[i];
        bool is_bare = (z > 0.0f) & (n == 0.0f);
        bare[i] = is_bare ? 1 : 0;
    }
}
