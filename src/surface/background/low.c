/* Faces that are seen at a low angle and end within some pixels: a carton's top, a table's, a seat.
 *
 * Seen at ten degrees such a face is a few rows high, its depth is a dozen times as noisy as that
 * of a face seen squarely, and from row to row it changes by more than what is taken for a mixed
 * pixel. So of its last rows only those samples are kept that lean towards the rows beside them,
 * and a gated mean begins again and again: the face is bent, and leans. Here every sample counts: a
 * mean per pixel of depth as it came, within a wide gate about the background, and a plane by least
 * squares through the means about a pixel that are of its face. What was hardly ever seen goes on
 * in that plane, too. */
#include "surface/steps.h"
#include "surface/window.h"

#include "kernel/kernel.h"

#include <math.h>
#include <string.h>

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
    BLOCK_PLANES = 4
};

static const float LOW = 0.3f;           /* cosine between ray and normal: less is a low angle */
static const float LEAST_FACING = 0.02f; /* a face may be seen edge-on, not from behind */
static const float ONE_FACE = 0.94f;     /* cosine: 20 degrees */
static const float OFF_FACE = 0.01f;     /* share of the depth, at its end */
static const float GATE = 6.0f;          /* sigmas of a sample */
static const float LEAST_NOISE = 0.4f;   /* of the sigma that a sample of such a face has */
static const float MOST_OFF = 3.0f;      /* sigmas: a mean that is on a plane */
static const float MOST_LEFT = 2.0f;     /* of the samples' variance: what is left of a plane's */
static const float MOST_TURN = 0.02f;    /* radians: error of the plane */
static const float MOST_CHANGE = 0.04f;  /* share of the depth */

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
    float x = grid->ray_x[i], y = grid->ray_y[i];
    float dot = normal[0][i] * x + normal[1][i] * y + normal[2][i];
    return -dot / sqrtf(x * x + y * y + 1.0f);
}

static void add_sample(const low_job *job, ptrdiff_t i)
{
    const rlf_low *low = &job->stage->background.low;
    float z = job->raw[i], behind = job->sheet->depth[i];
    float cosine = facing_at(&job->stage->grid, job->sheet->normal, i);
    float slant = rlf_kernel_slant(cosine > LEAST_FACING ? cosine : LEAST_FACING, 1.0f);
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
            if (job->stage->steady.calm == NULL || !rlf_hold_may_move(job->stage, x, y)) {
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

static float dot_ray(const rlf_grid *grid, const float normal[3], ptrdiff_t i)
{
    return normal[0] * grid->ray_x[i] + normal[1] * grid->ray_y[i] + normal[2];
}

/* The face of pixel i does not go on to pixel `at`. */
static bool ends_at(const rlf_grid *grid, const rlf_sheet *sheet, ptrdiff_t i, ptrdiff_t at)
{
    const float n[3] = {sheet->normal[0][i], sheet->normal[1][i], sheet->normal[2][i]};
    float z = sheet->depth[at], cosine = 0.0f;
    for (int k = 0; k < 3; k++) {
        cosine += n[k] * sheet->normal[k][at];
    }
    float off = dot_ray(grid, n, i) * sheet->depth[i] - dot_ray(grid, n, at) * z;
    return !(z > 0.0f) || !(cosine > ONE_FACE) || !(rlf_kernel_abs(off) < OFF_FACE * z);
}

static bool is_low(const rlf_grid *grid, const rlf_sheet *sheet, ptrdiff_t i)
{
    if (!(sheet->depth[i] > 0.0f)) {
        return false;
    }
    float cosine = facing_at(grid, sheet->normal, i);
    ptrdiff_t down = (ptrdiff_t)ENDS * grid->width;
    return cosine > LEAST_FACING && cosine < LOW &&
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

/* Inverse depth is a + b x + c y along the ray (x, y, 1). */
typedef struct low_plane {
    double a, b, c;
    double noise; /* of a sample */
    double turn;  /* radians: error of its normal */
} low_plane;

typedef struct low_sums {
    double n, x, y, xx, xy, yy, w, xw, yw, ww, variance;
    int32_t count;
} low_sums;

static void add_mean(low_sums *s, double n, double x, double y, double w, double variance)
{
    s->variance += n * variance;
    s->n += n;
    s->x += n * x;
    s->y += n * y;
    s->xx += n * x * x;
    s->xy += n * x * y;
    s->yy += n * y * y;
    s->w += n * w;
    s->xw += n * x * w;
    s->yw += n * y * w;
    s->ww += n * w * w;
    s->count++;
}

static double inverse_depth(const low_plane *p, double x, double y)
{
    return p->a + p->b * x + p->c * y;
}

/* Error of the normal about the middle of the means, from the covariance of the slopes. */
static double turn_of(const low_plane *p, double variance, const double cov[3], double x, double y)
{
    const rlf_vec3 q = {p->b, p->c, p->a};
    rlf_vec3 u = {1.0, 0.0, -x}, v = {0.0, 1.0, -y};
    double square = rlf_dot(q, q);
    u = rlf_mad(u, q, -rlf_dot(u, q) / square);
    v = rlf_mad(v, q, -rlf_dot(v, q) / square);
    double sum = cov[0] * rlf_dot(u, u) + 2.0 * cov[1] * rlf_dot(u, v) + cov[2] * rlf_dot(v, v);
    return sqrt(rlf_max(0.0, variance * sum / square));
}

/* The sums are about the ray (x0, y0). */
static bool solve(const low_sums *s, double x0, double y0, low_plane *out)
{
    double mx = s->x / s->n, my = s->y / s->n, mw = s->w / s->n;
    double xx = s->xx - s->x * mx, xy = s->xy - s->x * my, yy = s->yy - s->y * my;
    double xw = s->xw - s->x * mw, yw = s->yw - s->y * mw, ww = s->ww - s->w * mw;
    double det = xx * yy - xy * xy;
    if (!(det > 0.02 * xx * yy)) {
        out->noise = 0.0;
        return false;
    }
    out->b = (xw * yy - yw * xy) / det;
    out->c = (yw * xx - xw * xy) / det;
    out->a = mw - out->b * (mx + x0) - out->c * (my + y0);
    double left = rlf_max(0.0, ww - out->b * xw - out->c * yw) / (s->count - 3);
    double variance = s->variance / s->n;
    const double cov[3] = {yy / det, -xy / det, xx / det};
    out->noise = sqrt(variance);
    out->turn = turn_of(out, rlf_max(left, variance), cov, mx + x0, my + y0);
    return left < MOST_LEFT * variance;
}

typedef struct low_fit {
    const rlf_reconstruct *stage;
    const rlf_slot *slot;
    const rlf_sheet *old, *sheet;
    rlf_kernel_noise noise;
} low_fit;

/* Its samples are as noisy as those of such a face: a pixel of the face beside it, which frames
 * took for this one, is not. */
static bool is_noisy(const low_fit *f, ptrdiff_t i)
{
    const rlf_low *low = &f->stage->background.low;
    const rlf_grid *grid = &f->stage->grid;
    float cosine = facing_at(grid, f->sheet->normal, i), w = low->mean[i];
    float slant = rlf_kernel_slant(cosine > LEAST_FACING ? cosine : LEAST_FACING, 1.0f);
    float sigma = LEAST_NOISE * slant * rlf_kernel_inverse_sigma(f->noise, w);
    return low->samples[i] >= (float)LEAST && low->variance[i] > sigma * sigma;
}

static bool is_of_face(const low_fit *f, const float normal[3], ptrdiff_t at)
{
    float cosine = 0.0f;
    for (int k = 0; k < 3; k++) {
        cosine += normal[k] * f->sheet->normal[k][at];
    }
    return f->stage->background.low.mark[at] != 0 && cosine > ONE_FACE && is_noisy(f, at);
}

/* The means about pixel i that are of its face and on the plane. */
static low_sums sums_about(const low_fit *f, ptrdiff_t i, const float normal[3],
                           const low_plane *plane)
{
    const rlf_grid *grid = &f->stage->grid;
    const rlf_low *low = &f->stage->background.low;
    low_sums sums = {.count = 0};
    for (int32_t dy = -DOWN; dy <= DOWN; dy++) {
        for (int32_t dx = -ACROSS; dx <= ACROSS; dx++) {
            ptrdiff_t at = i + (ptrdiff_t)dy * grid->width + dx;
            if (!is_of_face(f, normal, at)) {
                continue;
            }
            double x = grid->ray_x[at], y = grid->ray_y[at], w = low->mean[at];
            double off = w - inverse_depth(plane, x, y), most = MOST_OFF * plane->noise;
            if (off * off * low->samples[at] < most * most) {
                add_mean(&sums, low->samples[at], x - grid->ray_x[i], y - grid->ray_y[i], w,
                         low->variance[at]);
            }
        }
    }
    return sums;
}

/* Mean of the normals of the face about pixel i. */
static void mean_normal(const low_fit *f, ptrdiff_t i, const float normal[3], float out[3])
{
    rlf_vec3 sum = {normal[0], normal[1], normal[2]};
    for (int32_t dy = -DOWN; dy <= DOWN; dy++) {
        for (int32_t dx = -ACROSS; dx <= ACROSS; dx++) {
            ptrdiff_t at = i + (ptrdiff_t)dy * f->stage->grid.width + dx;
            if (is_of_face(f, normal, at)) {
                float *const *n = f->sheet->normal;
                sum = rlf_add(sum, rlf_vec3_make(n[0][at], n[1][at], n[2][at]));
            }
        }
    }
    sum = rlf_normalize(sum);
    out[0] = (float)sum.x;
    out[1] = (float)sum.y;
    out[2] = (float)sum.z;
}

/* From the plane that the sheet shows about pixel i, within what its depth may be off. */
static bool find_plane(const low_fit *f, ptrdiff_t i, const float normal[3], low_plane *out)
{
    const rlf_grid *grid = &f->stage->grid;
    float x = grid->ray_x[i], y = grid->ray_y[i], w = 1.0f / f->sheet->depth[i], mean[3];
    mean_normal(f, i, normal, mean);
    float here = dot_ray(grid, mean, i), length = sqrtf(x * x + y * y + 1.0f);
    if (!(here < -LEAST_FACING)) {
        return false;
    }
    double sigma = rlf_kernel_inverse_sigma(f->noise, w) * rlf_kernel_slant(-here, length);
    *out = (low_plane){w * mean[2] / here, w * mean[0] / here, w * mean[1] / here, 0.0, 0.0};
    out->noise = sigma * sqrt((double)MOST) / MOST_OFF; /* one sigma, of whatever mean */
    bool is_plane = false;
    for (int32_t k = 0; k < PASSES; k++) {
        low_sums sums = sums_about(f, i, normal, out);
        if (sums.count < LEAST_ON) {
            return false;
        }
        is_plane = solve(&sums, x, y, out);
    }
    return is_plane && out->turn < MOST_TURN;
}

/* Pixel i has no mean of its own, or one on the plane. */
static bool is_on(const low_fit *f, ptrdiff_t i, const low_plane *plane)
{
    const rlf_grid *grid = &f->stage->grid;
    const rlf_low *low = &f->stage->background.low;
    double off = low->mean[i] - inverse_depth(plane, grid->ray_x[i], grid->ray_y[i]);
    double most = MOST_OFF * plane->noise;
    return low->samples[i] < (float)LEAST ||
           (is_noisy(f, i) && off * off * low->samples[i] < most * most);
}

/* Puts pixel i on the plane if it is on it but for noise. */
static bool put_on(const low_fit *f, rlf_sheet *sheet, ptrdiff_t i, const low_plane *plane)
{
    const rlf_grid *grid = &f->stage->grid;
    rlf_vec3 n = rlf_normalize(rlf_vec3_make(-plane->b, -plane->c, -plane->a));
    float z = (float)(1.0 / inverse_depth(plane, grid->ray_x[i], grid->ray_y[i]));
    double cosine =
        n.x * sheet->normal[0][i] + n.y * sheet->normal[1][i] + n.z * sheet->normal[2][i];
    if (!(rlf_kernel_abs(z - sheet->depth[i]) < MOST_CHANGE * z) || !(cosine > ONE_FACE) ||
        !is_on(f, i, plane)) {
        return false;
    }
    sheet->depth[i] = z;
    sheet->normal[0][i] = (float)n.x;
    sheet->normal[1][i] = (float)n.y;
    sheet->normal[2][i] = (float)n.z;
    return true;
}

/* The planes of a block of pixels: neighbours have the same one. */
typedef struct low_block {
    low_plane planes[BLOCK_PLANES];
    int32_t count;
} low_block;

static void fit_pixel(const low_fit *f, rlf_sheet *sheet, ptrdiff_t i, low_block *block)
{
    const float normal[3] = {sheet->normal[0][i], sheet->normal[1][i], sheet->normal[2][i]};
    for (int32_t k = 0; k < block->count; k++) {
        if (put_on(f, sheet, i, &block->planes[k])) {
            return;
        }
    }
    low_plane plane;
    if (find_plane(f, i, normal, &plane) && put_on(f, sheet, i, &plane) &&
        block->count < BLOCK_PLANES) {
        block->planes[block->count++] = plane;
    }
}

/* What something hides stays where it was put when it was seen, unless the model is another one. */
static void keep(const low_fit *f, rlf_sheet *sheet, ptrdiff_t i)
{
    float z = sheet->depth[i];
    if (!(rlf_kernel_abs(f->old->depth[i] - z) < MOST_CHANGE * z)) {
        return;
    }
    sheet->depth[i] = f->old->depth[i];
    for (int k = 0; k < 3; k++) {
        sheet->normal[k][i] = f->old->normal[k][i];
    }
}

static void fit_block(const low_fit *f, rlf_sheet *sheet, rlf_rect r)
{
    low_block block = {.count = 0};
    for (int32_t y = r.y0; y < r.y1; y++) {
        for (int32_t x = r.x0; x < r.x1; x++) {
            ptrdiff_t i = (ptrdiff_t)y * f->stage->grid.width + x;
            bool is_marked = f->stage->background.low.mark[i] != 0;
            if (is_marked && f->old != NULL && f->slot->foreground[i] != 0) {
                keep(f, sheet, i);
            } else if (is_marked && is_low(&f->stage->grid, sheet, i)) {
                fit_pixel(f, sheet, i, &block);
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
            fit_block(&f, sheet, block);
        }
    }
}
