/* A remembered colour of the background, per pixel of the depth grid. */
#include "clean_plate.h"

#include <string.h>

#define FIRST_ROWS 16   /* learnt per frame until all have been, */
#define LATER_ROWS 4    /* and then */
#define GATE 16         /* steps of a channel that still are the same colour */
#define TIMES_MAX 4     /* a colour seen so often gives way after as many others */
#define CELL 8          /* pixels */
#define CLEAR 2         /* cells around foreground that are not learnt: shadows, parallax */
#define FOREIGN 900.0f  /* squared distance of colours, from which they are not the plate's */
#define FARTHEST 48.0f  /* picture pixels between a near place and a far one, at most */
#define DARKEST 0.5f    /* share of the plate's colour in the deepest shadow, */
#define BRIGHTEST 1.08f /* and in the light */

rlf_result clean_plate_create(const rlf_registration *registration, const rlf_camera *depth,
                              const rlf_pose *T_picture_depth, clean_plate *out)
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
        clean_plate_destroy(out);
        return RLF_ERROR_MEMORY;
    }
    return RLF_OK;
}

void clean_plate_destroy(clean_plate *plate)
{
    rlf_free(plate->colors);
    rlf_free(plate->cells);
    memset(plate, 0, sizeof(*plate));
}

/* ---- colours -------------------------------------------------------------------------------- */

const uint8_t *clean_plate_picture(const clean_plate *plate, const rlf_image_rgba8 *color, float u,
                                   float v)
{
    const float x = (u + 0.5f) * plate->scale[0];
    const float y = (v + 0.5f) * plate->scale[1];
    if (!(x >= 0.0f && y >= 0.0f && x < (float)color->width && y < (float)color->height)) {
        return NULL;
    }
    return rlf_rgba8_row(color, (int32_t)y) + 4 * (ptrdiff_t)(int32_t)x;
}

float clean_plate_squared(const uint8_t *a, const uint8_t *b)
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

/* Least distance of a colour from the plate's at (x, y) and beside it; < 0: not known there. */
static float from_plate(const clean_plate *plate, const uint8_t *c, int32_t x, int32_t y,
                        bool may_be_shadow)
{
    static const int32_t beside[5][2] = {{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    float least = -1.0f;
    for (int k = 0; k < 5; k++) {
        const int32_t at_x = x + beside[k][0];
        const int32_t at_y = y + beside[k][1];
        if (at_x < 0 || at_y < 0 || at_x >= plate->width || at_y >= plate->height) {
            continue;
        }
        const uint8_t *known = plate->colors + 4 * ((ptrdiff_t)at_y * plate->width + at_x);
        if (known[3] != 0) {
            const float here =
                may_be_shadow ? squared_in_shadow(c, known) : clean_plate_squared(c, known);
            least = least < 0.0f || here < least ? here : least;
        } else if (k == 0) {
            return -1.0f;
        }
    }
    return least;
}

/* ---- cells ---------------------------------------------------------------------------------- */

enum { HAS_FOREGROUND = 1, NOT_CLEAR = 2 };

static void mark_around(clean_plate *plate, int32_t column, int32_t row)
{
    for (int32_t y = row - CLEAR; y <= row + CLEAR; y++) {
        for (int32_t x = column - CLEAR; x <= column + CLEAR; x++) {
            if (x >= 0 && y >= 0 && x < plate->columns && y < plate->rows) {
                plate->cells[y * plate->columns + x] |= NOT_CLEAR;
            }
        }
    }
}

/* Cells of a row of them with foreground in its pixels. */
static void mark_foreground(clean_plate *plate, const rlf_surface *surface, int32_t row)
{
    const int32_t width = plate->width;
    const int32_t end = (row + 1) * CELL < plate->height ? (row + 1) * CELL : plate->height;
    for (int32_t y = row * CELL; y < end; y++) {
        const uint8_t *foreground = surface->foreground + (ptrdiff_t)y * width;
        int32_t x = rlf_kernel_next_mark(foreground, 0, width);
        while (x < width) {
            plate->cells[row * plate->columns + x / CELL] |= HAS_FOREGROUND;
            x = rlf_kernel_next_mark(foreground, (x / CELL + 1) * CELL, width);
        }
    }
}

static void mark_cells(clean_plate *plate, const rlf_surface *surface)
{
    memset(plate->cells, 0, (size_t)plate->columns * (size_t)plate->rows);
    for (int32_t row = 0; row < plate->rows; row++) {
        mark_foreground(plate, surface, row);
    }
    for (int32_t i = 0; i < plate->columns * plate->rows; i++) {
        if ((plate->cells[i] & HAS_FOREGROUND) != 0) {
            mark_around(plate, i % plate->columns, i / plate->columns);
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

static void learn_row(clean_plate *plate, rlf_registration *registration,
                      const rlf_image_rgba8 *color, const rlf_surface *surface, votes *v)
{
    const int32_t y = plate->next_row;
    const uint8_t *cells = plate->cells + y / CELL * plate->columns;
    const rlf_kernel_points *p = &registration->points;
    uint8_t *known = plate->colors + 4 * (ptrdiff_t)y * plate->width;
    plate->next_row = y + 1 < plate->height ? y + 1 : 0;
    plate->is_whole = plate->is_whole || plate->next_row == 0;
    registration_project(registration, surface->background_depth, y, 0, plate->width);
    for (int32_t x = 0; x < plate->width; x++) {
        const bool is_seen = (cells[x / CELL] & NOT_CLEAR) == 0 && p->scale[x] > 0.0f &&
                             p->z[x] < RLF_KERNEL_NOTHING;
        const uint8_t *c = is_seen ? clean_plate_picture(plate, color, p->u[x], p->v[x]) : NULL;
        if (c != NULL) {
            const bool was_known = known[4 * x + 3] != 0;
            const bool is_same = take_color(known + 4 * x, c);
            v->same += is_same;
            v->other += was_known && !is_same;
        }
    }
}

static void learn(clean_plate *plate, rlf_registration *registration, const rlf_image_rgba8 *color,
                  const rlf_surface *surface)
{
    const int32_t rows = plate->is_whole ? LATER_ROWS : FIRST_ROWS;
    votes v = {0, 0};
    for (int32_t k = 0; k < rows; k++) {
        learn_row(plate, registration, color, surface, &v);
    }
    if (v.other > v.same) {
        memset(plate->colors, 0, 4 * (size_t)plate->width * (size_t)plate->height);
        plate->next_row = 0;
        plate->is_whole = false;
    }
}

/* ---- telling -------------------------------------------------------------------------------- */

const uint8_t *clean_plate_color(const clean_plate *plate, const rlf_registration *registration,
                                 const rlf_image_rgba8 *color, int32_t i, float z)
{
    float at[2];
    registration_pixel(registration, i, z, at);
    return clean_plate_picture(plate, color, at[0], at[1]);
}

static int32_t round_to_int(float x)
{
    return (int32_t)(x + 128.5f) - 128;
}

/* True when pixel i shows a thing at near_z, for the picture there is not the plate's. */
static bool shows_foreground(const clean_plate *plate, const clean_plate_sight *sight, int32_t i,
                             float near_z, const float at_far[2])
{
    float at[2];
    registration_pixel(sight->registration, i, near_z, at);
    const uint8_t *c = clean_plate_picture(plate, sight->color, at[0], at[1]);
    const float u = at[0] - at_far[0];
    const float v = at[1] - at_far[1];
    if (c == NULL || !(u * u + v * v < FARTHEST * FARTHEST)) {
        return false;
    }
    const int32_t x = i % plate->width;
    const int32_t y = i / plate->width;
    const int32_t plate_x = x + round_to_int(plate->to_grid[0] * u + plate->to_grid[1] * v);
    const int32_t plate_y = y + round_to_int(plate->to_grid[2] * u + plate->to_grid[3] * v);
    return from_plate(plate, c, plate_x, plate_y, true) > FOREIGN;
}

/* True when the background's colour is known at pixel i, and foreground like that of pixel `near`
 * would look another way. */
static bool would_differ(const clean_plate *plate, const clean_plate_sight *sight, int32_t i,
                         int32_t near)
{
    const uint8_t *foreground = clean_plate_color(plate, sight->registration, sight->color, near,
                                                  sight->surface->depth[near]);
    return foreground != NULL &&
           from_plate(plate, foreground, i % plate->width, i / plate->width, true) > FOREIGN;
}

int clean_plate_tells(const clean_plate *plate, const clean_plate_sight *sight, int32_t i,
                      int32_t near, float near_z)
{
    const rlf_surface *surface = sight->surface;
    const float far_z = surface->background_depth != NULL ? surface->background_depth[i] : 0.0f;
    if (!(far_z > near_z) || !silhouette_jumps(near_z, far_z)) {
        return 0;
    }
    float at_far[2];
    registration_pixel(sight->registration, i, far_z, at_far);
    if (shows_foreground(plate, sight, i, near_z, at_far)) {
        return 1;
    }
    return would_differ(plate, sight, i, near) ? -1 : 0;
}

void clean_plate_update(clean_plate *plate, rlf_registration *registration,
                        const rlf_render_input *input)
{
    const rlf_frame *frame = input->frame;
    const rlf_surface *surface = input->surface;
    plate->scale[0] = (float)frame->color.width / (float)registration->color.width;
    plate->scale[1] = (float)frame->color.height / (float)registration->color.height;
    const bool is_new = !plate->has_sequence || frame->sequence != plate->last_sequence;
    if (surface->background_depth == NULL || surface->foreground == NULL ||
        frame->color.data == NULL || plate->to_grid[0] == 0.0f || !is_new) {
        return;
    }
    mark_cells(plate, surface);
    learn(plate, registration, &frame->color, surface);
    plate->last_sequence = frame->sequence;
    plate->has_sequence = true;
}
