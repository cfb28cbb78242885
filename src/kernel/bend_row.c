/* Where normals turn from one side of a pixel to the other, as they do about a crease. */
#include "kernel/kernel.h"

#include <string.h>

enum { SPAN = RLF_KERNEL_BEND_SPAN, CHUNK = 16 };

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

/* 1 where the far sides have normals that are alike: nothing turns there, whatever is between. */
RLF_KERNEL_PART int32_t is_straight(const rlf_kernel_bend_in *a, const rlf_kernel_bend_in *b,
                                    int32_t i, int32_t k)
{
    float cosine = a->normal[0][i] * b->normal[0][k] + a->normal[1][i] * b->normal[1][k] +
                   a->normal[2][i] * b->normal[2][k];
    return cosine >= least_bend ? 1 : 0;
}

/* Whether nothing turns about pixels i .. i + CHUNK - 1, most of which are on wide faces. */
RLF_KERNEL_PART bool is_flat(const rlf_kernel_bend_in rows[5], int32_t i)
{
    int32_t straight = 1;
    RLF_KERNEL_WHOLE
    for (int32_t k = 0; k < CHUNK; k++) {
        straight &= is_straight(&rows[0], &rows[4], i + k, i + k) &
                    is_straight(&rows[2], &rows[2], i + k - SPAN, i + k + SPAN);
    }
    return straight != 0;
}

/* Pixels i .. i + CHUNK - 1, none of them at the sides of the image. */
RLF_KERNEL_PART void bend_chunk(const rlf_kernel_bend_in rows[5], int32_t i, uint8_t *restrict bend)
{
    int32_t found[CHUNK];
    RLF_KERNEL_WHOLE
    for (int32_t k = 0; k < CHUNK; k++) {
        const side at[5] = {side_at(&rows[0], i + k), side_at(&rows[1], i + k),
                            side_at(&rows[2], i + k), side_at(&rows[3], i + k),
                            side_at(&rows[4], i + k)};
        found[k] = RLF_BEND_DOWN * turns(at);
    }
    RLF_KERNEL_WHOLE
    for (int32_t k = 0; k < CHUNK; k++) {
        const rlf_kernel_bend_in *row = &rows[2];
        const side at[5] = {side_at(row, i + k - 2), side_at(row, i + k - 1), side_at(row, i + k),
                            side_at(row, i + k + 1), side_at(row, i + k + 2)};
        found[k] += RLF_BEND_ACROSS * turns(at);
    }
    for (int32_t k = 0; k < CHUNK; k++) {
        bend[i + k] = (uint8_t)found[k];
    }
}

RLF_KERNEL_PART void bend_pixels(const rlf_kernel_bend_in rows[5], int32_t begin, int32_t end,
                                 int32_t count, uint8_t *restrict bend)
{
    for (int32_t i = begin; i < end; i++) {
        const side at[5] = {side_at(&rows[0], i), side_at(&rows[1], i), side_at(&rows[2], i),
                            side_at(&rows[3], i), side_at(&rows[4], i)};
        bend[i] = (uint8_t)(RLF_BEND_DOWN * turns(at));
    }
    int32_t first = begin > SPAN ? begin : SPAN, last = end < count - SPAN ? end : count - SPAN;
    for (int32_t i = first; i < last; i++) {
        const rlf_kernel_bend_in *row = &rows[2];
        const side at[5] = {side_at(row, i - 2), side_at(row, i - 1), side_at(row, i),
                            side_at(row, i + 1), side_at(row, i + 2)};
        bend[i] = (uint8_t)(bend[i] + RLF_BEND_ACROSS * turns(at));
    }
}

/* The last chunk overlaps the one before it. */
RLF_KERNEL void rlf_kernel_bend_row(const rlf_kernel_bend_in rows[5], int32_t count,
                                    uint8_t *restrict bend)
{
    int32_t last = count - SPAN - CHUNK;
    if (last < SPAN) {
        bend_pixels(rows, 0, count, count, bend);
        return;
    }
    bend_pixels(rows, 0, SPAN, count, bend);
    bend_pixels(rows, count - SPAN, count, count, bend);
    for (int32_t i = SPAN; i < count - SPAN; i += CHUNK) {
        int32_t at = i < last ? i : last;
        if (is_flat(rows, at)) {
            memset(bend + at, 0, CHUNK);
        } else {
            bend_chunk(rows, at, bend);
        }
    }
}
