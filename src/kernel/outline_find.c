/* Outlines beside pixels: see surface/normals/outline.c. */
#include "kernel/outline.h"

#include <math.h>

/* Offsets of what is behind each pixel and of what is not, summed. */
typedef struct sides {
    float far_x[RLF_BATCH], far_y[RLF_BATCH], far_n[RLF_BATCH];
    float near_x[RLF_BATCH], near_y[RLF_BATCH], near_n[RLF_BATCH];
    float nearest[RLF_BATCH]; /* squared distance of what is behind */
} sides;

RLF_KERNEL_PART void add_row(const float (*restrict row)[RLF_BATCH], int32_t about, float dy,
                             const float *restrict before, const float *restrict behind,
                             sides *restrict s)
{
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        float far_n = 0.0f, far_x = 0.0f, near_n = 0.0f, near_x = 0.0f, nearest = s->nearest[i];
        for (int32_t k = 0; k <= 2 * about; k++) {
            float z = row[k][i], dx = (float)(k - about), square = dx * dx + dy * dy;
            bool is_far = z > behind[i];
            bool is_near = (z > before[i]) & !is_far;
            float far = is_far ? 1.0f : 0.0f, near = is_near ? 1.0f : 0.0f;
            float to_far = is_far ? square : nearest;
            far_n += far;
            far_x += far * dx;
            near_n += near;
            near_x += near * dx;
            nearest = to_far < nearest ? to_far : nearest;
        }
        s->far_n[i] += far_n;
        s->far_x[i] += far_x;
        s->far_y[i] += far_n * dy;
        s->near_n[i] += near_n;
        s->near_x[i] += near_x;
        s->near_y[i] += near_n * dy;
        s->nearest[i] = nearest;
    }
}

RLF_KERNEL_PART float larger(float a, float b)
{
    return a > b ? a : b;
}

/* What lies behind each pixel's own surface, that being as near as anything of it in the window. */
RLF_KERNEL_PART void find_behind(const float (*restrict at)[RLF_BATCH], int32_t count, float step,
                                 float *restrict behind)
{
    const float *restrict own = at[count / 2];
    float nearest[RLF_BATCH];
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        nearest[i] = own[i];
    }
    for (int32_t k = 0; k < count; k++) {
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < RLF_BATCH; i++) {
            float z = at[k][i];
            float of_own = z > own[i] * (1.0f - RLF_OUTLINE_JUMP) ? z : own[i];
            nearest[i] = of_own < nearest[i] ? of_own : nearest[i];
        }
    }
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        behind[i] = rlf_outline_behind(own[i], step, own[i] - nearest[i]);
    }
}

/* Outlines of the pixels in the middles of windows that reach so far about them. */
RLF_KERNEL_PART void find_within(const float (*restrict at)[RLF_BATCH], int32_t about, float step,
                                 float *restrict behind, rlf_outlines *restrict out)
{
    const int32_t side = 2 * about + 1;
    const float *restrict own = at[about * side + about];
    float before[RLF_BATCH];
    sides s;
    find_behind(at, side * side, step, behind);
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        before[i] = own[i] * (1.0f - step);
        s.far_x[i] = s.far_y[i] = s.far_n[i] = s.near_x[i] = s.near_y[i] = s.near_n[i] = 0.0f;
        s.nearest[i] = 99.0f;
    }
    for (int32_t k = 0; k < side; k++) {
        add_row(&at[k * side], about, (float)(k - about), before, behind, &s);
    }
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        float far_n = larger(s.far_n[i], 1.0f), near_n = larger(s.near_n[i], 1.0f);
        float gx = s.far_x[i] / far_n - s.near_x[i] / near_n;
        float gy = s.far_y[i] / far_n - s.near_y[i] / near_n;
        float length = sqrtf(gx * gx + gy * gy);
        float distance = sqrtf(s.nearest[i]) - 0.5f;
        distance = s.far_n[i] > 1.5f ? distance : 0.0f;
        bool is_sure = length >= 0.25f * (float)about;
        float whole = is_sure ? length : 1.0f;
        out->x[i] = gx / whole;
        out->y[i] = gy / whole;
        out->distance[i] = is_sure ? distance : 0.0f;
    }
}

RLF_KERNEL void rlf_kernel_outline_find(const rlf_windows *restrict depth, float step,
                                        rlf_outlines *restrict out)
{
    enum { ABOUT = RLF_WINDOW_ABOUT };
    const float(*restrict at)[RLF_BATCH] = depth->at;
    const float *restrict left = at[ABOUT * RLF_WINDOW_SIDE];
    const float *restrict right = at[ABOUT * RLF_WINDOW_SIDE + 2 * ABOUT];
    const float *restrict above = at[ABOUT];
    const float *restrict below = at[2 * ABOUT * RLF_WINDOW_SIDE + ABOUT];
    float behind[RLF_BATCH];
    find_within(at, ABOUT, step, behind, out);
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        float aside = larger(left[i], right[i]);
        float farthest = larger(aside, larger(above[i], below[i]));
        out->distance[i] = farthest > behind[i] ? out->distance[i] : 0.0f;
    }
}

RLF_KERNEL void rlf_kernel_outline_apart(const rlf_way *way, const rlf_way_from *restrict from,
                                         rlf_outlines *restrict out)
{
    enum { ABOUT = RLF_NEAR_EDGE_APART, SIDE = 2 * ABOUT + 1 };
    float at[SIDE * SIDE][RLF_BATCH], behind[RLF_BATCH];
    for (int32_t r = 0; r < SIDE; r++) {
        for (int32_t i = 0; i < RLF_BATCH; i++) {
            int32_t y = from->y[i] + r - ABOUT, x = from->x[i] - ABOUT;
            const float *row = way->depth + ((ptrdiff_t)y * way->width + x);
            for (int32_t c = 0; c < SIDE; c++) {
                at[r * SIDE + c][i] = row[c];
            }
        }
    }
    find_within((const float(*)[RLF_BATCH])at, ABOUT, RLF_OUTLINE_STEP_SEEN, behind, out);
}
