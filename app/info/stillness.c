/* Depth over time, pixel by pixel. A pixel is still when it stays within the noise that its sensor
 * is taken to have, and does not drift: noise may last from frame to frame, and depth has steps.
 *
 * Of a sensor that is noisier than it is taken to be, noise tells itself. What moves or drifts has
 * successive differences that are small beside its deviation: the ratio of the mean square
 * successive difference to the variance (von Neumann 1941) is 2 for noise alone. Where most pixels
 * at a distance have noise alone, those that have about as much of it as the others are still. */
#include "info/info.h"

#include <math.h>
#include <string.h>

/* Histogram of the deviation: 0.1 mm cells to 0.2 m, the last one takes the rest. */
#define CELLS 2000
#define CELL_M (STILLNESS_MOST_M / CELLS)

static const double most_deviation = 2.5; /* in sigmas of the sensor's model ... */
static const double most_drift = 3.0;     /* ... and from the first frame to the last */
static const double most_unlike = 3.0;    /* times as much noise as half of the others */

typedef struct pixel_sums {
    float last, mean, first;
    float square;     /* sum of squares about the mean */
    float successive; /* sum of squared differences from frame to frame */
    float times;      /* sums of the frames' numbers, of their squares, ... */
    float times_square;
    float moment; /* ... and of both with depth, from the first one on */
    int16_t count, pairs;
} pixel_sums;

struct stillness {
    rlf_depth_noise noise;
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
    s->noise = rig->noise;
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
static void add_pixel(pixel_sums *p, float z, float time)
{
    if (z <= 0.0f) {
        p->last = 0.0f;
        return;
    }
    if (p->last > 0.0f) {
        p->successive += (z - p->last) * (z - p->last);
        p->pairs++;
    }
    p->first = p->count == 0 ? z : p->first;
    p->times += time;
    p->times_square += time * time;
    p->moment += time * (z - p->first);
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
        add_pixel(&s->pixels[i], depth[i], (float)s->frames);
    }
    s->frames++;
}

static double variance_of(const pixel_sums *p)
{
    return fmax(p->square / (p->count - 1), 0.0);
}

/* Standard deviation of the noise from frame to frame. */
static double noise_of(const pixel_sums *p)
{
    return sqrt(0.5 * p->successive / p->pairs);
}

/* By the line that fits depth over time. */
static double drift_of(const pixel_sums *p, int32_t frames)
{
    const double n = p->count, mean_time = p->times / n;
    const double spread = p->times_square - n * mean_time * mean_time;
    const double moment = p->moment - p->times * ((double)p->mean - (double)p->first);
    return spread > 0.0 ? fabs(moment / spread) * (frames - 1) : 0.0;
}

static bool is_seen(const stillness *s, const pixel_sums *p)
{
    return p->count * 5 >= s->frames * 4 && p->pairs >= STILLNESS_FRAMES_MIN / 2;
}

static bool is_as_taken(const stillness *s, const pixel_sums *p)
{
    const double sigma = rlf_depth_noise_sigma(&s->noise, p->mean);
    return sqrt(variance_of(p)) <= most_deviation * sigma &&
           drift_of(p, s->frames) <= most_drift * sigma;
}

/* The ratio scatters by 2 / sqrt(n) about 2; what is two deviations below is taken to move. */
static bool is_noise(const pixel_sums *p)
{
    const double variance = variance_of(p);
    const double ratio = variance > 0.0 ? p->successive / p->pairs / variance : 2.0;
    return ratio > 2.0 - 4.0 / sqrt(p->count);
}

static int32_t cell_of(double sigma)
{
    return (int32_t)fmin(sigma / CELL_M + 0.5, CELLS - 1);
}

/* Deviation below which a share of the pixels lies. */
static double quantile(const int64_t *cells, int64_t count, double share)
{
    int64_t below = 0;
    for (int32_t i = 0; i < CELLS; i++) {
        below += cells[i];
        if ((double)below >= share * (double)count && i < CELLS - 1) {
            return i * CELL_M;
        }
    }
    return STILLNESS_MOST_M;
}

typedef struct tally {
    int64_t seen, still, noisy;
    int64_t cells[CELLS]; /* of the pixels that are still, or have noise alone */
    double most;          /* noise that counts as noise; 0 = none does */
} tally;

static tally tallies[INFO_BINS];

/* How much noise alone may be, at each distance. */
static void bound_noise(const stillness *s)
{
    for (size_t i = 0; i < s->count; i++) {
        const pixel_sums *p = &s->pixels[i];
        tally *t = &tallies[info_bin(p->mean)];
        if (is_seen(s, p)) {
            t->seen++;
            if (is_noise(p)) {
                t->noisy++;
                t->cells[cell_of(noise_of(p))]++;
            }
        }
    }
    for (int32_t b = 0; b < INFO_BINS; b++) {
        tally *t = &tallies[b];
        t->most = 2 * t->noisy > t->seen ? most_unlike * quantile(t->cells, t->noisy, 0.5) : 0.0;
        memset(t->cells, 0, sizeof(t->cells));
    }
}

static void count_still(const stillness *s)
{
    for (size_t i = 0; i < s->count; i++) {
        const pixel_sums *p = &s->pixels[i];
        tally *t = &tallies[info_bin(p->mean)];
        const bool is_still =
            is_seen(s, p) && (is_as_taken(s, p) || (noise_of(p) <= t->most && is_noise(p)));
        if (is_still) {
            t->still++;
            t->cells[cell_of(noise_of(p))]++;
        }
    }
}

void stillness_get(const stillness *s, stillness_result *out)
{
    memset(tallies, 0, sizeof(tallies));
    memset(out, 0, sizeof(*out));
    out->frames = s->frames;
    if (s->frames < STILLNESS_FRAMES_MIN) {
        return;
    }
    bound_noise(s);
    count_still(s);
    int64_t seen = 0, still = 0;
    for (int32_t b = 0; b < INFO_BINS; b++) {
        const tally *t = &tallies[b];
        stillness_bin *bin = &out->bins[b];
        seen += t->seen;
        still += t->still;
        bin->pixels = t->still;
        bin->median_m = t->still > 0 ? quantile(t->cells, t->still, 0.5) : 0.0;
        bin->most_m = t->still > 0 ? quantile(t->cells, t->still, 0.9) : 0.0;
    }
    out->still_percent = seen > 0 ? 100.0 * (double)still / (double)seen : 0.0;
}
