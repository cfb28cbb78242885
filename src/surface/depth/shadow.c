/* The sensor's shadow: a projector beside the camera lights from another place, so that beside a
 * near thing, on one side of it, a strip of what is behind returns nothing.
 *
 * The strip is fx * baseline * (1 / z_near - 1 / z_far) pixels wide (Khoshelham and Elberink 2012).
 * The baseline, and the side, are read off the picture: every run without depth between a near and
 * a far end says how long its baseline would be. On the shadow's side many are about as long, and
 * their median is the sensor's; on the other side, and with a sensor that has none, few are. */
#include "surface/steps.h"

#include <string.h>

enum {
    ROWS_APART = 8,  /* of those that a frame is asked about */
    WIDEST = 64,     /* pixels without depth; what is wider is a hole */
    FIRST_BIN = 4,   /* of a run that a shadow is in: less is what drivers drop at edges */
    LEAST_TOLD = 50, /* runs, so that their median counts */
    PLAIN_STEP = 4   /* pixels of shadow that a step would have to throw by `plain_m` */
};

static const float bin_m = 0.005f;     /* of a baseline */
static const float plain_m = 0.05f;    /* a baseline of most sensors, until this one's is known */
static const float least_share = 0.3f; /* of the runs on a shadow's side are long ... */
static const float least_more = 1.5f;  /* ... and so many times as many as on the other */
static const float kept = 0.98f;       /* of what was told, from frame to frame */

static void tell(rlf_reconstruct *stage, float left, float right, int32_t wide)
{
    rlf_shadow *shadow = &stage->shadow;
    float steps = (float)stage->grid.camera.fx * rlf_kernel_abs(1.0f / left - 1.0f / right);
    if (!(steps * plain_m >= (float)PLAIN_STEP)) {
        return;
    }
    float metres = wide > RLF_SHADOW_MIXED ? (float)(wide - RLF_SHADOW_MIXED) / steps : 0.0f;
    int32_t bin = (int32_t)(metres / bin_m);
    if (bin < RLF_SHADOW_BINS) {
        shadow->told[left < right][bin] += 1.0f;
    }
}

static void ask_row(rlf_reconstruct *stage, const float *depth)
{
    int32_t width = stage->grid.width, last = -1;
    for (int32_t x = 0; x < width; x++) {
        if (!(depth[x] > 0.0f)) {
            continue;
        }
        if (last >= 0 && x - last <= WIDEST) {
            tell(stage, depth[last], depth[x], x - last - 1);
        }
        last = x;
    }
}

static float sum_from(const float told[RLF_SHADOW_BINS], int32_t first)
{
    float sum = 0.0f;
    for (int32_t k = first; k < RLF_SHADOW_BINS; k++) {
        sum += told[k];
    }
    return sum;
}

/* Metres; of the runs that are longer than those at an edge without shadow. */
static float median_of(const float told[RLF_SHADOW_BINS])
{
    float half = 0.5f * sum_from(told, FIRST_BIN), sum = 0.0f;
    int32_t bin = FIRST_BIN;
    while (bin < RLF_SHADOW_BINS - 1 && sum + told[bin] < half) {
        sum += told[bin++];
    }
    return ((float)bin + 0.5f) * bin_m;
}

/* A shadow lies on one side only: there long runs are many, and more than on the other. */
static void find_baseline(rlf_shadow *shadow)
{
    float plain[2] = {sum_from(shadow->told[0], FIRST_BIN), sum_from(shadow->told[1], FIRST_BIN)};
    int32_t side = plain[1] > plain[0] ? 1 : 0;
    float all = sum_from(shadow->told[side], 0);
    shadow->is_known = all + sum_from(shadow->told[1 - side], 0) >= (float)LEAST_TOLD;
    bool is_there = plain[side] >= least_share * all && plain[side] >= least_more * plain[1 - side];
    shadow->baseline[side] = is_there ? median_of(shadow->told[side]) : 0.0f;
    shadow->baseline[1 - side] = 0.0f;
}

void rlf_shadow_reset(rlf_shadow *shadow)
{
    memset(shadow, 0, sizeof *shadow);
}

void rlf_shadow_learn(rlf_reconstruct *stage, const float *depth)
{
    rlf_shadow *shadow = &stage->shadow;
    for (int32_t side = 0; side < 2; side++) {
        for (int32_t k = 0; k < RLF_SHADOW_BINS; k++) {
            shadow->told[side][k] *= kept;
        }
    }
    for (int32_t y = shadow->next_row; y < stage->grid.height; y += ROWS_APART) {
        ask_row(stage, depth + (ptrdiff_t)y * stage->grid.width);
    }
    shadow->next_row = (shadow->next_row + 1) % ROWS_APART;
    find_baseline(shadow);
}

float rlf_shadow_width(const rlf_reconstruct *stage, rlf_shadow_side side, float near_z,
                       float far_z)
{
    float baseline = stage->shadow.baseline[side];
    float apart = near_z < far_z ? 1.0f / near_z - 1.0f / far_z : 0.0f;
    return (float)stage->grid.camera.fx * (stage->shadow.is_known ? baseline : plain_m) * apart;
}
