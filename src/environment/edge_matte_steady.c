/* Cover without lines gone astray; what pixels show is steady over time. */
#include "environment/edge_matte.h"

#include "environment/depth_edge.h"
#include "kernel/kernel.h"

#include <string.h>

#define STEADY_SHARE 4       /* a still pixel moves by a quarter of the way to its new cover */
#define STEADY_LIGHT_MOST 10 /* steps of a light that noise may change, at most; */
#define STEADY_SPREAD 5      /* in means of what it does: four standard deviations */
#define STEADY_TIMES 8       /* pictures: the most that trust in a surface lasts against another */

#define NOT_DOUBTFUL (EDGE_MATTE_NONE << 8) /* settled from here on: no line set it */
#define VOTERS (2 * EDGE_MATTE_TILE) /* of a row: one before the tile's pixels, and beyond them */

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
    for (int32_t i = 0; i < EDGE_MATTE_TILE; i++) {
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

/* What the lines settled about pixels x0 .. x0 + EDGE_MATTE_TILE of row y. */
RLF_KERNEL_PART void read_voters(const edge_matte *s, int32_t x0, int32_t y,
                                 uint16_t rows[3][VOTERS])
{
    const int32_t width = s->cover.width;
    const int32_t first = x0 > 0 ? x0 - 1 : 0;
    const int32_t at = first + 1 - x0;
    const int32_t count = edge_matte_at_most(x0 - 1 + VOTERS, width) - first;
    for (int32_t k = 0; k < 3; k++) {
        const int32_t line = y + k - 1;
        const uint16_t *from = s->settled + (ptrdiff_t)line * width + first;
        const bool is_in = line >= 0 && line < s->cover.height;
        if (is_in && count == VOTERS) { /* its own case, for a size that is known */
            memcpy(rows[k], from, sizeof(rows[k]));
        } else {
            memset(rows[k], EDGE_MATTE_NONE, sizeof(rows[k]));
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
RLF_KERNEL_PART void find_light(const edge_matte_pass *p, int32_t x0, int32_t y, int32_t count,
                                int32_t *restrict out)
{
    const uint8_t *restrict row = p->color + p->s->offset_y[y];
    const ptrdiff_t *restrict offset = p->s->offset_x + x0;
    const uint8_t *restrict first = row + offset[0];
    if (p->has_own_colors && count == EDGE_MATTE_TILE) {
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < EDGE_MATTE_TILE; i++) {
            out[i] = light_of(first + 4 * i);
        }
        return;
    }
    for (int32_t i = 0; i < count; i++) {
        out[i] = light_of(row + offset[i]);
    }
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

/* Of `count` <= EDGE_MATTE_TILE pixels from `first` on. */
typedef struct steady_pixels {
    uint32_t *last;
    uint8_t *cover, *trust;
    float *near_z, *far_z, *held_near, *held_far;
} steady_pixels;

static steady_pixels pixels_at(const edge_matte *s, ptrdiff_t first)
{
    return (steady_pixels){.last = s->last + first,
                           .cover = s->cover.data + first,
                           .trust = s->trust + first,
                           .near_z = s->near_z.data + first,
                           .far_z = s->far_z.data + first,
                           .held_near = s->held_near + first,
                           .held_far = s->held_far + first};
}

RLF_KERNEL_PART int32_t is_within(int32_t off, int32_t most)
{
    return (off <= most ? 1 : 0) & (off >= -most ? 1 : 0);
}

/* True when what a pixel shows most of is on the same surface as what it showed. */
RLF_KERNEL_PART int32_t is_same_surface(float a, float b)
{
    const float nearer = a < b ? a : b;
    const float farther = a < b ? b : a;
    return depth_steps(nearer, farther) ? 0 : 1;
}

/* Which of `count` pixels show the same light as before, by the mean change of three, whose noise
 * is less than that of one. */
RLF_KERNEL_PART void find_still(const uint32_t *restrict last, const int32_t *restrict light,
                                int32_t count, int32_t limit, int32_t *restrict out)
{
    int32_t mean[EDGE_MATTE_TILE + 2] = {0};
    int32_t tint[EDGE_MATTE_TILE + 2] = {0};
    for (int32_t i = 0; i < count; i++) {
        mean[i + 1] = (light[i] >> 7) - (int32_t)(last[i] >> 15 & 127u);
        tint[i + 1] = (light[i] & 127) - (int32_t)(last[i] >> 8 & 127u);
    }
    mean[0] = mean[1];
    tint[0] = tint[1];
    mean[count + 1] = mean[count];
    tint[count + 1] = tint[count];
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < EDGE_MATTE_TILE; i++) {
        out[i] = is_within(mean[i] + mean[i + 1] + mean[i + 2], 3 * limit) &
                 is_within(tint[i] + tint[i + 1] + tint[i + 2], 3 * limit) &
                 is_within(mean[i + 1], 2 * limit) & is_within(tint[i + 1], 2 * limit);
    }
}

/* Changes that may be noise, for they are at most so large, of pixels known from picture `known`.
 */
RLF_KERNEL_PART void add_changes(const uint32_t *restrict last, const int32_t *restrict light,
                                 int32_t count, uint32_t known, int32_t most,
                                 edge_matte_change *change)
{
    for (int32_t i = 0; i < count; i++) {
        const int32_t mean = (light[i] >> 7) - (int32_t)(last[i] >> 15 & 127u);
        const int32_t tint = (light[i] & 127) - (int32_t)(last[i] >> 8 & 127u);
        const int32_t is_noise =
            (last[i] >> 22 == known ? 1 : 0) & is_within(mean, most) & is_within(tint, most);
        change->sum += is_noise * ((mean < 0 ? -mean : mean) + (tint < 0 ? -tint : tint));
        change->count += 2 * is_noise;
    }
}

/* Where the picture has not changed the cover moves slowly, so that noise does not show, and
 * another surface has to be seen more often: sensors lose depth now and then and find it again, and
 * shift edges, while nothing moves. What a pixel shows right after a change is not trusted yet. */
RLF_KERNEL_PART void steady_tile_row(const edge_matte_pass *p, uint32_t known,
                                     const int32_t *restrict voted, const int32_t *restrict light,
                                     int32_t count, const steady_pixels *at)
{
    int32_t is_still[EDGE_MATTE_TILE];
    find_still(at->last, light, count, p->s->still_light, is_still);
    const uint32_t picture = p->s->picture;
    const int32_t moves = p->is_new ? 1 : 0;
    const int32_t times = p->color != NULL ? STEADY_TIMES : 0;
    for (int32_t i = 0; i < count; i++) {
        const uint32_t before = at->last[i];
        const int32_t old = (int32_t)(before & 255u);
        const int32_t is_known = is_still[i] & (before >> 22 == known ? 1 : 0);
        const int32_t is_same = is_same_surface(old > 127 ? at->held_near[i] : at->held_far[i],
                                                voted[i] > 127 ? at->near_z[i] : at->far_z[i]);
        const int32_t trust = at->trust[i] + moves * (is_same != 0 ? 2 : -1);
        const int32_t is_held = is_known & (1 - is_same) & (trust > 0 ? 1 : 0);
        const int32_t slow = old + moves * ((voted[i] - old) / STEADY_SHARE);
        const int32_t is_pair = is_same & is_same_surface(at->held_near[i], at->near_z[i]) &
                                is_same_surface(at->held_far[i], at->far_z[i]);
        const int32_t next = is_held != 0 ? old : ((is_known & is_pair) != 0 ? slow : voted[i]);
        at->near_z[i] = is_held != 0 ? at->held_near[i] : at->near_z[i];
        at->far_z[i] = is_held != 0 ? at->held_far[i] : at->far_z[i];
        at->held_near[i] = at->near_z[i];
        at->held_far[i] = at->far_z[i];
        const int32_t earned = (is_same | is_held) != 0 ? edge_matte_at_most(trust, times) : times;
        at->trust[i] = (uint8_t)(is_known != 0 ? earned : 0);
        at->cover[i] = (uint8_t)next;
        at->last[i] = picture << 22 | (uint32_t)light[i] << 8 | (uint32_t)next;
    }
}

/* `count` pixels of a tile from (x0, y) on. */
RLF_KERNEL static void steady_row(const edge_matte_pass *p, uint32_t known, int32_t x0, int32_t y,
                                  int32_t count, edge_matte_change *change)
{
    const edge_matte *s = p->s;
    const ptrdiff_t first = (ptrdiff_t)y * s->cover.width + x0;
    const steady_pixels at = pixels_at(s, first);
    int32_t voted[EDGE_MATTE_TILE] = {0};
    int32_t light[EDGE_MATTE_TILE] = {0};
    if (has_doubtful(s->settled + first, count)) {
        uint16_t rows[3][VOTERS];
        read_voters(s, x0, y, rows);
        vote((const uint16_t(*)[VOTERS])rows, voted);
    }
    for (int32_t i = 0; i < count; i++) {
        voted[i] = s->settled[first + i] < NOT_DOUBTFUL ? voted[i] : at.cover[i];
    }
    if (p->color != NULL) {
        find_light(p, x0, y, count, light);
    }
    add_changes(at.last, light, count, known, 2 * s->still_light, change);
    steady_tile_row(p, known, voted, light, count, &at);
}

static void steady_tile(const edge_matte_pass *p, int32_t tile, uint32_t known,
                        edge_matte_change *change)
{
    const edge_matte *s = p->s;
    const int32_t x0 = tile % s->columns * EDGE_MATTE_TILE;
    const int32_t x1 = edge_matte_at_most(x0 + EDGE_MATTE_TILE, s->cover.width);
    const int32_t y0 = tile / s->columns * EDGE_MATTE_TILE;
    const int32_t y1 = edge_matte_at_most(y0 + EDGE_MATTE_TILE, s->cover.height);
    for (int32_t y = y0; y < y1; y++) {
        if (p->color != NULL && y + 4 < y1) {
            RLF_KERNEL_SOON(p->color + s->offset_y[y + 4] + s->offset_x[x0]);
            RLF_KERNEL_SOON(s->last + (ptrdiff_t)(y + 4) * s->cover.width + x0);
        }
        steady_row(p, known, x0, y, x1 - x0, change);
    }
}

void edge_matte_steady_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const edge_matte_pass *p = context;
    const edge_matte *s = p->s;
    const uint32_t before = s->picture == 1 ? EDGE_MATTE_PICTURES : s->picture - 1u;
    const uint32_t known = p->is_new ? before : s->picture;
    (void)worker;
    for (int32_t row = begin; row < end; row++) {
        edge_matte_change change = {0, 0};
        for (int32_t k = 0; k < s->columns; k++) {
            if ((s->marks[row * s->columns + k] & EDGE_MATTE_EDGE) != 0) {
                steady_tile(p, row * s->columns + k, known, &change);
            }
        }
        s->changes[row] = change;
    }
}

void edge_matte_learn_noise(edge_matte *s)
{
    edge_matte_change all = {0, 0};
    for (int32_t row = 0; row < s->rows; row++) {
        all.sum += s->changes[row].sum;
        all.count += s->changes[row].count;
    }
    const int32_t limit = all.count > 0 ? STEADY_SPREAD * all.sum / all.count + 1 : 0;
    s->still_light = limit < EDGE_MATTE_STILL_LIGHT ? EDGE_MATTE_STILL_LIGHT
                                                    : edge_matte_at_most(limit, STEADY_LIGHT_MOST);
}
