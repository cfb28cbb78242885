/* Which pixels may hide a body: tiles, rows, columns, and steadiness over time. */
#include "silhouette.h"

#include "kernel/kernel.h"
#include "render/body_look.h"
#include "render/caster.h"

#include <string.h>

#define STEADY_SHARE 4 /* a still pixel moves by a quarter of the way to its new cover */
#define BESIDE 2       /* lines */
#define MARGIN_M 0.1f  /* bodies so near to an edge's sides fade there, or the sides slope */
#define STEADY_LIGHT 5 /* steps of the mean colour that noise may change */

/* ---- create --------------------------------------------------------------------------------- */

static rlf_result allocate(silhouette *s, int32_t width, int32_t height)
{
    /* Readers may look at several pixels at once, beyond the last. */
    size_t pixels = (size_t)width * (size_t)height + SILHOUETTE_TILE;
    rlf_plane_f32 *depths[2] = {&s->near_z, &s->far_z};
    rlf_plane_u8 *bytes[5] = {&s->cover, &s->settled, &s->distance, &s->last_cover, &s->last_light};
    bool has_all = true;
    for (int i = 0; i < 2; i++) {
        *depths[i] = (rlf_plane_f32){rlf_alloc_array(pixels, sizeof(float)), width, height,
                                     width * (ptrdiff_t)sizeof(float)};
        has_all = has_all && depths[i]->data != NULL;
    }
    for (int i = 0; i < 5; i++) {
        *bytes[i] = (rlf_plane_u8){rlf_alloc(pixels), width, height, width};
        has_all = has_all && bytes[i]->data != NULL;
    }
    size_t tiles = (size_t)s->columns * (size_t)s->rows;
    s->tiles = rlf_alloc_array(tiles, sizeof(*s->tiles));
    s->own = rlf_alloc_array(tiles, sizeof(*s->own));
    s->marks = rlf_alloc_array(tiles, 1);
    s->last_seen = rlf_alloc_array(pixels, sizeof(*s->last_seen));
    s->offset_x = rlf_alloc_array((size_t)width, sizeof(*s->offset_x));
    s->offset_y = rlf_alloc_array((size_t)height, sizeof(*s->offset_y));
    has_all = has_all && s->tiles != NULL && s->own != NULL && s->marks != NULL &&
              s->last_seen != NULL && s->offset_x != NULL && s->offset_y != NULL;
    return has_all ? RLF_OK : RLF_ERROR_MEMORY;
}

rlf_result silhouette_create(const rlf_camera *camera, const rlf_camera *depth, rlf_pool *pool,
                             silhouette *out)
{
    memset(out, 0, sizeof(*out));
    out->columns = (camera->width + SILHOUETTE_TILE - 1) / SILHOUETTE_TILE;
    out->rows = (camera->height + SILHOUETTE_TILE - 1) / SILHOUETTE_TILE;
    out->pool = pool;
    double ratio = rlf_max(camera->fx / depth->fx, camera->fy / depth->fy);
    /* Sensors lose or mix up to three depth pixels at an edge. */
    out->reach = (int32_t)rlf_clamp(3.0 * ratio + 1.5, 2.0, SILHOUETTE_TILE);
    rlf_result result = allocate(out, camera->width, camera->height);
    if (result != RLF_OK) {
        silhouette_destroy(out);
    }
    return result;
}

void silhouette_destroy(silhouette *s)
{
    void *parts[13] = {
        s->near_z.data,     s->far_z.data,   s->cover.data, s->distance.data, s->last_cover.data,
        s->last_light.data, s->last_seen,    s->tiles,      s->own,           s->offset_x,
        s->offset_y,        s->settled.data, s->marks};
    for (int i = 0; i < 13; i++) {
        rlf_free(parts[i]);
    }
    memset(s, 0, sizeof(*s));
}

/* ---- bodies --------------------------------------------------------------------------------- */

static void widen(silhouette_tile *tile, const silhouette_tile *by)
{
    tile->near_z = by->near_z < tile->near_z ? by->near_z : tile->near_z;
    tile->far_z = by->far_z > tile->far_z ? by->far_z : tile->far_z;
}

static void add_body(silhouette *s, const caster_rect *rect, const silhouette_tile *range)
{
    for (int32_t y = rect->y0 / SILHOUETTE_TILE; y * SILHOUETTE_TILE < rect->y1; y++) {
        for (int32_t x = rect->x0 / SILHOUETTE_TILE; x * SILHOUETTE_TILE < rect->x1; x++) {
            widen(&s->own[y * s->columns + x], range);
        }
    }
}

void silhouette_place(silhouette *s, const rlf_camera *camera, const rlf_pose *T_picture_world,
                      const rlf_snapshot *snapshot)
{
    for (int32_t i = 0; i < s->columns * s->rows; i++) {
        s->own[i] = (silhouette_tile){SILHOUETTE_FAR, -1.0f};
    }
    for (int32_t i = 0; snapshot != NULL && i < snapshot->body_count; i++) {
        const rlf_body_state *state = &snapshot->bodies[i];
        rlf_vec3 center = rlf_transform(T_picture_world, state->T_world_body.p);
        double radius = body_look_radius(state);
        const silhouette_tile range = {(float)(center.z - radius), (float)(center.z + radius)};
        caster_rect rect;
        if (caster_rect_of_ball(camera, center, radius, &rect)) {
            add_body(s, &rect, &range);
        }
    }
}

/* An edge in the next tile may reach into a tile with a body. */
static void spread_tiles(silhouette *s)
{
    for (int32_t i = 0; i < s->columns * s->rows; i++) {
        s->tiles[i] = s->own[i];
        for (int32_t k = 0; k < 9; k++) {
            int32_t x = i % s->columns + k % 3 - 1;
            int32_t y = i / s->columns + k / 3 - 1;
            if (x >= 0 && y >= 0 && x < s->columns && y < s->rows) {
                widen(&s->tiles[i], &s->own[y * s->columns + x]);
            }
        }
    }
}

static bool is_used(const silhouette_tile *tile)
{
    return tile->far_z >= tile->near_z;
}

/* ---- passes --------------------------------------------------------------------------------- */

typedef struct pass {
    silhouette *s;
    const rlf_plane_f32 *z;
    const known_layer *known; /* NULL = no models */
    const uint8_t *exact;     /* its `shown` */
    const uint8_t *color;
    bool is_new; /* a new frame: cover may move on */
} pass;

static int32_t at_most(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

RLF_KERNEL static void copy_depth(const float *restrict z, int32_t count, float *restrict near_z,
                                  float *restrict far_z)
{
    for (int32_t i = 0; i < count; i++) {
        float here = z[i] > 0.0f ? z[i] : SILHOUETTE_FAR;
        near_z[i] = here;
        far_z[i] = here;
    }
}

/* Without edges: all of a pixel is as far as the registered depth says. */
static void clear_row(const pass *p, int32_t x0, int32_t x1, int32_t y)
{
    copy_depth(rlf_f32_row(p->z, y) + x0, x1 - x0, rlf_f32_row(&p->s->near_z, y) + x0,
               rlf_f32_row(&p->s->far_z, y) + x0);
    memset(rlf_u8_row(&p->s->cover, y) + x0, 255, (size_t)(x1 - x0));
    memset(rlf_u8_row(&p->s->distance, y) + x0, SILHOUETTE_NONE, (size_t)(x1 - x0));
}

/* True when depth jumps between any of a[i] and b[i]. */
RLF_KERNEL static bool has_jump(const float *a, const float *b, int32_t count)
{
    int32_t any = 0;
    for (int32_t i = 0; i < count; i++) {
        any |= silhouette_jumps(a[i], b[i]) ? 1 : 0;
    }
    return any != 0;
}

/* A jump that matters to bodies: they are not all before, nor all behind both of its sides. */
RLF_KERNEL_PART int32_t matters(float a, float b, float near_z, float far_z)
{
    float nearer = a < b ? a : b;
    float farther = a < b ? b : a;
    /* Without depth there is nothing: as far as can be. */
    farther = nearer > 0.0f ? farther : SILHOUETTE_FAR;
    nearer = nearer > 0.0f ? nearer : (a < b ? b : a);
    return (silhouette_jumps(a, b) ? 1 : 0) & (nearer < far_z ? 1 : 0) & (farther > near_z ? 1 : 0);
}

/* Marks the tiles in which depth jumps between a row's pixels and the next ones, or those below.
 * `whole` tiles have a pixel beyond their last. */
RLF_KERNEL static void mark_jumps(const float *restrict row, const float *restrict below,
                                  const silhouette_tile *restrict tiles, int32_t whole,
                                  uint8_t *restrict marks)
{
    for (int32_t k = 0; k < whole; k++) {
        const float *here = row + k * SILHOUETTE_TILE;
        const float *under = below + k * SILHOUETTE_TILE;
        const float near_z = tiles[k].near_z - MARGIN_M;
        const float far_z = tiles[k].far_z + MARGIN_M;
        int32_t any = 0;
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < SILHOUETTE_TILE; i++) {
            any |= matters(here[i], here[i + 1], near_z, far_z);
            any |= matters(here[i], under[i], near_z, far_z);
        }
        marks[k] |= (uint8_t)any;
    }
}

/* The same for the last pixels of a row, which end in a tile that may be cut. */
static bool jumps_at_end(const float *row, const float *below, int32_t count)
{
    bool any = false;
    for (int32_t i = 0; i < count; i++) {
        any = any || silhouette_jumps(row[i], below[i]) ||
              (i + 1 < count && silhouette_jumps(row[i], row[i + 1]));
    }
    return any;
}

static void find_jumps(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const pass *p = context;
    silhouette *s = p->s;
    (void)worker;
    const rlf_plane_f32 *z = p->z;
    const int32_t whole = (z->width - 1) / SILHOUETTE_TILE;
    memset(s->marks + begin * s->columns, 0, (size_t)((end - begin) * s->columns));
    for (int32_t y = begin * SILHOUETTE_TILE; y < at_most(end * SILHOUETTE_TILE, z->height); y++) {
        const int32_t first = y / SILHOUETTE_TILE * s->columns;
        const float *row = rlf_f32_row(z, y);
        const float *below = rlf_f32_row(z, y + 1 < z->height ? y + 1 : y);
        for (int32_t x = 0; x < whole;) {
            int32_t run = 0;
            while (x + run < whole && is_used(&s->tiles[first + x + run])) {
                run++;
            }
            mark_jumps(row + x * SILHOUETTE_TILE, below + x * SILHOUETTE_TILE, s->tiles + first + x,
                       run, s->marks + first + x);
            x += run + 1;
        }
        const int32_t at = whole * SILHOUETTE_TILE;
        if (whole < s->columns && is_used(&s->tiles[first + whole]) &&
            jumps_at_end(row + at, below + at, z->width - at)) {
            s->marks[first + whole] = SILHOUETTE_JUMPS;
        }
    }
}

/* Marks the tiles within `reach` of (x, y) in its row and the rows beside, as far as they have
 * bodies. */
static void mark_around(silhouette *s, int32_t tile, int32_t reach, uint8_t mark)
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

static void mark_tiles(silhouette *s)
{
    for (int32_t i = 0; i < s->columns * s->rows; i++) {
        if ((s->marks[i] & SILHOUETTE_JUMPS) != 0) {
            mark_around(s, i, 1, SILHOUETTE_EDGE);
            mark_around(s, i, 1 + SILHOUETTE_AROUND, SILHOUETTE_FILLED);
        }
        if (s->fills_all && is_used(&s->tiles[i])) {
            s->marks[i] |= SILHOUETTE_FILLED;
        }
    }
}

/* Colours of line i, and of the lines BESIDE before and after it. */
static void set_colors(const pass *p, const ptrdiff_t *offset, int32_t i, int32_t count,
                       silhouette_line *line)
{
    if (p->color == NULL) {
        return;
    }
    line->color = p->color + offset[i];
    line->beside[0] = p->color + offset[i >= BESIDE ? i - BESIDE : 0];
    line->beside[1] = p->color + offset[i + BESIDE < count ? i + BESIDE : count - 1];
}

static void settle_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const pass *p = context;
    silhouette *s = p->s;
    (void)worker;
    int32_t width = p->z->width;
    int32_t height = p->z->height;
    for (int32_t y = begin * SILHOUETTE_TILE; y < at_most(end * SILHOUETTE_TILE, height); y++) {
        const silhouette_tile *tiles = &s->tiles[y / SILHOUETTE_TILE * s->columns];
        const uint8_t *marks = &s->marks[y / SILHOUETTE_TILE * s->columns];
        silhouette_line line = {.z = rlf_f32_row(p->z, y),
                                .exact = p->exact != NULL ? p->exact + (ptrdiff_t)y * width : NULL,
                                .color_offset = s->offset_x,
                                .near_z = rlf_f32_row(&s->near_z, y),
                                .far_z = rlf_f32_row(&s->far_z, y),
                                .cover = rlf_u8_row(&s->settled, y),
                                .distance = rlf_u8_row(&s->distance, y),
                                .step = 1,
                                .across = width,
                                .count = width,
                                .above = y,
                                .below = height - 1 - y};
        set_colors(p, s->offset_y, y, height, &line);
        for (int32_t x = 0; x < width; x += SILHOUETTE_TILE) {
            if ((marks[x / SILHOUETTE_TILE] & SILHOUETTE_FILLED) != 0) {
                clear_row(p, x, at_most(x + SILHOUETTE_TILE, width), y);
            }
        }
        for (int32_t x = 0; x < width; x += SILHOUETTE_TILE) {
            const silhouette_tile *tile = &tiles[x / SILHOUETTE_TILE];
            int32_t last = at_most(x + SILHOUETTE_TILE, width - 1);
            if ((marks[x / SILHOUETTE_TILE] & SILHOUETTE_JUMPS) != 0 &&
                has_jump(line.z + x, line.z + x + 1, last - x)) {
                for (int32_t i = x; i < last; i++) {
                    silhouette_settle(&line, i, tile, s->reach);
                }
            }
        }
    }
}

static void settle_columns(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const pass *p = context;
    silhouette *s = p->s;
    (void)worker;
    int32_t width = p->z->width;
    int32_t height = p->z->height;
    for (int32_t tile_x = begin; tile_x < end; tile_x++) {
        int32_t x0 = tile_x * SILHOUETTE_TILE;
        int32_t count = at_most(SILHOUETTE_TILE, width - x0);
        for (int32_t y = 0; y < height - 1; y++) {
            const int32_t at = y / SILHOUETTE_TILE * s->columns + tile_x;
            const silhouette_tile *tile = &s->tiles[at];
            const float *row = rlf_f32_row(p->z, y) + x0;
            if ((s->marks[at] & SILHOUETTE_JUMPS) == 0 || !has_jump(row, row + width, count)) {
                continue;
            }
            for (int32_t x = x0; x < x0 + count; x++) {
                silhouette_line line = {.z = p->z->data + x,
                                        .exact = p->exact != NULL ? p->exact + x : NULL,
                                        .color_offset = s->offset_y,
                                        .near_z = s->near_z.data + x,
                                        .far_z = s->far_z.data + x,
                                        .cover = s->settled.data + x,
                                        .distance = s->distance.data + x,
                                        .step = width,
                                        .across = 1,
                                        .count = height,
                                        .above = x,
                                        .below = width - 1 - x,
                                        .is_column = true};
                set_colors(p, s->offset_x, x, width, &line);
                silhouette_settle(&line, y, tile, s->reach);
            }
        }
    }
}

/* ---- steadiness ----------------------------------------------------------------------------- */

static uint8_t light_of(const pass *p, int32_t x, int32_t y)
{
    if (p->color == NULL) {
        return 0;
    }
    const uint8_t *c = p->color + p->s->offset_y[y] + p->s->offset_x[x];
    return (uint8_t)((c[0] + 2 * c[1] + c[2]) / 4);
}

#define VOTERS (2 * SILHOUETTE_TILE) /* of a row: one before the tile's pixels, and beyond them */

/* Of three rows' doubtful pixels, per column: how many, how many of them near, and the sum of their
 * cover. */
typedef struct votes {
    int32_t count[VOTERS], near_count[VOTERS], sum[VOTERS];
} votes;

RLF_KERNEL_PART void add_votes(const uint8_t *restrict cover, const uint8_t *restrict distance,
                               votes *v)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < VOTERS; i++) {
        int32_t is_doubtful = distance[i] != SILHOUETTE_NONE ? 1 : 0;
        v->count[i] += is_doubtful;
        v->near_count[i] += is_doubtful & (cover[i] > 127 ? 1 : 0);
        v->sum[i] += is_doubtful * cover[i];
    }
}

/* A pixel that hardly any of the doubtful ones around it agree with is a line gone astray: it takes
 * their mean. */
RLF_KERNEL static void vote(uint8_t cover[3][VOTERS], uint8_t distance[3][VOTERS],
                            uint8_t *restrict out)
{
    votes v = {{0}, {0}, {0}};
    for (int k = 0; k < 3; k++) {
        add_votes(cover[k], distance[k], &v);
    }
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SILHOUETTE_TILE; i++) {
        int32_t own = cover[1][i + 1];
        int32_t count = v.count[i] + v.count[i + 1] + v.count[i + 2];
        int32_t near_count = v.near_count[i] + v.near_count[i + 1] + v.near_count[i + 2];
        int32_t sum = v.sum[i] + v.sum[i + 1] + v.sum[i + 2];
        int32_t agreeing = own > 127 ? near_count : count - near_count;
        /* Exact: the quotient is whole, or at least a ninth away from the next whole number. */
        int32_t mean = (int32_t)((float)sum / (float)(count > 0 ? count : 1));
        bool is_astray = (count >= 5) & (3 * agreeing <= count);
        out[i] = (uint8_t)(is_astray ? mean : own);
    }
}

/* What the lines settled in pixels x0 .. x0 + SILHOUETTE_TILE of row y, without those astray. */
static void vote_row(const silhouette *s, int32_t x0, int32_t y, uint8_t out[SILHOUETTE_TILE])
{
    uint8_t cover[3][VOTERS] = {{0}};
    uint8_t distance[3][VOTERS];
    memset(distance, SILHOUETTE_NONE, sizeof(distance));
    const int32_t first = x0 > 0 ? x0 - 1 : 0;
    const size_t count = (size_t)(at_most(x0 + SILHOUETTE_TILE + 1, s->cover.width) - first);
    for (int32_t k = 0; k < 3; k++) {
        const int32_t line = y + k - 1;
        if (line >= 0 && line < s->cover.height) {
            memcpy(cover[k] + (first + 1 - x0), rlf_u8_row(&s->settled, line) + first, count);
            memcpy(distance[k] + (first + 1 - x0), rlf_u8_row(&s->distance, line) + first, count);
        }
    }
    vote(cover, distance, out);
}

/* Where the picture has not changed the cover moves slowly, so that noise does not show. */
static void steady_pixel(const pass *p, int32_t x, int32_t y, uint8_t settled)
{
    silhouette *s = p->s;
    uint16_t *seen = &s->last_seen[(size_t)y * (size_t)s->cover.width + (size_t)x];
    uint8_t *cover = rlf_u8_row(&s->cover, y) + x;
    uint8_t *last = rlf_u8_row(&s->last_cover, y) + x;
    uint8_t *light = rlf_u8_row(&s->last_light, y) + x;
    uint8_t now = light_of(p, x, y);
    int32_t change = now - *light;
    *cover = settled;
    uint16_t before = (uint16_t)(s->picture == 1 ? UINT16_MAX : s->picture - 1);
    bool is_still = change <= STEADY_LIGHT && change >= -STEADY_LIGHT;
    bool is_known = *seen == (p->is_new ? before : s->picture);
    if (is_known && is_still) {
        int32_t step = *cover - *last;
        int32_t part = p->is_new ? step / STEADY_SHARE : 0;
        *cover = (uint8_t)(*last + part);
    }
    *last = *cover;
    *light = now;
    *seen = s->picture;
}

static bool is_far_from_edges(const uint8_t *distance, int32_t count)
{
    uint32_t all = SILHOUETTE_NONE;
    for (int32_t i = 0; i < count; i++) {
        all &= distance[i];
    }
    return all == SILHOUETTE_NONE;
}

static void steady_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const pass *p = context;
    const silhouette *s = p->s;
    (void)worker;
    for (int32_t y = begin * SILHOUETTE_TILE; y < at_most(end * SILHOUETTE_TILE, s->cover.height);
         y++) {
        const uint8_t *distance = rlf_u8_row(&s->distance, y);
        for (int32_t x0 = 0; x0 < s->cover.width; x0 += SILHOUETTE_TILE) {
            int32_t x1 = at_most(x0 + SILHOUETTE_TILE, s->cover.width);
            int32_t tile = y / SILHOUETTE_TILE * s->columns + x0 / SILHOUETTE_TILE;
            if ((s->marks[tile] & SILHOUETTE_EDGE) == 0 ||
                is_far_from_edges(distance + x0, x1 - x0)) {
                continue;
            }
            uint8_t settled[SILHOUETTE_TILE];
            vote_row(s, x0, y, settled);
            for (int32_t x = x0; x < x1; x++) {
                if (distance[x] != SILHOUETTE_NONE) {
                    steady_pixel(p, x, y, settled[x - x0]);
                }
            }
        }
    }
}

/* ---- models --------------------------------------------------------------------------------- */

/* The silhouettes of models are known, to parts of a pixel, where nothing stands before them. */
static void put_edges(const pass *p)
{
    silhouette *s = p->s;
    for (int32_t i = 0; p->known != NULL && i < p->known->edge_count; i++) {
        const known_edge *e = &p->known->edges[i];
        const int32_t tile = e->index / p->z->width / SILHOUETTE_TILE * s->columns +
                             e->index % p->z->width / SILHOUETTE_TILE;
        const float seen = p->z->data[e->index];
        const float outside = p->z->data[e->outside];
        const float far_z = outside > 0.0f ? outside : SILHOUETTE_FAR;
        if ((s->marks[tile] & SILHOUETTE_FILLED) == 0 || (seen > 0.0f && seen < e->front) ||
            s->near_z.data[e->index] < e->front || far_z <= e->near) {
            continue;
        }
        s->near_z.data[e->index] = e->near;
        s->far_z.data[e->index] = far_z;
        s->cover.data[e->index] = e->share;
    }
}

/* ---- update --------------------------------------------------------------------------------- */

static void fill_offsets(silhouette *s, const rlf_image_rgba8 *color)
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

void silhouette_update(silhouette *s, const rlf_plane_f32 *z, const known_layer *known,
                       const rlf_frame *frame)
{
    pass p = {s,
              z,
              known,
              known != NULL ? known->shown : NULL,
              frame->color.data,
              s->picture == 0 || frame->sequence != s->last_sequence};
    if (p.color != NULL) {
        fill_offsets(s, &frame->color);
    }
    if (p.is_new) {
        s->picture = (uint16_t)(s->picture == UINT16_MAX ? 1 : s->picture + 1);
    }
    s->last_sequence = frame->sequence;
    spread_tiles(s);
    rlf_parallel_for(s->pool, s->rows, 1, find_jumps, &p);
    mark_tiles(s);
    rlf_parallel_for(s->pool, s->rows, 1, settle_rows, &p);
    rlf_parallel_for(s->pool, s->columns, 1, settle_columns, &p);
    rlf_parallel_for(s->pool, s->rows, 1, steady_rows, &p);
    put_edges(&p);
}
