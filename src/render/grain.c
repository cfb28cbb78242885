/* Noise between pictures, and noise of its kind. */
#include "render/grain.h"

#include <math.h>
#include <string.h>

#define NEWEST 0.15f        /* share of a picture in what is known */
#define LEAST_SPOTS 24      /* of a brightness */
#define FLAT 8              /* codes to the other pixels: a place that shows noise and no edge */
#define PER_MEDIAN 1.4826f  /* sigma of a normal distribution over the median of its size */
#define PER_QUARTILE 3.1383 /* and over the value that a quarter of them are less than */
#define STEPS_SLACK 1.5     /* for few spots */
#define OUTLIER 4.0f        /* sigma: something that moved */
#define RISES 1.07       /* of a variance, at most: motion adds to it, and nothing takes off it */
#define RISES_LEAST 0.1  /* and so much, in square codes */
#define MOVES 0.75       /* correlation of neighbours: more than any noise has */
#define MOST_BESIDE 0.6f /* a blur of three pixels has no more */
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

/* A spot's pixels: one, those to its right and below, and one so far to its right that their noise
 * has nothing in common. What both share, a picture that moves or gets brighter, is no noise. */
enum { HERE, RIGHT, BELOW, FAR, FAR_PIXELS = 4 };

/* Of the flat spots of a brightness: how often two of their pixels changed so differently. */
typedef struct sums {
    int32_t far[3][CHANGES];          /* of a channel, from the pixel far to the right */
    int32_t beside[2][CHANGES];       /* of green, from those next to it */
    int32_t steps[3][CHANGES];        /* and how often the former differ so much in one picture */
    double red, green, red_and_green; /* sums of squares of the former */
} sums;

static void read_spot(const rlf_image_rgba8 *image, int32_t x, int32_t y, grain_spot *out)
{
    const uint8_t *p = rlf_rgba8_row(image, y) + 4 * (ptrdiff_t)x;
    memcpy(out->rgb[HERE], p, 3);
    memcpy(out->rgb[RIGHT], p + 4, 3);
    memcpy(out->rgb[BELOW], p + image->stride, 3);
    memcpy(out->rgb[FAR], p + 4 * (ptrdiff_t)FAR_PIXELS, 3);
}

static int32_t size_of(int32_t change)
{
    const int32_t size = change < 0 ? -change : change;
    return size < CHANGES ? size : CHANGES - 1;
}

/* The largest step from a pixel to the others, of both pictures together, whose noise is less. */
static int32_t step_at(const grain_spot *last, const grain_spot *now)
{
    int32_t most = 0;
    for (int i = RIGHT; i < GRAIN_PIXELS; i++) {
        for (int k = 0; k < 3; k++) {
            const int32_t step = size_of(
                (now->rgb[i][k] + last->rgb[i][k] - now->rgb[HERE][k] - last->rgb[HERE][k]) / 2);
            most = step > most ? step : most;
        }
    }
    return most;
}

/* How differently two pixels changed. */
static int32_t change_of(const grain_spot *last, const grain_spot *now, int other, int k)
{
    return now->rgb[HERE][k] - last->rgb[HERE][k] - now->rgb[other][k] + last->rgb[other][k];
}

static void add_spot(const grain *g, const grain_spot *last, const grain_spot *now, sums *out)
{
    /* Of the mean: how bright one of them is and how much they differ goes together. */
    const int32_t sum = now->rgb[0][0] + now->rgb[0][1] + now->rgb[0][2] + last->rgb[0][0] +
                        last->rgb[0][1] + last->rgb[0][2];
    const int32_t bin = sum / (6 * 256 / GRAIN_BINS);
    if (step_at(last, now) > FLAT + (int32_t)(2.0f * g->sigma[bin][1])) {
        return;
    }
    sums *of = &out[bin];
    int32_t far[3];
    for (int k = 0; k < 3; k++) {
        far[k] = change_of(last, now, FAR, k);
        of->far[k][size_of(far[k])]++;
        of->steps[k][size_of(now->rgb[HERE][k] - now->rgb[FAR][k])]++;
    }
    of->beside[0][size_of(change_of(last, now, RIGHT, 1))]++;
    of->beside[1][size_of(change_of(last, now, BELOW, 1))]++;
    const float most = g->is_seen[bin] ? OUTLIER * 2.0f * g->sigma[bin][1] + 2.0f : 24.0f;
    if ((float)size_of(far[0]) <= most && (float)size_of(far[1]) <= most) {
        of->red += far[0] * far[0];
        of->green += far[1] * far[1];
        of->red_and_green += far[0] * far[1];
    }
}

/* What `share` of all are less than: a change of k codes was anything from k - 1/2 to k + 1/2. */
static float quantile_of(const int32_t counts[CHANGES], float share, int32_t *out_count)
{
    int32_t all = 0;
    for (int32_t k = 0; k < CHANGES; k++) {
        all += counts[k];
    }
    *out_count = all;
    float below = 0.0f;
    for (int32_t k = 0; k < CHANGES && all > 0; k++) {
        const float here = (float)counts[k];
        if (below + here >= share * (float)all) {
            const float low = k > 0 ? (float)k - 0.5f : 0.0f;
            return low + (k > 0 ? 1.0f : 0.5f) * (share * (float)all - below) / here;
        }
        below += here;
    }
    return 0.0f;
}

/* Variance of a picture's noise, without what moved: four noises are in a difference of changes. */
static double variance_of(const int32_t counts[CHANGES], int32_t *out_count)
{
    const int32_t limit =
        (int32_t)(OUTLIER * PER_MEDIAN * quantile_of(counts, 0.5f, out_count)) + 2;
    double square = 0.0;
    double all = 0.0;
    for (int32_t k = 0; k < CHANGES && k <= limit; k++) {
        square += (double)counts[k] * k * k;
        all += counts[k];
    }
    return all > 0.0 ? square / (4.0 * all) : 0.0;
}

/* At most so much: nothing takes noise off a flat place either, and the flattest show it. Motion
 * adds nothing here, but texture does, so this alone would be too much. */
static double most_variance(const int32_t steps[CHANGES])
{
    int32_t count;
    const double sigma = (double)quantile_of(steps, 0.25f, &count) * PER_QUARTILE;
    return STEPS_SLACK * 0.5 * sigma * sigma;
}

static void approach(float *value, double now, bool is_known)
{
    *value += (is_known ? NEWEST : 1.0f) * ((float)now - *value);
}

/* What a picture tells of the noise, over all brightnesses. */
typedef struct pool {
    double far, beside[2], red, green, red_and_green;
} pool;

/* One step towards what a picture says of a brightness; where something moves that is no more than
 * what flat places show. */
static void learn(float *sigma, double now, const int32_t steps[CHANGES], bool is_seen)
{
    float variance = *sigma * *sigma;
    const double risen = is_seen ? RISES * variance + RISES_LEAST : now;
    approach(&variance, rlf_min(rlf_min(now, risen), most_variance(steps)), is_seen);
    *sigma = sqrtf(variance);
}

/* Nothing when too few spots show it. When neighbours change too much alike, something moves. */
static void take_brightness(grain *g, int32_t bin, const sums *s, pool *out)
{
    int32_t count;
    double far[3], beside[2];
    for (int k = 0; k < 3; k++) {
        far[k] = variance_of(s->far[k], &count);
    }
    for (int k = 0; k < 2; k++) {
        beside[k] = variance_of(s->beside[k], &count);
    }
    const double least = (1.0 - MOVES) * far[1];
    const bool moves = beside[0] < least || beside[1] < least;
    if (count < LEAST_SPOTS || (moves && !g->is_seen[bin])) {
        return;
    }
    for (int k = 0; k < 3; k++) {
        float *sigma = &g->sigma[bin][k];
        learn(sigma, moves ? *sigma * *sigma : far[k], s->steps[k], g->is_seen[bin]);
    }
    g->is_seen[bin] = true;
    if (!moves) {
        out->far += count * far[1];
        out->beside[0] += count * beside[0];
        out->beside[1] += count * beside[1];
        out->red += s->red;
        out->green += s->green;
        out->red_and_green += s->red_and_green;
    }
}

/* A brightness that was not seen yet is as noisy as the next darker one that was, or else as the
 * darkest of these. */
static void spread(grain *g)
{
    int32_t from = 0;
    while (from < GRAIN_BINS && !g->is_seen[from]) {
        from++;
    }
    for (int32_t bin = 0; bin < GRAIN_BINS && from < GRAIN_BINS; bin++) {
        from = g->is_seen[bin] ? bin : from;
        memcpy(g->sigma[bin], g->sigma[from], sizeof(g->sigma[bin]));
    }
}

/* A pixel of the next code is not suddenly noisier. */
static void fill_between(grain *g)
{
    const float wide = 256.0f / GRAIN_BINS;
    for (int32_t code = 0; code < 256; code++) {
        const float bin = ((float)code + 0.5f) / wide - 0.5f;
        const int32_t below = bin < 0.0f ? 0 : (int32_t)bin;
        const int32_t above = below + 1 < GRAIN_BINS ? below + 1 : below;
        const float share = bin < 0.0f ? 0.0f : bin - (float)below;
        for (int k = 0; k < 3; k++) {
            g->at[code][k] = g->sigma[below][k] + share * (g->sigma[above][k] - g->sigma[below][k]);
        }
    }
}

/* Most flat spots do not change by a code: what changes there moves. */
static bool is_noiseless(const sums s[GRAIN_BINS])
{
    int32_t all = 0;
    int32_t same = 0;
    for (int32_t i = 0; i < GRAIN_BINS * CHANGES; i++) {
        const int32_t count = s[i / CHANGES].far[1][i % CHANGES];
        all += count;
        same += i % CHANGES == 0 ? count : 0;
    }
    return 2 * same > all;
}

static void take_sums(grain *g, const sums s[GRAIN_BINS])
{
    pool p = {0};
    if (is_noiseless(s)) {
        return;
    }
    for (int32_t bin = 0; bin < GRAIN_BINS; bin++) {
        take_brightness(g, bin, &s[bin], &p);
    }
    spread(g);
    fill_between(g);
    if (p.far > 0.0 && p.red > 0.0 && p.green > 0.0) {
        approach(&g->beside[0], 1.0 - p.beside[0] / p.far, g->is_known);
        approach(&g->beside[1], 1.0 - p.beside[1] / p.far, g->is_known);
        approach(&g->common, p.red_and_green / sqrt(p.red * p.green), g->is_known);
        g->is_known = true;
    }
}

/* Spots on a lattice; `only_read` when there is no picture before. False when it is the last
 * picture again, as a camera gives whose colour is slower than its depth. */
static bool look(grain *g, const rlf_image_rgba8 *image, bool only_read, sums *out)
{
    int32_t step = 4;
    while ((image->width / step + 1) * (image->height / step + 1) > GRAIN_SPOTS) {
        step++;
    }
    bool is_other = false;
    int32_t i = 0;
    for (int32_t y = step / 2; y + 1 < image->height; y += step) {
        for (int32_t x = step / 2; x + FAR_PIXELS < image->width; x += step, i++) {
            grain_spot now;
            read_spot(image, x, y, &now);
            if (!only_read) {
                add_spot(g, &g->last[i], &now, out);
            }
            is_other = is_other || memcmp(&g->last[i], &now, sizeof(now)) != 0;
            g->last[i] = now;
        }
    }
    return is_other;
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
        memset(g->is_seen, 0, sizeof(g->is_seen));
        g->is_known = false;
        g->width = 0;
        return;
    }
    const bool is_first = image->width != g->width || image->height != g->height;
    if (!is_first && frame->sequence == g->sequence) {
        return;
    }
    sums s[GRAIN_BINS];
    memset(s, 0, sizeof(s));
    if (look(g, image, is_first, s) && !is_first) {
        take_sums(g, s);
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
