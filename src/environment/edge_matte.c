/* Which pixels may hide a body: rows and columns through the tiles with edges. */
#include "environment/edge_matte.h"

#include "environment/depth_edge.h"
#include "kernel/kernel.h"

#include <string.h>

#define BESIDE 2 /* lines */

/* ---- create --------------------------------------------------------------------------------- */

static rlf_result allocate(edge_matte *s, int32_t width, int32_t height)
{
    /* Readers may look at several pixels at once, beyond the last. */
    size_t pixels = (size_t)width * (size_t)height + EDGE_MATTE_TILE;
    rlf_plane_f32 *depths[2] = {&s->near_z, &s->far_z};
    bool has_all = true;
    for (int i = 0; i < 2; i++) {
        *depths[i] = (rlf_plane_f32){rlf_alloc_array(pixels, sizeof(float)), width, height,
                                     width * (ptrdiff_t)sizeof(float)};
        has_all = has_all && depths[i]->data != NULL;
    }
    s->cover = (rlf_plane_u8){rlf_alloc(pixels), width, height, width};
    size_t tiles = (size_t)s->columns * (size_t)s->rows;
    s->tiles = rlf_alloc_array(tiles, sizeof(*s->tiles));
    s->own = rlf_alloc_array(tiles, sizeof(*s->own));
    s->real = rlf_alloc_array(tiles, sizeof(*s->real));
    s->marks = rlf_alloc_array(tiles, 1);
    s->settled = rlf_alloc_array(pixels, sizeof(*s->settled));
    s->last = rlf_alloc_array(pixels, sizeof(*s->last));
    s->held_near = rlf_alloc_array(pixels, sizeof(*s->held_near));
    s->held_far = rlf_alloc_array(pixels, sizeof(*s->held_far));
    s->trust = rlf_alloc_array(pixels, sizeof(*s->trust));
    s->changes = rlf_alloc_array((size_t)s->rows, sizeof(*s->changes));
    has_all = has_all && s->changes != NULL && s->held_near != NULL && s->held_far != NULL &&
              s->trust != NULL;
    s->offset_x = rlf_alloc_array((size_t)width, sizeof(*s->offset_x));
    s->offset_y = rlf_alloc_array((size_t)height, sizeof(*s->offset_y));
    has_all = has_all && s->cover.data != NULL && s->tiles != NULL && s->own != NULL &&
              s->real != NULL && s->marks != NULL && s->settled != NULL && s->last != NULL &&
              s->offset_x != NULL && s->offset_y != NULL;
    return has_all ? RLF_OK : RLF_ERROR_MEMORY;
}

rlf_result edge_matte_create(const rlf_camera *camera, const rlf_camera *depth, rlf_pool *pool,
                             edge_matte *out)
{
    memset(out, 0, sizeof(*out));
    out->columns = (camera->width + EDGE_MATTE_TILE - 1) / EDGE_MATTE_TILE;
    out->rows = (camera->height + EDGE_MATTE_TILE - 1) / EDGE_MATTE_TILE;
    out->pool = pool;
    out->still_light = EDGE_MATTE_STILL_LIGHT;
    double ratio = rlf_max(camera->fx / depth->fx, camera->fy / depth->fy);
    /* Sensors lose or mix up to three depth pixels at an edge. */
    out->reach = (int32_t)rlf_clamp(3.0 * ratio + 1.5, 2.0, EDGE_MATTE_TILE);
    rlf_result result = allocate(out, camera->width, camera->height);
    if (result != RLF_OK) {
        edge_matte_destroy(out);
    }
    return result;
}

void edge_matte_destroy(edge_matte *s)
{
    void *parts[15] = {s->near_z.data, s->far_z.data, s->cover.data, s->settled,  s->last,
                       s->tiles,       s->own,        s->offset_x,   s->offset_y, s->marks,
                       s->real,        s->held_near,  s->held_far,   s->trust,    s->changes};
    for (int i = 0; i < 15; i++) {
        rlf_free(parts[i]);
    }
    memset(s, 0, sizeof(*s));
}

/* ---- passes --------------------------------------------------------------------------------- */

RLF_KERNEL static void copy_depth(const float *restrict z, int32_t count, float *restrict near_z,
                                  float *restrict far_z)
{
    for (int32_t i = 0; i < count; i++) {
        float here = z[i] > 0.0f ? z[i] : EDGE_MATTE_FAR;
        near_z[i] = here;
        far_z[i] = here;
    }
}

/* Without edges: all of a pixel is as far as the registered depth says. */
static void clear_row(const edge_matte_pass *p, int32_t x0, int32_t x1, int32_t y)
{
    copy_depth(rlf_f32_row(p->z, y) + x0, x1 - x0, rlf_f32_row(&p->s->near_z, y) + x0,
               rlf_f32_row(&p->s->far_z, y) + x0);
    memset(rlf_u8_row(&p->s->cover, y) + x0, 255, (size_t)(x1 - x0));
    memset(p->s->settled + (ptrdiff_t)y * p->z->width + x0, EDGE_MATTE_NONE,
           (size_t)(x1 - x0) * sizeof(*p->s->settled));
}

/* True when depth jumps between any of a[i] and b[i]. */
RLF_KERNEL static bool has_jump(const float *a, const float *b, int32_t count)
{
    int32_t any = 0;
    for (int32_t i = 0; i < count; i++) {
        any |= depth_steps(a[i], b[i]) ? 1 : 0;
    }
    return any != 0;
}

/* Colours of line i, and of the lines BESIDE before and after it. */
static void set_colors(const edge_matte_pass *p, const ptrdiff_t *offset, int32_t i, int32_t count,
                       edge_matte_line *line)
{
    if (p->color == NULL) {
        return;
    }
    line->color = p->color + offset[i];
    line->beside[0] = p->color + offset[i >= BESIDE ? i - BESIDE : 0];
    line->beside[1] = p->color + offset[i + BESIDE < count ? i + BESIDE : count - 1];
    line->ahead = p->color + offset[i + BESIDE + 4 < count ? i + BESIDE + 4 : count - 1];
}

static edge_matte_line row_at(const edge_matte_pass *p, int32_t y)
{
    edge_matte *s = p->s;
    const int32_t width = p->z->width;
    edge_matte_line line = {.z = rlf_f32_row(p->z, y),
                            .exact = p->exact != NULL ? p->exact + (ptrdiff_t)y * width : NULL,
                            .color_offset = s->offset_x,
                            .near_z = rlf_f32_row(&s->near_z, y),
                            .far_z = rlf_f32_row(&s->far_z, y),
                            .settled = s->settled + (ptrdiff_t)y * width,
                            .step = 1,
                            .across = width,
                            .count = width,
                            .above = y,
                            .below = p->z->height - 1 - y};
    set_colors(p, s->offset_y, y, p->z->height, &line);
    return line;
}

static edge_matte_line column_at(const edge_matte_pass *p, int32_t x)
{
    edge_matte *s = p->s;
    const int32_t width = p->z->width;
    edge_matte_line line = {.z = p->z->data + x,
                            .exact = p->exact != NULL ? p->exact + x : NULL,
                            .color_offset = s->offset_y,
                            .near_z = s->near_z.data + x,
                            .far_z = s->far_z.data + x,
                            .settled = s->settled + x,
                            .step = width,
                            .across = 1,
                            .count = p->z->height,
                            .above = x,
                            .below = width - 1 - x,
                            .is_column = true};
    set_colors(p, s->offset_x, x, width, &line);
    return line;
}

/* Rows [y0, y1) of a row of tiles. */
static void clear_tiles(const edge_matte_pass *p, const uint8_t *marks, int32_t y0, int32_t y1)
{
    const int32_t columns = p->s->columns;
    for (int32_t first = 0; first < columns; first++) {
        int32_t end = first;
        while (end < columns && (marks[end] & EDGE_MATTE_FILLED) != 0) {
            end++;
        }
        const int32_t x1 = edge_matte_at_most(end * EDGE_MATTE_TILE, p->z->width);
        for (int32_t y = y0; y < y1 && first < end; y++) {
            clear_row(p, first * EDGE_MATTE_TILE, x1, y);
        }
        first = end;
    }
}

/* Jumps in row y between pixels [x, last] of a tile. */
static void settle_row(const edge_matte_pass *p, int32_t x, int32_t last, int32_t y,
                       const edge_matte_tile *tile)
{
    const float *z = rlf_f32_row(p->z, y);
    if (!has_jump(z + x, z + x + 1, last - x)) {
        return;
    }
    const edge_matte_line line = row_at(p, y);
    for (int32_t i = x; i < last; i++) {
        if (depth_steps(z[i], z[i + 1])) {
            edge_matte_settle(&line, i, tile, p->s->reach);
        }
    }
}

static void settle_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const edge_matte_pass *p = context;
    const edge_matte *s = p->s;
    (void)worker;
    for (int32_t row = begin; row < end; row++) {
        const int32_t y0 = row * EDGE_MATTE_TILE;
        const int32_t y1 = edge_matte_at_most(y0 + EDGE_MATTE_TILE, p->z->height);
        clear_tiles(p, s->marks + row * s->columns, y0, y1);
        for (int32_t at = row * s->columns; at < (row + 1) * s->columns; at++) {
            const int32_t x = (at - row * s->columns) * EDGE_MATTE_TILE;
            const int32_t last = edge_matte_at_most(x + EDGE_MATTE_TILE, p->z->width - 1);
            const bool jumps = (s->marks[at] & EDGE_MATTE_JUMPS) != 0;
            for (int32_t y = y0; y < y1 && jumps; y++) {
                settle_row(p, x, last, y, &s->tiles[at]);
            }
        }
    }
}

/* Jumps in columns of a tile between row y and the next one. */
static void settle_below(const edge_matte_pass *p, int32_t x0, int32_t y,
                         const edge_matte_tile *tile)
{
    const float *row = rlf_f32_row(p->z, y);
    const float *below = row + p->z->width;
    const int32_t end = edge_matte_at_most(x0 + EDGE_MATTE_TILE, p->z->width);
    if (!has_jump(row + x0, below + x0, end - x0)) {
        return;
    }
    for (int32_t x = x0; x < end; x++) {
        if (depth_steps(row[x], below[x])) {
            const edge_matte_line line = column_at(p, x);
            edge_matte_settle(&line, y, tile, p->s->reach);
        }
    }
}

static void settle_columns(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const edge_matte_pass *p = context;
    const edge_matte *s = p->s;
    (void)worker;
    for (int32_t column = begin; column < end; column++) {
        for (int32_t row = 0; row < s->rows; row++) {
            const int32_t at = row * s->columns + column;
            const int32_t y0 = row * EDGE_MATTE_TILE;
            const int32_t last = edge_matte_at_most(y0 + EDGE_MATTE_TILE, p->z->height - 1);
            const bool jumps = (s->marks[at] & EDGE_MATTE_JUMPS) != 0;
            for (int32_t y = y0; y < last && jumps; y++) {
                settle_below(p, column * EDGE_MATTE_TILE, y, &s->tiles[at]);
            }
        }
    }
}

/* ---- models --------------------------------------------------------------------------------- */

/* The silhouettes of models are known, to parts of a pixel, where nothing stands before them. */
static void put_edges(const edge_matte_pass *p)
{
    edge_matte *s = p->s;
    for (int32_t i = 0; p->known != NULL && i < p->known->edge_count; i++) {
        const known_edge *e = &p->known->edges[i];
        const int32_t tile = e->index / p->z->width / EDGE_MATTE_TILE * s->columns +
                             e->index % p->z->width / EDGE_MATTE_TILE;
        const float seen = p->z->data[e->index];
        const float outside = p->z->data[e->outside];
        const float far_z = outside > 0.0f ? outside : EDGE_MATTE_FAR;
        if ((s->marks[tile] & EDGE_MATTE_FILLED) == 0 || (seen > 0.0f && seen < e->front) ||
            s->near_z.data[e->index] < e->front || far_z <= e->near) {
            continue;
        }
        s->near_z.data[e->index] = e->near;
        s->far_z.data[e->index] = far_z;
        s->cover.data[e->index] = e->share;
    }
}

/* ---- update --------------------------------------------------------------------------------- */

static void fill_offsets(edge_matte *s, const rlf_image_rgba8 *color)
{
    for (int32_t x = 0; x < s->cover.width; x++) {
        s->offset_x[x] =
            4 * (ptrdiff_t)((2 * (int64_t)x + 1) * color->width / (2 * s->cover.width));
    }
    for (int32_t y = 0; y < s->cover.height; y++) {
        s->offset_y[y] = color->stride *
                         (ptrdiff_t)((2 * (int64_t)y + 1) * color->height / (2 * s->cover.height));
    }
}

static uint16_t next_number(uint16_t picture)
{
    return (uint16_t)(picture == EDGE_MATTE_PICTURES ? 1 : picture + 1);
}

/* A number is left out, and so no pixel is of the picture before. */
void edge_matte_forget(edge_matte *s)
{
    s->picture = s->picture != 0 ? next_number(s->picture) : 0;
}

void edge_matte_update(edge_matte *s, const rlf_plane_f32 *z, const known_layer *known,
                       const rlf_frame *frame)
{
    edge_matte_pass p = {s,
                         z,
                         known,
                         known != NULL ? known->shown : NULL,
                         frame->color.data,
                         frame->color.width == z->width,
                         s->picture == 0 || frame->sequence != s->last_sequence};
    if (p.color != NULL) {
        fill_offsets(s, &frame->color);
    }
    if (p.is_new) {
        s->picture = next_number(s->picture);
    }
    s->last_sequence = frame->sequence;
    rlf_parallel_for(s->pool, s->rows, 1, edge_matte_find_jumps, &p);
    edge_matte_mark_tiles(s);
    rlf_parallel_for(s->pool, s->rows, 1, settle_rows, &p);
    rlf_parallel_for(s->pool, s->columns, 1, settle_columns, &p);
    rlf_parallel_for(s->pool, s->rows, 1, edge_matte_steady_rows, &p);
    if (p.is_new) {
        edge_matte_learn_noise(s);
    }
    put_edges(&p);
}
