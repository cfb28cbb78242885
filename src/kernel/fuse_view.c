/* What a view says, pixel by pixel: the plane at each, and how far space is surely free. */
#include "kernel/fuse.h"

/* Cosine of the steepest slant of a ray on a surface that is fused: 80 degrees. */
static const float least_facing = 0.17f;

RLF_KERNEL void rlf_kernel_fuse_planes(const rlf_fuse_row *row, const float *restrict nx,
                                       const float *restrict ny, const float *restrict nz,
                                       int32_t count, rlf_fuse_plane *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        float z = row->depth[i], x = row->ray_x[i], y = row->ray_y[i];
        float along = nx[i] * x + ny[i] * y + nz[i]; /* < 0 on faces towards the camera */
        float length = sqrtf(x * x + y * y + 1.0f);
        bool is_fused = (z > 0.0f) & (along < -least_facing * length);
        is_fused &= row->is_static == NULL || row->is_static[i] != 0;
        out[i].x = is_fused ? nx[i] : 0.0f;
        out[i].y = is_fused ? ny[i] : 0.0f;
        out[i].z = is_fused ? nz[i] : 0.0f;
        out[i].offset = is_fused ? z * along : 0.0f;
    }
}

/* Whether b goes on from a: within the noise of both, and no steeper than a ray at 80 degrees. */
RLF_KERNEL_PART bool goes_on(float a, float b, float apart, float sigma)
{
    float off = rlf_kernel_abs(a - b);
    return (a > 0.0f) & (b > 0.0f) & (off < 6.0f * a * apart + 4.0f * sigma);
}

RLF_KERNEL void rlf_kernel_fuse_normals(const rlf_fuse_row *row, int32_t count, float *restrict nx,
                                        float *restrict ny, float *restrict nz)
{
    for (int32_t i = 0; i < count; i++) {
        int32_t l = i < 2 ? 0 : i - 2, r = i + 2 < count ? i + 2 : count - 1;
        float z = row->depth[i], sigma = rlf_kernel_sigma(row->noise, z);
        float wide = row->ray_x[r] - row->ray_x[l],
              high = row->ray_y_below[i] - row->ray_y_above[i];
        bool to_l = goes_on(z, row->depth[l], wide, sigma),
             to_r = goes_on(z, row->depth[r], wide, sigma);
        bool to_a = goes_on(z, row->above[i], high, sigma),
             to_b = goes_on(z, row->below[i], high, sigma);
        float zl = to_l ? row->depth[l] : z, zr = to_r ? row->depth[r] : z;
        float za = to_a ? row->above[i] : z, zb = to_b ? row->below[i] : z;
        int32_t cl = to_l ? l : i, cr = to_r ? r : i;
        float ax = zr * row->ray_x[cr] - zl * row->ray_x[cl];
        float ay = zr * row->ray_y[cr] - zl * row->ray_y[cl], az = zr - zl;
        float tx = to_a ? row->ray_x_above[i] : row->ray_x[i];
        float ty = to_a ? row->ray_y_above[i] : row->ray_y[i];
        float ux = to_b ? row->ray_x_below[i] : row->ray_x[i];
        float uy = to_b ? row->ray_y_below[i] : row->ray_y[i];
        float bx = zb * ux - za * tx, by = zb * uy - za * ty, bz = zb - za;
        /* Right across down looks forward: turned round, towards the camera. */
        float x = az * by - ay * bz, y = ax * bz - az * bx, n = ay * bx - ax * by;
        float size = sqrtf(x * x + y * y + n * n);
        float scale = (z > 0.0f) & (size > 0.0f) ? 1.0f / (size > 0.0f ? size : 1.0f) : 0.0f;
        nx[i] = x * scale;
        ny[i] = y * scale;
        nz[i] = n * scale;
    }
}

RLF_KERNEL void rlf_kernel_fuse_least_row(const float *restrict depth, int32_t count,
                                          float *restrict out)
{
    for (int32_t i = 1; i + 1 < count; i++) {
        float a = depth[i - 1] < depth[i] ? depth[i - 1] : depth[i];
        out[i] = a < depth[i + 1] ? a : depth[i + 1];
    }
    out[0] = 0.0f;
    out[count - 1] = 0.0f;
}

RLF_KERNEL void rlf_kernel_fuse_least(const float *restrict a, const float *restrict b,
                                      const float *restrict c, int32_t count, float *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        float least = a[i] < b[i] ? a[i] : b[i];
        out[i] = least < c[i] ? least : c[i];
    }
}
