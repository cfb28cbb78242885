/* What the colours about pixels beside an edge say of their sides. */
#include "kernel/color.h"

enum { ABOUT = RLF_COLOR_ABOUT, SIDE = RLF_WINDOW_SIDE, PX = RLF_WINDOW_ABOUT };

/* Columns and rows of the samples from the pixel, and what each counts: exp(-d^2 / 1.6 px^2). */
static const int32_t about[ABOUT][2] = {{0, -2}, {-1, -1}, {0, -1}, {1, -1}, {-2, 0}, {-1, 0},
                                        {1, 0},  {2, 0},   {-1, 1}, {0, 1},  {1, 1},  {0, 2}};
static const float weight_at[ABOUT] = {0.082f, 0.287f, 0.535f, 0.287f, 0.082f, 0.535f,
                                       0.535f, 0.082f, 0.287f, 0.535f, 0.287f, 0.082f};
static const float end_weight = 0.2f;      /* that of an end */
static const float noise = 36.0f;          /* variance of a colour, sRGB steps squared */
static const float within_weight = 1.333f; /* of the variance within the sides beside it */
static const float off_line = 0.6f;        /* see silhouette_mixture.h */

RLF_KERNEL_PART void find_offsets(const rlf_color_places *restrict p, const float *restrict x,
                                  const float *restrict y, int32_t *restrict out)
{
    const float ux = p->step[0][0], uy = p->step[0][1], vx = p->step[1][0], vy = p->step[1][1];
    const int32_t stride = p->stride;
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        float u = p->u[i] + ux * x[i] + uy * y[i] + 0.5f;
        float v = p->v[i] + vx * x[i] + vy * y[i] + 0.5f;
        out[i] = (int32_t)v * stride + 4 * (int32_t)u;
    }
}

RLF_KERNEL void rlf_kernel_color_offsets(const rlf_color_places *restrict places,
                                         const rlf_gap_ends *restrict ends,
                                         int32_t offset[restrict RLF_COLOR_SAMPLES][RLF_BATCH])
{
    float x[RLF_BATCH], y[RLF_BATCH];
    for (int32_t s = 0; s < ABOUT; s++) {
        for (int32_t i = 0; i < RLF_BATCH; i++) {
            x[i] = (float)about[s][0];
            y[i] = (float)about[s][1];
        }
        find_offsets(places, x, y, offset[s]);
    }
    for (int32_t s = 0; s < 2; s++) {
        for (int32_t i = 0; i < RLF_BATCH; i++) {
            float steps = s == 0 ? -ends->to_before[i] : ends->to_after[i];
            x[i] = steps * places->line[0][i];
            y[i] = steps * places->line[1][i];
        }
        find_offsets(places, x, y, offset[ABOUT + s]);
    }
}

/* Colours of one side. */
typedef struct palette {
    float weight[RLF_BATCH], sum[3][RLF_BATCH], square[3][RLF_BATCH];
} palette;

/* Adds a sample to both sides, to one of them with a weight of 0: so nothing depends on a pixel. */
RLF_KERNEL_PART void add_sample(const uint32_t *restrict sample, const float *restrict to_far,
                                const float *restrict to_near, palette *restrict far_side,
                                palette *restrict near_side)
{
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        far_side->weight[i] += to_far[i];
        near_side->weight[i] += to_near[i];
    }
    for (int32_t k = 0; k < 3; k++) {
        for (int32_t i = 0; i < RLF_BATCH; i++) {
            float value = (float)(int32_t)(sample[i] >> (8 * k) & 255u);
            float near_part = to_near[i] * value, far_part = to_far[i] * value;
            near_side->sum[k][i] += near_part;
            near_side->square[k][i] += near_part * value;
            far_side->sum[k][i] += far_part;
            far_side->square[k][i] += far_part * value;
        }
    }
}

/* Adds all samples; what was not seen counts 0. */
RLF_KERNEL_PART void gather(const rlf_windows *restrict depth, const rlf_gap_ends *restrict ends,
                            const float *restrict middle, const rlf_color_samples *restrict seen,
                            palette *restrict far_side, palette *restrict near_side)
{
    float to_far[RLF_BATCH], to_near[RLF_BATCH];
    for (int32_t s = 0; s < ABOUT; s++) {
        const float *at = depth->at[(about[s][1] + PX) * SIDE + about[s][0] + PX];
        const float weight = weight_at[s];
        for (int32_t i = 0; i < RLF_BATCH; i++) {
            float counts = at[i] > 0.0f ? weight : 0.0f;
            to_near[i] = at[i] < middle[i] ? counts : 0.0f;
            to_far[i] = at[i] < middle[i] ? 0.0f : counts;
        }
        add_sample(seen->sample[s], to_far, to_near, far_side, near_side);
    }
    for (int32_t s = 0; s < 2; s++) {
        const float *at = s == 0 ? ends->before : ends->after;
        for (int32_t i = 0; i < RLF_BATCH; i++) {
            to_near[i] = at[i] < middle[i] ? end_weight : 0.0f;
            to_far[i] = at[i] < middle[i] ? 0.0f : end_weight;
        }
        add_sample(seen->sample[ABOUT + s], to_far, to_near, far_side, near_side);
    }
}

/* How two sides and a colour lie to each other. */
typedef struct relation {
    float apart[RLF_BATCH], along[RLF_BATCH], from_far[RLF_BATCH], within[RLF_BATCH];
} relation;

RLF_KERNEL_PART void relate(const palette *restrict far_side, const palette *restrict near_side,
                            const rlf_color_samples *restrict seen, relation *restrict out)
{
    memset(out, 0, sizeof *out);
    for (int32_t k = 0; k < 3; k++) {
        for (int32_t i = 0; i < RLF_BATCH; i++) {
            float of_far = 1.0f / far_side->weight[i], of_near = 1.0f / near_side->weight[i];
            float far_mean = far_side->sum[k][i] * of_far;
            float near_mean = near_side->sum[k][i] * of_near;
            float step = near_mean - far_mean, off = seen->color[k][i] - far_mean;
            float within = out->within[i];
            within += far_side->square[k][i] * of_far - far_mean * far_mean;
            within += near_side->square[k][i] * of_near - near_mean * near_mean;
            out->within[i] = within;
            out->apart[i] += step * step;
            out->along[i] += step * off;
            out->from_far[i] += off * off;
        }
    }
}

RLF_KERNEL_PART void find_shares(const relation *restrict r, rlf_color_shares *restrict out)
{
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        float apart = r->apart[i], within = r->within[i] > 0.0f ? r->within[i] : 0.0f;
        float worth = apart / (apart + within_weight * within + noise);
        bool is_apart = apart > 1.0f;
        float least = is_apart ? apart : 1.0f, share = r->along[i] / least;
        float strange = (r->from_far[i] - share * r->along[i]) / (off_line * least);
        strange = strange > 0.0f ? strange : 0.0f;
        worth /= 1.0f + strange * strange;
        share = share < 0.0f ? 0.0f : (share > 1.0f ? 1.0f : share);
        out->share[i] = is_apart ? share : 0.5f;
        out->worth[i] = is_apart ? worth : 0.0f;
    }
}

RLF_KERNEL_PART void find_ways(const rlf_windows *restrict depth, const float *restrict middle,
                               rlf_color_shares *restrict out)
{
    memset(out->way, 0, sizeof out->way);
    for (int32_t k = 0; k < RLF_WINDOW_SIZE; k++) {
        const float x = (float)(k % SIDE - PX), y = (float)(k / SIDE - PX);
        for (int32_t i = 0; i < RLF_BATCH; i++) {
            float z = depth->at[k][i], sign = z < middle[i] ? 1.0f : -1.0f;
            sign = z > 0.0f ? sign : 0.0f;
            out->way[0][i] += sign * x;
            out->way[1][i] += sign * y;
        }
    }
}

RLF_KERNEL void rlf_kernel_color_shares(const rlf_windows *restrict depth,
                                        const rlf_gap_ends *restrict ends,
                                        const rlf_color_samples *restrict seen,
                                        rlf_color_shares *restrict out)
{
    palette far_side, near_side;
    relation between;
    float middle[RLF_BATCH];
    memset(&far_side, 0, sizeof far_side);
    memset(&near_side, 0, sizeof near_side);
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        middle[i] = rlf_gap_middle(ends->before[i], ends->after[i]);
    }
    gather(depth, ends, middle, seen, &far_side, &near_side);
    relate(&far_side, &near_side, seen, &between);
    find_shares(&between, out);
    find_ways(depth, middle, out);
}
