/* Normals of noisy depth: least-squares planes in inverse depth, one window chosen per pixel.
 *
 * On a plane w = 1/z = A + B x + C y in the ray (x, y, 1), whatever the lens, and the normal is
 * -(B, C, A): errata of eq. 4.3. Moments of 2x2 pixel blocks are summed over windows of 5x5 and 3x3
 * blocks (10 and 6 pixels); each block keeps the larger window whose residual is explained by the
 * sensor's noise. A pixel then takes the weighted mean of those planes of the 3x3 blocks about it
 * that predict the pixel's own depth (after the selection of Kuwahara et al. 1976): windows that
 * reach across a depth edge or a crease drop out, and on curved surfaces the others balance.
 *
 * Sums are taken relative to the tile's middle, which keeps single precision far below the noise.
 */
#include "kernel/kernel.h"

#include <math.h>

enum {
    MOMENTS = 10,
    REACH = 2, /* blocks from a pixel's own to the planes that it may take */
    PLANES = RLF_KERNEL_TILE / 2 + 2 * REACH, /* blocks on a side that have a plane */
    BLOCKS = PLANES + 4,                      /* and two more each side for the windows */
    SPAN = PLANES / 3,                        /* blocks that get small windows together */
    CORNERS = SPAN + 4,                       /* their corners, in whole vectors */
    PADDING = 2,                              /* so that those of the last span can be read */
    BLOCK_PIXELS = 2 * BLOCKS,
    PLANE_PIXELS = 2 * PLANES
};

/* Largest residuals that a window may have, in sigmas. */
static const float WIDE_SIGMAS = 1.22f, NARROW_SIGMAS = 1.6f;

enum { N, X, Y, XX, XY, YY, W, XW, YW, WW };

typedef struct reference {
    float x, y, w; /* what sums are relative to */
} reference;

typedef struct plane_rows { /* of one row of blocks, each value twice: once per pixel column */
    float a[PLANE_PIXELS], b[PLANE_PIXELS], c[PLANE_PIXELS];
    float weight[PLANE_PIXELS];    /* 0 = no plane */
    float precision[PLANE_PIXELS]; /* 1 / the square of the largest error of a pixel on it */
} plane_rows;

typedef struct pixel_row {
    float z[BLOCK_PIXELS], x[BLOCK_PIXELS], y[BLOCK_PIXELS];
} pixel_row;

typedef struct block_row {
    float moment[MOMENTS][BLOCKS + PADDING];
} block_row;

/* A row of the tile with its border; zero depth outside the image. */
RLF_KERNEL_PART void load_row(const rlf_kernel_tile *t, int32_t y, pixel_row *row)
{
    int32_t first = t->x0 - 2 * REACH - 4;
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
        for (int32_t i = BLOCKS; i < BLOCKS + PADDING; i++) {
            out->moment[k][i] = 0.0f;
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
    float a, b, c, weight, precision;
} plane;

typedef struct fit_in {
    reference ref;
    rlf_kernel_noise noise;
} fit_in;

/* Plane of one window. Its weight is the square of the inverse variance that its gradient has from
 * noise and misfit: planes that straddle a crease hardly count. 0 when the residual is more than
 * most_sigmas times the noise. */
RLF_KERNEL_PART plane fit(const float (*restrict s)[PLANES], int32_t i, reference ref,
                          rlf_kernel_noise noise, float most_sigmas)
{
    float n = s[N][i];
    float inv = 1.0f / (n > 1.0f ? n : 1.0f);
    float mx = s[X][i] * inv, my = s[Y][i] * inv, mw = s[W][i] * inv;
    float xx = s[XX][i] - s[X][i] * mx;
    float xy = s[XY][i] - s[X][i] * my;
    float yy = s[YY][i] - s[Y][i] * my;
    float xw = s[XW][i] - s[X][i] * mw;
    float yw = s[YW][i] - s[Y][i] * mw;
    float ww = s[WW][i] - s[W][i] * mw;
    float det = xx * yy - xy * xy;
    float solvable = n > 5.5f ? 1.0f : 0.0f;
    solvable = det > 0.02f * xx * yy ? solvable : 0.0f;
    float inv_det = solvable / (solvable > 0.0f ? det : 1.0f);
    plane p;
    p.b = (xw * yy - yw * xy) * inv_det;
    p.c = (yw * xx - xw * xy) * inv_det;
    float w = mw + ref.w;
    p.a = w - p.b * mx - p.c * my;
    float residual = ww - p.b * xw - p.c * yw;
    residual = residual > 0.0f ? residual : 0.0f;
    float variance = residual / (n > 4.0f ? n - 3.0f : 1.0f);
    w = w > 1e-3f ? w : 1e-3f;
    float rx = ref.x + mx, ry = ref.y + my;
    float nz = p.a - p.b * ref.x - p.c * ref.y;
    float square = (p.b * p.b + p.c * p.c + nz * nz) * (rx * rx + ry * ry + 1.0f);
    float cosine = w / sqrtf(square > w * w ? square : w * w);
    float sigma = rlf_kernel_sigma(noise, 1.0f / w) * w * w * rlf_kernel_slant(cosine);
    float limit = most_sigmas * sigma;
    float fits = variance <= limit * limit ? solvable : 0.0f;
    float spread = xx < yy ? xx : yy;
    float expected = sigma * sigma;
    float certainty = spread / (variance > expected ? variance : expected);
    p.weight = fits * certainty * certainty;
    p.precision = 1.0f / (9.0f * expected);
    return p;
}

/* Planes of one row of blocks. */
typedef struct plane_set {
    float a[PLANES], b[PLANES], c[PLANES], weight[PLANES], precision[PLANES];
} plane_set;

/* Puts the windows' planes where they are more certain than what is there. */
RLF_KERNEL_PART void improve(const float (*restrict s)[PLANES], const fit_in *in, float most_sigmas,
                             int32_t first, int32_t count, plane_set *restrict best)
{
    for (int32_t i = first; i < first + count; i++) {
        plane p = fit(s, i, in->ref, in->noise, most_sigmas);
        bool better = p.weight > best->weight[i];
        best->a[i] = better ? p.a : best->a[i];
        best->b[i] = better ? p.b : best->b[i];
        best->c[i] = better ? p.c : best->c[i];
        best->precision[i] = better ? p.precision : best->precision[i];
        best->weight[i] = better ? p.weight : best->weight[i];
    }
}

/* Windows of 2x2 blocks, each of which is about a corner of four blocks. */
RLF_KERNEL_PART void sum_corners(const block_row *restrict upper, const block_row *restrict lower,
                                 int32_t first, float (*restrict out)[PLANES])
{
    for (int32_t k = 0; k < MOMENTS; k++) {
        const float *restrict u = upper->moment[k] + first + 1;
        const float *restrict l = lower->moment[k] + first + 1;
        for (int32_t i = 0; i < CORNERS; i++) {
            out[k][i] = u[i] + u[i + 1] + l[i] + l[i + 1];
        }
    }
}

RLF_KERNEL_PART void clear_planes(plane_set *restrict planes)
{
    for (int32_t i = 0; i < PLANES; i++) {
        planes->a[i] = planes->b[i] = planes->c[i] = 0.0f;
        planes->weight[i] = planes->precision[i] = 0.0f;
    }
}

/* Takes a span of another set's planes, from index `from` on, where they are more certain or, if
 * only_missing, where there is none yet. */
RLF_KERNEL_PART void take_planes(const plane_set *restrict other, int32_t from, int32_t first,
                                 bool only_missing, plane_set *restrict planes)
{
    for (int32_t i = 0; i < SPAN; i++) {
        int32_t o = from + i, p = first + i;
        bool better =
            only_missing ? !(planes->weight[p] > 0.0f) : other->weight[o] > planes->weight[p];
        planes->a[p] = better ? other->a[o] : planes->a[p];
        planes->b[p] = better ? other->b[o] : planes->b[p];
        planes->c[p] = better ? other->c[o] : planes->c[p];
        planes->precision[p] = better ? other->precision[o] : planes->precision[p];
        planes->weight[p] = better ? other->weight[o] : planes->weight[p];
    }
}

/* In a span of blocks, where no wide window fits: the most certain of the window of 3x3 blocks and
 * the four of 2x2. */
RLF_KERNEL_PART void fit_small(const block_row *const rows[5],
                               const float (*restrict narrow)[PLANES], const fit_in *in,
                               int32_t first, plane_set *restrict planes)
{
    plane_set best, corners;
    float corner[MOMENTS][PLANES];
    clear_planes(&best);
    improve(narrow, in, NARROW_SIGMAS, first, SPAN, &best);
    for (int32_t k = 0; k < 2; k++) {
        sum_corners(rows[1 + k], rows[2 + k], first, corner);
        clear_planes(&corners);
        improve((const float(*)[PLANES])corner, in, NARROW_SIGMAS, 0, CORNERS, &corners);
        take_planes(&corners, 0, first, false, &best);
        take_planes(&corners, 1, first, false, &best);
    }
    take_planes(&best, first, first, true, planes);
}

/* Some block of the span has seen pixels about it but no plane. */
RLF_KERNEL_PART bool needs_small(const float *restrict seen, const float *restrict weight,
                                 int32_t first)
{
    int32_t without = 0;
    for (int32_t i = first; i < first + SPAN; i++) {
        without += (seen[i] > 0.0f) & !(weight[i] > 0.0f);
    }
    return without > 0;
}

RLF_KERNEL_PART void fit_row(const block_row *const rows[5], const fit_in *in,
                             plane_rows *restrict out)
{
    window_sums sums;
    plane_set planes;
    sum_windows(rows, &sums);
    clear_planes(&planes);
    improve((const float(*)[PLANES])sums.wide, in, WIDE_SIGMAS, 0, PLANES, &planes);
    for (int32_t first = 0; first < PLANES; first += SPAN) {
        if (needs_small(sums.narrow[N], planes.weight, first)) {
            fit_small(rows, (const float(*)[PLANES])sums.narrow, in, first, &planes);
        }
    }
    const float *const from[5] = {planes.a, planes.b, planes.c, planes.weight, planes.precision};
    float *const to[5] = {out->a, out->b, out->c, out->weight, out->precision};
    for (int32_t k = 0; k < 5; k++) {
        for (int32_t i = 0; i < PLANES; i++) {
            to[k][2 * i] = to[k][2 * i + 1] = from[k][i];
        }
    }
}

typedef struct blend {
    float x[RLF_KERNEL_TILE], y[RLF_KERNEL_TILE], w[RLF_KERNEL_TILE]; /* the pixels' own */
    float a[RLF_KERNEL_TILE], b[RLF_KERNEL_TILE], c[RLF_KERNEL_TILE]; /* weighted sums */
    float weight[RLF_KERNEL_TILE];
} blend;

/* Adds plane k where it predicts pixel i. */
RLF_KERNEL_PART void offer(const plane_rows *restrict planes, int32_t k, const blend *restrict at,
                           int32_t i, float sum[4])
{
    float a = planes->a[k], b = planes->b[k], c = planes->c[k];
    float error = a + b * at->x[i] + c * at->y[i] - at->w[i];
    float miss = error * error * planes->precision[k];
    float near = miss < 1.0f ? 1.0f - miss : 0.0f;
    float weight = planes->weight[k] * near * near;
    sum[0] += weight * a;
    sum[1] += weight * b;
    sum[2] += weight * c;
    sum[3] += weight;
}

/* Adds three planes of a row, whose distance in pixels is `step`. */
RLF_KERNEL_PART void offer_three(const plane_rows *restrict planes, int32_t step,
                                 blend *restrict sums)
{
    for (int32_t i = 0; i < RLF_KERNEL_TILE; i++) {
        float sum[4] = {0.0f, 0.0f, 0.0f, 0.0f};
        offer(planes, i + 2 * REACH - step, sums, i, sum);
        offer(planes, i + 2 * REACH, sums, i, sum);
        offer(planes, i + 2 * REACH + step, sums, i, sum);
        sums->a[i] += sum[0];
        sums->b[i] += sum[1];
        sums->c[i] += sum[2];
        sums->weight[i] += sum[3];
    }
}

/* The two planes of the middle row that are far. */
RLF_KERNEL_PART void offer_far(const plane_rows *restrict planes, blend *restrict sums)
{
    for (int32_t i = 0; i < RLF_KERNEL_TILE; i++) {
        float sum[4] = {0.0f, 0.0f, 0.0f, 0.0f};
        offer(planes, i, sums, i, sum);
        offer(planes, i + 4 * REACH, sums, i, sum);
        sums->a[i] += sum[0];
        sums->b[i] += sum[1];
        sums->c[i] += sum[2];
        sums->weight[i] += sum[3];
    }
}

/* Depth of the pixel's planes along its ray: what noise there is in a window is averaged, and no
 * window reaches across an edge or a crease. */
RLF_KERNEL_PART void project_row(const blend *restrict sums, int32_t count,
                                 const float *restrict depth, float *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        float w = sums->a[i] + sums->b[i] * sums->x[i] + sums->c[i] * sums->y[i];
        bool known = sums->weight[i] > 0.0f && w > 0.0f;
        out[i] = known ? sums->weight[i] / (known ? w : 1.0f) : depth[i];
    }
}

/* Writes one pixel row from the rows of planes about it. */
RLF_KERNEL_PART void blend_row(const rlf_kernel_tile *t, int32_t y, reference ref,
                               const plane_rows *restrict planes)
{
    ptrdiff_t offset = (ptrdiff_t)y * t->width + t->x0;
    int32_t count = t->x1 - t->x0;
    blend sums;
    for (int32_t i = 0; i < RLF_KERNEL_TILE; i++) {
        sums.x[i] = sums.y[i] = sums.w[i] = 0.0f;
        sums.a[i] = sums.b[i] = sums.c[i] = sums.weight[i] = 0.0f;
    }
    for (int32_t i = 0; i < count; i++) {
        float z = t->depth[offset + i];
        sums.x[i] = t->ray_x[offset + i] - ref.x;
        sums.y[i] = t->ray_y[offset + i] - ref.y;
        sums.w[i] = z > 0.0f ? 1.0f / (z > 0.0f ? z : 1.0f) : -1e9f; /* no plane predicts this */
    }
    offer_three(&planes[0], 4, &sums); /* 3x3 blocks about the pixel and 8 farther ones */
    offer_three(&planes[1], 2, &sums);
    offer_three(&planes[2], 2, &sums);
    offer_three(&planes[3], 2, &sums);
    offer_three(&planes[4], 4, &sums);
    offer_far(&planes[2], &sums);
    float *restrict out_x = t->out_x + offset;
    float *restrict out_y = t->out_y + offset;
    float *restrict out_z = t->out_z + offset;
    for (int32_t i = 0; i < count; i++) {
        float whole = sums.weight[i] > 0.0f ? 1.0f / sums.weight[i] : 0.0f;
        float b = sums.b[i] * whole, c = sums.c[i] * whole;
        float a = sums.a[i] * whole - b * ref.x - c * ref.y;
        float square = a * a + b * b + c * c;
        float usable = square > 1e-30f ? 1.0f : 0.0f;
        float scale = -usable / sqrtf(usable > 0.0f ? square : 1.0f);
        out_x[i] = b * scale;
        out_y[i] = c * scale;
        out_z[i] = a * scale;
    }
    if (t->out_depth != NULL) {
        project_row(&sums, count, t->depth + offset, t->out_depth + offset);
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
    const fit_in in = {ref, tile->noise};
    block_row blocks[5];
    plane_rows planes[PLANES];
    int32_t plane_count = (tile->y1 - tile->y0 + 1) / 2 + 2 * REACH;
    for (int32_t row = 0; row < plane_count + 4; row++) {
        block_moments(tile, tile->y0 + 2 * (row - REACH - 2), ref, &blocks[row % 5]);
        if (row < 4) {
            continue;
        }
        const block_row *const rows[5] = {&blocks[(row + 1) % 5], &blocks[(row + 2) % 5],
                                          &blocks[(row + 3) % 5], &blocks[(row + 4) % 5],
                                          &blocks[row % 5]};
        fit_row(rows, &in, &planes[row - 4]);
    }
    for (int32_t y = tile->y0; y < tile->y1; y++) {
        blend_row(tile, y, ref, &planes[(y - tile->y0) / 2]);
    }
}
