/* The background's locally convex pieces. */
#include "surface/thickness/thickness.h"

#include "surface/steps.h"

#include <string.h>

enum {
    ARM = 2,        /* pixels on both sides of a crease whose normals are compared */
    GROWN = 3,      /* pixels beside it that are given to the pieces again */
    BANDS = 16,     /* of rows, of which one per step is searched for creases */
    IMAGE_SHARE = 5 /* a piece whose rectangle is more than one of so many parts is the room */
};

static const float bent_sine = 0.2f;    /* 12 degrees: more is a crease ... */
static const float even_m = 0.003f;     /* ... unless it is noise */
static const float beside_m = 0.02f;    /* off the plane of the neighbour */
static const float flat_length = 0.95f; /* of the mean of unit normals: more is one face */

static bool is_in(const image_grid *grid, int32_t x, int32_t y)
{
    return x >= 0 && y >= 0 && x < grid->width && y < grid->height;
}

/* Metres of pixel i before the plane of pixel j; *square: of the way between them. */
static float before_plane(const rlf_reconstruct *stage, float *const normal[3], ptrdiff_t i,
                          ptrdiff_t j, float *square)
{
    const image_grid *grid = &stage->grid;
    const float *depth = stage->background.thick.depth;
    const float way[3] = {depth[i] * grid->ray_x[i] - depth[j] * grid->ray_x[j],
                          depth[i] * grid->ray_y[i] - depth[j] * grid->ray_y[j],
                          depth[i] - depth[j]};
    *square = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
    return normal[0][j] * way[0] + normal[1][j] * way[1] + normal[2][j] * way[2];
}

/* Whether the surface bends inwards between two pixels, or one hides the other: on a convex thing
 * neither lies before the plane of the other. */
static bool is_concave(const rlf_reconstruct *stage, float *const normal[3], ptrdiff_t a,
                       ptrdiff_t b)
{
    const float *depth = stage->background.thick.depth;
    float square, of_a = before_plane(stage, normal, a, b, &square);
    float of_b = before_plane(stage, normal, b, a, &square), most = of_a > of_b ? of_a : of_b;
    return depth[a] > 0.0f && depth[b] > 0.0f && most > even_m &&
           most * most > bent_sine * bent_sine * square;
}

/* Marks what lies at concave creases in a band of rows of state->piece. */
static void mark_creases(const rlf_reconstruct *stage, float *const normal[3], int32_t band)
{
    static const int32_t ways[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    const image_grid *grid = &stage->grid;
    for (int32_t y = band * grid->height / BANDS; y < (band + 1) * grid->height / BANDS; y++) {
        for (int32_t x = 0; x < grid->width; x++) {
            ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
            bool is_crease = false;
            for (int k = 0; k < 4 && !is_crease; k++) {
                int32_t dx = ARM * ways[k][0], dy = ARM * ways[k][1];
                ptrdiff_t way = (ptrdiff_t)dy * grid->width + dx;
                is_crease = is_in(grid, x - dx, y - dy) && is_in(grid, x + dx, y + dy) &&
                            is_concave(stage, normal, i - way, i + way);
            }
            stage->background.thick.piece[i] = is_crease;
        }
    }
}

/* Numbers the components of what lies at no crease, from 1: those that are large enough, as far as
 * there is room. */
static void separate(rlf_reconstruct *stage)
{
    static_thickness *state = &stage->background.thick;
    const rlf_runs *runs = &stage->work.runs;
    int32_t *number = stage->work.map;
    float *smooth = stage->background.thick.smooth;
    for (int32_t i = 0; i < stage->grid.count; i++) {
        smooth[i] = state->piece[i] != 0 ? 0.0f : state->depth[i];
    }
    rlf_segment_links(stage, RLF_SEGMENT_NOISE, smooth, NULL, NULL);
    int32_t components = rlf_components_find(stage, NULL), count = 0;
    for (int32_t c = 1; c <= components; c++) {
        bool is_large = stage->work.size[c] >= stage->def.min_region_points && count < RLF_PIECES;
        number[c] = is_large ? ++count : 0;
    }
    state->piece_count = count;
    memset(state->piece, 0, (size_t)stage->grid.count);
    for (int32_t y = 0; y < stage->grid.height; y++) {
        for (int32_t r = runs->first[y]; r < runs->first[y + 1]; r++) {
            const rlf_run *run = &runs->run[r];
            memset(state->piece + (ptrdiff_t)y * stage->grid.width + run->x0,
                   number[run->component], (size_t)(run->x1 - run->x0));
        }
    }
}

/* Gives pixels at creases to the piece beside them whose plane they are nearest to. */
static void grow(rlf_reconstruct *stage, float *const normal[3])
{
    static const int32_t ways[4][2] = {{0, -1}, {-1, 0}, {1, 0}, {0, 1}};
    static_thickness *state = &stage->background.thick;
    const image_grid *grid = &stage->grid;
    uint8_t *before = stage->background.thick.before;
    memcpy(before, state->piece, (size_t)grid->count);
    for (int32_t i = 0; i < grid->count; i++) {
        float nearest = beside_m, square;
        for (int k = 0; k < 4 && before[i] == 0 && state->depth[i] > 0.0f; k++) {
            int32_t u = i % grid->width + ways[k][0], v = i / grid->width + ways[k][1];
            ptrdiff_t j = (ptrdiff_t)v * grid->width + u;
            if (is_in(grid, u, v) && before[j] != 0) {
                float off = rlf_kernel_abs(before_plane(stage, normal, i, j, &square));
                state->piece[i] = off < nearest ? before[j] : state->piece[i];
                nearest = off < nearest ? off : nearest;
            }
        }
    }
}

/* Finds the rectangles of the pieces; those of one face, and of parts of the room, are empty. */
static void find_windows(rlf_reconstruct *stage, float *const normal[3])
{
    static_thickness *state = &stage->background.thick;
    const image_grid *grid = &stage->grid;
    float sum[RLF_PIECES + 1][4] = {{0.0f}}; /* of normals; and how many */
    for (int32_t k = 0; k <= RLF_PIECES; k++) {
        state->window[k] = (rlf_rect){grid->width, grid->height, 0, 0};
    }
    for (int32_t i = 0; i < grid->count; i++) {
        int32_t k = state->piece[i];
        for (int32_t c = 0; c < 3; c++) {
            sum[k][c] += normal[c][i];
        }
        sum[k][3] += 1.0f;
        rlf_rect_add(&state->window[k], i % grid->width, i / grid->width);
    }
    for (int32_t k = 1; k <= state->piece_count; k++) {
        const float *s = sum[k], most = flat_length * s[3];
        rlf_rect *w = &state->window[k];
        bool is_flat = s[0] * s[0] + s[1] * s[1] + s[2] * s[2] >= most * most;
        if (is_flat || (w->x1 - w->x0) * (w->y1 - w->y0) >= grid->count / IMAGE_SHARE) {
            *w = (rlf_rect){0, 0, 0, 0};
        }
    }
}

bool static_find_pieces(rlf_reconstruct *stage, float *const normal[3], int32_t step)
{
    if (step < BANDS) {
        mark_creases(stage, normal, step);
    } else if (step == BANDS) {
        separate(stage);
    } else if (step <= BANDS + GROWN) {
        grow(stage, normal);
    } else {
        find_windows(stage, normal);
    }
    return step > BANDS + GROWN;
}
