/* Cover without lines gone astray, and steady over time. */
#include "silhouette_pass.h"

#include "kernel/kernel.h"

#include <string.h>

#define STEADY_SHARE 4 /* a still pixel moves by a quarter of the way to its new cover */
#define STEADY_LIGHT 2 /* steps of a light that noise may change */

#define NOT_DOUBTFUL (SILHOUETTE_NONE << 8) /* settled from here on: no line set it */
#define VOTERS (2 * SILHOUETTE_TILE) /* of a row: one before the tile's pixels, and beyond them */

/* Of three rows' doubtful pixels, per column: how many, how many of them near, and the sum of their
 * cover. */
typedef struct votes {
    int32_t count[VOTERS], near_count[VOTERS], sum[VOTERS];
} votes;

RLF_KERNEL_PART void count_votes(const uint16_t rows[3][VOTERS], votes *v)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < VOTERS; i++) {
        int32_t count = 0;
        int32_t near_count = 0;
        int32_t sum = 0;
        for (int k = 0; k < 3; k++) {
            int32_t cover = rows[k][i] & 255;
            int32_t is_doubtful = rows[k][i] < NOT_DOUBTFUL ? 1 : 0;
            count += is_doubtful;
            near_count += is_doubtful & (cover > 127 ? 1 : 0);
            sum += is_doubtful * cover;
        }
        v->count[i] = count;
        v->near_count[i] = near_count;
        v->sum[i] = sum;
    }
}

/* A pixel that hardly any of the doubtful ones around it agree with is a line gone astray: it takes
 * their mean. */
RLF_KERNEL_PART void vote(const uint16_t rows[3][VOTERS], int32_t *restrict out)
{
    votes v;
    count_votes(rows, &v);
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SILHOUETTE_TILE; i++) {
        int32_t own = rows[1][i + 1] & 255;
        int32_t count = v.count[i] + v.count[i + 1] + v.count[i + 2];
        int32_t near_count = v.near_count[i] + v.near_count[i + 1] + v.near_count[i + 2];
        int32_t sum = v.sum[i] + v.sum[i + 1] + v.sum[i + 2];
        int32_t agreeing = own > 127 ? near_count : count - near_count;
        /* Exact: the quotient is whole, or at least a ninth away from the next whole number. */
        int32_t mean = (int32_t)((float)sum / (float)(count > 0 ? count : 1));
        bool is_astray = (count >= 5) & (3 * agreeing <= count);
        out[i] = is_astray ? mean : own;
    }
}

/* What the lines settled about pixels x0 .. x0 + SILHOUETTE_TILE of row y. */
RLF_KERNEL_PART void read_voters(const silhouette *s, int32_t x0, int32_t y,
                                 uint16_t rows[3][VOTERS])
{
    const int32_t width = s->cover.width;
    const int32_t first = x0 > 0 ? x0 - 1 : 0;
    const int32_t at = first + 1 - x0;
    const int32_t count = silhouette_at_most(x0 - 1 + VOTERS, width) - first;
    for (int32_t k = 0; k < 3; k++) {
        const int32_t line = y + k - 1;
        const uint16_t *from = s->settled + (ptrdiff_t)line * width + first;
        const bool is_in = line >= 0 && line < s->cover.height;
        if (is_in && count == VOTERS) { /* its own case, for a size that is known */
            memcpy(rows[k], from, sizeof(rows[k]));
        } else {
            memset(rows[k], SILHOUETTE_NONE, sizeof(rows[k]));
            memcpy(rows[k] + at, from, is_in ? (size_t)count * sizeof(*from) : 0);
        }
    }
}

/* By what a pixel is known to show the same as before: half of the mean colour times 128, and a
 * quarter of red minus blue, about 63. */
RLF_KERNEL_PART int32_t light_of(const uint8_t *c)
{
    return (c[0] + 2 * c[1] + c[2]) / 8 * 128 + (255 + c[0] - c[2]) / 4;
}

/* Light of `count` pixels from (x0, y) on. */
RLF_KERNEL_PART void find_light(const silhouette_pass *p, int32_t x0, int32_t y, int32_t count,
                                int32_t *restrict out)
{
    const uint8_t *restrict row = p->color + p->s->offset_y[y];
    const ptrdiff_t *restrict offset = p->s->offset_x + x0;
    const uint8_t *restrict first = row + offset[0];
    if (p->has_own_colors && count == SILHOUETTE_TILE) {
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < SILHOUETTE_TILE; i++) {
            out[i] = light_of(first + 4 * i);
        }
        return;
    }
    for (int32_t i = 0; i < count; i++) {
        out[i] = light_of(row + offset[i]);
    }
}

/* Where the picture has not changed the cover moves slowly, so that noise does not show. Into
 * `last` and `cover` where the pixel is doubtful; `known`: of a picture that may be known. */
RLF_KERNEL_PART void steady_pixels(const silhouette_pass *p, uint32_t known,
                                   const uint16_t *restrict settled, const int32_t *restrict voted,
                                   const int32_t *restrict light, uint32_t *restrict last,
                                   uint8_t *restrict cover)
{
    const uint32_t picture = p->s->picture;
    const int32_t moves = p->is_new ? 1 : 0;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SILHOUETTE_TILE; i++) {
        const uint32_t before = last[i];
        const int32_t old = (int32_t)(before & 255u);
        const int32_t mean = (light[i] >> 7) - (int32_t)(before >> 15 & 127u);
        const int32_t tint = (light[i] & 127) - (int32_t)(before >> 8 & 127u);
        const int32_t is_still = (mean <= STEADY_LIGHT ? 1 : 0) & (mean >= -STEADY_LIGHT) &
                                 (tint <= STEADY_LIGHT) & (tint >= -STEADY_LIGHT);
        const int32_t is_kept = is_still & (before >> 22 == known ? 1 : 0);
        const int32_t slow = old + moves * ((voted[i] - old) / STEADY_SHARE);
        const int32_t next = is_kept != 0 ? slow : voted[i];
        const uint32_t now = picture << 22 | (uint32_t)light[i] << 8 | (uint32_t)next;
        const bool is_doubtful = settled[i] < NOT_DOUBTFUL;
        last[i] = is_doubtful ? now : before;
        cover[i] = is_doubtful ? (uint8_t)next : cover[i];
    }
}

/* `count` pixels of a tile from (x0, y) on. */
RLF_KERNEL static void steady_row(const silhouette_pass *p, uint32_t known, int32_t x0, int32_t y,
                                  int32_t count)
{
    const silhouette *s = p->s;
    const ptrdiff_t first = (ptrdiff_t)y * s->cover.width + x0;
    uint8_t *cover = s->cover.data + first;
    uint32_t *last = s->last + first;
    uint16_t rows[3][VOTERS];
    int32_t voted[SILHOUETTE_TILE];
    int32_t light[SILHOUETTE_TILE] = {0};
    read_voters(s, x0, y, rows);
    vote((const uint16_t(*)[VOTERS])rows, voted);
    if (p->color != NULL) {
        find_light(p, x0, y, count, light);
    }
    if (count == SILHOUETTE_TILE) {
        steady_pixels(p, known, rows[1] + 1, voted, light, last, cover);
        return;
    }
    uint32_t some_last[SILHOUETTE_TILE] = {0};
    uint8_t some_cover[SILHOUETTE_TILE] = {0};
    memcpy(some_last, last, (size_t)count * sizeof(*last));
    memcpy(some_cover, cover, (size_t)count);
    steady_pixels(p, known, rows[1] + 1, voted, light, some_last, some_cover);
    memcpy(last, some_last, (size_t)count * sizeof(*last));
    memcpy(cover, some_cover, (size_t)count);
}

/* False when no line settled any of `count` pixels. */
static bool has_doubtful(const uint16_t *settled, int32_t count)
{
    int32_t any = 0;
    for (int32_t i = 0; i < count; i++) {
        any |= settled[i] < NOT_DOUBTFUL ? 1 : 0;
    }
    return any != 0;
}

void silhouette_steady_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const silhouette_pass *p = context;
    const silhouette *s = p->s;
    const uint32_t before = s->picture == 1 ? SILHOUETTE_PICTURES : s->picture - 1u;
    const uint32_t known = p->is_new ? before : s->picture;
    (void)worker;
    for (int32_t tile = begin * s->columns; tile < end * s->columns; tile++) {
        const int32_t x0 = tile % s->columns * SILHOUETTE_TILE;
        const int32_t x1 = silhouette_at_most(x0 + SILHOUETTE_TILE, s->cover.width);
        const int32_t y0 = tile / s->columns * SILHOUETTE_TILE;
        const int32_t y1 = silhouette_at_most(y0 + SILHOUETTE_TILE, s->cover.height);
        const bool has_edge = (s->marks[tile] & SILHOUETTE_EDGE) != 0;
        for (int32_t y = y0; y < y1 && has_edge; y++) {
            if (p->color != NULL && y + 4 < y1) {
                RLF_KERNEL_SOON(p->color + s->offset_y[y + 4] + s->offset_x[x0]);
                RLF_KERNEL_SOON(s->last + (ptrdiff_t)(y + 4) * s->cover.width + x0);
            }
            if (has_doubtful(s->settled + (ptrdiff_t)y * s->cover.width + x0, x1 - x0)) {
                steady_row(p, known, x0, y, x1 - x0);
            }
        }
    }
}
