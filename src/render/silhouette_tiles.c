/* Tiles of the picture: which have bodies, and which have edges that matter to those. */
#include "silhouette_pass.h"

#include "kernel/kernel.h"
#include "render/body_look.h"
#include "render/caster.h"

#include <string.h>

#define MARGIN_M 0.1f /* bodies so near to an edge's sides fade there, or the sides slope */

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
void silhouette_spread_tiles(silhouette *s)
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

/* ---- jumps ---------------------------------------------------------------------------------- */

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

void silhouette_find_jumps(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const silhouette_pass *p = context;
    silhouette *s = p->s;
    (void)worker;
    const rlf_plane_f32 *z = p->z;
    const int32_t whole = (z->width - 1) / SILHOUETTE_TILE;
    memset(s->marks + begin * s->columns, 0, (size_t)((end - begin) * s->columns));
    for (int32_t y = begin * SILHOUETTE_TILE;
         y < silhouette_at_most(end * SILHOUETTE_TILE, z->height); y++) {
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

void silhouette_mark_tiles(silhouette *s)
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
