/* Which neighbouring pixels belong together: one row against the one above it. */
#include "kernel/kernel.h"

RLF_KERNEL_PART int32_t is_member(const float *depth, const uint8_t *mask, int32_t i)
{
    return (depth[i] > 0.0f ? 1 : 0) & (mask[i] != 0 ? 1 : 0);
}

RLF_KERNEL_PART int32_t is_near(float a, float b, float limit)
{
    return rlf_kernel_abs(a - b) <= limit ? 1 : 0;
}

RLF_KERNEL_PART uint8_t link_pixel(const rlf_kernel_links *p, const rlf_kernel_links_in *in,
                                   int32_t i, int32_t left)
{
    float z = in->depth[i];
    float limit = p->sigmas * rlf_kernel_sigma(p->noise, z) + p->slope * z + p->step_m;
    int32_t own = is_member(in->depth, in->mask, i);
    int32_t beside = is_member(in->depth, in->mask, left) & is_near(z, in->depth[left], limit) &
                     (left != i ? 1 : 0);
    int32_t up = is_member(in->above, in->mask_above, i) & is_near(z, in->above[i], limit);
    return (uint8_t)(own * (RLF_LINK_MEMBER + beside * RLF_LINK_LEFT + up * RLF_LINK_UP));
}

RLF_KERNEL void rlf_kernel_link_row(const rlf_kernel_links *params, const rlf_kernel_links_in *in,
                                    uint8_t *restrict links)
{
    const rlf_kernel_links p = *params;
    const rlf_kernel_links_in row = *in;
    if (row.count > 0) {
        links[0] = link_pixel(&p, &row, 0, 0);
    }
    for (int32_t i = 1; i < row.count; i++) {
        links[i] = link_pixel(&p, &row, i, i - 1);
    }
}

RLF_KERNEL int32_t rlf_kernel_label_row(const float *restrict depth,
                                        const uint8_t *restrict foreground,
                                        const int32_t *restrict background, int32_t count,
                                        int32_t *restrict label)
{
    int32_t seen = 0;
    for (int32_t i = 0; i < count; i++) {
        int32_t valid = depth[i] > 0.0f ? 1 : 0;
        int32_t shown = valid & (foreground[i] == 0 ? 1 : 0);
        label[i] = shown * background[i];
        seen += valid;
    }
    return seen;
}
