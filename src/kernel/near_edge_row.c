/* Which pixels in front are near an outline. */
#include "kernel/outline.h"

RLF_KERNEL void rlf_kernel_was_front_row(const uint8_t *front, const uint8_t *known,
                                         ptrdiff_t width, int32_t begin, int32_t end,
                                         uint8_t *restrict out)
{
    enum { APART = RLF_NEAR_EDGE_APART };
    const uint8_t *restrict at = front, *restrict seen = known;
    const uint8_t *restrict up = front - APART * width, *restrict down = front + APART * width;
    for (int32_t i = begin; i < end; i++) {
        uint8_t about = (uint8_t)(at[i] | at[i - APART] | at[i + APART] | up[i] | down[i]);
        out[i] = (uint8_t)(seen[i] & (about != 0));
    }
}

RLF_KERNEL void rlf_kernel_near_edge_row(const float *depth, ptrdiff_t width, int32_t begin,
                                         int32_t end, uint8_t *restrict mark)
{
    enum { APART = RLF_NEAR_EDGE_APART, ASLANT = RLF_NEAR_EDGE_ASLANT };
    const float *restrict z = depth;
    const float *restrict up = z - APART * width, *restrict down = z + APART * width;
    const float *restrict upper = z - ASLANT * width, *restrict lower = z + ASLANT * width;
    for (int32_t i = begin; i < end; i++) {
        float behind = z[i] * (1.0f + RLF_OUTLINE_JUMP_SEEN);
        int32_t across = (z[i - APART] > behind) | (z[i + APART] > behind);
        int32_t along = (up[i] > behind) | (down[i] > behind);
        int32_t rising = (upper[i - ASLANT] > behind) | (lower[i + ASLANT] > behind);
        int32_t falling = (upper[i + ASLANT] > behind) | (lower[i - ASLANT] > behind);
        int32_t is_near = (z[i] > 0.0f) & (across | along | rising | falling);
        mark[i] = (uint8_t)(mark[i] & is_near);
    }
}
