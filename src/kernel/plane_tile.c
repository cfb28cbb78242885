/* Normals of noisy depth: least-squares planes in inverse depth, one window chosen per pixel.
 *
 * On a plane w = 1/z = A + B x + C y in the ray (x, y, 1), whatever the lens, and the normal is
 * -(B, C, A): errata of eq. 4.3. Moments of 2x2 pixel blocks are summed over windows of 5x5 and 3x3
 * blocks (10 and 6 pixels); each block keeps the larger window whose residual is explained by the
 * sensor's noise. A pixel then takes, among the planes of the 3x3 blocks about it, the best
 * determined one that predicts the pixel's own depth (the selection of Kuwahara et al. 1976), so
 * that no window reaches across a depth edge or a crease.
 *
 * Sums are taken relative to the tile's middle, which keeps single precision far below the noise.
 */
#include "kernel/kernel.h"

#include <math.h>

enum {
    MOMENTS = 10,
    PLANES = RLF_KERNEL_TILE / 2 + 2, /* blocks on a side that have a plane: one more each side */
    BLOCKS = PLANES + 4,              /* and two more for the windows */
    BLOCK_PIXELS = 2 * BLOCKS,
    PLANE_PIXELS = 2 * PLANES
};

enum { N, X, Y, XX, XY, YY, W, XW, YW, WW };

typedef struct reference {
    float x, y, w; /* what sums are relative to */
} reference;

typedef struct plane_rows { /* of one row of blocks, each value twice: once per pixel column */
    float a[PLANE_PIXELS], b[PLANE_PIXELS], c[PLANE_PIXELS], score[PLANE_PIXELS];
} plane_rows;

typedef struct pixel_row {
    float z[BLOCK_PIXELS], x[BLOCK_PIXELS], y[BLOCK_PIXELS];
} pixel_row;

typedef struct block_row {
    float moment[MOMENTS][BLOCKS];
} block_row;

static const float no_plane = 1e30f;

/* A row of the tile with its border; zero depth outside the image. */
RLF_KERNEL_PART void load_row(const rlf_kernel_tile *t, int32_t y, pixel_row *row)
{
    int32_t first = t->x0 - 6;
    for (int32_t i = 0; i < BLOCK_PIXELS; i++) {
        row->z[i] = row->x[i] = row->y[i] = 0.0f;
    }
    if (y < 0 || y >= t->height) {
        return;
    }
    int32_t begin = first < 0 ? -first : 0;
    int32_t end = first + BLOCK_PIXELS > t->width ? t->width - first : BLOCK_PIXELS;
    ptrdiff_t offset = (ptrdiff_t)y * t->width + first;
    for (int32_t i = begin; i < end; i++) {
        row->z[i] = t->depth[offset + i];
        row->x[i] = t->ray_x[offset + i];
        row->y[i] = t->ray_y[offset + i];
    }
}

RLF_KERNEL_PART void add_row(const pixel_row *restrict row, reference ref,
                             float (*restrict sum)[BLOCK_PIXELS])
{
    for (int32_t i = 0; i < BLOCK_PIXELS; i++) {
        float z = row->z[i];
        float m = z > 0.0f ? 1.0f : 0.0f;
        float x = m * (row->x[i] - ref.x);
        float y = m * (row->y[i] - ref.y);
        float w = m * (1.0f / (z > 0.0f ? z : 1.0f) - ref.w);
        sum[N][i] += m;
        sum[X][i] += x;
        sum[Y][i] += y;
        sum[XX][i] += x * x;
        sum[XY][i] += x * y;
        sum[YY][i] += y * y;
        sum[W][i] += w;
        sum[XW][i] += x * w;
        sum[YW][i] += y * w;
        sum[WW][i] += w * w;
    }
}

/* Moments of one row of 2x2 blocks, whose first pixel row is y. */
RLF_KERNEL_PART void block_moments(const rlf_kernel_tile *t, int32_t y, reference ref,
                                   block_row *restrict out)
{
    pixel_row row;
    float sum[MOMENTS][BLOCK_PIXELS];
    for (int32_t k = 0; k < MOMENTS; k++) {
        for (int32_t i = 0; i < BLOCK_PIXELS; i++) {
            sum[k][i] = 0.0f;
        }
    }
    for (int32_t dy = 0; dy < 2; dy++) {
        load_row(t, y + dy, &row);
        add_row(&row, ref, sum);
    }
    for (int32_t k = 0; k < MOMENTS; k++) {
        for (int32_t i = 0; i < BLOCKS; i++) {
            out->moment[k][i] = sum[k][2 * i] + sum[k][2 * i + 1];
        }
    }
}

typedef struct window_sums {
    float wide[MOMENTS][PLANES], narrow[MOMENTS][PLANES];
} window_sums;

RLF_KERNEL_PART void sum_windows(const block_row *const rows[5], window_sums *restrict out)
{
    for (int32_t k = 0; k < MOMENTS; k++) {
        float three[BLOCKS], five[BLOCKS];
        for (int32_t i = 0; i < BLOCKS; i++) {
            three[i] = rows[1]->moment[k][i] + rows[2]->moment[k][i] + rows[3]->moment[k][i];
            five[i] = three[i] + rows[0]->moment[k][i] + rows[4]->moment[k][i];
        }
        for (int32_t i = 0; i < PLANES; i++) {
            out->narrow[k][i] = three[i + 1] + three[i + 2] + three[i + 3];
            out->wide[k][i] = five[i] + five[i + 1] + five[i + 2] + five[i + 3] + five[i + 4];
        }
    }
}

typedef struct plane {
    float a, b, c, score;
} plane;

/* Plane of one window. The score is the variance of the gradient that noise and misfit leave. */
RLF_KERNEL_PART plane fit(const float (*restrict s)[PLANES], int32_t i, float ref_w,
                          rlf_kernel_noise noise, float most_sigmas)
{
    float n = s[N][i];
    float inv = 1.0f / (n > 0.0f ? n : 1.0f);
    float mx = s[X][i] * inv, my = s[Y][i] * inv, mw = s[W][i] * inv;
    float xx = s[XX][i] - s[X][i] * mx;
    float xy = s[XY][i] - s[X][i] * my;
    float yy = s[YY][i] - s[Y][i] * my;
    float xw = s[XW][i] - s[X][i] * mw;
    float yw = s[YW][i] - s[Y][i] * mw;
    float ww = s[WW][i] - s[W][i] * mw;
    float det = xx * yy - xy * xy;
    bool solvable = n > 5.5f && det > 0.02f * xx * yy && det > 0.0f;
    float inv_det = 1.0f / (solvable ? det : 1.0f);
    plane p;
    p.b = (xw * yy - yw * xy) * inv_det;
    p.c = (yw * xx - xw * xy) * inv_det;
    p.a = mw + ref_w - p.b * mx - p.c * my;
    float residual = ww - p.b * xw - p.c * yw;
    residual = residual > 0.0f ? residual : 0.0f;
    float variance = residual / (n > 4.0f ? n - 3.0f : 1.0f);
    float w = mw + ref_w;
    w = w > 1e-3f ? w : 1e-3f;
    float sigma_w = rlf_kernel_sigma(noise, 1.0f / w) * w * w;
    float expected = sigma_w * sigma_w;
    bool fits = solvable && variance <= most_sigmas * most_sigmas * expected;
    float spread = xx < yy ? xx : yy;
    float worst = variance > expected ? variance : expected;
    p.score = fits ? worst / (spread > 0.0f ? spread : 1.0f) : no_plane;
    return p;
}

RLF_KERNEL_PART void fit_row(const window_sums *restrict sums, float ref_w, rlf_kernel_noise noise,
                             plane_rows *restrict out)
{
    float a[PLANES], b[PLANES], c[PLANES], score[PLANES];
    for (int32_t i = 0; i < PLANES; i++) {
        plane wide = fit(sums->wide, i, ref_w, noise, 1.5f);
        plane narrow = fit(sums->narrow, i, ref_w, noise, 3.0f);
        bool use_wide = wide.score < no_plane;
        a[i] = use_wide ? wide.a : narrow.a;
        b[i] = use_wide ? wide.b : narrow.b;
        c[i] = use_wide ? wide.c : narrow.c;
        score[i] = use_wide ? wide.score : narrow.score;
    }
    for (int32_t i = 0; i < PLANES; i++) {
        for (int32_t k = 0; k < 2; k++) {
            out->a[2 * i + k] = a[i];
            out->b[2 * i + k] = b[i];
            out->c[2 * i + k] = c[i];
            out->score[2 * i + k] = score[i];
        }
    }
}

/* Writes one pixel row from the three rows of planes about it. */
RLF_KERNEL_PART void select_row(const rlf_kernel_tile *t, int32_t y, reference ref,
                                const plane_rows *restrict planes)
{
    ptrdiff_t offset = (ptrdiff_t)y * t->width + t->x0;
    const float *restrict depth = t->depth + offset;
    const float *restrict ray_x = t->ray_x + offset;
    const float *restrict ray_y = t->ray_y + offset;
    float *restrict out_x = t->out_x + offset;
    float *restrict out_y = t->out_y + offset;
    float *restrict out_z = t->out_z + offset;
    int32_t count = t->x1 - t->x0;
    for (int32_t i = 0; i < count; i++) {
        float z = depth[i];
        float w = z > 0.0f ? 1.0f / (z > 0.0f ? z : 1.0f) : 0.0f;
        float tolerance = 3.0f * rlf_kernel_sigma(t->noise, z) * w * w;
        float x = ray_x[i] - ref.x;
        float yy = ray_y[i] - ref.y;
        float a = 0.0f, b = 0.0f, c = 0.0f, score = no_plane;
        for (int32_t row = 0; row < 3; row++) {
            for (int32_t column = 0; column < 3; column++) {
                int32_t k = i + 2 * column;
                float pa = planes[row].a[k], pb = planes[row].b[k], pc = planes[row].c[k];
                float error = rlf_kernel_abs(pa + pb * x + pc * yy - w);
                float value = error <= tolerance ? planes[row].score[k] : no_plane;
                bool better = value < score;
                a = better ? pa : a;
                b = better ? pb : b;
                c = better ? pc : c;
                score = better ? value : score;
            }
        }
        a = a - b * ref.x - c * ref.y;
        float square = a * a + b * b + c * c;
        bool usable = z > 0.0f && square > 1e-30f;
        float scale = usable ? -1.0f / sqrtf(usable ? square : 1.0f) : 0.0f;
        out_x[i] = b * scale;
        out_y[i] = c * scale;
        out_z[i] = a * scale;
    }
}

static reference tile_reference(const rlf_kernel_tile *t)
{
    int32_t x = (t->x0 + t->x1) / 2;
    int32_t y = (t->y0 + t->y1) / 2;
    ptrdiff_t i = (ptrdiff_t)y * t->width + x;
    float z = t->depth[i];
    reference ref = {t->ray_x[i], t->ray_y[i], z > 0.0f ? 1.0f / z : 0.5f};
    return ref;
}

RLF_KERNEL void rlf_kernel_plane_tile(const rlf_kernel_tile *tile)
{
    reference ref = tile_reference(tile);
    block_row blocks[5];
    plane_rows planes[PLANES];
    window_sums sums;
    int32_t plane_count = (tile->y1 - tile->y0 + 1) / 2 + 2;
    for (int32_t row = 0; row < plane_count + 4; row++) {
        block_moments(tile, tile->y0 + 2 * (row - 3), ref, &blocks[row % 5]);
        if (row < 4) {
            continue;
        }
        const block_row *const rows[5] = {&blocks[(row + 1) % 5], &blocks[(row + 2) % 5],
                                          &blocks[(row + 3) % 5], &blocks[(row + 4) % 5],
                                          &blocks[row % 5]};
        sum_windows(rows, &sums);
        fit_row(&sums, ref.w, tile->noise, &planes[row - 4]);
    }
    for (int32_t y = tile->y0; y < tile->y1; y++) {
        select_row(tile, y, ref, &planes[(y - tile->y0) / 2]);
    }
}
