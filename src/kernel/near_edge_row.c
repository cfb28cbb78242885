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

/* 1 where one of two pixels on opposite sides is behind the one between them, else 0. */
RLF_KERNEL_PART int32_t is_behind(float z, float one, float other)
{
    float far = one > other ? one : other, near = one > other ? other : one;
    return far > rlf_outline_behind(z, RLF_OUTLINE_STEP_SEEN, z - near);
}

RLF_KERNEL void rlf_kernel_near_edge_row(const float *depth, ptrdiff_t width, int32_t begin,
                                         int32_t end, uint8_t *restrict mark)
{
    enum { APART = RLF_NEAR_EDGE_APART, ASLANT = RLF_NEAR_EDGE_ASLANT };
    const float *restrict z = depth;
    const float *restrict up = z - APART * width, *restrict down = z + APART * width;
    const float *restrict upper = z - ASLANT * width, *restrict lower = z + ASLANT * width;
    for (int32_t i = begin; i < end; i++) {
        int32_t across = is_behind(z[i], z[i - APART], z[i + APART]);
        int32_t along = is_behind(z[i], up[i], down[i]);
        int32_t rising = is_behind(z[i], upper[i - ASLANT], lower[i + ASLANT]);
        int32_t falling = is_behind(z[i], upper[i + ASLANT], lower[i - ASLANT]);
        int32_t is_near = (z[i] > 0.0f) & (across | along | rising | falling);
        mark[i] = (uint8_t)(mark[i] & is_near);
    }
}
