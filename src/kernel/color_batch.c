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

enum { SAMPLES = RLF_COLOR_SAMPLES };

/* What each sample counts on a side: on one of them 0, so that nothing depends on a pixel. */
typedef struct sample_weights {
    float of[SAMPLES][RLF_BATCH], sum[RLF_BATCH];
} sample_weights;

RLF_KERNEL_PART void choose_sides(const rlf_windows *restrict depth,
                                  const rlf_gap_ends *restrict ends, const float *restrict middle,
                                  sample_weights *restrict far_side,
                                  sample_weights *restrict near_side)
{
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        float of_far = 0.0f, of_near = 0.0f;
        RLF_KERNEL_UNROLLED(SAMPLES)
        for (int32_t s = 0; s < SAMPLES; s++) {
            int32_t place = s < ABOUT ? (about[s][1] + PX) * SIDE + about[s][0] + PX : 0;
            float end = s == ABOUT ? ends->before[i] : ends->after[i];
            float at = s < ABOUT ? depth->at[place][i] : end;
            float weight = s < ABOUT ? weight_at[s] : end_weight;
            float counts = at > 0.0f ? weight : 0.0f;
            near_side->of[s][i] = at < middle[i] ? counts : 0.0f;
            far_side->of[s][i] = at < middle[i] ? 0.0f : counts;
            of_near += near_side->of[s][i];
            of_far += far_side->of[s][i];
        }
        near_side->sum[i] = of_near;
        far_side->sum[i] = of_far;
    }
}

/* Sums of one of the three colours, and of its squares. */
typedef struct palette {
    float sum[RLF_BATCH], square[RLF_BATCH];
} palette;

RLF_KERNEL_PART void add_samples(const rlf_color_samples *restrict seen, int32_t color,
                                 const sample_weights *restrict weight, palette *restrict out)
{
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        float sum = 0.0f, square = 0.0f;
        RLF_KERNEL_UNROLLED(SAMPLES)
        for (int32_t s = 0; s < SAMPLES; s++) {
            float value = (float)(int32_t)(seen->sample[s][i] >> (8 * color) & 255u);
            float part = weight->of[s][i] * value;
            sum += part;
            square += part * value;
        }
        out->sum[i] = sum;
        out->square[i] = square;
    }
}

/* How two sides and a colour lie to each other. */
typedef struct relation {
    float apart[RLF_BATCH], along[RLF_BATCH], from_far[RLF_BATCH], within[RLF_BATCH];
} relation;

RLF_KERNEL_PART void relate(const sample_weights *restrict far_side,
                            const sample_weights *restrict near_side,
                            const rlf_color_samples *restrict seen, relation *restrict out)
{
    memset(out, 0, sizeof *out);
    for (int32_t k = 0; k < 3; k++) {
        palette of_far, of_near;
        add_samples(seen, k, far_side, &of_far);
        add_samples(seen, k, near_side, &of_near);
        for (int32_t i = 0; i < RLF_BATCH; i++) {
            float per_far = 1.0f / far_side->sum[i], per_near = 1.0f / near_side->sum[i];
            float far_mean = of_far.sum[i] * per_far, near_mean = of_near.sum[i] * per_near;
            float step = near_mean - far_mean, off = seen->color[k][i] - far_mean;
            float within = out->within[i];
            within += of_far.square[i] * per_far - far_mean * far_mean;
            within += of_near.square[i] * per_near - near_mean * near_mean;
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
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        float way_x = 0.0f, way_y = 0.0f;
        RLF_KERNEL_UNROLLED(RLF_WINDOW_SIZE)
        for (int32_t k = 0; k < RLF_WINDOW_SIZE; k++) {
            float z = depth->at[k][i], sign = z < middle[i] ? 1.0f : -1.0f;
            sign = z > 0.0f ? sign : 0.0f;
            way_x += sign * (float)(k % SIDE - PX);
            way_y += sign * (float)(k / SIDE - PX);
        }
        out->way[0][i] = way_x;
        out->way[1][i] = way_y;
    }
}

RLF_KERNEL void rlf_kernel_color_shares(const rlf_windows *restrict depth,
                                        const rlf_gap_ends *restrict ends,
                                        const rlf_color_samples *restrict seen,
                                        rlf_color_shares *restrict out)
{
    sample_weights far_side, near_side;
    relation between;
    float middle[RLF_BATCH];
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        middle[i] = rlf_gap_middle(ends->before[i], ends->after[i]);
    }
    choose_sides(depth, ends, middle, &far_side, &near_side);
    relate(&far_side, &near_side, seen, &between);
    find_shares(&between, out);
    find_ways(depth, middle, out);
}
