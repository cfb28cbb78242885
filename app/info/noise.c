/* Spatial noise: w = 1/z is linear along a row of a plane, so its second difference at step h is
 * noise alone, z^2 (w(-h) - 2 w(0) + w(h)) / sqrt(6). Curved surfaces and edges are outliers, so
 * the deviation is that of the middle part of the samples. Noise that is alike in neighbours shows
 * as a deviation that grows with the step. Temporal noise: (z_t - z_t-1) / sqrt(2). */
#include "info/info.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Histogram of |residual|: 0.1 mm cells to 0.2 m, the last one takes the rest. */
#define CELLS 2000
#define CELL_M 1e-4
#define SAMPLES_MIN 200

typedef struct noise_histogram {
    int64_t count;
    int64_t cells[CELLS];
} noise_histogram;

struct info_noise {
    int32_t width, height;
    float *depth, *previous;
    int64_t frames, pixels, missing;
    int64_t in_bin[INFO_NOISE_BINS];
    noise_histogram histograms[NOISE_KIND_COUNT][INFO_NOISE_BINS];
};

info_noise *info_noise_create(const rlf_rig *rig)
{
    info_noise *noise = rlf_alloc(sizeof(*noise));
    if (noise == NULL) {
        return NULL;
    }
    size_t count = (size_t)rig->depth.width * (size_t)rig->depth.height;
    memset(noise, 0, sizeof(*noise));
    noise->width = rig->depth.width;
    noise->height = rig->depth.height;
    noise->depth = rlf_alloc_array(count, sizeof(float));
    noise->previous = rlf_alloc_array(count, sizeof(float));
    if (noise->depth == NULL || noise->previous == NULL) {
        info_noise_destroy(&noise);
    }
    return noise;
}

void info_noise_destroy(info_noise **noise)
{
    if (*noise != NULL) {
        rlf_free((*noise)->depth);
        rlf_free((*noise)->previous);
        rlf_free(*noise);
        *noise = NULL;
    }
}

static int32_t bin_of(float z)
{
    int32_t bin = (int32_t)(z / INFO_NOISE_BIN_M);
    return bin < INFO_NOISE_BINS ? bin : -1;
}

static void histogram_add(noise_histogram *h, double residual)
{
    int32_t cell = (int32_t)fmin(fabs(residual) / CELL_M, CELLS - 1);
    h->cells[cell]++;
    h->count++;
}

static void add_pixel(info_noise *noise, int32_t x, int32_t y)
{
    static const int32_t steps[] = {1, 2, 4};
    const float *at = noise->depth + (ptrdiff_t)y * noise->width + x;
    int32_t bin = bin_of(*at);
    if (bin < 0) {
        return;
    }
    noise->in_bin[bin]++;
    for (int k = 0; k < 3; k++) {
        int32_t h = steps[k];
        bool inside = x >= h && x + h < noise->width;
        if (inside && at[-h] > 0.0f && at[h] > 0.0f) {
            double bend = 1.0 / at[-h] - 2.0 / at[0] + 1.0 / at[h];
            histogram_add(&noise->histograms[k][bin], at[0] * at[0] * bend / sqrt(6.0));
        }
    }
    float before = noise->previous[(ptrdiff_t)y * noise->width + x];
    if (noise->frames > 0 && before > 0.0f) {
        histogram_add(&noise->histograms[NOISE_TEMPORAL][bin], (at[0] - before) / sqrt(2.0));
    }
}

void info_noise_add(info_noise *noise, const rlf_frame *frame)
{
    info_depth_plane(frame, noise->depth);
    for (int32_t y = 0; y < noise->height; y++) {
        for (int32_t x = 0; x < noise->width; x++) {
            noise->pixels++;
            if (noise->depth[(ptrdiff_t)y * noise->width + x] > 0.0f) {
                add_pixel(noise, x, y);
            } else {
                noise->missing++;
            }
        }
    }
    float *depth = noise->depth;
    noise->depth = noise->previous;
    noise->previous = depth;
    noise->frames++;
}

/* Value below which a share of the samples lies. */
static double quantile(const noise_histogram *h, double share)
{
    int64_t wanted = (int64_t)(share * (double)h->count);
    int64_t below = h->cells[0];
    int32_t cell = 0;
    while (below < wanted && cell < CELLS - 1) {
        below += h->cells[++cell];
    }
    return cell * CELL_M;
}

/* Whole units of depth make the quantiles a staircase, so they only set the scale for a cut at 3
 * deviations, within which the root of the mean square is taken (0.9867 of the deviation for a
 * normal distribution). 68.27 % and 90 % of a normal distribution lie within 1 and 1.645
 * deviations; the second counts where most samples are equal. */
double info_noise_sigma(const info_noise *noise, noise_kind kind, int32_t bin)
{
    const noise_histogram *h = &noise->histograms[kind][bin];
    if (h->count < SAMPLES_MIN) {
        return -1.0;
    }
    double scale = fmax(quantile(h, 0.6827), quantile(h, 0.90) / 1.645) + CELL_M;
    int32_t end = (int32_t)fmin(3.0 * scale / CELL_M, CELLS - 1);
    double sum = 0.0;
    int64_t count = 0;
    for (int32_t i = 0; i < end; i++) {
        double value = i == 0 ? 0.0 : (i + 0.5) * CELL_M;
        sum += (double)h->cells[i] * value * value;
        count += h->cells[i];
    }
    return count > 0 ? sqrt(sum / (double)count) / 0.9867 : -1.0;
}

double info_noise_share(const info_noise *noise, int32_t bin)
{
    return noise->pixels > 0 ? 100.0 * (double)noise->in_bin[bin] / (double)noise->pixels : 0.0;
}

double info_noise_missing(const info_noise *noise)
{
    return noise->pixels > 0 ? 100.0 * (double)noise->missing / (double)noise->pixels : 0.0;
}

int64_t info_noise_frames(const info_noise *noise)
{
    return noise->frames;
}
