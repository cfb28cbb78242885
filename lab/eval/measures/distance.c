/* Sums per half metre of true distance. */
#include "eval/measures/distance.h"

#include "eval/measures/depth.h"

#include <math.h>

#define FIRST_M 0.5f
#define PER_METRE 2.0f
#define GROSS_M 0.04 /* the other side of an edge, as in depth.c */

typedef struct distance_name {
    const char *key, *title;
} distance_name;

#define NAMES(from, to)                                                                            \
    {"distance_" from "_m_raw_rmse_mm", "at " from " to " to " m: raw depth, RMSE, mm"},           \
        {"distance_" from "_m_rmse_mm", "  depth, RMSE, mm"},                                      \
    {                                                                                              \
        "distance_" from "_m_normal_mean_deg", "  normals, mean, deg"                              \
    }

static const distance_name names[3 * EVAL_DISTANCE_BINS] = {
    NAMES("0.5", "1.0"), NAMES("1.0", "1.5"), NAMES("1.5", "2.0"), NAMES("2.0", "2.5"),
    NAMES("2.5", "3.0"), NAMES("3.0", "3.5"), NAMES("3.5", "4.0"), NAMES("4.0", "4.5"),
};

static void add_depth(double *square_sum, int64_t *count, float z, float truth)
{
    double error = (double)z - truth;
    if (z > 0.0f && error < GROSS_M && error > -GROSS_M) {
        *square_sum += error * error;
        (*count)++;
    }
}

void eval_distance_add(eval_distance *e, const rlf_surface *s, const rlf_frame *frame,
                       const rlf_truth *truth, const uint8_t *band)
{
    for (int32_t i = 0; i < s->width * s->height; i++) {
        int32_t x = i % s->width * s->scale_factor, y = i / s->width * s->scale_factor;
        int32_t t = y * frame->rig->depth.width + x;
        float real = truth->depth[t];
        int32_t bin = (int32_t)((real - FIRST_M) * PER_METRE);
        if (band[t] || real < FIRST_M || bin >= EVAL_DISTANCE_BINS) {
            continue;
        }
        eval_distance_bin *b = &e->bins[bin];
        add_depth(&b->raw_square_sum, &b->raw_count, eval_raw_depth(frame, x, y), real);
        add_depth(&b->square_sum, &b->count, s->depth[i], real);
        double nx = s->normal_x[i], ny = s->normal_y[i], nz = s->normal_z[i];
        if (nx * nx + ny * ny + nz * nz > 0.5) {
            double dot =
                nx * truth->normal_x[t] + ny * truth->normal_y[t] + nz * truth->normal_z[t];
            b->angle_sum += rlf_acos(dot) * 180.0 / RLF_PI;
            b->angle_count++;
        }
    }
}

int32_t eval_distance_count(void)
{
    return 3 * EVAL_DISTANCE_BINS;
}

const char *eval_distance_key(int32_t index)
{
    return names[index].key;
}

const char *eval_distance_title(int32_t index)
{
    return names[index].title;
}

static double rms_mm(double square_sum, int64_t count)
{
    return count > 0 ? 1000.0 * sqrt(square_sum / (double)count) : NAN;
}

double eval_distance_value(const eval_distance *e, int32_t index)
{
    const eval_distance_bin *b = &e->bins[index / 3];
    switch (index % 3) {
    case 0: return rms_mm(b->raw_square_sum, b->raw_count);
    case 1: return rms_mm(b->square_sum, b->count);
    default: return b->angle_count > 0 ? b->angle_sum / (double)b->angle_count : NAN;
    }
}
