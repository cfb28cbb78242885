/* Sums and extents of the points of a region's pixels. */
#include "kernel/kernel.h"

enum { LANES = RLF_REGION_LANES, CHUNK = 64 };

/* Of some pixels: made apart, because lanes that begin as floats are half as long. */
typedef struct region_points {
    double x[CHUNK], y[CHUNK], z[CHUNK];
} region_points;

RLF_KERNEL_PART void extend(rlf_region_lanes *restrict l, int32_t k, double x, double y, double z)
{
    l->least[0][k] = x < l->least[0][k] ? x : l->least[0][k];
    l->least[1][k] = y < l->least[1][k] ? y : l->least[1][k];
    l->least[2][k] = z < l->least[2][k] ? z : l->least[2][k];
    l->most[0][k] = x > l->most[0][k] ? x : l->most[0][k];
    l->most[1][k] = y > l->most[1][k] ? y : l->most[1][k];
    l->most[2][k] = z > l->most[2][k] ? z : l->most[2][k];
}

RLF_KERNEL_PART void add(rlf_region_lanes *restrict l, int32_t k, double x, double y, double z)
{
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

RLF_KERNEL_PART void make_points(const float *restrict depth, const float *restrict ray_x,
                                 const float *restrict ray_y, int32_t count,
                                 region_points *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        double z = depth[i];
        out->x[i] = z * ray_x[i];
        out->y[i] = z * ray_y[i];
        out->z[i] = z;
    }
}

RLF_KERNEL_PART void turn(const rlf_region_axes *a, int32_t count, region_points *restrict p)
{
    const rlf_region_axes axes = *a;
    for (int32_t i = 0; i < count; i++) {
        double x = p->x[i] - axes.origin[0], y = p->y[i] - axes.origin[1];
        double w = p->z[i] - axes.origin[2];
        p->x[i] = axes.axis[0][0] * x + axes.axis[0][1] * y + axes.axis[0][2] * w;
        p->y[i] = axes.axis[1][0] * x + axes.axis[1][1] * y + axes.axis[1][2] * w;
        p->z[i] = axes.axis[2][0] * x + axes.axis[2][1] * y + axes.axis[2][2] * w;
    }
}

RLF_KERNEL void rlf_kernel_region_row(const float *restrict depth, const float *restrict ray_x,
                                      const float *restrict ray_y, int32_t count,
                                      rlf_region_lanes *restrict lanes)
{
    rlf_region_lanes l = *lanes;
    region_points p;
    for (int32_t first = 0; first < count; first += CHUNK) {
        int32_t size = count - first < CHUNK ? count - first : CHUNK, i = 0;
        make_points(depth + first, ray_x + first, ray_y + first, size, &p);
        for (; i + LANES <= size; i += LANES) {
            RLF_KERNEL_WHOLE
            for (int32_t k = 0; k < LANES; k++) {
                add(&l, k, p.x[i + k], p.y[i + k], p.z[i + k]);
            }
        }
        for (int32_t k = 0; i + k < size; k++) {
            add(&l, k, p.x[i + k], p.y[i + k], p.z[i + k]);
        }
    }
    *lanes = l;
}

RLF_KERNEL void rlf_kernel_extent_row(const rlf_region_axes *axes, const float *restrict depth,
                                      const float *restrict ray_x, const float *restrict ray_y,
                                      int32_t count, rlf_region_lanes *restrict lanes)
{
    rlf_region_lanes l = *lanes;
    region_points p;
    for (int32_t first = 0; first < count; first += CHUNK) {
        int32_t size = count - first < CHUNK ? count - first : CHUNK, i = 0;
        make_points(depth + first, ray_x + first, ray_y + first, size, &p);
        turn(axes, size, &p);
        for (; i + LANES <= size; i += LANES) {
            RLF_KERNEL_WHOLE
            for (int32_t k = 0; k < LANES; k++) {
                extend(&l, k, p.x[i + k], p.y[i + k], p.z[i + k]);
            }
        }
        for (int32_t k = 0; i + k < size; k++) {
            extend(&l, k, p.x[i + k], p.y[i + k], p.z[i + k]);
        }
    }
    *lanes = l;
}
