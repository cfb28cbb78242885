/* What is about pixels that were dropped: does it move, does it continue what was there? */
#include "kernel/patch.h"

/* Continuing a surface: share of depth per pixel of distance, and once. */
static const float most_slope = 0.01f, most_step = 0.01f;

enum { ABOUT = RLF_PATCH_ABOUT };

RLF_KERNEL_PART int32_t distance(int32_t dx, int32_t dy)
{
    int32_t x = dx < 0 ? -dx : dx, y = dy < 0 ? -dy : dy;
    return x > y ? x : y;
}

RLF_KERNEL_PART void look_for_motion(const rlf_byte_patch *restrict change, uint8_t *restrict moved)
{
    for (int32_t i = 0; i < RLF_PATCH; i++) {
        moved[i] = 0;
    }
    for (int32_t k = 0; k < RLF_PATCH_HEIGHT; k++) {
        const uint8_t *restrict row = change->at[k];
        for (int32_t i = 0; i < RLF_PATCH; i++) {
            int32_t any = moved[i];
            for (int32_t dx = 0; dx <= 2 * ABOUT; dx++) {
                any |= row[i + dx] == RLF_CHANGE_MOVED ? RLF_ABOUT_MOVED : 0;
            }
            moved[i] = (uint8_t)any;
        }
    }
}

RLF_KERNEL_PART void look_for_more(const rlf_patch *restrict seen, const float *restrict inverse,
                                   int32_t *restrict continued)
{
    for (int32_t i = 0; i < RLF_PATCH; i++) {
        continued[i] = 0;
    }
    for (int32_t k = 0; k < RLF_PATCH_HEIGHT; k++) {
        const float *restrict row = seen->at[k];
        for (int32_t i = 0; i < RLF_PATCH; i++) {
            int32_t any = continued[i];
            for (int32_t dx = -ABOUT; dx <= ABOUT; dx++) {
                float most = most_slope * (float)distance(dx, k - ABOUT) + most_step;
                float off = rlf_kernel_abs(inverse[i] * row[i + dx + ABOUT] - 1.0f);
                any |= off <= most ? RLF_ABOUT_CONTINUED : 0;
            }
            continued[i] = any;
        }
    }
}

RLF_KERNEL void rlf_kernel_recall_patch(const rlf_patch *restrict depth,
                                        const rlf_byte_patch *restrict change,
                                        const float *restrict inverse, uint8_t *restrict out)
{
    rlf_patch seen; /* 0 continues nothing */
    for (int32_t k = 0; k < RLF_PATCH_HEIGHT; k++) {
        for (int32_t i = 0; i < RLF_PATCH_WIDTH; i++) {
            float z = depth->at[k][i];
            seen.at[k][i] = change->at[k][i] != RLF_CHANGE_UNSEEN ? z : 0.0f;
        }
    }
    int32_t continued[RLF_PATCH];
    uint8_t moved[RLF_PATCH];
    look_for_more(&seen, inverse, continued);
    look_for_motion(change, moved);
    for (int32_t i = 0; i < RLF_PATCH; i++) {
        out[i] = (uint8_t)(moved[i] | continued[i]);
    }
}
