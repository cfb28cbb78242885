/* Where samples of a surface were a frame ago: see surface/velocity/cells.c. */
#include "kernel/flow.h"

#include "relief/surface.h"

RLF_KERNEL void rlf_kernel_front_row(const float *restrict depth, const uint8_t *restrict reason,
                                     const uint8_t *restrict front, int32_t count,
                                     float *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        out[i] = front[i] != 0 && reason[i] == RLF_REASON_OK ? depth[i] : 0.0f;
    }
}

RLF_KERNEL void rlf_kernel_flow_residuals(const rlf_kernel_flow_view *view,
                                          const rlf_kernel_flow_samples *samples,
                                          const float step[3], int32_t first, int32_t count,
                                          float *restrict out, int32_t *restrict is_seen)
{
    const rlf_kernel_flow_view w = *view;
    const float *restrict seen = w.seen;
    const float *restrict ray_x = w.ray_x;
    const float *restrict ray_y = w.ray_y;
    float sx = step[0], sy = step[1], sz = step[2];
    float right = (float)w.width - 0.5f, bottom = (float)w.height - 0.5f;
    for (int32_t i = first; i < first + count; i++) {
        float x = samples->x[i] - sx, y = samples->y[i] - sy, z = samples->z[i] - sz;
        bool is_before = z > 0.01f;
        float divisor = is_before ? z : 1.0f;
        float u = samples->column[i] + (x / divisor - samples->ray_x[i]) * w.fx;
        float v = samples->row[i] + (y / divisor - samples->ray_y[i]) * w.fy;
        bool is_in = is_before & (u > -0.5f) & (v > -0.5f) & (u < right) & (v < bottom);
        u = is_in ? u : 0.0f;
        v = is_in ? v : 0.0f;
        int32_t k = (int32_t)(v + 0.5f) * w.width + (int32_t)(u + 0.5f);
        float far = seen[k];
        float dx = x - far * ray_x[k], dy = y - far * ray_y[k], dz = z - far;
        out[i - first] = samples->nx[i] * dx + samples->ny[i] * dy + samples->nz[i] * dz;
        is_seen[i - first] = is_in & (far > 0.0f) & (rlf_kernel_abs(dz) < w.limb);
    }
}
