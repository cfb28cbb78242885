/* Blur and noise of the camera. */
#include "render/finish.h"

#include "kernel/kernel.h"

#include <string.h>

#define EVERY 4     /* frames between those whose edges are looked at */
#define ROW_STEP 12 /* pixels between rows that are looked at */
#define STEEP 24    /* codes across two pixels: an edge */
#define CONTRAST 60 /* of both its sides */
#define SIDE_PX 6   /* longest way from its middle to a side */
#define FLAT 0.08f  /* of the contrast: what the sides may differ beyond */
#define LEAST_EDGES 40.0f
#define KEPT 0.9f        /* of past edges, per look */
#define SHARP_SHARE 0.3f /* of the edges: slanted and rounded ones are wider */
#define DRAWN_PX 0.95f   /* width of an edge as it is drawn, over a pixel by four samples; */
#define SHARP_PX 1.3f    /* which, between pixels, looks up to so wide, */
#define BLURRED_PX 1.7f  /* and this is surely wider */
#define ACROSS 2.563f    /* from 10 to 90 % of a Gaussian's step, in sigma */
#define TAPS 2           /* pixels to each side of the blur */

/* ---- how sharp the camera is ---------------------------------------------------------------- */

/* Where a rising row passes a value, going from pixel `from` on. */
static float crossing(const uint8_t *green, int32_t from, int32_t step, int32_t sign, float value)
{
    int32_t x = from;
    while ((float)(sign * green[4 * (x + step)]) < (float)sign * value) {
        x += step;
    }
    const float low = (float)green[4 * x];
    const float high = (float)green[4 * (x + step)];
    return (float)(x * step) + (value - low) / (high - low);
}

/* Width of the edge about pixel x of a row, or 0 when it is none that tells. */
static float width_at(const uint8_t *green, int32_t x)
{
    const int32_t sign = green[4 * (x + 1)] > green[4 * (x - 1)] ? 1 : -1;
    int32_t left = x;
    int32_t right = x;
    while (x - left < SIDE_PX && sign * (green[4 * left] - green[4 * (left - 1)]) > 0) {
        left--;
    }
    while (right - x < SIDE_PX && sign * (green[4 * (right + 1)] - green[4 * right]) > 0) {
        right++;
    }
    const int32_t low = green[4 * left];
    const int32_t contrast = sign * (green[4 * right] - low);
    const float flat = FLAT * (float)contrast;
    const int32_t before = green[4 * (left - 2)] - low;
    const int32_t beyond = green[4 * (right + 2)] - green[4 * right];
    if (contrast < CONTRAST || x - left == SIDE_PX || right - x == SIDE_PX ||
        (float)(before * before) > flat * flat || (float)(beyond * beyond) > flat * flat) {
        return 0.0f;
    }
    const float step = (float)(sign * contrast);
    return crossing(green, left, 1, sign, (float)low + 0.9f * step) -
           crossing(green, left, 1, sign, (float)low + 0.1f * step);
}

static void look_at_row(finish *f, const uint8_t *row, int32_t width)
{
    const uint8_t *green = row + 1;
    for (int32_t x = SIDE_PX + 2; x < width - SIDE_PX - 3; x++) {
        const int32_t here = green[4 * (x + 1)] - green[4 * (x - 1)];
        const int32_t last = green[4 * x] - green[4 * (x - 2)];
        const int32_t next = green[4 * (x + 2)] - green[4 * x];
        if (here * here < STEEP * STEEP || here * here < last * last ||
            here * here <= next * next) {
            continue;
        }
        const int32_t bin = (int32_t)(width_at(green, x) * (1.0f / FINISH_BIN_PX));
        if (bin > 0 && bin < FINISH_BINS) {
            f->widths[bin] += 1.0f;
        }
    }
}

static void find_width(finish *f)
{
    float all = 0.0f;
    float sum = 0.0f;
    for (int32_t i = 0; i < FINISH_BINS; i++) {
        all += f->widths[i];
    }
    f->width_px = 0.0f;
    for (int32_t i = 0; i < FINISH_BINS && all >= LEAST_EDGES && f->width_px == 0.0f; i++) {
        const float wanted = SHARP_SHARE * all - sum;
        if (wanted <= f->widths[i]) {
            f->width_px = FINISH_BIN_PX * ((float)i + wanted / f->widths[i]);
        }
        sum += f->widths[i];
    }
}

void finish_look(finish *f, const rlf_frame *frame)
{
    const rlf_image_rgba8 *image = &frame->color;
    grain_update(&f->noise, frame);
    const bool is_due = frame->sequence >= f->sequence + EVERY || frame->sequence < f->sequence;
    if (image->data == NULL || (f->width_px > 0.0f && !is_due)) {
        return;
    }
    for (int32_t i = 0; i < FINISH_BINS; i++) {
        f->widths[i] *= KEPT;
    }
    for (int32_t y = ROW_STEP / 2; y < image->height; y += ROW_STEP) {
        look_at_row(f, rlf_rgba8_row(image, y), image->width);
    }
    f->sequence = frame->sequence;
    find_width(f);
    f->width_px *= (float)f->width / (float)image->width;
}

/* ---- where ---------------------------------------------------------------------------------- */

rlf_result finish_create(int32_t width, int32_t height, finish *out)
{
    grain_init(&out->noise);
    out->width = width;
    out->height = height;
    out->columns = (width + FINISH_TILE - 1) / FINISH_TILE;
    out->sharp = rlf_alloc_array((size_t)width * (size_t)height, 4);
    out->words = (out->columns + 63) / 64;
    out->marks = rlf_alloc_array((size_t)out->words * (size_t)height, sizeof(*out->marks));
    return out->sharp != NULL && out->marks != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

void finish_destroy(finish *f)
{
    rlf_free(f->sharp);
    rlf_free(f->marks);
    f->sharp = NULL;
    f->marks = NULL;
}

typedef struct finish_job {
    finish *f;
    const rlf_image_rgba8 *image;
    const rlf_plane_u8 *matte;
    int32_t weight[TAPS + 1]; /* of pixels so far away, in 256ths */
    bool is_blurred;
} finish_job;

static bool is_any(const uint8_t *matte, int32_t count)
{
    uint64_t any = 0;
    uint64_t part[FINISH_TILE / 8] = {0};
    memcpy(part, matte, (size_t)count);
    for (int i = 0; i < FINISH_TILE / 8; i++) {
        any |= part[i];
    }
    return any != 0;
}

static void mark_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const finish_job *job = context;
    finish *f = job->f;
    (void)worker;
    for (int32_t y = begin; y < end; y++) {
        const uint8_t *matte = rlf_u8_row(job->matte, y);
        uint64_t *marks = f->marks + (ptrdiff_t)y * f->words;
        memset(marks, 0, (size_t)f->words * sizeof(*marks));
        for (int32_t k = 0; k < f->columns; k++) {
            const int32_t left = f->width - k * FINISH_TILE;
            if (is_any(matte + k * FINISH_TILE, left < FINISH_TILE ? left : FINISH_TILE)) {
                marks[k / 64] |= UINT64_C(1) << k % 64;
            }
        }
    }
}

/* Marks of the 64 tiles of a word within `reach` rows of row y. */
static uint64_t word_at(const finish *f, int32_t y, int32_t word, int32_t reach)
{
    uint64_t any = 0;
    for (int32_t row = y - reach; row <= y + reach; row++) {
        if (row >= 0 && row < f->height && word >= 0 && word < f->words) {
            any |= f->marks[(ptrdiff_t)row * f->words + word];
        }
    }
    return any;
}

/* Calls for each tile of row y that has bodies within `reach` rows, in it or beside it. */
static void for_tiles(const finish_job *job, int32_t y, int32_t reach,
                      void (*visit)(const finish_job *job, int32_t k, int32_t y))
{
    const finish *f = job->f;
    for (int32_t word = 0; word < f->words; word++) {
        const uint64_t here = word_at(f, y, word, reach);
        const uint64_t before = word_at(f, y, word - 1, reach) >> 63;
        const uint64_t after = word_at(f, y, word + 1, reach) << 63;
        const uint64_t near_by = here | here << 1 | here >> 1 | before | after;
        for (int32_t k = 64 * word; near_by != 0 && k < 64 * (word + 1) && k < f->columns; k++) {
            if ((near_by >> k % 64 & 1) != 0) {
                visit(job, k, y);
            }
        }
    }
}

static void keep_tile(const finish_job *job, int32_t k, int32_t y)
{
    const finish *f = job->f;
    const int32_t x0 = k * FINISH_TILE;
    const int32_t left = f->width - x0;
    const size_t count = (size_t)(left < FINISH_TILE ? left : FINISH_TILE);
    memcpy(f->sharp + 4 * ((ptrdiff_t)y * f->width + x0),
           rlf_rgba8_row(job->image, y) + 4 * (ptrdiff_t)x0, 4 * count);
}

static void keep_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    for (int32_t y = begin; y < end; y++) {
        for_tiles(context, y, 2 * TAPS, keep_tile);
    }
}

/* ---- what ----------------------------------------------------------------------------------- */

enum { SPAN = FINISH_TILE + 2 * TAPS };

/* A tile of a row: light of its pixels and of those beside, summed down the column; then along. */
typedef struct tile_row {
    uint8_t pixels[2 * TAPS + 1][4 * SPAN], matte[2 * TAPS + 1][SPAN];
    int32_t down[4 * SPAN], matte_down[SPAN];
    uint8_t blurred[4 * FINISH_TILE], shown[FINISH_TILE];
} tile_row;

static int32_t within(int32_t x, int32_t count)
{
    return x < 0 ? 0 : (x < count ? x : count - 1);
}

/* Beyond the picture its last pixels go on. */
static void read_tile(const finish_job *job, int32_t x0, int32_t y, tile_row *t)
{
    const finish *f = job->f;
    for (int32_t i = 0; i <= 2 * TAPS; i++) {
        const int32_t row = within(y + i - TAPS, f->height);
        const uint8_t *from = f->sharp + 4 * (ptrdiff_t)row * f->width;
        const uint8_t *matte = rlf_u8_row(job->matte, row);
        for (int32_t k = 0; k < SPAN; k++) {
            const int32_t x = within(x0 + k - TAPS, f->width);
            memcpy(t->pixels[i] + 4 * k, from + 4 * (ptrdiff_t)x, 4);
            t->matte[i][k] = matte[x];
        }
    }
}

RLF_KERNEL_PART void sum_down(const uint8_t *rows, ptrdiff_t stride, int32_t count,
                              const int32_t weight[TAPS + 1], int32_t *restrict out)
{
    const uint8_t *restrict a = rows;
    const uint8_t *restrict b = rows + stride;
    const uint8_t *restrict c = rows + 2 * stride;
    const uint8_t *restrict d = rows + 3 * stride;
    const uint8_t *restrict e = rows + 4 * stride;
    const int32_t w0 = weight[0];
    const int32_t w1 = weight[1];
    const int32_t w2 = weight[2];
    for (int32_t i = 0; i < count; i++) {
        out[i] = w0 * c[i] + w1 * (b[i] + d[i]) + w2 * (a[i] + e[i]);
    }
}

RLF_KERNEL_PART void sum_along(const int32_t *restrict down, int32_t step, int32_t count,
                               const int32_t weight[TAPS + 1], uint8_t *restrict out)
{
    const int32_t w0 = weight[0];
    const int32_t w1 = weight[1];
    const int32_t w2 = weight[2];
    for (int32_t i = 0; i < count; i++) {
        const int32_t sum = w0 * down[i + 2 * step] + w1 * (down[i + step] + down[i + 3 * step]) +
                            w2 * (down[i] + down[i + 4 * step]);
        out[i] = (uint8_t)((sum + 32768) >> 16);
    }
}

/* All of it wherever a body's light gets to: an edge is as soft outside of the body as within. */
RLF_KERNEL_PART void mix(const uint8_t *restrict shown, const uint8_t *restrict sharp,
                         int32_t count, uint8_t *restrict blurred)
{
    for (int32_t i = 0; i < 4 * count; i++) {
        const int32_t more = 32 * shown[i / 4];
        const int32_t share = more < 256 ? more : 256;
        blurred[i] = (uint8_t)((sharp[i] * (256 - share) + blurred[i] * share + 128) >> 8);
    }
}

RLF_KERNEL static void blur(const finish_job *job, int32_t count, tile_row *t)
{
    sum_down(t->pixels[0], 4 * SPAN, 4 * SPAN, job->weight, t->down);
    sum_down(t->matte[0], SPAN, SPAN, job->weight, t->matte_down);
    sum_along(t->down, 4, 4 * FINISH_TILE, job->weight, t->blurred);
    sum_along(t->matte_down, 1, FINISH_TILE, job->weight, t->shown);
    mix(t->shown, t->pixels[TAPS] + 4 * TAPS, count, t->blurred);
}

/* Noise of a pixel's brightness, as far as bodies are shown. */
RLF_KERNEL static void add_noise(const grain *g, const float (*tile)[3], int32_t column,
                                 const uint8_t *shown, int32_t count, uint8_t *pixels)
{
    for (int32_t i = 0; i < count; i++) {
        uint8_t *p = pixels + 4 * i;
        const float *sigma = g->at[(p[0] + p[1] + p[2]) / 3];
        const float *noise = tile[(column + i) & (GRAIN_TILE - 1)];
        const float share = (float)shown[i] * (1.0f / 255.0f);
        for (int k = 0; k < 3 && shown[i] != 0; k++) {
            const float code = (float)p[k] + share * sigma[k] * noise[k] + 0.5f;
            p[k] = (uint8_t)(int32_t)(code < 0.0f ? 0.0f : (code < 255.0f ? code : 255.0f));
        }
    }
}

static void finish_tile(const finish_job *job, int32_t k, int32_t y)
{
    const finish *f = job->f;
    const int32_t x0 = k * FINISH_TILE;
    const int32_t left = f->width - x0;
    const int32_t count = left < FINISH_TILE ? left : FINISH_TILE;
    uint8_t *pixels = rlf_rgba8_row(job->image, y) + 4 * (ptrdiff_t)x0;
    const uint8_t *shown = rlf_u8_row(job->matte, y) + x0;
    tile_row t;
    if (job->is_blurred) {
        read_tile(job, x0, y, &t);
        blur(job, count, &t);
        memcpy(pixels, t.blurred, 4 * (size_t)count);
        shown = t.shown;
    }
    if (f->noise.is_known) {
        add_noise(&f->noise, grain_row(&f->noise, y), x0 + f->noise.offset_x, shown, count, pixels);
    }
}

static void finish_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const finish_job *job = context;
    (void)worker;
    for (int32_t y = begin; y < end; y++) {
        for_tiles(job, y, job->is_blurred ? TAPS : 0, finish_tile);
    }
}

/* Two steps (a, 1 - 2a, a) one after the other, whose variances add up to what is missing. */
static bool find_weights(const finish *f, int32_t weight[TAPS + 1])
{
    const float missing =
        (f->width_px * f->width_px - DRAWN_PX * DRAWN_PX) * (1.0f / (ACROSS * ACROSS));
    const float surely = (f->width_px - SHARP_PX) * (1.0f / (BLURRED_PX - SHARP_PX));
    const float share = surely < 0.0f ? 0.0f : (surely < 1.0f ? surely : 1.0f);
    const float variance = share * (missing < 1.0f ? missing : 1.0f);
    const float a = 0.25f * variance;
    weight[2] = (int32_t)(256.0f * a * a + 0.5f);
    weight[1] = (int32_t)(256.0f * 2.0f * a * (1.0f - 2.0f * a) + 0.5f);
    weight[0] = 256 - 2 * (weight[1] + weight[2]);
    return weight[1] > 0;
}

void finish_picture(finish *f, rlf_pool *pool, const rlf_image_rgba8 *image,
                    const rlf_plane_u8 *matte)
{
    finish_job job = {.f = f, .image = image, .matte = matte};
    job.is_blurred = find_weights(f, job.weight);
    if (!job.is_blurred && !f->noise.is_known) {
        return;
    }
    rlf_parallel_for(pool, f->height, FINISH_TILE, mark_rows, &job);
    if (job.is_blurred) {
        rlf_parallel_for(pool, f->height, FINISH_TILE, keep_rows, &job);
    }
    rlf_parallel_for(pool, f->height, FINISH_TILE, finish_rows, &job);
}
