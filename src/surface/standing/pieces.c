/* The background's locally convex pieces. */
#include "surface/standing/standing.h"

#include "surface/steps.h"

#include <string.h>

enum {
    ARM = 2,    /* pixels on both sides of a crease whose normals are compared */
    GROWN = 3,  /* pixels beside it that are given to the pieces again */
    BANDS = 16, /* of rows, of which one per step is searched for creases */
    LEAST_POINTS = 150,
    IMAGE_SHARE = 5 /* a piece whose rectangle is more than one of so many parts is the room */
};

static const float bent_sine = 0.2f;    /* 12 degrees: more is a crease ... */
static const float even_m = 0.003f;     /* ... unless it is noise */
static const float step_m = 0.04f;      /* more than the neighbour's plane: one hides the other */
static const float beside_m = 0.02f;    /* off the plane of the neighbour */
static const float flat_length = 0.95f; /* of the mean of unit normals: more is one face */

typedef struct piece_sum {
    float normal[3];
    int32_t count;
} piece_sum;

static bool is_in(const rlf_grid *grid, int32_t x, int32_t y)
{
    return x >= 0 && y >= 0 && x < grid->width && y < grid->height;
}

/* Whether the surface bends inwards between two pixels, or one hides the other: on a convex thing
 * neither lies before the plane of the other. */
static bool is_concave(const rlf_grid *grid, const float *depth, float *const normal[3],
                       ptrdiff_t a, ptrdiff_t b)
{
    if (!(depth[a] > 0.0f) || !(depth[b] > 0.0f)) {
        return false;
    }
    float before_a = 0.0f, before_b = 0.0f, square = 0.0f;
    const float to[3] = {depth[b] * grid->ray_x[b] - depth[a] * grid->ray_x[a],
                         depth[b] * grid->ray_y[b] - depth[a] * grid->ray_y[a],
                         depth[b] - depth[a]};
    for (int k = 0; k < 3; k++) {
        before_a += normal[k][a] * to[k];
        before_b -= normal[k][b] * to[k];
        square += to[k] * to[k];
    }
    float most = before_a > before_b ? before_a : before_b;
    return most > even_m && most * most > bent_sine * bent_sine * square;
}

/* Marks what lies at concave creases in rows y0 <= y < y1 of standing->piece. */
static void mark_creases(const rlf_reconstruct *stage, float *const normal[3], int32_t y0,
                         int32_t y1)
{
    static const int32_t ways[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    const rlf_grid *grid = &stage->grid;
    const rlf_standing *standing = &stage->background.thick;
    for (int32_t y = y0; y < y1; y++) {
        for (int32_t x = 0; x < grid->width; x++) {
            ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
            bool is_crease = false;
            for (int k = 0; k < 4 && !is_crease; k++) {
                int32_t dx = ARM * ways[k][0], dy = ARM * ways[k][1];
                ptrdiff_t way = (ptrdiff_t)dy * grid->width + dx;
                is_crease = is_in(grid, x - dx, y - dy) && is_in(grid, x + dx, y + dy) &&
                            is_concave(grid, standing->depth, normal, i - way, i + way);
            }
            standing->piece[i] = is_crease;
        }
    }
}

static void widen(rlf_rect *w, int32_t x0, int32_t x1, int32_t y)
{
    w->x0 = x0 < w->x0 ? x0 : w->x0;
    w->x1 = x1 > w->x1 ? x1 : w->x1;
    w->y0 = y < w->y0 ? y : w->y0;
    w->y1 = y + 1;
}

/* Numbers those components that are large enough, as far as there is room, from 1. */
static int32_t number(const rlf_reconstruct *stage, int32_t components)
{
    int32_t count = 0;
    for (int32_t c = 1; c <= components; c++) {
        bool is_large = stage->work.size[c] >= LEAST_POINTS && count < RLF_PIECES;
        stage->work.map[c] = is_large ? ++count : 0;
    }
    return count;
}

static void add_normals(piece_sum *sum, float *const normal[3], ptrdiff_t first, int32_t count)
{
    for (int k = 0; k < 3; k++) {
        float total = 0.0f;
        for (int32_t i = 0; i < count; i++) {
            total += normal[k][first + i];
        }
        sum->normal[k] += total;
    }
    sum->count += count;
}

static void write_pieces(rlf_reconstruct *stage)
{
    uint8_t *piece = stage->background.thick.piece;
    const rlf_runs *runs = &stage->work.runs;
    memset(piece, 0, (size_t)stage->grid.count);
    for (int32_t y = 0; y < stage->grid.height; y++) {
        for (int32_t r = runs->first[y]; r < runs->first[y + 1]; r++) {
            const rlf_run *run = &runs->run[r];
            memset(piece + (ptrdiff_t)y * stage->grid.width + run->x0,
                   stage->work.map[run->component], (size_t)(run->x1 - run->x0));
        }
    }
}

/* Whether a piece is more than one face, and no part of the room itself. */
static bool is_thing(const rlf_grid *grid, const rlf_rect *w, const piece_sum *sum)
{
    float length2 = 0.0f, most = flat_length * (float)sum->count;
    for (int k = 0; k < 3; k++) {
        length2 += sum->normal[k] * sum->normal[k];
    }
    return length2 < most * most && (w->x1 - w->x0) * (w->y1 - w->y0) < grid->count / IMAGE_SHARE;
}

/* Metres of pixel i off the plane of pixel j. */
static float off_plane(const rlf_grid *grid, const float *depth, float *const normal[3],
                       ptrdiff_t i, ptrdiff_t j)
{
    float off = normal[0][j] * (depth[i] * grid->ray_x[i] - depth[j] * grid->ray_x[j]) +
                normal[1][j] * (depth[i] * grid->ray_y[i] - depth[j] * grid->ray_y[j]) +
                normal[2][j] * (depth[i] - depth[j]);
    return rlf_kernel_abs(off);
}

/* Whether pixel i is as deep as its neighbour j, or as that one's plane, which may be seen at a low
 * angle. */
static bool goes_on(const rlf_grid *grid, const float *depth, float *const normal[3], ptrdiff_t i,
                    ptrdiff_t j)
{
    const float least_slope = 0.05f;
    float facing = -(normal[0][j] * grid->ray_x[i] + normal[1][j] * grid->ray_y[i] + normal[2][j]);
    float own = -(normal[0][j] * grid->ray_x[j] + normal[1][j] * grid->ray_y[j] + normal[2][j]);
    float plane = facing > least_slope ? depth[j] * own / facing : depth[j];
    return rlf_kernel_abs(depth[j] - depth[i]) <= step_m ||
           rlf_kernel_abs(plane - depth[i]) <= step_m;
}

/* The piece, of those beside a pixel at a crease, whose plane it is nearest to. */
static uint8_t piece_beside(const rlf_grid *grid, const float *depth, float *const normal[3],
                            const uint8_t *piece, int32_t x, int32_t y)
{
    static const int32_t ways[4][2] = {{0, -1}, {-1, 0}, {1, 0}, {0, 1}};
    ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
    float nearest = beside_m;
    uint8_t best = 0;
    for (int k = 0; k < 4; k++) {
        int32_t u = x + ways[k][0], v = y + ways[k][1];
        ptrdiff_t j = (ptrdiff_t)v * grid->width + u;
        if (!is_in(grid, u, v) || piece[j] == 0 || !goes_on(grid, depth, normal, i, j)) {
            continue;
        }
        float off = off_plane(grid, depth, normal, i, j);
        best = off < nearest ? piece[j] : best;
        nearest = off < nearest ? off : nearest;
    }
    return best;
}

/* Gives pixels at creases to the pieces beside them. */
static void grow(rlf_reconstruct *stage, float *const normal[3])
{
    rlf_standing *standing = &stage->background.thick;
    const rlf_grid *grid = &stage->grid;
    uint8_t *before = stage->work.mask[0];
    memcpy(before, standing->piece, (size_t)grid->count);
    for (int32_t y = 0; y < grid->height; y++) {
        for (int32_t x = 0; x < grid->width; x++) {
            ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
            bool is_cut = standing->depth[i] > 0.0f && before[i] == 0;
            if (is_cut) {
                standing->piece[i] = piece_beside(grid, standing->depth, normal, before, x, y);
            }
        }
    }
}

/* Sums and rectangles of the pieces as they are now. */
static void measure(rlf_reconstruct *stage, float *const normal[3], int32_t count, piece_sum *sums)
{
    rlf_standing *standing = &stage->background.thick;
    const rlf_grid *grid = &stage->grid;
    for (int32_t k = 0; k <= count; k++) {
        sums[k] = (piece_sum){.count = 0};
        standing->window[k] = (rlf_rect){grid->width, grid->height, 0, 0};
    }
    for (int32_t y = 0; y < grid->height; y++) {
        const uint8_t *row = standing->piece + (ptrdiff_t)y * grid->width;
        for (int32_t x = 0; x < grid->width;) {
            int32_t begin = x, k = row[x];
            while (x < grid->width && row[x] == k) {
                x++;
            }
            if (k > 0) {
                add_normals(&sums[k], normal, (ptrdiff_t)y * grid->width + begin, x - begin);
                widen(&standing->window[k], begin, x, y);
            }
        }
    }
}

/* Components of what lies at no crease. */
static void separate(rlf_reconstruct *stage)
{
    rlf_standing *standing = &stage->background.thick;
    float *depth = stage->work.depth[0];
    for (int32_t i = 0; i < stage->grid.count; i++) {
        depth[i] = standing->piece[i] != 0 ? 0.0f : standing->depth[i];
    }
    rlf_segment_links(stage, RLF_SEGMENT_NOISE, depth, NULL, NULL);
    standing->piece_count = number(stage, rlf_components_find(stage, NULL));
    write_pieces(stage);
}

/* Leaves the rectangles of things alone. */
static void choose(rlf_reconstruct *stage, float *const normal[3])
{
    rlf_standing *standing = &stage->background.thick;
    piece_sum sums[RLF_PIECES + 1];
    measure(stage, normal, standing->piece_count, sums);
    for (int32_t k = 1; k <= standing->piece_count; k++) {
        if (!is_thing(&stage->grid, &standing->window[k], &sums[k])) {
            standing->window[k] = (rlf_rect){0, 0, 0, 0};
        }
    }
}

bool rlf_standing_find_pieces(rlf_reconstruct *stage, float *const normal[3], int32_t step)
{
    int32_t height = stage->grid.height;
    if (step < BANDS) {
        mark_creases(stage, normal, step * height / BANDS, (step + 1) * height / BANDS);
    } else if (step == BANDS) {
        separate(stage);
    } else if (step <= BANDS + GROWN) {
        grow(stage, normal);
    } else {
        choose(stage, normal);
    }
    return step > BANDS + GROWN;
}
