/* Noise between pictures, and noise of its kind. */
#include "render/grain.h"

#include <math.h>
#include <string.h>

#define NEWEST 0.15f       /* share of a picture in what is known */
#define LEAST_SPOTS 24     /* of a brightness */
#define FLAT 8             /* codes to the next pixels: a place that shows noise and no motion, */
#define STEEP 20           /* and one that shows motion */
#define MOVES 2.0f         /* the camera does when steep places change so many times as much, */
#define MOVES_CODES 2.0f   /* and more */
#define PER_MEDIAN 1.4826f /* sigma of a normal distribution over the median of its size */
#define OUTLIER 4.0f       /* sigma: something that moved */
#define MOST_BESIDE 0.6f   /* a blur of three pixels has no more */
#define STEPS 32.0f

enum { CHANGES = 64 }; /* codes that are told apart */

static uint32_t hash_of(uint32_t x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ x >> 16;
}

void grain_init(grain *g)
{
    memset(g, 0, sizeof(*g));
    g->blur[0] = -1;
    for (uint32_t i = 0; i < GRAIN_TILE * GRAIN_TILE; i++) {
        for (uint32_t k = 0; k < 4; k++) {
            const uint32_t h = hash_of(4 * i + k + 1);
            const int32_t sum =
                (int32_t)((h & 255u) + (h >> 8 & 255u) + (h >> 16 & 255u) + (h >> 24)) -
                510; /* of four even ones: nearly normal */
            g->white[i][k] = (float)sum * (1.0f / 147.8f);
        }
    }
}

/* ---- measuring ------------------------------------------------------------------------------ */

/* How often a change is so large: of flat places by brightness and channel, of steep ones by green.
 */
typedef struct sums {
    int32_t flat[GRAIN_BINS][3][CHANGES], all[CHANGES], steep[CHANGES];
    double square[3], beside[2], red_green;
} sums;

static void read_spot(const rlf_image_rgba8 *image, int32_t x, int32_t y, uint8_t out[9])
{
    const uint8_t *p = rlf_rgba8_row(image, y) + 4 * (ptrdiff_t)x;
    memcpy(out, p, 3);
    memcpy(out + 3, p + 4, 3);
    memcpy(out + 6, p + image->stride, 3);
}

static int32_t size_of(int32_t change)
{
    const int32_t size = change < 0 ? -change : change;
    return size < CHANGES ? size : CHANGES - 1;
}

/* The largest step from a pixel to the next ones, of both pictures together, whose noise is less.
 */
static int32_t step_at(const uint8_t last[9], const uint8_t now[9])
{
    int32_t most = 0;
    for (int k = 3; k < 9; k++) {
        const int32_t step = size_of((now[k] + last[k] - now[k % 3] - last[k % 3]) / 2);
        most = step > most ? step : most;
    }
    return most;
}

static void add_spot(const grain *g, const uint8_t last[9], const uint8_t now[9], sums *out)
{
    int32_t d[9];
    /* Of the mean: how bright one of them is and how much they differ goes together. */
    const int32_t sum = now[0] + now[1] + now[2] + last[0] + last[1] + last[2];
    const int32_t bin = sum / (6 * 256 / GRAIN_BINS);
    const int32_t step = step_at(last, now);
    const float most = g->is_known ? OUTLIER * 1.5f * g->sigma[bin][1] + 2.0f : 24.0f;
    bool is_noise = step <= FLAT + (int32_t)(2.0f * g->sigma[bin][1]);
    out->steep[size_of(now[1] - last[1])] += step >= STEEP ? 1 : 0;
    for (int k = 0; k < 9 && is_noise; k++) {
        d[k] = now[k] - last[k];
        if (k < 3) {
            out->flat[bin][k][size_of(d[k])]++;
        }
    }
    out->all[size_of(now[1] - last[1])] += is_noise ? 1 : 0;
    for (int k = 0; k < 9 && is_noise; k++) {
        is_noise = (float)size_of(d[k]) <= most;
    }
    if (is_noise) {
        for (int k = 0; k < 3; k++) {
            out->square[k] += d[k] * d[k];
        }
        out->beside[0] += d[1] * d[4];
        out->beside[1] += d[1] * d[7];
        out->red_green += d[0] * d[1];
    }
}

/* A change of k codes was anything from k - 1/2 to k + 1/2. */
static float median_of(const int32_t counts[CHANGES], int32_t *out_count)
{
    int32_t all = 0;
    for (int32_t k = 0; k < CHANGES; k++) {
        all += counts[k];
    }
    *out_count = all;
    float below = 0.0f;
    for (int32_t k = 0; k < CHANGES && all > 0; k++) {
        const float here = (float)counts[k];
        if (below + here >= 0.5f * (float)all) {
            const float low = k > 0 ? (float)k - 0.5f : 0.0f;
            return low + (k > 0 ? 1.0f : 0.5f) * (0.5f * (float)all - below) / here;
        }
        below += here;
    }
    return 0.0f;
}

/* Variance of a picture's noise, from changes between two, without what moved. */
static double variance_of(const int32_t counts[CHANGES], float median)
{
    const int32_t limit = (int32_t)(OUTLIER * PER_MEDIAN * median) + 2;
    double square = 0.0;
    double all = 0.0;
    for (int32_t k = 0; k < CHANGES && k <= limit; k++) {
        square += (double)counts[k] * k * k;
        all += counts[k];
    }
    return all > 0.0 ? square / (2.0 * all) : 0.0;
}

static bool is_still(const sums *s)
{
    int32_t flat, steep;
    const float noise = median_of(s->all, &flat);
    const float motion = median_of(s->steep, &steep);
    return flat >= LEAST_SPOTS && (steep < LEAST_SPOTS || motion <= MOVES * noise + MOVES_CODES);
}

static void approach(float *value, double now, bool is_known)
{
    *value += (is_known ? NEWEST : 1.0f) * ((float)now - *value);
}

/* A brightness that is not seen is as noisy as the next darker one that is. */
static void take_sums(grain *g, const sums *s)
{
    int32_t from = -1;
    for (int32_t bin = 0; bin < GRAIN_BINS; bin++) {
        int32_t count = 0;
        for (int k = 0; k < 3; k++) {
            const float median = median_of(s->flat[bin][k], &count);
            float variance = g->sigma[bin][k] * g->sigma[bin][k];
            if (count >= LEAST_SPOTS) {
                approach(&variance, variance_of(s->flat[bin][k], median), g->is_known);
                g->sigma[bin][k] = sqrtf(variance);
            } else if (from >= 0) {
                g->sigma[bin][k] = g->sigma[from][k];
            }
        }
        for (int32_t b = 0; count >= LEAST_SPOTS && from < 0 && b < bin; b++) {
            memcpy(g->sigma[b], g->sigma[bin], sizeof(g->sigma[b]));
        }
        from = count >= LEAST_SPOTS ? bin : from;
    }
    if (s->square[1] > 0.0 && s->square[0] > 0.0) {
        approach(&g->beside[0], s->beside[0] / s->square[1], g->is_known);
        approach(&g->beside[1], s->beside[1] / s->square[1], g->is_known);
        approach(&g->common, s->red_green / sqrt(s->square[0] * s->square[1]), g->is_known);
    }
    g->is_known = g->is_known || from >= 0;
}

/* Spots on a lattice; `only_read` when there is no picture before. */
static void look(grain *g, const rlf_image_rgba8 *image, bool only_read, sums *out)
{
    int32_t step = 4;
    while ((image->width / step + 1) * (image->height / step + 1) > GRAIN_SPOTS) {
        step++;
    }
    int32_t i = 0;
    for (int32_t y = step / 2; y + 1 < image->height; y += step) {
        for (int32_t x = step / 2; x + 1 < image->width; x += step, i++) {
            uint8_t now[9];
            read_spot(image, x, y, now);
            if (!only_read) {
                add_spot(g, g->last[i], now, out);
            }
            memcpy(g->last[i], now, sizeof(now));
        }
    }
}

/* ---- the tile ------------------------------------------------------------------------------- */

/* Side of the kernel (a, 1, a) after which neighbours correlate so: 2 a / (1 + 2 a^2). */
static float side_of(int32_t steps)
{
    const float r = (float)steps / STEPS;
    return steps > 0 ? (1.0f - sqrtf(1.0f - 2.0f * r * r)) / (2.0f * r) : 0.0f;
}

/* White noise of a channel, as far as it has that to itself. */
static float white_at(const grain *g, int32_t x, int32_t y, int k, float own, float common)
{
    const float *w = g->white[(y & (GRAIN_TILE - 1)) * GRAIN_TILE + (x & (GRAIN_TILE - 1))];
    return own * w[k] + common * w[3];
}

static void make_tile(grain *g)
{
    const float a = side_of(g->blur[0]);
    const float b = side_of(g->blur[1]);
    const float share = (float)g->mixed / STEPS;
    const float scale = 1.0f / sqrtf((1.0f + 2.0f * a * a) * (1.0f + 2.0f * b * b));
    const float own = scale * sqrtf(1.0f - share);
    const float common = scale * sqrtf(share);
    for (int32_t i = 0; i < GRAIN_TILE * GRAIN_TILE; i++) {
        const int32_t x = i % GRAIN_TILE;
        const int32_t y = i / GRAIN_TILE;
        for (int k = 0; k < 3; k++) {
            float line[3];
            for (int32_t d = 0; d < 3; d++) {
                line[d] = white_at(g, x, y + d - 1, k, own, common) +
                          a * (white_at(g, x - 1, y + d - 1, k, own, common) +
                               white_at(g, x + 1, y + d - 1, k, own, common));
            }
            g->tile[i][k] = line[1] + b * (line[0] + line[2]);
        }
    }
}

static int32_t steps_of(float correlation, float most)
{
    const float limited = correlation < 0.0f ? 0.0f : (correlation > most ? most : correlation);
    return (int32_t)(limited * STEPS + 0.5f);
}

static void update_tile(grain *g)
{
    const int32_t x = steps_of(g->beside[0], MOST_BESIDE);
    const int32_t y = steps_of(g->beside[1], MOST_BESIDE);
    const int32_t mixed = steps_of(g->common, 1.0f);
    if (x != g->blur[0] || y != g->blur[1] || mixed != g->mixed) {
        g->blur[0] = x;
        g->blur[1] = y;
        g->mixed = mixed;
        make_tile(g);
    }
}

void grain_update(grain *g, const rlf_frame *frame)
{
    const rlf_image_rgba8 *image = &frame->color;
    if (image->data == NULL) {
        memset(g->sigma, 0, sizeof(g->sigma));
        g->is_known = false;
        g->width = 0;
        return;
    }
    const bool is_first = image->width != g->width || image->height != g->height;
    if (!is_first && frame->sequence == g->sequence) {
        return;
    }
    sums s;
    memset(&s, 0, sizeof(s));
    look(g, image, is_first, &s);
    if (!is_first && is_still(&s)) {
        take_sums(g, &s);
    }
    g->sequence = frame->sequence;
    g->width = image->width;
    g->height = image->height;
    const uint32_t h = hash_of((uint32_t)frame->sequence + 77u);
    g->offset_x = (int32_t)(h & (GRAIN_TILE - 1));
    g->offset_y = (int32_t)(h >> 8 & (GRAIN_TILE - 1));
    if (g->is_known) {
        update_tile(g);
    }
}
