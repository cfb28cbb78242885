/* What is about pixels that were dropped: does it move, does it continue what was there? */
#include "kernel/batch.h"

/* Continuing a surface: share of depth per pixel of distance, and once. */
static const float most_slope = 0.01f, most_step = 0.01f;

RLF_KERNEL_PART int32_t distance(int32_t dx, int32_t dy)
{
    int32_t x = dx < 0 ? -dx : dx, y = dy < 0 ? -dy : dy;
    return x > y ? x : y;
}

RLF_KERNEL void rlf_kernel_recall_batch(const rlf_windows *restrict seen,
                                        const float *restrict inverse, uint8_t *restrict out)
{
    enum { ABOUT = RLF_WINDOW_ABOUT };
    int32_t about[RLF_BATCH];
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        about[i] = 0;
    }
    for (int32_t dy = -ABOUT; dy <= ABOUT; dy++) {
        const float(*restrict row)[RLF_BATCH] = &seen->at[(dy + ABOUT) * RLF_WINDOW_SIDE];
        for (int32_t i = 0; i < RLF_BATCH; i++) {
            int32_t any = about[i];
            for (int32_t dx = -ABOUT; dx <= ABOUT; dx++) {
                float z = row[dx + ABOUT][i];
                float most = most_slope * (float)distance(dx, dy) + most_step;
                float off = rlf_kernel_abs(inverse[i] * rlf_kernel_abs(z) - 1.0f);
                any |= off <= most ? RLF_ABOUT_CONTINUED : 0; /* 0 continues nothing */
                any |= z < 0.0f ? RLF_ABOUT_MOVED : 0;
            }
            about[i] = any;
        }
    }
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        out[i] = (uint8_t)about[i];
    }
}
