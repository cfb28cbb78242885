/* Faces that are seen at a low angle and end within some pixels: a carton's top, a table's, a seat.
 *
 * Seen at ten degrees such a face is a few rows high, its depth is a dozen times as noisy as that
 * of a face seen squarely, and from row to row it changes by more than what is taken for a mixed
 * pixel. So of its last rows only those samples are kept that lean towards the rows beside them,
 * and a gated mean begins again and again: the face is bent, and leans. Here every sample counts: a
 * mean per pixel of depth as it came, within a wide gate about the background, and a plane by least
 * squares through the means about a pixel that are of its face. What was hardly ever seen goes on
 * in that plane, too. */
#include "surface/background/facing.h"
#include "surface/background/low_plane.h"
#include "surface/steps.h"
#include "surface/window.h"

#include "kernel/kernel.h"

#include <math.h>

enum {
    ACROSS = 10,   /* pixels: as far reach the means that are asked ... */
    DOWN = 6,      /* ... in rows */
    ENDS = 6,      /* so far from a face's end it is fitted */
    PASSES = 3,    /* of the fit; what is far off it is left out */
    MOST = 32,     /* samples in a mean: a second, and what has moved is forgotten */
    LEAST = 4,     /* in one that counts */
    LEAST_ON = 12, /* means on a plane */
    BLOCK_ACROSS = 8,
    BLOCK_DOWN = 6,
    BLOCK_PLANES = 4,
    AROUND_ACROSS = BLOCK_ACROSS + 2 * ACROSS, /* pixels: a block and all that are asked ... */
    AROUND_DOWN = BLOCK_DOWN + 2 * DOWN,       /* ... in rows */
    WIDE = 2 * ACROSS + 1,                     /* pixels that are asked of a row, about one */
    MOST_MEANS = WIDE * (2 * DOWN + 1)
};

static const float LOW = 0.3f;          /* cosine between ray and normal: less is a low angle */
static const float OFF_FACE = 0.01f;    /* share of the depth, at its end */
static const float GATE = 6.0f;         /* sigmas of a sample */
static const float LEAST_NOISE = 0.4f;  /* of the sigma that a sample of such a face has */
static const float MOST_OFF = 3.0f;     /* sigmas: a mean that is on a plane */
static const double MOST_LEFT = 2.0;    /* of the samples' variance: what is left of a plane's */
static const float MOST_TURN = 0.02f;   /* radians: error of the plane */
static const float MOST_CHANGE = 0.04f; /* share of the depth */

/* ---- means of samples ---- */

typedef struct low_job {
    const rlf_reconstruct *stage;
    const rlf_sheet *sheet;
    const float *raw;
    rlf_kernel_noise noise;
} low_job;

/* Cosine of the angle at which pixel i is seen; < 0 from behind. */
static float facing_at(const rlf_grid *grid, float *const normal[3], ptrdiff_t i)
{
    float x = grid->ray_x[i], y = grid->ray_y[i], n[3];
    rlf_read_normal(normal, i, n);
    return -rlf_facing(grid, n, i) / sqrtf(x * x + y * y + 1.0f);
}

/* How much noisier its samples are than those of a face that is seen squarely. */
static float slant_at(const rlf_grid *grid, float *const normal[3], ptrdiff_t i)
{
    float cosine = facing_at(grid, normal, i);
    return rlf_kernel_slant(cosine > rlf_least_facing ? cosine : rlf_least_facing, 1.0f);
}

static void add_sample(const low_job *job, ptrdiff_t i)
{
    const rlf_low *low = &job->stage->background.low;
    float z = job->raw[i], behind = job->sheet->depth[i];
    float slant = slant_at(&job->stage->grid, job->sheet->normal, i);
    float gate = GATE * slant * rlf_kernel_sigma(job->noise, behind);
    if (!(z > 0.0f) || !(rlf_kernel_abs(z - behind) < gate)) {
        return;
    }
    float n = low->samples[i] < (float)MOST ? low->samples[i] + 1.0f : (float)MOST;
    float before = 1.0f / z - low->mean[i];
    low->mean[i] += before / n;
    low->variance[i] += (before * (1.0f / z - low->mean[i]) - low->variance[i]) / n;
    low->samples[i] = n;
}

static void add_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const low_job *job = context;
    int32_t width = job->stage->grid.width;
    for (int32_t y = begin; y < end; y++) {
        const uint8_t *mark = job->stage->background.low.mark + (ptrdiff_t)y * width;
        for (int32_t x = 0; (x = rlf_kernel_next_mark(mark, x, width)) < width; x++) {
            if (!rlf_hold_may_move(job->stage, x, y)) {
                add_sample(job, (ptrdiff_t)y * width + x);
            }
        }
    }
}

void rlf_low_add(const rlf_reconstruct *stage, const rlf_sheet *sheet, const float *raw)
{
    if (stage->background.low.mark != NULL && sheet != NULL) {
        low_job job = {stage, sheet, raw, rlf_kernel_noise_make(&stage->def.rig.noise)};
        rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, add_rows, &job);
    }
}

/* ---- which pixels ---- */

/* The face of pixel i does not go on to pixel `at`. */
static bool ends_at(const rlf_grid *grid, const rlf_sheet *sheet, ptrdiff_t i, ptrdiff_t at)
{
    float n[3], other[3], z = sheet->depth[at];
    rlf_read_normal(sheet->normal, i, n);
    rlf_read_normal(sheet->normal, at, other);
    float off = rlf_facing(grid, n, i) * sheet->depth[i] - rlf_facing(grid, n, at) * z;
    return !(z > 0.0f) || !(rlf_cosine(n, other) > rlf_one_face) ||
           !(rlf_kernel_abs(off) < OFF_FACE * z);
}

static bool is_low(const rlf_grid *grid, const rlf_sheet *sheet, ptrdiff_t i)
{
    if (!(sheet->depth[i] > 0.0f)) {
        return false;
    }
    float cosine = facing_at(grid, sheet->normal, i);
    ptrdiff_t down = (ptrdiff_t)ENDS * grid->width;
    return cosine > rlf_least_facing && cosine < LOW &&
           (ends_at(grid, sheet, i, i - ENDS) || ends_at(grid, sheet, i, i + ENDS) ||
            ends_at(grid, sheet, i, i - down) || ends_at(grid, sheet, i, i + down));
}

/* The part of r about whose pixels all that are asked are in the picture. */
static rlf_rect within(const rlf_grid *grid, rlf_rect r)
{
    const rlf_rect in = {r.x0 > ACROSS ? r.x0 : ACROSS, r.y0 > DOWN ? r.y0 : DOWN,
                         rlf_least(r.x1, grid->width - ACROSS),
                         rlf_least(r.y1, grid->height - DOWN)};
    return in;
}

void rlf_low_mark(const rlf_reconstruct *stage, const rlf_sheet *sheet, rlf_rect r)
{
    const rlf_grid *grid = &stage->grid;
    const rlf_low *low = &stage->background.low;
    const rlf_rect in = within(grid, r);
    for (int32_t y = in.y0; y < in.y1 && low->mark != NULL; y++) {
        for (int32_t x = in.x0; x < in.x1; x++) {
            ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
            low->mark[i] = is_low(grid, sheet, i);
            bool is_there = low->mark[i] != 0 &&
                            rlf_kernel_abs(low->mean[i] * sheet->depth[i] - 1.0f) < MOST_CHANGE;
            low->samples[i] = is_there ? low->samples[i] : 0.0f;
        }
    }
}

/* ---- the plane about a pixel ---- */

typedef struct low_fit {
    const rlf_reconstruct *stage;
    const rlf_slot *slot;
    const rlf_sheet *old;
    rlf_sheet *sheet;
    rlf_kernel_noise noise;
} low_fit;

/* A block of pixels. */
typedef struct low_block {
    rlf_low_plane planes[BLOCK_PLANES]; /* neighbours have the same one */
    int32_t count;
    int32_t x0, y0;   /* the first pixel that is asked */
    bool has_counted; /* from the first that is fitted on, `counts` is known: */
    uint8_t counts[AROUND_DOWN][AROUND_ACROSS]; /* 1 where the mean counts */
} low_block;

/* Its samples are as noisy as those of such a face: a pixel of the face beside it, which frames
 * took for this one, is not. */
static bool is_noisy(const low_fit *f, ptrdiff_t i)
{
    const rlf_low *low = &f->stage->background.low;
    float slant = slant_at(&f->stage->grid, f->sheet->normal, i);
    float sigma = LEAST_NOISE * slant * rlf_kernel_inverse_sigma(f->noise, low->mean[i]);
    return low->samples[i] >= (float)LEAST && low->variance[i] > sigma * sigma;
}

static void count_mean(const low_fit *f, low_block *block, int32_t x, int32_t y)
{
    ptrdiff_t i = (ptrdiff_t)y * f->stage->grid.width + x;
    bool counts = f->stage->background.low.mark[i] != 0 && is_noisy(f, i);
    block->counts[y - block->y0][x - block->x0] = counts;
}

static void count_means(const low_fit *f, low_block *block)
{
    const rlf_grid *grid = &f->stage->grid;
    int32_t x1 = rlf_least(block->x0 + AROUND_ACROSS, grid->width);
    int32_t y1 = rlf_least(block->y0 + AROUND_DOWN, grid->height);
    for (int32_t y = block->y0; y < y1; y++) {
        for (int32_t x = block->x0; x < x1; x++) {
            count_mean(f, block, x, y);
        }
    }
    block->has_counted = true;
}

/* The means about a pixel that count and are of its face. */
typedef struct low_means {
    ptrdiff_t at[MOST_MEANS];
    int32_t count;
} low_means;

static void find_means(const low_fit *f, const low_block *block, int32_t x, int32_t y,
                       const float normal[3], low_means *out)
{
    out->count = 0;
    for (int32_t dy = -DOWN; dy <= DOWN; dy++) {
        const uint8_t *counts = &block->counts[y + dy - block->y0][x - ACROSS - block->x0];
        ptrdiff_t row = (ptrdiff_t)(y + dy) * f->stage->grid.width + x - ACROSS;
        for (int32_t k = 0; (k = rlf_kernel_next_mark(counts, k, WIDE)) < WIDE; k++) {
            float other[3];
            rlf_read_normal(f->sheet->normal, row + k, other);
            if (rlf_cosine(normal, other) > rlf_one_face) {
                out->at[out->count++] = row + k;
            }
        }
    }
}

/* Of those that are on the plane; about the ray of pixel i. */
static rlf_low_sums sums_of(const low_fit *f, ptrdiff_t i, const low_means *means,
                            const rlf_low_plane *plane)
{
    const rlf_grid *grid = &f->stage->grid;
    const rlf_low *low = &f->stage->background.low;
    rlf_low_sums sums = {.count = 0};
    for (int32_t k = 0; k < means->count; k++) {
        ptrdiff_t at = means->at[k];
        double x = grid->ray_x[at], y = grid->ray_y[at], w = low->mean[at];
        double off = w - rlf_low_plane_at(plane, x, y), most = MOST_OFF * plane->noise;
        if (off * off * low->samples[at] < most * most) {
            rlf_low_sums_add(&sums, low->samples[at], x - grid->ray_x[i], y - grid->ray_y[i], w,
                             low->variance[at]);
        }
    }
    return sums;
}

/* Mean of the normals, and pixel i's own. */
static void mean_normal(const low_fit *f, const low_means *means, const float normal[3],
                        float out[3])
{
    rlf_vec3 sum = {normal[0], normal[1], normal[2]};
    for (int32_t k = 0; k < means->count; k++) {
        float n[3];
        rlf_read_normal(f->sheet->normal, means->at[k], n);
        sum = rlf_add(sum, rlf_vec3_make(n[0], n[1], n[2]));
    }
    sum = rlf_normalize(sum);
    out[0] = (float)sum.x;
    out[1] = (float)sum.y;
    out[2] = (float)sum.z;
}

/* From the plane that the sheet shows about pixel i, within what its depth may be off. */
static bool find_plane(const low_fit *f, ptrdiff_t i, const low_means *means, const float normal[3],
                       rlf_low_plane *out)
{
    const rlf_grid *grid = &f->stage->grid;
    float x = grid->ray_x[i], y = grid->ray_y[i], w = 1.0f / f->sheet->depth[i], mean[3];
    mean_normal(f, means, normal, mean);
    float here = rlf_facing(grid, mean, i), length = sqrtf(x * x + y * y + 1.0f);
    if (!(here < -rlf_least_facing)) {
        return false;
    }
    double sigma = rlf_kernel_inverse_sigma(f->noise, w) * rlf_kernel_slant(-here, length);
    *out = (rlf_low_plane){w * mean[2] / here, w * mean[0] / here, w * mean[1] / here, 0.0, 0.0};
    /* A mean of n may be off by sigma sqrt(MOST / n): the sheet's depth is no better. */
    out->noise = sigma * sqrt((double)MOST) / MOST_OFF;
    bool is_plane = false;
    for (int32_t k = 0; k < PASSES; k++) {
        rlf_low_sums sums = sums_of(f, i, means, out);
        if (sums.count < LEAST_ON) {
            return false;
        }
        is_plane = rlf_low_plane_solve(&sums, x, y, MOST_LEFT, out);
    }
    return is_plane && out->turn < MOST_TURN;
}

/* Pixel i has no mean of its own, or one on the plane. */
static bool is_on(const low_fit *f, ptrdiff_t i, const rlf_low_plane *plane)
{
    const rlf_grid *grid = &f->stage->grid;
    const rlf_low *low = &f->stage->background.low;
    double off = low->mean[i] - rlf_low_plane_at(plane, grid->ray_x[i], grid->ray_y[i]);
    double most = MOST_OFF * plane->noise;
    return low->samples[i] < (float)LEAST ||
           (is_noisy(f, i) && off * off * low->samples[i] < most * most);
}

/* Puts pixel i on the plane if it is on it but for noise. */
static bool put_on(const low_fit *f, ptrdiff_t i, const rlf_low_plane *plane)
{
    const rlf_grid *grid = &f->stage->grid;
    const rlf_sheet *sheet = f->sheet;
    rlf_vec3 n = rlf_normalize(rlf_vec3_make(-plane->b, -plane->c, -plane->a));
    float z = (float)(1.0 / rlf_low_plane_at(plane, grid->ray_x[i], grid->ray_y[i]));
    double cosine =
        n.x * sheet->normal[0][i] + n.y * sheet->normal[1][i] + n.z * sheet->normal[2][i];
    if (!(rlf_kernel_abs(z - sheet->depth[i]) < MOST_CHANGE * z) || !(cosine > rlf_one_face) ||
        !is_on(f, i, plane)) {
        return false;
    }
    sheet->depth[i] = z;
    sheet->normal[0][i] = (float)n.x;
    sheet->normal[1][i] = (float)n.y;
    sheet->normal[2][i] = (float)n.z;
    return true;
}

static void fit_pixel(const low_fit *f, int32_t x, int32_t y, low_block *block)
{
    ptrdiff_t i = (ptrdiff_t)y * f->stage->grid.width + x;
    for (int32_t k = 0; k < block->count; k++) {
        if (put_on(f, i, &block->planes[k])) {
            return;
        }
    }
    if (!block->has_counted) {
        count_means(f, block);
    }
    float normal[3];
    low_means means;
    rlf_low_plane plane;
    rlf_read_normal(f->sheet->normal, i, normal);
    find_means(f, block, x, y, normal, &means);
    if (find_plane(f, i, &means, normal, &plane) && put_on(f, i, &plane) &&
        block->count < BLOCK_PLANES) {
        block->planes[block->count++] = plane;
    }
}

/* What something hides stays where it was put when it was seen, unless the model is another one. */
static void keep(const low_fit *f, ptrdiff_t i)
{
    float z = f->sheet->depth[i];
    if (!(rlf_kernel_abs(f->old->depth[i] - z) < MOST_CHANGE * z)) {
        return;
    }
    f->sheet->depth[i] = f->old->depth[i];
    for (int k = 0; k < 3; k++) {
        f->sheet->normal[k][i] = f->old->normal[k][i];
    }
}

static void fit_block(const low_fit *f, rlf_rect r)
{
    low_block block;
    block.count = 0;
    block.x0 = r.x0 - ACROSS;
    block.y0 = r.y0 - DOWN;
    block.has_counted = false;
    for (int32_t y = r.y0; y < r.y1; y++) {
        const uint8_t *mark = f->stage->background.low.mark + (ptrdiff_t)y * f->stage->grid.width;
        for (int32_t x = r.x0; (x = rlf_kernel_next_mark(mark, x, r.x1)) < r.x1; x++) {
            ptrdiff_t i = (ptrdiff_t)y * f->stage->grid.width + x;
            if (f->old != NULL && f->slot->foreground[i] != 0) {
                keep(f, i);
            } else if (is_low(&f->stage->grid, f->sheet, i)) {
                fit_pixel(f, x, y, &block);
            }
            if (block.has_counted) {
                count_mean(f, &block, x, y); /* it has another normal */
            }
        }
    }
}

void rlf_low_fit(const rlf_reconstruct *stage, const rlf_slot *slot, const rlf_sheet *old,
                 rlf_sheet *sheet, rlf_rect r)
{
    const low_fit f = {stage, slot, old, sheet, rlf_kernel_noise_make(&stage->def.rig.noise)};
    const rlf_rect in = within(&stage->grid, r);
    if (slot == NULL || stage->background.low.mark == NULL) {
        return;
    }
    for (int32_t y = in.y0; y < in.y1; y += BLOCK_DOWN) {
        for (int32_t x = in.x0; x < in.x1; x += BLOCK_ACROSS) {
            const rlf_rect block = {x, y, rlf_least(x + BLOCK_ACROSS, in.x1),
                                    rlf_least(y + BLOCK_DOWN, in.y1)};
            fit_block(&f, block);
        }
    }
}
