/* Noise between pictures, and noise of its kind. */
#include "render/grain.h"

#include <math.h>
#include <string.h>

#define NEWEST 0.15f      /* share of a picture in what is known */
#define FIRST_LIMIT 24.0f /* codes: what differs by more has moved */
#define STILL_SHARE 0.6f  /* of the spots: of fewer the camera moves */
#define LEAST_SPOTS 24    /* of a brightness */
#define MOST_BESIDE 0.6f  /* a blur of three pixels has no more */
#define STEPS 32.0f

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

typedef struct sums {
    double square[GRAIN_BINS][3], all[3], beside[2], red_green;
    int32_t count[GRAIN_BINS], still, seen;
} sums;

static void read_spot(const rlf_image_rgba8 *image, int32_t x, int32_t y, uint8_t out[9])
{
    const uint8_t *p = rlf_rgba8_row(image, y) + 4 * (ptrdiff_t)x;
    memcpy(out, p, 3);
    memcpy(out + 3, p + 4, 3);
    memcpy(out + 6, p + image->stride, 3);
}

/* What differs by more than four sigma has moved; a code of rounding is allowed beside. */
static float limit_of(const grain *g, int32_t bin, int k)
{
    const float most = 4.0f * 1.5f * g->sigma[bin][k] + 2.0f;
    return g->is_known ? most : FIRST_LIMIT;
}

static void add_spot(const grain *g, const uint8_t last[9], const uint8_t now[9], sums *out)
{
    int32_t d[9];
    /* Of the mean: how bright one of them is and how much they differ goes together. */
    const int32_t sum = now[0] + now[1] + now[2] + last[0] + last[1] + last[2];
    const int32_t bin = sum / (6 * 256 / GRAIN_BINS);
    bool is_still = true;
    for (int k = 0; k < 9; k++) {
        d[k] = now[k] - last[k];
        const float limit = limit_of(g, bin, k % 3);
        is_still = is_still && (float)d[k] <= limit && (float)-d[k] <= limit;
    }
    out->seen++;
    if (!is_still) {
        return;
    }
    out->still++;
    out->count[bin]++;
    for (int k = 0; k < 3; k++) {
        out->square[bin][k] += d[k] * d[k];
        out->all[k] += d[k] * d[k];
    }
    out->beside[0] += d[1] * d[4];
    out->beside[1] += d[1] * d[7];
    out->red_green += d[0] * d[1];
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
        const bool is_seen = s->count[bin] >= LEAST_SPOTS;
        for (int k = 0; k < 3; k++) {
            float variance = g->sigma[bin][k] * g->sigma[bin][k];
            if (is_seen) {
                approach(&variance, s->square[bin][k] / (2.0 * s->count[bin]), g->is_known);
                g->sigma[bin][k] = sqrtf(variance);
            } else if (from >= 0) {
                g->sigma[bin][k] = g->sigma[from][k];
            }
        }
        for (int32_t b = 0; is_seen && from < 0 && b < bin; b++) {
            memcpy(g->sigma[b], g->sigma[bin], sizeof(g->sigma[b]));
        }
        from = is_seen ? bin : from;
    }
    if (s->all[1] > 0.0 && s->all[0] > 0.0) {
        approach(&g->beside[0], s->beside[0] / s->all[1], g->is_known);
        approach(&g->beside[1], s->beside[1] / s->all[1], g->is_known);
        approach(&g->common, s->red_green / sqrt(s->all[0] * s->all[1]), g->is_known);
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
    sums s = {.seen = 0};
    look(g, image, is_first, &s);
    if (s.seen > 0 && (float)s.still > STILL_SHARE * (float)s.seen) {
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
