/* A box and the points of a row. */
#include "kernel/plate.h"

RLF_KERNEL void rlf_kernel_plate_row(const rlf_kernel_plate *plate, float reach,
                                     const float *restrict ray_x, const float *restrict ray_y,
                                     const float *restrict depth, int32_t count,
                                     float *restrict leave, int32_t *restrict is_near)
{
    const rlf_kernel_plate box = *plate;
    const float least = 1e-9f, far_m = 1e9f;
    for (int32_t i = 0; i < count; i++) {
        float enter = 0.0f, out = far_m, square = 0.0f;
        for (int32_t k = 0; k < 3; k++) {
            float along = box.axis[k][0] * ray_x[i] + box.axis[k][1] * ray_y[i] + box.axis[k][2];
            float beyond = rlf_kernel_abs(depth[i] * along - box.from[k]) - box.half[k];
            bool is_parallel = rlf_kernel_abs(along) < least;
            along = is_parallel ? least : along;
            float a = (box.from[k] - box.half[k]) / along, b = (box.from[k] + box.half[k]) / along;
            float low = a < b ? a : b, high = a < b ? b : a;
            enter = low > enter ? low : enter;
            out = high < out ? high : out;
            beyond = beyond > 0.0f ? beyond : 0.0f;
            square += beyond * beyond;
        }
        leave[i] = enter < out ? out : 0.0f;
        is_near[i] = (depth[i] > 0.0f ? 1 : 0) & (square <= reach * reach ? 1 : 0);
    }
}
