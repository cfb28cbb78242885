/* Depth over time, pixel by pixel. What moves or drifts has successive differences that are small
 * beside its deviation: the ratio of the mean square successive difference to the variance (von
 * Neumann 1941) is 2 for noise alone. */
#include "info/stillness.h"

#include <math.h>
#include <string.h>

/* Histogram of the deviation: 0.1 mm cells to 0.2 m, the last one takes the rest. */
#define CELLS 2000
#define CELL_M 1e-4

typedef struct pixel_sums {
    float last, mean;
    float square;     /* sum of squares about the mean */
    float successive; /* sum of squared differences from frame to frame */
    int16_t count, pairs;
} pixel_sums;

struct stillness {
    size_t count;
    int32_t frames;
    pixel_sums *pixels;
};

stillness *stillness_create(const rlf_rig *rig)
{
    stillness *s = rlf_alloc(sizeof(*s));
    if (s == NULL) {
        return NULL;
    }
    s->count = (size_t)rig->depth.width * (size_t)rig->depth.height;
    s->pixels = rlf_alloc_array(s->count, sizeof(s->pixels[0]));
    if (s->pixels == NULL) {
        stillness_destroy(&s);
    }
    return s;
}

void stillness_destroy(stillness **s)
{
    if (*s != NULL) {
        rlf_free((*s)->pixels);
        rlf_free(*s);
        *s = NULL;
    }
}

/* Mean and variance as they come (Welford 1962). */
static void add_pixel(pixel_sums *p, float z)
{
    if (z <= 0.0f) {
        p->last = 0.0f;
        return;
    }
    if (p->last > 0.0f) {
        p->successive += (z - p->last) * (z - p->last);
        p->pairs++;
    }
    p->count++;
    const float off = z - p->mean;
    p->mean += off / (float)p->count;
    p->square += off * (z - p->mean);
    p->last = z;
}

void stillness_add(stillness *s, const float *depth)
{
    if (s->frames == STILLNESS_FRAMES_MAX) {
        return;
    }
    for (size_t i = 0; i < s->count; i++) {
        add_pixel(&s->pixels[i], depth[i]);
    }
    s->frames++;
}

/* The ratio scatters by 2 / sqrt(n) about 2; what is two deviations below is taken to move. */
static bool is_still(const pixel_sums *p)
{
    const double variance = p->square / (p->count - 1);
    if (variance <= 0.0) {
        return true; /* always the same: finer than the depth's steps */
    }
    const double ratio = p->successive / p->pairs / variance;
    return ratio > 2.0 - 4.0 / sqrt(p->count);
}

/* Deviation below which a share of the pixels lies. */
static double quantile(const int64_t *cells, int64_t count, double share)
{
    int64_t below = 0;
    for (int32_t i = 0; i < CELLS; i++) {
        below += cells[i];
        if ((double)below >= share * (double)count) {
            return i * CELL_M;
        }
    }
    return CELLS * CELL_M;
}

void stillness_get(const stillness *s, stillness_result *out)
{
    static int64_t cells[INFO_BINS][CELLS];
    memset(cells, 0, sizeof(cells));
    memset(out, 0, sizeof(*out));
    out->frames = s->frames;
    int64_t seen = 0, still = 0;
    for (size_t i = 0; i < s->count && s->frames >= STILLNESS_FRAMES_MIN; i++) {
        const pixel_sums *p = &s->pixels[i];
        if (p->count * 5 < s->frames * 4 || p->pairs < STILLNESS_FRAMES_MIN / 2) {
            continue;
        }
        seen++;
        if (is_still(p)) {
            still++;
            const double sigma = sqrt(0.5 * p->successive / p->pairs);
            const int32_t cell = (int32_t)fmin(sigma / CELL_M + 0.5, CELLS - 1);
            cells[info_bin(p->mean)][cell]++;
            out->bins[info_bin(p->mean)].pixels++;
        }
    }
    out->still_percent = seen > 0 ? 100.0 * (double)still / (double)seen : 0.0;
    for (int32_t b = 0; b < INFO_BINS; b++) {
        stillness_bin *bin = &out->bins[b];
        bin->median_m = bin->pixels > 0 ? quantile(cells[b], bin->pixels, 0.5) : 0.0;
        bin->most_m = bin->pixels > 0 ? quantile(cells[b], bin->pixels, 0.9) : 0.0;
    }
}
