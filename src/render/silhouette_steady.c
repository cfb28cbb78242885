/* Cover without lines gone astray, and steady over time. */
#include "silhouette_pass.h"

#include "kernel/kernel.h"

#include <string.h>

#define STEADY_SHARE 4 /* a still pixel moves by a quarter of the way to its new cover */
#define STEADY_LIGHT 5 /* steps of the mean colour that noise may change */

static uint8_t light_of(const silhouette_pass *p, int32_t x, int32_t y)
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
    const size_t count =
        (size_t)(silhouette_at_most(x0 + SILHOUETTE_TILE + 1, s->cover.width) - first);
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
static void steady_pixel(const silhouette_pass *p, int32_t x, int32_t y, uint8_t settled)
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

/* Pixels [x0, x1) of a tile in row y. */
static void steady_row(const silhouette_pass *p, int32_t x0, int32_t x1, int32_t y)
{
    const uint8_t *distance = rlf_u8_row(&p->s->distance, y);
    if (is_far_from_edges(distance + x0, x1 - x0)) {
        return;
    }
    uint8_t settled[SILHOUETTE_TILE];
    vote_row(p->s, x0, y, settled);
    for (int32_t x = x0; x < x1; x++) {
        if (distance[x] != SILHOUETTE_NONE) {
            steady_pixel(p, x, y, settled[x - x0]);
        }
    }
}

void silhouette_steady_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const silhouette_pass *p = context;
    const silhouette *s = p->s;
    (void)worker;
    for (int32_t tile = begin * s->columns; tile < end * s->columns; tile++) {
        const int32_t x0 = tile % s->columns * SILHOUETTE_TILE;
        const int32_t x1 = silhouette_at_most(x0 + SILHOUETTE_TILE, s->cover.width);
        const int32_t y0 = tile / s->columns * SILHOUETTE_TILE;
        const int32_t y1 = silhouette_at_most(y0 + SILHOUETTE_TILE, s->cover.height);
        const bool has_edge = (s->marks[tile] & SILHOUETTE_EDGE) != 0;
        for (int32_t y = y0; y < y1 && has_edge; y++) {
            steady_row(p, x0, x1, y);
        }
    }
}
