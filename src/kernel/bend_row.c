/* Where normals turn from one side of a pixel to the other, as they do about a crease. */
#include "kernel/kernel.h"

static const float least_bend = 0.9f;  /* cosine between the sides */
static const float most_slope = 0.16f; /* share of the depth from side to side: no edge between */

typedef struct side {
    float x, y, z, depth;
} side;

RLF_KERNEL_PART side side_at(const rlf_kernel_bend_in *row, int32_t i)
{
    return (side){row->normal[0][i], row->normal[1][i], row->normal[2][i], row->depth[i]};
}

RLF_KERNEL_PART bool has_normal(side s)
{
    return s.x * s.x + s.y * s.y + s.z * s.z > 0.5f;
}

RLF_KERNEL_PART side choose(bool first, side a, side b)
{
    return (side){first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z,
                  first ? a.depth : b.depth};
}

/* From the far sides, or where one of these has no normal from the near ones, or the middle. */
RLF_KERNEL_PART int32_t turns(const side at[5])
{
    bool whole = has_normal(at[0]) & has_normal(at[4]);
    side before = choose(has_normal(at[1]), at[1], at[2]);
    side after = choose(has_normal(at[3]), at[3], at[2]);
    side a = choose(whole, at[0], before), b = choose(whole, at[4], after);
    float cosine = a.x * b.x + a.y * b.y + a.z * b.z;
    float apart = rlf_kernel_abs(a.depth - b.depth);
    return (cosine < least_bend ? 1 : 0) & (apart < most_slope * a.depth ? 1 : 0);
}

RLF_KERNEL void rlf_kernel_bend_row(const rlf_kernel_bend_in rows[5], int32_t count,
                                    uint8_t *restrict bend)
{
    enum { SPAN = RLF_KERNEL_BEND_SPAN };
    for (int32_t i = 0; i < count; i++) {
        const side at[5] = {side_at(&rows[0], i), side_at(&rows[1], i), side_at(&rows[2], i),
                            side_at(&rows[3], i), side_at(&rows[4], i)};
        bend[i] = (uint8_t)(RLF_BEND_DOWN * turns(at));
    }
    for (int32_t i = SPAN; i < count - SPAN; i++) {
        const rlf_kernel_bend_in *row = &rows[2];
        const side at[5] = {side_at(row, i - 2), side_at(row, i - 1), side_at(row, i),
                            side_at(row, i + 1), side_at(row, i + 2)};
        bend[i] = (uint8_t)(bend[i] + RLF_BEND_ACROSS * turns(at));
    }
}
