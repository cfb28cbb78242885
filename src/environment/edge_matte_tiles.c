/* Tiles of the picture: which have bodies, and which have edges that matter to those. */
#include "environment/edge_matte.h"

#include "environment/depth_edge.h"
#include "kernel/kernel.h"

#include <string.h>

#define MARGIN_M 0.1f /* bodies so near to an edge's sides fade there, or the sides slope */

/* ---- bodies --------------------------------------------------------------------------------- */

static void widen(edge_matte_tile *tile, const edge_matte_tile *by)
{
    tile->near_z = by->near_z < tile->near_z ? by->near_z : tile->near_z;
    tile->far_z = by->far_z > tile->far_z ? by->far_z : tile->far_z;
}

static bool is_used(const edge_matte_tile *tile)
{
    return tile->far_z >= tile->near_z;
}

void edge_matte_clear_bodies(edge_matte *s)
{
    for (int32_t i = 0; i < s->columns * s->rows; i++) {
        s->own[i] = (edge_matte_tile){EDGE_MATTE_FAR, -1.0f};
    }
}

void edge_matte_add_shadow(edge_matte *s, const pixel_rect *rect, double near_z, double far_z)
{
    const edge_matte_tile range = {(float)near_z, (float)far_z};
    for (int32_t y = rect->y0 / EDGE_MATTE_TILE; y * EDGE_MATTE_TILE < rect->y1; y++) {
        for (int32_t x = rect->x0 / EDGE_MATTE_TILE; x * EDGE_MATTE_TILE < rect->x1; x++) {
            widen(&s->own[y * s->columns + x], &range);
        }
    }
}

void edge_matte_add_body(edge_matte *s, const rlf_camera *camera, rlf_vec3 center, double radius)
{
    pixel_rect rect;
    if (pixel_rect_of_ball(camera, center, radius, &rect)) {
        edge_matte_add_shadow(s, &rect, center.z - radius, center.z + radius);
    }
}

/* An edge in the next tile may reach into a tile with a body. */
void edge_matte_spread_bodies(edge_matte *s)
{
    memcpy(s->tiles, s->own, (size_t)(s->columns * s->rows) * sizeof(*s->tiles));
    for (int32_t i = 0; i < s->columns * s->rows; i++) {
        const edge_matte_tile *own = &s->own[i];
        for (int32_t k = 0; k < 9 && is_used(own); k++) {
            int32_t x = i % s->columns + k % 3 - 1;
            int32_t y = i / s->columns + k / 3 - 1;
            if (x >= 0 && y >= 0 && x < s->columns && y < s->rows) {
                widen(&s->tiles[y * s->columns + x], own);
            }
        }
    }
}

/* ---- jumps ---------------------------------------------------------------------------------- */

/* A jump that matters to bodies: they are not all before, nor all behind both of its sides. */
RLF_KERNEL_PART int32_t matters(float a, float b, float near_z, float far_z)
{
    float nearer = a < b ? a : b;
    float farther = a < b ? b : a;
    /* Without depth there is nothing: as far as can be. */
    farther = nearer > 0.0f ? farther : EDGE_MATTE_FAR;
    nearer = nearer > 0.0f ? nearer : (a < b ? b : a);
    return (depth_steps(a, b) ? 1 : 0) & (nearer < far_z ? 1 : 0) & (farther > near_z ? 1 : 0);
}

/* Depths of the pixels of a tile, z being its first, and of those beside and below: `rows` rows,
 * `stride` pixels apart. */
RLF_KERNEL_PART edge_matte_tile range_of(const float *restrict z, ptrdiff_t stride, int32_t rows)
{
    float near_z[EDGE_MATTE_TILE];
    float far_z[EDGE_MATTE_TILE];
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < EDGE_MATTE_TILE; i++) {
        near_z[i] = far_z[i] = z[i];
    }
    for (int32_t y = 0; y < rows; y++) {
        const float *restrict row = z + y * stride;
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < EDGE_MATTE_TILE; i++) {
            float nearer = row[i] < row[i + 1] ? row[i] : row[i + 1];
            float farther = row[i] < row[i + 1] ? row[i + 1] : row[i];
            near_z[i] = nearer < near_z[i] ? nearer : near_z[i];
            far_z[i] = farther > far_z[i] ? farther : far_z[i];
        }
    }
    for (int32_t half = EDGE_MATTE_TILE / 2; half > 0; half /= 2) {
        for (int32_t i = 0; i < half; i++) {
            near_z[i] = near_z[i + half] < near_z[i] ? near_z[i + half] : near_z[i];
            far_z[i] = far_z[i + half] > far_z[i] ? far_z[i + half] : far_z[i];
        }
    }
    const edge_matte_tile range = {near_z[0], near_z[0] > 0.0f ? far_z[0] : EDGE_MATTE_FAR};
    return range;
}

/* True when depth jumps between a pixel of the tile and the next one, or the one below, in a way
 * that matters to the tile's bodies; `below`: rows that have one below. */
RLF_KERNEL_PART bool has_jump(const float *restrict z, ptrdiff_t stride, int32_t rows,
                              int32_t below, const edge_matte_tile *bodies)
{
    const float near_z = bodies->near_z - MARGIN_M;
    const float far_z = bodies->far_z + MARGIN_M;
    int32_t any = 0;
    for (int32_t y = 0; y < rows && any == 0; y++) {
        const float *here = z + y * stride;
        const float *under = here + (y < below ? stride : 0);
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < EDGE_MATTE_TILE; i++) {
            any |= matters(here[i], here[i + 1], near_z, far_z);
            any |= matters(here[i], under[i], near_z, far_z);
        }
    }
    return any != 0;
}

/* Ranges of a row of tiles, z being its first pixel, and marks of those where depth jumps. The
 * first `whole` tiles have a pixel beyond their last. No two depths of a tile differ by more than
 * the least and the greatest: where these do not jump none do. */
RLF_KERNEL static void find_jumps(const float *z, ptrdiff_t stride, int32_t rows, int32_t below,
                                  int32_t whole, const edge_matte_tile *restrict tiles,
                                  edge_matte_tile *restrict real, uint8_t *restrict marks)
{
    for (int32_t k = 0; k < whole; k++) {
        const float *first = z + k * EDGE_MATTE_TILE;
        if (is_used(&tiles[k])) {
            real[k] = range_of(first, stride, rows + (below == rows ? 1 : 0));
            bool jumps = depth_steps(real[k].near_z, real[k].far_z) &&
                         has_jump(first, stride, rows, below, &tiles[k]);
            marks[k] |= jumps ? EDGE_MATTE_JUMPS : 0;
        }
    }
}

/* The same for the last pixels of rows y0 <= y < y1, which end in a tile that may be cut. */
static bool jumps_at_end(const rlf_plane_f32 *z, int32_t x0, int32_t y0, int32_t y1)
{
    bool any = false;
    for (int32_t y = y0; y < y1 && !any; y++) {
        const float *row = rlf_f32_row(z, y);
        const float *below = rlf_f32_row(z, y + 1 < z->height ? y + 1 : y);
        for (int32_t x = x0; x < z->width; x++) {
            any = any || depth_steps(row[x], below[x]) ||
                  (x + 1 < z->width && depth_steps(row[x], row[x + 1]));
        }
    }
    return any;
}

void edge_matte_find_jumps(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const edge_matte_pass *p = context;
    edge_matte *s = p->s;
    (void)worker;
    const rlf_plane_f32 *z = p->z;
    const int32_t whole = (z->width - 1) / EDGE_MATTE_TILE;
    const int32_t at = whole * EDGE_MATTE_TILE;
    for (int32_t i = begin * s->columns; i < end * s->columns; i++) {
        s->marks[i] = (s->marks[i] & EDGE_MATTE_EDGE) != 0 ? EDGE_MATTE_WAS_EDGE : 0;
    }
    for (int32_t tile = begin; tile < end; tile++) {
        const int32_t y0 = tile * EDGE_MATTE_TILE;
        const int32_t y1 = edge_matte_at_most(y0 + EDGE_MATTE_TILE, z->height);
        const int32_t first = tile * s->columns;
        find_jumps(rlf_f32_row(z, y0), z->width, y1 - y0,
                   edge_matte_at_most(y1, z->height - 1) - y0, whole, s->tiles + first,
                   s->real + first, s->marks + first);
        const int32_t last = first + whole;
        if (whole < s->columns && is_used(&s->tiles[last])) {
            s->real[last] = (edge_matte_tile){0.0f, EDGE_MATTE_FAR};
            s->marks[last] |= jumps_at_end(z, at, y0, y1) ? EDGE_MATTE_JUMPS : 0;
        }
    }
}

/* Marks the tiles within `reach` of (x, y) in its row and the rows beside, as far as they have
 * bodies. */
static void mark_around(edge_matte *s, int32_t tile, int32_t reach, uint8_t mark)
{
    for (int32_t y = tile / s->columns - 1; y <= tile / s->columns + 1; y++) {
        for (int32_t x = tile % s->columns - reach; x <= tile % s->columns + reach; x++) {
            int32_t i = y * s->columns + x;
            if (x >= 0 && y >= 0 && x < s->columns && y < s->rows && is_used(&s->tiles[i])) {
                s->marks[i] |= mark;
            }
        }
    }
}

void edge_matte_mark_tiles(edge_matte *s)
{
    for (int32_t i = 0; i < s->columns * s->rows; i++) {
        if ((s->marks[i] & EDGE_MATTE_JUMPS) != 0) {
            mark_around(s, i, 1, EDGE_MATTE_EDGE);
            mark_around(s, i, 1 + EDGE_MATTE_AROUND, EDGE_MATTE_FILLED);
        }
        if ((s->marks[i] & EDGE_MATTE_WAS_EDGE) != 0 && is_used(&s->tiles[i])) {
            s->marks[i] |= EDGE_MATTE_EDGE | EDGE_MATTE_FILLED;
        }
        if (s->fills_all && is_used(&s->tiles[i])) {
            s->marks[i] |= EDGE_MATTE_FILLED;
        }
    }
}
