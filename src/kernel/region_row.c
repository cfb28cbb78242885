/* Sums and extents of the points of a region's pixels. */
#include "kernel/kernel.h"

enum { LANES = RLF_REGION_LANES };

RLF_KERNEL_PART void extend(rlf_region_lanes *restrict l, int32_t k, double x, double y, double z)
{
    l->least[0][k] = x < l->least[0][k] ? x : l->least[0][k];
    l->least[1][k] = y < l->least[1][k] ? y : l->least[1][k];
    l->least[2][k] = z < l->least[2][k] ? z : l->least[2][k];
    l->most[0][k] = x > l->most[0][k] ? x : l->most[0][k];
    l->most[1][k] = y > l->most[1][k] ? y : l->most[1][k];
    l->most[2][k] = z > l->most[2][k] ? z : l->most[2][k];
}

RLF_KERNEL_PART void add(rlf_region_lanes *restrict l, int32_t k, double z, double ray_x,
                         double ray_y)
{
    double x = z * ray_x, y = z * ray_y;
    extend(l, k, x, y, z);
    l->sum[0][k] += x;
    l->sum[1][k] += y;
    l->sum[2][k] += z;
    l->square[0][k] += x * x;
    l->square[1][k] += x * y;
    l->square[2][k] += x * z;
    l->square[3][k] += y * y;
    l->square[4][k] += y * z;
    l->square[5][k] += z * z;
}

RLF_KERNEL_PART void turn(const rlf_region_axes *a, rlf_region_lanes *restrict l, int32_t k,
                          double z, double ray_x, double ray_y)
{
    double x = z * ray_x - a->origin[0], y = z * ray_y - a->origin[1], w = z - a->origin[2];
    extend(l, k, a->axis[0][0] * x + a->axis[0][1] * y + a->axis[0][2] * w,
           a->axis[1][0] * x + a->axis[1][1] * y + a->axis[1][2] * w,
           a->axis[2][0] * x + a->axis[2][1] * y + a->axis[2][2] * w);
}

RLF_KERNEL void rlf_kernel_region_row(const float *restrict depth, const float *restrict ray_x,
                                      const float *restrict ray_y, int32_t count,
                                      rlf_region_lanes *restrict lanes)
{
    rlf_region_lanes l = *lanes;
    int32_t i = 0;
    for (; i + LANES <= count; i += LANES) {
        RLF_KERNEL_WHOLE
        for (int32_t k = 0; k < LANES; k++) {
            add(&l, k, depth[i + k], ray_x[i + k], ray_y[i + k]);
        }
    }
    for (int32_t k = 0; i + k < count; k++) {
        add(&l, k, depth[i + k], ray_x[i + k], ray_y[i + k]);
    }
    *lanes = l;
}

RLF_KERNEL void rlf_kernel_extent_row(const rlf_region_axes *axes, const float *restrict depth,
                                      const float *restrict ray_x, const float *restrict ray_y,
                                      int32_t count, rlf_region_lanes *restrict lanes)
{
    const rlf_region_axes a = *axes;
    rlf_region_lanes l = *lanes;
    int32_t i = 0;
    for (; i + LANES <= count; i += LANES) {
        RLF_KERNEL_WHOLE
        for (int32_t k = 0; k < LANES; k++) {
            turn(&a, &l, k, depth[i + k], ray_x[i + k], ray_y[i + k]);
        }
    }
    for (int32_t k = 0; i + k < count; k++) {
        turn(&a, &l, k, depth[i + k], ray_x[i + k], ray_y[i + k]);
    }
    *lanes = l;
}
