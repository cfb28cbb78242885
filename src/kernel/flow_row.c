/* Velocity of pixels from that of the cells around: see surface/motion/cells.c. */
#include "kernel/flow.h"

#include <math.h>

enum { RUN = 32 }; /* pixels at a time */

typedef struct sums {
    float across[RUN]; /* share of the way from the left cells' middles to the right ones' */
    float whole[3][RUN], v[3][RUN], weight[RUN];
} sums;

/* Velocity of what moves as one. */
RLF_KERNEL_PART void move_points(const rlf_kernel_twist *twist, const float *restrict depth,
                                 const float *restrict ray_x, const float *restrict ray_y,
                                 int32_t count, sums *restrict to)
{
    const rlf_kernel_twist t = *twist;
    for (int32_t i = 0; i < count; i++) {
        float z = depth[i], x = z * ray_x[i], y = z * ray_y[i];
        double px = (double)x - t.centre[0], py = (double)y - t.centre[1];
        double pz = (double)z - t.centre[2];
        to->whole[0][i] = (float)(t.linear[0] + (t.spin[1] * pz - t.spin[2] * py));
        to->whole[1][i] = (float)(t.linear[1] + (t.spin[2] * px - t.spin[0] * pz));
        to->whole[2][i] = (float)(t.linear[2] + (t.spin[0] * py - t.spin[1] * px));
    }
}

RLF_KERNEL_PART void start(float inverse, float column, int32_t first, bool moves, int32_t count,
                           sums *restrict to)
{
    for (int32_t i = 0; i < count; i++) {
        to->across[i] = (((float)(first + i) + 0.5f) * inverse - 0.5f) - column;
        to->weight[i] = to->v[0][i] = to->v[1][i] = to->v[2][i] = 0.0f;
    }
    for (int32_t i = 0; i < count && !moves; i++) {
        to->whole[0][i] = to->whole[1][i] = to->whole[2][i] = 0.0f;
    }
}

/* Adds a cell to the pixels with its limb, by nearness. */
RLF_KERNEL_PART void add_cell(const rlf_kernel_flow_cell *cell, bool is_right, float down,
                              float limb, const float *restrict depth, int32_t count,
                              sums *restrict to)
{
    const float x = cell->velocity[0], y = cell->velocity[1], z = cell->velocity[2];
    const float at = cell->depth;
    const bool is_whole = cell->is_whole;
    for (int32_t i = 0; i < count; i++) {
        float across = is_right ? to->across[i] : 1.0f - to->across[i];
        float weight = across * down + 1e-4f;
        weight = rlf_kernel_abs(at - depth[i]) > limb ? 0.0f : weight;
        to->weight[i] += weight;
        to->v[0][i] += weight * (is_whole ? to->whole[0][i] : x);
        to->v[1][i] += weight * (is_whole ? to->whole[1][i] : y);
        to->v[2][i] += weight * (is_whole ? to->whole[2][i] : z);
    }
}

/* Their mean, the whole's velocity where there is none. */
RLF_KERNEL_PART void finish(const sums *restrict from, float fastest, int32_t count,
                            float *restrict out_x, float *restrict out_y, float *restrict out_z)
{
    for (int32_t i = 0; i < count; i++) {
        bool is_known = from->weight[i] > 0.0f;
        float divisor = is_known ? from->weight[i] : 1.0f;
        float x = from->v[0][i] / divisor, y = from->v[1][i] / divisor;
        float z = from->v[2][i] / divisor;
        x = is_known ? x : from->whole[0][i];
        y = is_known ? y : from->whole[1][i];
        z = is_known ? z : from->whole[2][i];
        float square = x * x + y * y + z * z;
        bool is_fast = square > fastest * fastest;
        float scale = fastest / sqrtf(is_fast ? square : 1.0f);
        scale = is_fast ? scale : 1.0f;
        out_x[i] = scale * x;
        out_y[i] = scale * y;
        out_z[i] = scale * z;
    }
}

RLF_KERNEL void rlf_kernel_flow_row(const rlf_kernel_flow *restrict flow,
                                    const float *restrict depth, const float *restrict ray_x,
                                    const float *restrict ray_y, int32_t count,
                                    float *const velocity[3])
{
    /* No copy of the flow: it has just been written value by value, and whole lines of that would
     * be waited for. */
    const bool moves = flow->moves;
    const float limb = flow->limb, fastest = flow->fastest, below = flow->down;
    for (int32_t i = 0; i < count; i += RUN) {
        int32_t n = count - i < RUN ? count - i : RUN;
        sums s;
        start(flow->inverse, flow->column, flow->first + i, moves, n, &s);
        if (moves) {
            move_points(&flow->twist, depth + i, ray_x + i, ray_y + i, n, &s);
        }
        for (int k = 0; k < 4; k++) {
            const rlf_kernel_flow_cell *cell = &flow->cell[k];
            if (cell->is_known) {
                add_cell(cell, k % 2 != 0, k / 2 ? below : 1.0f - below, limb, depth + i, n, &s);
            }
        }
        finish(&s, fastest, n, velocity[0] + i, velocity[1] + i, velocity[2] + i);
    }
}
