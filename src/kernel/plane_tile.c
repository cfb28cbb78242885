/* Normals of noisy depth: least-squares planes in inverse depth, one window chosen per pixel.
 *
 * Each 2x2 block of pixels gets the plane of its window of 5x5 blocks where the sensor's noise
 * explains the residual, otherwise of the most certain of the window of 3x3 blocks and the four of
 * 2x2. A pixel then takes the weighted mean of those planes of 13 blocks about it that predict the
 * pixel's own depth (after the selection of Kuwahara et al. 1976): windows that reach across a
 * depth edge or a crease drop out, and on curved surfaces the others balance.
 *
 * Rows of blocks stream through two rings of five: moments in, planes out, pixels from planes. */
#include "kernel/plane_window.h"

#include <string.h>

enum {
    REACH = 2, /* blocks from a pixel's own to the planes that it may take */
    HALO = 4,  /* blocks with moments before the tile: two more, for the windows */
    SPAN = 8,  /* blocks that get small windows together */
    PLANES = RLF_KERNEL_TILE_WIDTH / 2 + SPAN, /* REACH on each side of the tile, then padding */
    CORNERS = PLANES + SPAN,
    BLOCKS = CORNERS + 2 * SPAN,
    LINE = 16, /* floats of a line of cache */
    LEFT = LINE,
    PIXELS = LEFT - 2 * REACH + 2 * PLANES + 4
};

/* Largest residuals that a window may have, in sigmas. */
static const rlf_plane_gate WIDE = {1.15f, true}, NARROW = {1.6f, false};

enum { N, X, Y, XX, XY, YY, W, XW, YW, WW, LEFT_OVER, MOMENTS };

/* Plane i is of block i - REACH of the tile. The moments of that block have the index
 * i + HALO - REACH, and the corner to its left has the index i. */
typedef struct moment_row {
    _Alignas(64) float of[MOMENTS][BLOCKS];
} moment_row;

typedef struct plane_row {
    _Alignas(64) float a[CORNERS], b[CORNERS], c[CORNERS], weight[CORNERS], precision[CORNERS];
} plane_row;

typedef struct pixel_planes { /* of one row of blocks, each value twice: once per pixel column */
    _Alignas(64) float a[PIXELS], b[PIXELS], c[PIXELS], weight[PIXELS], precision[PIXELS];
} pixel_planes;

/* Windows of 2x2 blocks, fitted span by span when one is asked for. */
typedef struct corner_row {
    plane_row planes;
    bool is_fitted[CORNERS / SPAN];
} corner_row;

typedef struct tile_state {
    const rlf_kernel_tile *tile;
    rlf_plane_reference ref;
    int32_t planes;        /* in a row, whole spans */
    moment_row moments[5]; /* rings by the row's number */
    pixel_planes pixels[5];
    corner_row corners[2]; /* below a row of moments */
} tile_state;

/* ---- moments ---- */

typedef struct pixel_row {
    const float *z, *frames, *x, *y;
} pixel_row;

RLF_KERNEL_PART void store_moments(rlf_plane_moments s, int32_t i, moment_row *out)
{
    out->of[N][i] = s.n;
    out->of[X][i] = s.x;
    out->of[Y][i] = s.y;
    out->of[XX][i] = s.xx;
    out->of[XY][i] = s.xy;
    out->of[YY][i] = s.yy;
    out->of[W][i] = s.w;
    out->of[XW][i] = s.xw;
    out->of[YW][i] = s.yw;
    out->of[WW][i] = s.ww;
    out->of[LEFT_OVER][i] = s.left;
}

RLF_KERNEL_PART rlf_plane_moments pair_moments(const float *z, const float *frames, const float *x,
                                               const float *y, rlf_plane_reference ref)
{
    return rlf_plane_add(rlf_plane_pixel(z[0], frames[0], x[0], y[0], ref),
                         rlf_plane_pixel(z[1], frames[1], x[1], y[1], ref));
}

/* Whole blocks: `count` of them from two rows of pixels. */
RLF_KERNEL_PART void add_blocks(pixel_row upper, pixel_row lower, rlf_plane_reference ref,
                                int32_t count, moment_row *restrict out, int32_t first)
{
    const float *restrict z0 = upper.z, *restrict x0 = upper.x, *restrict y0 = upper.y;
    const float *restrict z1 = lower.z, *restrict x1 = lower.x, *restrict y1 = lower.y;
    const float *restrict f0 = upper.frames, *restrict f1 = lower.frames;
    for (int32_t i = 0; i < count; i++) {
        rlf_plane_moments top = pair_moments(z0 + 2 * i, f0 + 2 * i, x0 + 2 * i, y0 + 2 * i, ref);
        rlf_plane_moments low = pair_moments(z1 + 2 * i, f1 + 2 * i, x1 + 2 * i, y1 + 2 * i, ref);
        store_moments(rlf_plane_add(top, low), first + i, out);
    }
}

/* The block of the last column of an odd width. */
RLF_KERNEL_PART void add_half_block(pixel_row upper, pixel_row lower, rlf_plane_reference ref,
                                    int32_t x, moment_row *restrict out, int32_t i)
{
    rlf_plane_moments top =
        rlf_plane_pixel(upper.z[x], upper.frames[x], upper.x[x], upper.y[x], ref);
    rlf_plane_moments low =
        rlf_plane_pixel(lower.z[x], lower.frames[x], lower.x[x], lower.y[x], ref);
    store_moments(rlf_plane_add(top, low), i, out);
}

/* The next row of pixels in the tile begins far from the end of this one: it is brought near. */
RLF_KERNEL_PART void fetch_row(const rlf_kernel_tile *t, ptrdiff_t i, int32_t count)
{
    for (int32_t k = 0; k < count; k += LINE) {
        RLF_KERNEL_SOON(t->depth + i + k);
        RLF_KERNEL_SOON(t->ray_x + i + k);
        RLF_KERNEL_SOON(t->ray_y + i + k);
    }
}

RLF_KERNEL_PART void fetch_out(const rlf_kernel_tile *t, ptrdiff_t i, int32_t count)
{
    for (int32_t k = 0; k < count; k += LINE) {
        RLF_KERNEL_SOON_WRITTEN(t->out_x + i + k);
        RLF_KERNEL_SOON_WRITTEN(t->out_y + i + k);
        RLF_KERNEL_SOON_WRITTEN(t->out_z + i + k);
        if (t->out_depth != NULL) {
            RLF_KERNEL_SOON_WRITTEN(t->out_depth + i + k);
        }
    }
}

/* Moments of the row of blocks whose first row of pixels is y. Blocks outside the image are 0 from
 * the start and stay so. */
RLF_KERNEL_PART void make_moments(tile_state *state, int32_t y, moment_row *restrict out)
{
    static const float missing[2 * BLOCKS];
    const rlf_kernel_tile *t = state->tile;
    if (y < 0 || y >= t->height) {
        memset(out, 0, sizeof *out);
        return;
    }
    int32_t x = t->x0 - 2 * HALO;
    int32_t first = x < 0 ? -x / 2 : 0;
    x += 2 * first;
    int32_t room = (t->width - x) / 2;
    int32_t count = state->planes + SPAN - first;
    bool is_cut = count > room;
    count = is_cut ? room : count;
    ptrdiff_t i = (ptrdiff_t)y * t->width + x;
    const float *frames = t->frames != NULL ? t->frames + i : missing; /* less than one is one */
    pixel_row upper = {t->depth + i, frames, t->ray_x + i, t->ray_y + i};
    pixel_row lower = {missing, frames, upper.x, upper.y};
    if (y + 1 < t->height) {
        ptrdiff_t below = t->frames != NULL ? t->width : 0;
        lower =
            (pixel_row){upper.z + t->width, frames + below, upper.x + t->width, upper.y + t->width};
    }
    for (int32_t next = 2; next < 4 && y + next < t->height; next++) {
        fetch_row(t, i + (ptrdiff_t)next * t->width, 2 * count);
    }
    add_blocks(upper, lower, state->ref, count, out, first);
    if (is_cut && t->width % 2 != 0) {
        add_half_block(upper, lower, state->ref, 2 * count, out, first + count);
    }
}

/* ---- planes ---- */

RLF_KERNEL_PART void store_plane(rlf_plane p, int32_t i, plane_row *restrict out)
{
    out->a[i] = p.a;
    out->b[i] = p.b;
    out->c[i] = p.c;
    out->weight[i] = p.weight;
    out->precision[i] = p.precision;
}

/* Puts plane `from` of another row where it is more certain than plane `to`. */
RLF_KERNEL_PART void improve(plane_row *restrict planes, int32_t to,
                             const plane_row *restrict other, int32_t from)
{
    bool better = other->weight[from] > planes->weight[to];
    planes->a[to] = better ? other->a[from] : planes->a[to];
    planes->b[to] = better ? other->b[from] : planes->b[to];
    planes->c[to] = better ? other->c[from] : planes->c[to];
    planes->precision[to] = better ? other->precision[from] : planes->precision[to];
    planes->weight[to] = better ? other->weight[from] : planes->weight[to];
}

/* Sums of rows of moments over the blocks begin .. end - 1. */
RLF_KERNEL_PART void sum_rows(const moment_row *const *rows, int32_t height, int32_t begin,
                              int32_t end, moment_row *restrict out)
{
    for (int32_t k = 0; k < MOMENTS; k++) {
        float *restrict sum = out->of[k];
        const float *row[5];
        for (int32_t r = 0; r < 5; r++) {
            row[r] = rows[r < height ? r : 0]->of[k];
        }
        for (int32_t i = begin; i < end; i++) {
            float upper = row[0][i] + row[1][i];
            float lower = height > 3 ? row[3][i] + row[4][i] : 0.0f;
            sum[i] = height > 3   ? upper + lower + row[2][i]
                     : height > 2 ? upper + row[2][i]
                                  : upper;
        }
    }
}

RLF_KERNEL_PART float run(const float *v, int32_t length)
{
    float sum = v[0];
    for (int32_t k = 1; k < length; k++) {
        sum += v[k];
    }
    return sum;
}

/* Moments of the window of `length` blocks from the index i on. */
RLF_KERNEL_PART rlf_plane_moments window(const moment_row *s, int32_t i, int32_t length)
{
    rlf_plane_moments sum = {
        run(s->of[N] + i, length),  run(s->of[X] + i, length),        run(s->of[Y] + i, length),
        run(s->of[XX] + i, length), run(s->of[XY] + i, length),       run(s->of[YY] + i, length),
        run(s->of[W] + i, length),  run(s->of[XW] + i, length),       run(s->of[YW] + i, length),
        run(s->of[WW] + i, length), run(s->of[LEFT_OVER] + i, length)};
    return sum;
}

/* Planes of the windows of `length` blocks; that of plane i starts at the moments i + shift. */
RLF_KERNEL_PART void fit_windows(const tile_state *state, const moment_row *restrict sums,
                                 int32_t shift, int32_t length, rlf_plane_gate gate, int32_t first,
                                 int32_t end, plane_row *restrict out)
{
    const rlf_plane_reference ref = state->ref;
    const rlf_kernel_noise noise = state->tile->noise;
    const float lasting = state->tile->lasting;
    for (int32_t i = first; i < end; i++) {
        store_plane(rlf_plane_fit(window(sums, i + shift, length), ref, noise, lasting, gate), i,
                    out);
    }
}

/* Planes of the corners between two rows, spans from `first` to `end`, as far as they are missing;
 * long runs keep the vectors busy. */
RLF_KERNEL_PART void fit_corners(const tile_state *state, const moment_row *const rows[2],
                                 int32_t first, int32_t end, corner_row *corners)
{
    moment_row sums;
    while (first < end) {
        int32_t last = first;
        while (last < end && !corners->is_fitted[last / SPAN]) {
            corners->is_fitted[last / SPAN] = true;
            last += SPAN;
        }
        if (last > first) {
            sum_rows(rows, 2, first, last + SPAN, &sums);
            fit_windows(state, &sums, 1, 2, NARROW, first, last, &corners->planes);
        }
        first = last > first ? last : first + SPAN;
    }
}

/* Some block of the span has pixels enough in its widest window but no plane. */
RLF_KERNEL_PART bool needs_small(const moment_row *restrict sums, const plane_row *restrict planes,
                                 int32_t first)
{
    int32_t without = 0;
    for (int32_t i = first; i < first + SPAN; i++) {
        float n = run(sums->of[N] + i, 5);
        without += (n > 5.5f) & !(planes->weight[i] > 0.0f);
    }
    return without > 0;
}

/* In some spans of blocks, where no wide window fits: the most certain of the window of 3x3 blocks
 * and the four of 2x2. */
RLF_KERNEL_PART void fit_small(tile_state *state, const moment_row *const rows[5], int32_t row,
                               int32_t first, int32_t end, plane_row *restrict planes)
{
    moment_row sums;
    plane_row best;
    sum_rows(rows + 1, 3, first, end + SPAN, &sums);
    fit_windows(state, &sums, 1, 3, NARROW, first, end, &best);
    for (int32_t side = 0; side < 2; side++) {
        corner_row *corners = &state->corners[(row + 1 + side) % 2];
        fit_corners(state, rows + 1 + side, first, end + SPAN, corners);
        for (int32_t i = first; i < end; i++) {
            improve(&best, i, &corners->planes, i);
            improve(&best, i, &corners->planes, i + 1);
        }
    }
    for (int32_t i = first; i < end; i++) {
        best.weight[i] = planes->weight[i] > 0.0f ? 0.0f : best.weight[i];
        improve(planes, i, &best, i);
    }
}

RLF_KERNEL_PART void expand(const float *restrict planes, int32_t count, float *restrict pixels)
{
    for (int32_t i = 0; i < count; i++) {
        pixels[2 * i] = planes[i];
        pixels[2 * i + 1] = planes[i];
    }
}

/* Planes of row `row` of blocks, whose moments are the third of the five rows. */
RLF_KERNEL_PART void make_planes(tile_state *state, int32_t row)
{
    const moment_row *rows[5];
    for (int32_t k = 0; k < 5; k++) {
        rows[k] = &state->moments[(row + k) % 5];
    }
    moment_row sums;
    plane_row planes;
    memset(state->corners[row % 2].is_fitted, 0, sizeof state->corners[0].is_fitted);
    sum_rows(rows, 5, 0, state->planes + HALO, &sums);
    fit_windows(state, &sums, 0, 5, WIDE, 0, state->planes, &planes);
    for (int32_t first = 0; first < state->planes; first += SPAN) {
        int32_t end = first;
        while (end < state->planes && needs_small(&sums, &planes, end)) {
            end += SPAN;
        }
        if (end > first) {
            fit_small(state, rows, row, first, end, &planes);
            first = end; /* is known to need none */
        }
    }
    pixel_planes *out = &state->pixels[row % 5];
    expand(planes.a, state->planes, out->a + LEFT - 2 * REACH);
    expand(planes.b, state->planes, out->b + LEFT - 2 * REACH);
    expand(planes.c, state->planes, out->c + LEFT - 2 * REACH);
    expand(planes.weight, state->planes, out->weight + LEFT - 2 * REACH);
    expand(planes.precision, state->planes, out->precision + LEFT - 2 * REACH);
}

/* ---- pixels ---- */

typedef struct blend { /* of one row of pixels */
    _Alignas(64) float x[RLF_KERNEL_TILE_WIDTH], y[RLF_KERNEL_TILE_WIDTH], w[RLF_KERNEL_TILE_WIDTH];
    /* sums of planes times weight, and of weights */
    float a[RLF_KERNEL_TILE_WIDTH], b[RLF_KERNEL_TILE_WIDTH], c[RLF_KERNEL_TILE_WIDTH];
    float weight[RLF_KERNEL_TILE_WIDTH];
} blend;

typedef struct plane_sum {
    float a, b, c, weight;
} plane_sum;

/* Adds the plane at k where it predicts pixel i. */
RLF_KERNEL_PART plane_sum offer(plane_sum sum, const pixel_planes *restrict planes, int32_t k,
                                const blend *restrict at, int32_t i)
{
    float a = planes->a[k], b = planes->b[k], c = planes->c[k];
    float error = a + b * at->x[i] + c * at->y[i] - at->w[i];
    float near = 1.0f - error * error * planes->precision[k];
    near = near > 0.0f ? near : 0.0f;
    float weight = planes->weight[k] * (near * near);
    plane_sum next = {sum.a + weight * a, sum.b + weight * b, sum.c + weight * c,
                      sum.weight + weight};
    return next;
}

/* A pixel and the one below it, in one row of blocks. */
typedef struct plane_sums {
    plane_sum upper, lower;
} plane_sums;

RLF_KERNEL_PART plane_sums offer_both(plane_sums sums, const pixel_planes *restrict planes,
                                      int32_t k, const blend *restrict upper,
                                      const blend *restrict lower, int32_t i)
{
    plane_sums next = {offer(sums.upper, planes, k, upper, i),
                       offer(sums.lower, planes, k, lower, i)};
    return next;
}

RLF_KERNEL_PART void store_sum(plane_sum sum, int32_t i, blend *restrict at)
{
    at->a[i] = sum.a;
    at->b[i] = sum.b;
    at->c[i] = sum.c;
    at->weight[i] = sum.weight;
}

/* Blends the planes of five rows of blocks for the two rows of pixels of the middle one, each plane
 * loaded once for the two: those at distance 0 and two blocks in the outer rows, at 0, one and two
 * in the middle one, at 0 in the others. */
RLF_KERNEL_PART void offer_planes(const pixel_planes *const planes[5], int32_t count,
                                  blend *restrict upper, blend *restrict lower)
{
    const pixel_planes *restrict p0 = planes[0], *restrict p1 = planes[1];
    const pixel_planes *restrict p2 = planes[2], *restrict p3 = planes[3];
    const pixel_planes *restrict p4 = planes[4];
    for (int32_t i = 0; i < count; i++) {
        int32_t k = i + LEFT;
        plane_sums sums = {{0.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 0.0f}};
        sums = offer_both(sums, p0, k, upper, lower, i);
        sums = offer_both(sums, p0, k - 4, upper, lower, i);
        sums = offer_both(sums, p0, k + 4, upper, lower, i);
        sums = offer_both(sums, p1, k, upper, lower, i);
        sums = offer_both(sums, p2, k, upper, lower, i);
        sums = offer_both(sums, p2, k - 2, upper, lower, i);
        sums = offer_both(sums, p2, k + 2, upper, lower, i);
        sums = offer_both(sums, p2, k - 4, upper, lower, i);
        sums = offer_both(sums, p2, k + 4, upper, lower, i);
        sums = offer_both(sums, p3, k, upper, lower, i);
        sums = offer_both(sums, p4, k, upper, lower, i);
        sums = offer_both(sums, p4, k - 4, upper, lower, i);
        sums = offer_both(sums, p4, k + 4, upper, lower, i);
        store_sum(sums.upper, i, upper);
        store_sum(sums.lower, i, lower);
    }
}

RLF_KERNEL_PART void begin_blend(const float *restrict x, const float *restrict y,
                                 const float *restrict z, int32_t count, blend *restrict at)
{
    for (int32_t i = 0; i < count; i++) {
        at->x[i] = x[i];
        at->y[i] = y[i];
        at->w[i] = z[i] > 0.0f ? 1.0f / (z[i] > 0.0f ? z[i] : 1.0f) : -1e9f; /* fits no plane */
    }
}

/* Normals, and depth where the planes meet the ray: what noise there is in a window is averaged,
 * and no window reaches across an edge or a crease. */
RLF_KERNEL_PART void end_blend(const blend *restrict at, const float *restrict z, int32_t count,
                               float *restrict out_x, float *restrict out_y, float *restrict out_z,
                               float *restrict out_depth)
{
    for (int32_t i = 0; i < count; i++) {
        float weight = at->weight[i];
        float whole = weight > 0.0f ? 1.0f / (weight > 0.0f ? weight : 1.0f) : 0.0f;
        float a = at->a[i] * whole, b = at->b[i] * whole, c = at->c[i] * whole;
        float square = a * a + b * b + c * c;
        float scale = square > 1e-30f ? -1.0f / sqrtf(square > 1e-30f ? square : 1.0f) : 0.0f;
        out_x[i] = b * scale;
        out_y[i] = c * scale;
        out_z[i] = a * scale;
        float inverse = a + b * at->x[i] + c * at->y[i];
        out_depth[i] = inverse > 0.0f ? 1.0f / (inverse > 0.0f ? inverse : 1.0f) : z[i];
    }
}

RLF_KERNEL_PART void make_pixels(const tile_state *state, int32_t row, int32_t y)
{
    const rlf_kernel_tile *t = state->tile;
    const pixel_planes *planes[5];
    for (int32_t k = 0; k < 5; k++) {
        planes[k] = &state->pixels[(row + k) % 5];
    }
    int32_t count = t->x1 - t->x0;
    int32_t rows = t->y1 - y < 2 ? t->y1 - y : 2;
    blend at[2];
    for (int32_t r = 0; r < 2; r++) { /* below the last row: that row again */
        ptrdiff_t i = (ptrdiff_t)(y + (r < rows ? r : 0)) * t->width + t->x0;
        fetch_out(t, i, count);
        begin_blend(t->ray_x + i, t->ray_y + i, t->depth + i, count, &at[r]);
    }
    offer_planes(planes, count, &at[0], &at[1]);
    float unwanted[RLF_KERNEL_TILE_WIDTH];
    for (int32_t r = 0; r < rows; r++) {
        ptrdiff_t i = (ptrdiff_t)(y + r) * t->width + t->x0;
        end_blend(&at[r], t->depth + i, count, t->out_x + i, t->out_y + i, t->out_z + i,
                  t->out_depth == NULL ? unwanted : t->out_depth + i);
    }
}

/* ---- the tile ---- */

/* The middle of the tile, at the farthest of some pixels: far surfaces have the least noise in
 * inverse depth, and need the smallest sums. */
static rlf_plane_reference choose_reference(const rlf_kernel_tile *t)
{
    enum { STEP = 8 };
    float farthest = 0.0f;
    for (int32_t y = t->y0; y < t->y1; y += STEP) {
        for (int32_t x = t->x0; x < t->x1; x += STEP) {
            float z = t->depth[(ptrdiff_t)y * t->width + x];
            farthest = z > farthest ? z : farthest;
        }
    }
    ptrdiff_t middle = (ptrdiff_t)((t->y0 + t->y1) / 2) * t->width + (t->x0 + t->x1) / 2;
    rlf_plane_reference ref = {t->ray_x[middle], t->ray_y[middle],
                               farthest > 0.0f ? 1.0f / farthest : 0.5f};
    return ref;
}

RLF_KERNEL void rlf_kernel_plane_tile(const rlf_kernel_tile *tile)
{
    tile_state state;
    state.tile = tile;
    state.ref = choose_reference(tile);
    int32_t across = (tile->x1 - tile->x0 + 1) / 2 + 2 * REACH;
    state.planes = (across + SPAN - 1) / SPAN * SPAN;
    memset(state.moments, 0, sizeof state.moments);
    memset(state.corners[1].is_fitted, 0, sizeof state.corners[1].is_fitted);
    int32_t down = (tile->y1 - tile->y0 + 1) / 2;
    for (int32_t row = 0; row < down + 2 * HALO; row++) {
        make_moments(&state, tile->y0 + 2 * (row - HALO), &state.moments[row % 5]);
        if (row >= HALO) {
            make_planes(&state, row - HALO);
        }
        if (row >= 2 * HALO) {
            int32_t first = row - 2 * HALO;
            make_pixels(&state, first, tile->y0 + 2 * first);
        }
    }
}
