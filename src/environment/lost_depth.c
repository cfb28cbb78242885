/* Which surface a pixel without depth belongs to. */
#include "environment/real_depth.h"

#include "environment/depth_edge.h"

#include "kernel/kernel.h"

#include <string.h>

#define CELL 8          /* pixels */
#define TOLD 99.0f      /* nats of what the background and its colour tell: not voted on */
#define MOST_NATS 1.0f  /* of one pixel among those that decide together */
#define RIM 24          /* pixels: so wide may the border be that a camera leaves without depth */
#define HOLE_M 0.3f     /* what is seen farther than this from a lost pixel does not enclose it */
#define INSIDE 2        /* pixels beyond the first seen one, whose colours may be mixed */
#define ENCLOSED 2.5f   /* nats for a side that all eight ways lead to; for half of them none */
#define REMEMBERED 1.5f /* nats: the background there is as near as the near side */
#define MOST_COLOR 2.0f /* nats that colours say at most */
#define COLOR_VARIANCE 100.0f /* squared sRGB steps, of three channels' noise and texture */
#define STRANGE 5000.0f       /* squared distance from both sides that halves what colours say */
#define FOREIGN 900.0f        /* that of a far side whose colour is not known, */
#define MOST_FOREIGN 0.9f     /* and nats that this says at most: rims are not all alike */
#define STEEPEST 4.0f         /* slope of a plane that goes on, along z per metre across */
#define CLEARLY 0.1f          /* mean nats from which a surface goes on into nothing */
#define NO_CHOICE (-1.0f)
#define VOTE 2 /* pixels around one that have a say */

#define MARGIN_M 0.1f /* bodies so near to what is behind them may be hidden by it */

/* ---- create --------------------------------------------------------------------------------- */

rlf_result lost_depth_create(const rlf_registration *registration, const rlf_camera *depth,
                             const rlf_pose *T_picture_depth, rlf_pool *pool, lost_depth *out)
{
    memset(out, 0, sizeof(*out));
    out->pool = pool;
    out->width = registration->width;
    out->height = registration->height;
    out->focal = (float)depth->fx;
    out->columns = (out->width + CELL - 1) / CELL;
    out->rows = (out->height + CELL - 1) / CELL;
    const size_t pixels = (size_t)out->width * (size_t)out->height;
    bool has_all = true;
    for (int k = 0; k < LOST_DEPTH_WAYS; k++) {
        out->away[k] = rlf_alloc(pixels);
        has_all = has_all && out->away[k] != NULL;
    }
    out->far_z = rlf_alloc_array(pixels, sizeof(float));
    out->near_z = rlf_alloc_array(pixels, sizeof(float));
    out->nats = rlf_alloc_array(pixels, sizeof(float));
    out->is_open = rlf_alloc(pixels);
    out->open = rlf_alloc_array((size_t)out->columns * (size_t)out->rows, sizeof(*out->open));
    out->nearest = rlf_alloc_array((size_t)out->rows, sizeof(float));
    has_all = has_all && out->nearest != NULL;
    out->cells = rlf_alloc((size_t)out->columns * (size_t)out->rows);
    out->body_near =
        rlf_alloc_array((size_t)out->columns * (size_t)out->rows, sizeof(*out->body_near));
    has_all = has_all && out->body_near != NULL && out->far_z != NULL && out->near_z != NULL &&
              out->nats != NULL && out->cells != NULL && out->is_open != NULL && out->open != NULL;
    rlf_result result =
        has_all ? background_color_create(registration, depth, T_picture_depth, &out->background)
                : RLF_ERROR_MEMORY;
    if (result != RLF_OK) {
        lost_depth_destroy(out);
    }
    return result;
}

void lost_depth_destroy(lost_depth *l)
{
    for (int k = 0; k < LOST_DEPTH_WAYS; k++) {
        rlf_free(l->away[k]);
    }
    rlf_free(l->far_z);
    rlf_free(l->nats);
    rlf_free(l->is_open);
    rlf_free(l->open);
    rlf_free(l->near_z);
    rlf_free(l->cells);
    rlf_free(l->body_near);
    rlf_free(l->nearest);
    background_color_destroy(&l->background);
    memset(l, 0, sizeof(*l));
}

/* ---- what is around a pixel ----------------------------------------------------------------- */

typedef struct pass {
    lost_depth *l;
    const rlf_registration *registration;
    const rlf_image_rgba8 *color; /* data NULL = none */
    const rlf_surface *surface;
    float *depth;
} pass;

/* A seen pixel. */
typedef struct hit {
    int32_t index, inside; /* the first, and one INSIDE of it */
    float z;               /* of its surface at the lost pixel */
    float away;            /* pixels */
} hit;

typedef struct around {
    hit hits[LOST_DEPTH_WAYS]; /* near to far */
    int32_t count, near_count;
    int32_t missing; /* ways that lead to nothing */
} around;

/* Borders that a pixel without depth lies at, within the rim: 1 left, 2 top, 4 right, 8 bottom. */
static int32_t rims_of(const lost_depth *l, int32_t x, int32_t y)
{
    const int32_t i = y * l->width + x;
    const int32_t to_border[4] = {x, y, l->width - 1 - x, l->height - 1 - y};
    static const int outward[4] = {0, 1, 4, 5};
    static const int inward[4] = {4, 5, 0, 1};
    int32_t rims = 0;
    for (int k = 0; k < 4; k++) {
        const bool is_contour = to_border[k] < RIM &&
                                l->away[outward[k]][i] == LOST_DEPTH_NOTHING &&
                                to_border[k] + l->away[inward[k]][i] <= RIM;
        rims |= is_contour ? 1 << k : 0;
    }
    return rims;
}

/* True when a way leads along or out of one of those rims: that it meets nothing tells nothing. */
static bool stays_in_rim(int32_t rims, const int32_t way[2])
{
    return ((rims & 1) != 0 && way[0] <= 0) || ((rims & 4) != 0 && way[0] >= 0) ||
           ((rims & 2) != 0 && way[1] <= 0) || ((rims & 8) != 0 && way[1] >= 0);
}

static int32_t steps_to_border(const lost_depth *l, int32_t x, int32_t y, const int32_t way[2])
{
    const int32_t along_x = way[0] < 0 ? x : (way[0] > 0 ? l->width - 1 - x : l->width);
    const int32_t along_y = way[1] < 0 ? y : (way[1] > 0 ? l->height - 1 - y : l->height);
    return along_x < along_y ? along_x : along_y;
}

/* Depth of pixel `i` on the plane that is seen at pixel `j`, within STEEPEST times what the
 * pixels are apart. */
static float on_plane(const rlf_surface *s, int32_t i, int32_t j, float apart_m)
{
    const float n[3] = {s->normal_x[j], s->normal_y[j], s->normal_z[j]};
    const float z = s->depth[j];
    const float there = n[0] * s->ray_x[j] + n[1] * s->ray_y[j] + n[2];
    const float here = n[0] * s->ray_x[i] + n[1] * s->ray_y[i] + n[2];
    const float least = z > 2.0f * apart_m ? z - apart_m : 0.5f * z;
    if (!(here < -0.05f) || !(there < 0.0f)) {
        return z;
    }
    const float plane = z * there / here;
    return plane < least ? least : (plane > z + apart_m ? z + apart_m : plane);
}

static void add_hit(around *a, const hit *h)
{
    int32_t at = a->count++;
    while (at > 0 && a->hits[at - 1].z > h->z) {
        a->hits[at] = a->hits[at - 1];
        at--;
    }
    a->hits[at] = *h;
}

/* Splits the hits where depth jumps most, more than a slope of 45 degrees between them does. */
static void split_hits(const lost_depth *l, around *a)
{
    float most = 0.0f;
    a->near_count = a->count;
    for (int32_t k = 1; k < a->count; k++) {
        const hit *b = &a->hits[k - 1];
        const hit *c = &a->hits[k];
        const float slope = (b->away + c->away) * b->z / l->focal;
        const float gap = 1.0f / b->z - 1.0f / c->z;
        if (depth_steps(b->z, c->z - slope) && c->z - slope > b->z && gap > most) {
            most = gap;
            a->near_count = k;
        }
    }
}

static around look_around(const pass *p, int32_t x, int32_t y)
{
    const lost_depth *l = p->l;
    const int32_t i = y * l->width + x;
    const int32_t rims = rims_of(l, x, y);
    around a = {.count = 0};
    for (int k = 0; k < LOST_DEPTH_WAYS; k++) {
        const int32_t away = l->away[k][i];
        const int32_t border = steps_to_border(l, x, y, lost_depth_way[k]);
        const int32_t step = lost_depth_way[k][1] * l->width + lost_depth_way[k][0];
        if (away >= LOST_DEPTH_NOTHING) {
            a.missing += stays_in_rim(rims, lost_depth_way[k]) ? 0 : 1;
            continue;
        }
        hit h = {.index = i + away * step, .away = (float)away};
        const float z = p->surface->depth[h.index];
        const float apart_m = h.away * z / l->focal;
        if (apart_m > HOLE_M) {
            a.missing++;
            continue;
        }
        const int32_t further = away + INSIDE <= border ? h.index + INSIDE * step : h.index;
        h.inside = p->surface->reason[further] == RLF_REASON_OK ? further : h.index;
        h.z =
            p->surface->normal_x != NULL ? on_plane(p->surface, i, h.index, STEEPEST * apart_m) : z;
        add_hit(&a, &h);
    }
    split_hits(l, &a);
    return a;
}

/* Depth that hits have together, the nearer to the pixel the more; 0 = there are none. */
static float depth_of(const hit *hits, int32_t count)
{
    float sum = 0.0f;
    float weights = 0.0f;
    for (int32_t k = 0; k < count; k++) {
        const float weight = 1.0f / (hits[k].away * hits[k].away);
        sum += weight / hits[k].z;
        weights += weight;
    }
    return count > 0 ? weights / sum : 0.0f;
}

/* ---- colours -------------------------------------------------------------------------------- */

/* Colour of pixel i, as far away as it is seen; of a lost one as if a metre away. NULL outside of
 * the picture. */
static const uint8_t *color_of(const pass *p, int32_t i)
{
    const float z = p->surface->depth[i];
    return background_color_seen(&p->l->background, p->registration, p->color, i,
                                 z > 0.0f ? z : 1.0f);
}

/* Colour at lost pixel i, were it at depth z; NULL outside of the picture. */
static const uint8_t *color_at(const pass *p, int32_t i, float z)
{
    return p->registration->parallax_px_m > 0.0
               ? background_color_seen(&p->l->background, p->registration, p->color, i, z)
               : color_of(p, i);
}

/* Least squared distance of a colour from those of hits; < 0: not known. */
static float from_hits(const pass *p, const uint8_t *c, const hit *hits, int32_t count)
{
    float least = -1.0f;
    for (int32_t k = 0; k < count && c != NULL; k++) {
        const uint8_t *other = color_of(p, hits[k].inside);
        const float off = other != NULL ? background_color_squared(c, other) : -1.0f;
        least = off >= 0.0f && (least < 0.0f || off < least) ? off : least;
    }
    return least;
}

/* Nats for the near side. */
static float color_evidence(const pass *p, int32_t i, const around *a, float near_z, float far_z)
{
    const float from_near = from_hits(p, color_at(p, i, near_z), a->hits, a->near_count);
    const float z = far_z > 0.0f ? far_z : near_z;
    float from_far =
        from_hits(p, color_at(p, i, z), a->hits + a->near_count, a->count - a->near_count);
    if (from_near < 0.0f) {
        return 0.0f;
    }
    const float most = from_far < 0.0f ? MOST_FOREIGN : MOST_COLOR;
    from_far = from_far < 0.0f ? FOREIGN : from_far;
    const float strange = (from_near < from_far ? from_near : from_far) / STRANGE;
    float nats = 0.5f * (from_far - from_near) / COLOR_VARIANCE;
    nats = nats > MOST_COLOR ? MOST_COLOR : (nats < -most ? -most : nats);
    return nats / (1.0f + strange * strange);
}

/* The hit of the near side that is nearest to the pixel. */
static int32_t nearest_hit(const around *a)
{
    int32_t best = 0;
    for (int32_t k = 1; k < a->near_count; k++) {
        best = a->hits[k].away < a->hits[best].away ? k : best;
    }
    return a->hits[best].index;
}

/* Nats for the near side: of still things the background knows where they are, of moving ones its
 * colour what they hide, and else what encloses the pixel and its colours tell. */
static float evidence(const pass *p, int32_t i, const around *a, float near_z, float far_z)
{
    const rlf_surface *surface = p->surface;
    const float background =
        surface->background_depth != NULL ? surface->background_depth[i] : 0.0f;
    const bool was_near = background > 0.0f && !depth_steps(background, near_z);
    const int32_t nearest = nearest_hit(a);
    if (background > 0.0f && (surface->foreground == NULL || surface->foreground[nearest] == 0)) {
        return was_near ? TOLD : -TOLD;
    }
    const int32_t others = a->count - a->near_count + a->missing;
    const float nats = ENCLOSED * (float)(a->near_count - others) / LOST_DEPTH_WAYS +
                       (was_near ? REMEMBERED : 0.0f);
    if (p->color->data == NULL || a->near_count == LOST_DEPTH_WAYS) {
        return nats;
    }
    const background_color_sight sight = {p->registration, p->color, surface};
    const int told = background_color_tells(&p->l->background, &sight, i, nearest, near_z);
    return told != 0 ? TOLD * (float)told : nats + color_evidence(p, i, a, near_z, far_z);
}

/* True when as little of what is around a pixel encloses it as there is nothing behind. */
static bool is_open(const around *a)
{
    return a->near_count == a->count && a->missing >= a->near_count;
}

static float within_vote(float nats)
{
    return nats > MOST_NATS ? MOST_NATS : (nats < -MOST_NATS ? -MOST_NATS : nats);
}

/* ---- passes --------------------------------------------------------------------------------- */

static void settle(const pass *p, int32_t x, int32_t y)
{
    const int32_t i = y * p->l->width + x;
    const float before = p->depth[i];
    p->l->far_z[i] = NO_CHOICE;
    if (before > 0.0f && before < p->l->body_near[y / CELL * p->l->columns + x / CELL] - MARGIN_M) {
        return; /* what is nearer than that hides what it hides */
    }
    const around a = look_around(p, x, y);
    if (a.count == 0) {
        return;
    }
    const float near_z = depth_of(a.hits, a.near_count);
    const bool has_farther = before > near_z && depth_steps(near_z, before);
    float far_z = has_farther ? before : depth_of(a.hits + a.near_count, a.count - a.near_count);
    const bool is_before = before > 0.0f && !has_farther && depth_steps(before, near_z);
    if (is_before || (before > 0.0f && !(far_z > 0.0f))) {
        return; /* what was seen there before, and nothing that speaks against it */
    }
    const float nats = evidence(p, i, &a, near_z, far_z);
    p->l->far_z[i] = far_z;
    p->l->near_z[i] = near_z;
    p->l->nats[i] = nats;
    p->l->is_open[i] = is_open(&a) ? 1 : 0;
    lost_depth_open *open = &p->l->open[y / CELL * p->l->columns + x / CELL];
    if (p->l->is_open[i] != 0) {
        open->nats += within_vote(nats);
        open->inverse += 1.0f / near_z;
        open->count += 1.0f;
    }
    p->depth[i] = nats > 0.0f ? near_z : far_z;
    float *nearest = &p->l->nearest[y / CELL];
    *nearest = near_z < *nearest ? near_z : *nearest;
}

/* Nats for the near side of a pixel, from all around it: seen ones of that side, or farther ones,
 * have their full say. */
static float mean_nats(const pass *p, int32_t x, int32_t y, float middle)
{
    const lost_depth *l = p->l;
    float sum = 0.0f;
    for (int32_t dy = -VOTE; dy <= VOTE; dy++) {
        for (int32_t dx = -VOTE; dx <= VOTE; dx++) {
            if (x + dx < 0 || y + dy < 0 || x + dx >= l->width || y + dy >= l->height) {
                continue;
            }
            const int32_t i = (y + dy) * l->width + x + dx;
            if (p->surface->reason[i] == RLF_REASON_OK) {
                sum += p->depth[i] * middle < 1.0f ? MOST_NATS : -MOST_NATS;
            } else if (l->cells[(y + dy) / CELL * l->columns + (x + dx) / CELL] != 0 &&
                       l->far_z[i] >= 0.0f) {
                sum += within_vote(l->nats[i]);
            }
        }
    }
    return sum;
}

/* Open pixels about one, linear between the middles of cells: where nothing encloses the end of a
 * surface it goes on as far, and as it does, for all of them together. */
static lost_depth_open open_about(const lost_depth *l, int32_t x, int32_t y)
{
    const float at[2] = {((float)x + 0.5f) / (float)CELL + 0.5f,
                         ((float)y + 0.5f) / (float)CELL + 0.5f};
    const int32_t column = (int32_t)at[0];
    const int32_t row = (int32_t)at[1];
    lost_depth_open sum = {0.0f, 0.0f, 0.0f};
    for (int k = 0; k < 4; k++) {
        const int32_t c = column - (k & 1);
        const int32_t r = row - (k >> 1);
        if (c >= 0 && r >= 0 && c < l->columns && r < l->rows) {
            const float across = (k & 1) != 0 ? (float)(column + 1) - at[0] : at[0] - (float)column;
            const float down = (k >> 1) != 0 ? (float)(row + 1) - at[1] : at[1] - (float)row;
            const lost_depth_open *open = &l->open[r * l->columns + c];
            sum.nats += across * down * open->nats;
            sum.inverse += across * down * open->inverse;
            sum.count += across * down * open->count;
        }
    }
    return sum;
}

/* Specks of a few pixels go the way of what is around them. */
static void vote(const pass *p, int32_t x, int32_t y)
{
    lost_depth *l = p->l;
    const int32_t i = y * l->width + x;
    if (l->far_z[i] < 0.0f || l->nats[i] >= TOLD || l->nats[i] <= -TOLD) {
        return;
    }
    if (l->is_open[i] != 0) {
        const lost_depth_open open = open_about(l, x, y);
        p->depth[i] = open.nats > CLEARLY * open.count ? open.count / open.inverse : 0.0f;
        return;
    }
    const float far_inverse = l->far_z[i] > 0.0f ? 1.0f / l->far_z[i] : 0.0f;
    const float middle = 0.5f * (1.0f / l->near_z[i] + far_inverse);
    p->depth[i] = mean_nats(p, x, y, middle) > 0.0f ? l->near_z[i] : l->far_z[i];
}

/* Calls `visit` for every lost pixel of the cells that are needed, in rows of cells. */
static void for_lost(const pass *p, int32_t begin, int32_t end,
                     void (*visit)(const pass *p, int32_t x, int32_t y))
{
    const lost_depth *l = p->l;
    const int32_t last = end * CELL < l->height ? end * CELL : l->height;
    for (int32_t y = begin * CELL; y < last; y++) {
        const uint8_t *cells = l->cells + y / CELL * l->columns;
        const uint8_t *reason = p->surface->reason + (ptrdiff_t)y * l->width;
        int32_t x = rlf_kernel_next_mark(reason, 0, l->width);
        for (; x < l->width; x = rlf_kernel_next_mark(reason, x + 1, l->width)) {
            if (cells[x / CELL] != 0) {
                visit(p, x, y);
            }
        }
    }
}

static void settle_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    for_lost(context, begin, end, settle);
}

static void vote_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    for_lost(context, begin, end, vote);
}

static bool is_in_window(const real_windows *windows, const float at[2])
{
    for (int32_t k = 0; k < windows->count; k++) {
        const pixel_rect *w = &windows->window[k];
        if (at[0] >= (float)w->x0 && at[1] >= (float)w->y0 && at[0] < (float)w->x1 &&
            at[1] < (float)w->y1) {
            return true;
        }
    }
    return false;
}

/* Least depth of bodies about a place of the picture. */
static float body_near_at(const edge_matte *s, const float at[2])
{
    if (s == NULL) {
        return 0.0f;
    }
    if (!(at[0] > -0.5f && at[1] > -0.5f && at[0] < (float)s->cover.width - 0.5f &&
          at[1] < (float)s->cover.height - 0.5f)) {
        return EDGE_MATTE_FAR;
    }
    const int32_t column = (int32_t)(at[0] + 0.5f) / EDGE_MATTE_TILE;
    const int32_t row = (int32_t)(at[1] + 0.5f) / EDGE_MATTE_TILE;
    return s->tiles[row * s->columns + column].near_z;
}

/* Cells whose middle, at the depth that is seen or filled in, lies in a window; those have a
 * margin. */
static void mark_cells(const pass *p, const edge_matte *bodies, const real_windows *needed)
{
    const lost_depth *l = p->l;
    for (int32_t i = 0; i < l->columns * l->rows; i++) {
        int32_t x = i % l->columns * CELL + CELL / 2;
        int32_t y = i / l->columns * CELL + CELL / 2;
        x = x < l->width ? x : l->width - 1;
        y = y < l->height ? y : l->height - 1;
        const float z = p->depth[y * l->width + x];
        float at[2];
        registration_pixel(p->registration, y * l->width + x, z > 0.0f ? z : 1e3f, at);
        l->cells[i] = is_in_window(needed, at) ? 1 : 0;
        l->body_near[i] = body_near_at(bodies, at);
        l->open[i] = (lost_depth_open){0.0f, 0.0f, 0.0f};
    }
}

float lost_depth_update(lost_depth *l, rlf_registration *registration, const rlf_frame *frame,
                        const rlf_surface *surface, const edge_matte *bodies,
                        const real_windows *needed, float *depth, float nearest)
{
    if (surface->reason == NULL || surface->depth == NULL) {
        return nearest;
    }
    background_color_update(&l->background, registration, frame, surface);
    if (needed->count == 0) {
        return nearest;
    }
    pass p = {l, registration, &frame->color, surface, depth};
    mark_cells(&p, bodies, needed);
    int32_t first = l->height;
    int32_t end = 0;
    for (int32_t row = 0; row < l->rows; row++) {
        l->nearest[row] = nearest;
        if (memchr(l->cells + row * l->columns, 1, (size_t)l->columns) != NULL) {
            first = row * CELL < first ? row * CELL : first;
            end = (row + 1) * CELL < l->height ? (row + 1) * CELL : l->height;
        }
    }
    lost_depth_find_ways(l, surface->reason, first, end);
    rlf_parallel_for(l->pool, l->rows, 1, settle_rows, &p);
    rlf_parallel_for(l->pool, l->rows, 1, vote_rows, &p);
    for (int32_t row = 0; row < l->rows; row++) {
        nearest = l->nearest[row] < nearest ? l->nearest[row] : nearest;
    }
    return nearest;
}
