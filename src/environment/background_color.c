/* A remembered colour of the background, per pixel of the depth grid. */
#include "environment/background_color.h"

#include "environment/depth_edge.h"

#include <string.h>

#define FIRST_ROWS 16   /* learnt per frame until all have been, */
#define LATER_ROWS 4    /* and then */
#define GATE 16         /* steps of a channel that still are the same colour */
#define TIMES_MAX 4     /* a colour seen so often gives way after as many others */
#define CELL 8          /* pixels */
#define CLEAR 2         /* cells around foreground that are not learnt: shadows, parallax */
#define FOREIGN 900.0f  /* squared distance of colours, from which they are two */
#define FARTHEST 48.0f  /* picture pixels between a near place and a far one, at most */
#define DARKEST 0.5f    /* share of the background's colour in the deepest shadow, */
#define BRIGHTEST 1.08f /* and in the light */

rlf_result background_color_create(const rlf_registration *registration, const rlf_camera *depth,
                                   const rlf_pose *T_picture_depth, background_color *out)
{
    memset(out, 0, sizeof(*out));
    out->width = registration->width;
    out->height = registration->height;
    const size_t pixels = (size_t)out->width * (size_t)out->height;
    const rlf_mat3 R = rlf_quat_to_mat3(T_picture_depth->q);
    const rlf_camera *picture = &registration->color;
    const double xu = picture->fx * R.m[0][0] / depth->fx;
    const double yu = picture->fx * R.m[0][1] / depth->fy;
    const double xv = picture->fy * R.m[1][0] / depth->fx;
    const double yv = picture->fy * R.m[1][1] / depth->fy;
    const double determinant = xu * yv - yu * xv;
    const double inverse = determinant > 0.01 || determinant < -0.01 ? 1.0 / determinant : 0.0;
    out->to_grid[0] = (float)(yv * inverse);
    out->to_grid[1] = (float)(-yu * inverse);
    out->to_grid[2] = (float)(-xv * inverse);
    out->to_grid[3] = (float)(xu * inverse);
    out->colors = rlf_alloc(4 * pixels);
    out->columns = (out->width + CELL - 1) / CELL;
    out->rows = (out->height + CELL - 1) / CELL;
    out->cells = rlf_alloc((size_t)out->columns * (size_t)out->rows);
    if (out->colors == NULL || out->cells == NULL) {
        background_color_destroy(out);
        return RLF_ERROR_MEMORY;
    }
    return RLF_OK;
}

void background_color_destroy(background_color *background)
{
    rlf_free(background->colors);
    rlf_free(background->cells);
    memset(background, 0, sizeof(*background));
}

/* ---- colours -------------------------------------------------------------------------------- */

const uint8_t *background_color_seen_at(const background_color *background,
                                        const rlf_image_rgba8 *color, float u, float v)
{
    const float x = (u + 0.5f) * background->scale[0];
    const float y = (v + 0.5f) * background->scale[1];
    if (!(x >= 0.0f && y >= 0.0f && x < (float)color->width && y < (float)color->height)) {
        return NULL;
    }
    return rlf_rgba8_row(color, (int32_t)y) + 4 * (ptrdiff_t)(int32_t)x;
}

float background_color_squared(const uint8_t *a, const uint8_t *b)
{
    float sum = 0.0f;
    for (int k = 0; k < 3; k++) {
        const float off = (float)(a[k] - b[k]);
        sum += off * off;
    }
    return sum;
}

/* Squared distance of a colour from another one that may be darker or a little brighter. */
static float squared_in_shadow(const uint8_t *c, const uint8_t *lit)
{
    float along = 0.0f;
    float length = 1.0f;
    for (int k = 0; k < 3; k++) {
        along += (float)(c[k] * lit[k]);
        length += (float)(lit[k] * lit[k]);
    }
    float share = along / length;
    share = share < DARKEST ? DARKEST : (share > BRIGHTEST ? BRIGHTEST : share);
    float sum = 0.0f;
    for (int k = 0; k < 3; k++) {
        const float off = (float)c[k] - share * (float)lit[k];
        sum += off * off;
    }
    return sum;
}

/* Least distance of a colour from the background's at (x, y) and beside it; < 0: not known there.
 */
static float from_background(const background_color *background, const uint8_t *c, int32_t x,
                             int32_t y, bool may_be_shadow)
{
    static const int32_t beside[5][2] = {{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    float least = -1.0f;
    for (int k = 0; k < 5; k++) {
        const int32_t at_x = x + beside[k][0];
        const int32_t at_y = y + beside[k][1];
        if (at_x < 0 || at_y < 0 || at_x >= background->width || at_y >= background->height) {
            continue;
        }
        const uint8_t *known =
            background->colors + 4 * ((ptrdiff_t)at_y * background->width + at_x);
        if (known[3] != 0) {
            const float here =
                may_be_shadow ? squared_in_shadow(c, known) : background_color_squared(c, known);
            least = least < 0.0f || here < least ? here : least;
        } else if (k == 0) {
            return -1.0f;
        }
    }
    return least;
}

/* ---- cells ---------------------------------------------------------------------------------- */

enum { HAS_FOREGROUND = 1, NOT_CLEAR = 2 };

static void mark_around(background_color *background, int32_t column, int32_t row)
{
    for (int32_t y = row - CLEAR; y <= row + CLEAR; y++) {
        for (int32_t x = column - CLEAR; x <= column + CLEAR; x++) {
            if (x >= 0 && y >= 0 && x < background->columns && y < background->rows) {
                background->cells[y * background->columns + x] |= NOT_CLEAR;
            }
        }
    }
}

/* Cells of a row of them with foreground in its pixels. */
static void mark_foreground(background_color *background, const rlf_surface *surface, int32_t row)
{
    const int32_t width = background->width;
    const int32_t end =
        (row + 1) * CELL < background->height ? (row + 1) * CELL : background->height;
    for (int32_t y = row * CELL; y < end; y++) {
        const uint8_t *foreground = surface->foreground + (ptrdiff_t)y * width;
        int32_t x = rlf_kernel_next_mark(foreground, 0, width);
        while (x < width) {
            background->cells[row * background->columns + x / CELL] |= HAS_FOREGROUND;
            x = rlf_kernel_next_mark(foreground, (x / CELL + 1) * CELL, width);
        }
    }
}

static void mark_cells(background_color *background, const rlf_surface *surface)
{
    memset(background->cells, 0, (size_t)background->columns * (size_t)background->rows);
    for (int32_t row = 0; row < background->rows; row++) {
        mark_foreground(background, surface, row);
    }
    for (int32_t i = 0; i < background->columns * background->rows; i++) {
        if ((background->cells[i] & HAS_FOREGROUND) != 0) {
            mark_around(background, i % background->columns, i / background->columns);
        }
    }
}

/* ---- learning ------------------------------------------------------------------------------- */

/* Takes a colour; true when it is the one that is known already. */
static bool take_color(uint8_t *known, const uint8_t *c)
{
    bool is_same = known[3] != 0;
    for (int k = 0; k < 3; k++) {
        const int32_t off = c[k] - known[k];
        is_same = is_same && off <= GATE && off >= -GATE;
    }
    if (is_same) {
        for (int k = 0; k < 3; k++) {
            known[k] = (uint8_t)(known[k] + (c[k] - known[k]) / 2);
        }
        known[3] = known[3] < TIMES_MAX ? (uint8_t)(known[3] + 1) : TIMES_MAX;
    } else if (known[3] > 1) {
        known[3]--;
    } else {
        memcpy(known, c, 3);
        known[3] = 1;
    }
    return is_same;
}

/* How many colours of what was known were the same, and how many were not. */
typedef struct votes {
    int32_t same, other;
} votes;

static void learn_row(background_color *background, rlf_registration *registration,
                      const rlf_image_rgba8 *color, const rlf_surface *surface, votes *v)
{
    const int32_t y = background->next_row;
    const uint8_t *cells = background->cells + y / CELL * background->columns;
    const rlf_kernel_points *p = &registration->points;
    uint8_t *known = background->colors + 4 * (ptrdiff_t)y * background->width;
    background->next_row = y + 1 < background->height ? y + 1 : 0;
    background->is_whole = background->is_whole || background->next_row == 0;
    registration_project(registration, surface->background_depth, y, 0, background->width,
                         &registration->points);
    for (int32_t x = 0; x < background->width; x++) {
        const bool is_seen = (cells[x / CELL] & NOT_CLEAR) == 0 && p->scale[x] > 0.0f &&
                             p->z[x] < RLF_KERNEL_NOTHING;
        const uint8_t *c =
            is_seen ? background_color_seen_at(background, color, p->u[x], p->v[x]) : NULL;
        if (c != NULL) {
            const bool was_known = known[4 * x + 3] != 0;
            const bool is_same = take_color(known + 4 * x, c);
            v->same += is_same;
            v->other += was_known && !is_same;
        }
    }
}

void background_color_forget(background_color *background)
{
    memset(background->colors, 0, 4 * (size_t)background->width * (size_t)background->height);
    background->next_row = 0;
    background->is_whole = false;
}

static void learn(background_color *background, rlf_registration *registration,
                  const rlf_image_rgba8 *color, const rlf_surface *surface)
{
    const int32_t rows = background->is_whole ? LATER_ROWS : FIRST_ROWS;
    votes v = {0, 0};
    for (int32_t k = 0; k < rows; k++) {
        learn_row(background, registration, color, surface, &v);
    }
    if (v.other > v.same) {
        background_color_forget(background);
    }
}

/* ---- telling -------------------------------------------------------------------------------- */

const uint8_t *background_color_seen(const background_color *background,
                                     const rlf_registration *registration,
                                     const rlf_image_rgba8 *color, int32_t i, float z)
{
    float at[2];
    registration_pixel(registration, i, z, at);
    return background_color_seen_at(background, color, at[0], at[1]);
}

static int32_t round_to_int(float x)
{
    return (int32_t)(x + 128.5f) - 128;
}

/* True when pixel i shows a thing at near_z, for the picture there is not the background's. */
static bool shows_foreground(const background_color *background,
                             const background_color_sight *sight, int32_t i, float near_z,
                             const float at_far[2])
{
    float at[2];
    registration_pixel(sight->registration, i, near_z, at);
    const uint8_t *c = background_color_seen_at(background, sight->color, at[0], at[1]);
    const float u = at[0] - at_far[0];
    const float v = at[1] - at_far[1];
    if (c == NULL || !(u * u + v * v < FARTHEST * FARTHEST)) {
        return false;
    }
    const int32_t x = i % background->width;
    const int32_t y = i / background->width;
    const int32_t background_x =
        x + round_to_int(background->to_grid[0] * u + background->to_grid[1] * v);
    const int32_t background_y =
        y + round_to_int(background->to_grid[2] * u + background->to_grid[3] * v);
    return from_background(background, c, background_x, background_y, true) > FOREIGN;
}

/* True when the background's colour is known at pixel i, and foreground like that of pixel `near`
 * would look another way. */
static bool would_differ(const background_color *background, const background_color_sight *sight,
                         int32_t i, int32_t near)
{
    const uint8_t *foreground = background_color_seen(background, sight->registration, sight->color,
                                                      near, sight->surface->depth[near]);
    return foreground != NULL && from_background(background, foreground, i % background->width,
                                                 i / background->width, true) > FOREIGN;
}

int background_color_tells(const background_color *background, const background_color_sight *sight,
                           int32_t i, int32_t near, float near_z)
{
    const rlf_surface *surface = sight->surface;
    const float far_z = surface->background_depth != NULL ? surface->background_depth[i] : 0.0f;
    if (!(far_z > near_z) || !depth_steps(near_z, far_z)) {
        return 0;
    }
    float at_far[2];
    registration_pixel(sight->registration, i, far_z, at_far);
    if (shows_foreground(background, sight, i, near_z, at_far)) {
        return 1;
    }
    return would_differ(background, sight, i, near) ? -1 : 0;
}

void background_color_update(background_color *background, rlf_registration *registration,
                             const rlf_frame *frame, const rlf_surface *surface)
{
    background->scale[0] = (float)frame->color.width / (float)registration->color.width;
    background->scale[1] = (float)frame->color.height / (float)registration->color.height;
    const bool is_new = !background->has_sequence || frame->sequence != background->last_sequence;
    if (surface->background_depth == NULL || surface->foreground == NULL ||
        frame->color.data == NULL || background->to_grid[0] == 0.0f || !is_new) {
        return;
    }
    mark_cells(background, surface);
    learn(background, registration, &frame->color, surface);
    background->last_sequence = frame->sequence;
    background->has_sequence = true;
}
