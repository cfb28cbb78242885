/* Where samples of a surface were a frame ago: see surface/motion/cells.c. */
#include "kernel/flow.h"

#include "relief/surface.h"

RLF_KERNEL void rlf_kernel_front_row(const float *restrict depth, const uint8_t *restrict reason,
                                     const uint8_t *restrict front, int32_t count,
                                     float *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        float z = depth[i];
        out[i] = (front[i] != 0) & (reason[i] == RLF_REASON_OK) ? z : 0.0f;
    }
}

enum { LANES = RLF_FLOW_LANES };

/* Where some samples were, and what was seen there. */
typedef struct looked_back {
    float x[LANES], y[LANES], z[LANES];
    int32_t place[LANES], is_in[LANES];
    float far[LANES], ray_x[LANES], ray_y[LANES];
} looked_back;

RLF_KERNEL_PART void find_places(const rlf_kernel_flow_view *view,
                                 const rlf_kernel_flow_samples *restrict samples,
                                 const float step[3], int32_t first, int32_t count,
                                 looked_back *restrict out)
{
    const rlf_kernel_flow_view w = *view;
    const float sx = step[0], sy = step[1], sz = step[2];
    const float right = (float)w.width - 0.5f, bottom = (float)w.height - 0.5f;
    for (int32_t k = 0; k < count; k++) {
        int32_t i = first + k;
        float x = samples->x[i] - sx, y = samples->y[i] - sy, z = samples->z[i] - sz;
        bool is_before = z > 0.0f;
        float divisor = is_before ? z : 1.0f;
        float u = samples->column[i] + (x / divisor - samples->ray_x[i]) * w.fx;
        float v = samples->row[i] + (y / divisor - samples->ray_y[i]) * w.fy;
        bool is_in = is_before & (u > -0.5f) & (v > -0.5f) & (u < right) & (v < bottom);
        u = is_in ? u : 0.0f;
        v = is_in ? v : 0.0f;
        out->x[k] = x;
        out->y[k] = y;
        out->z[k] = z;
        out->place[k] = (int32_t)(v + 0.5f) * w.width + (int32_t)(u + 0.5f);
        out->is_in[k] = is_in ? 1 : 0;
    }
}

RLF_KERNEL_PART void look(const rlf_kernel_flow_view *view, int32_t count, looked_back *restrict at)
{
    for (int32_t k = 0; k < count; k++) {
        int32_t i = at->place[k];
        at->far[k] = view->seen[i];
        at->ray_x[k] = view->ray_x[i];
        at->ray_y[k] = view->ray_y[i];
    }
}

RLF_KERNEL void rlf_kernel_flow_residuals(const rlf_kernel_flow_view *view,
                                          const rlf_kernel_flow_samples *samples,
                                          const float step[3], int32_t first, int32_t count,
                                          float *restrict out, int32_t *restrict is_seen)
{
    const float limb = view->limb;
    looked_back at;
    for (int32_t from = first; from < first + count; from += LANES) {
        int32_t size = first + count - from < LANES ? first + count - from : LANES;
        const float *restrict nx = samples->nx + from, *restrict ny = samples->ny + from;
        const float *restrict nz = samples->nz + from;
        float *restrict error = out + (from - first);
        int32_t *restrict seen = is_seen + (from - first);
        find_places(view, samples, step, from, size, &at);
        look(view, size, &at);
        for (int32_t k = 0; k < size; k++) {
            float far = at.far[k], dz = at.z[k] - far;
            float dx = at.x[k] - far * at.ray_x[k], dy = at.y[k] - far * at.ray_y[k];
            error[k] = nx[k] * dx + ny[k] * dy + nz[k] * dz;
            seen[k] = at.is_in[k] & (far > 0.0f ? 1 : 0) & (rlf_kernel_abs(dz) < limb ? 1 : 0);
        }
    }
}
