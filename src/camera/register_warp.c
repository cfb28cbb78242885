/* Depth seen from the colour camera: forward warp with a z-buffer.
 *
 * Each depth pixel is a small rectangle in the colour image, as wide as the ratio of the focal
 * lengths and the lenses there make it, so that a smooth surface leaves no gaps; the nearest one
 * wins. Neighbours in a row of
 * the grid mostly share their rows of the picture: they are drawn into one line, which then goes
 * into all of those rows at once. */
#include "camera/register.h"

#include <string.h>

static inline void draw_pixel(float *line, int32_t x, float here)
{
    float before = line[x];
    line[x] = here < before ? here : before;
}

/* Draws rectangles [begin, end), all of the same rows and at most `widest` pixels wide, into the
 * line. Those without pixels draw nothing at the line's start. Few pixels are drawn more than once
 * rather than counted. */
static void draw_run(const rlf_registration *r, int32_t begin, int32_t end, int32_t widest)
{
    const float *restrict z = r->points.z;
    const int32_t *restrict row_x0 = r->row.x0;
    const int32_t *restrict row_x1 = r->row.x1;
    float *restrict line = r->line;
    if (widest <= 2) {
        for (int32_t i = begin; i < end; i++) {
            draw_pixel(line, row_x0[i], z[i]);
            draw_pixel(line, row_x1[i], z[i]);
        }
        return;
    }
    for (int32_t i = begin; i < end; i++) {
        const int32_t x0 = row_x0[i];
        const int32_t x1 = row_x1[i];
        const int32_t middle = (x0 + x1) / 2;
        draw_pixel(line, x0, z[i]);
        draw_pixel(line, middle, z[i]);
        draw_pixel(line, x1, z[i]);
        for (int32_t x = x0 + 1; widest > 3 && x < x1; x++) {
            draw_pixel(line, x, z[i]);
        }
    }
}

/* Pixels of the picture that are wanted, how many rows are drawn into, and how many are done: each
 * while it is in the processor's cache. */
typedef struct wanted_rows {
    pixel_rect window;
    int32_t drawn, done;
    const rlf_plane_f32 *depth;
    const rlf_plane_u8 *state;
} wanted_rows;

static void clear_up_to(wanted_rows *rows, int32_t end)
{
    for (; rows->drawn < end; rows->drawn++) {
        rlf_kernel_clear_row(rows->window.x1 - rows->window.x0,
                             rlf_f32_row(rows->depth, rows->drawn) + rows->window.x0);
    }
}

/* Rows before `end` change no more. */
static void finish_up_to(const rlf_registration *r, wanted_rows *rows, int32_t end)
{
    end = end < rows->window.y1 ? end : rows->window.y1;
    if (rows->done < end) {
        clear_up_to(rows, end);
        const pixel_rect done = {rows->window.x0, rows->done, rows->window.x1, end};
        registration_fill_holes(r, &done, rows->depth, rows->state);
        rows->done = end;
    }
}

/* Puts pixels x0 <= x < x1 of the line into the next row: the first that is drawn into it. */
static void put_row(const rlf_registration *r, int32_t x0, int32_t x1, wanted_rows *rows)
{
    float *out = rlf_f32_row(rows->depth, rows->drawn);
    const pixel_rect *window = &rows->window;
    rlf_kernel_clear_row(x0 - window->x0, out + window->x0);
    memcpy(out + x0, r->line + x0, (size_t)(x1 - x0) * sizeof(*out));
    rlf_kernel_clear_row(window->x1 - x1, out + x1);
    rows->drawn++;
}

static int32_t clamp(int32_t x, int32_t low, int32_t high)
{
    return x < low ? low : (x > high ? high : x);
}

static void put_line(const rlf_registration *r, const int32_t x[2], int32_t y, wanted_rows *rows)
{
    const pixel_rect *window = &rows->window;
    const int32_t first = y / RLF_KERNEL_ROWS;
    const int32_t last = y % RLF_KERNEL_ROWS < window->y1 ? y % RLF_KERNEL_ROWS : window->y1 - 1;
    const int32_t x0 = clamp(x[0], window->x0, window->x1);
    const int32_t x1 = clamp(x[1] + 1, x0, window->x1);
    clear_up_to(rows, first < window->y1 ? first : window->y1);
    for (int32_t row = first > window->y0 ? first : window->y0; row <= last; row++) {
        if (row < rows->drawn) {
            rlf_kernel_nearer_row(r->line + x0, x1 - x0, rlf_f32_row(rows->depth, row) + x0);
        } else {
            put_row(r, x0, x1, rows);
        }
    }
    rlf_kernel_clear_row(x[1] + 1 - x[0], r->line + x[0]);
}

/* Draws columns [first, count) of a depth row. */
static void splat(const rlf_registration *r, int32_t first, int32_t count, wanted_rows *rows)
{
    const int32_t *row_y = r->row.y;
    for (int32_t i = first; i < count;) {
        if (row_y[i] < 0) {
            i++;
            continue;
        }
        int32_t x[3];
        const int32_t end = rlf_kernel_splat_run(&r->row, i, count, x);
        draw_run(r, i, end, x[2]);
        put_line(r, x, row_y[i], rows);
        i = end;
    }
}

static rlf_kernel_points points_at(const rlf_registration *r, int32_t x)
{
    const rlf_kernel_points *p = &r->points;
    return (rlf_kernel_points){p->u + x, p->v + x, p->scale + x, p->z + x};
}

void registration_project(const rlf_registration *r, const float *depth, int32_t y, int32_t x0,
                          int32_t x1, const rlf_kernel_points *points)
{
    const size_t first = (size_t)y * (size_t)r->width + (size_t)x0;
    const rlf_kernel_rays rays = {r->a + y * r->row_a + x0, r->b + first, r->c + y * r->row_c + x0};
    rlf_kernel_project_row(&r->pinhole, &rays, depth + first, x1 - x0, points);
    if (r->lens.du != NULL) {
        rlf_kernel_distort_row(&r->lens, x1 - x0, points);
    }
    if (r->size != NULL) {
        rlf_kernel_stretch_row(r->size + first, x1 - x0, points->scale);
    }
}

void registration_pixel(const rlf_registration *r, int32_t i, float z, float out[2])
{
    const rlf_kernel_rays rays = {r->a + i, r->b + i, r->c + i};
    float scale;
    float seen;
    const rlf_kernel_points point = {&out[0], &out[1], &scale, &seen};
    rlf_kernel_project_row(&r->pinhole, &rays, &z, 1, &point);
    if (r->lens.du != NULL) {
        rlf_kernel_distort_row(&r->lens, 1, &point);
    }
    out[0] = seen < RLF_KERNEL_NOTHING ? out[0] : -RLF_KERNEL_NOTHING;
}

/* Row y of the depth grid, columns [x[0], x[1]). */
static void draw_row(rlf_registration *r, const float *depth, int32_t y, const int32_t x[2],
                     wanted_rows *rows)
{
    const rlf_kernel_points points = points_at(r, x[0]);
    const rlf_kernel_splat *row = &r->row;
    const rlf_kernel_splat part = {row->x0 + x[0], row->x1 + x[0], row->y + x[0], row->y0 + x[0]};
    registration_project(r, depth, y, x[0], x[1], &points);
    rlf_kernel_splat_row(&r->pinhole, &points, x[1] - x[0], &part);
    splat(r, x[0], x[1], rows);
}

void registration_apply_window(rlf_registration *r, const float *depth, const pixel_rect *wanted,
                               double nearest, const rlf_plane_f32 *out_depth,
                               const rlf_plane_u8 *out_state)
{
    wanted_rows rows = {registration_widen(r, wanted, nearest), wanted->y0, wanted->y0, out_depth,
                        out_state};
    int32_t x[2];
    registration_columns(r, rows.window.x0, rows.window.x1, nearest, x);
    rows.drawn = rows.done = rows.window.y0;
    for (int32_t y = 0; y < r->height; y++) {
        if (r->row_bottom[y] < (float)rows.window.y0 || r->row_top[y] > (float)rows.window.y1) {
            continue;
        }
        if (x[0] < x[1]) {
            draw_row(r, depth, y, x, &rows);
        }
        finish_up_to(r, &rows, r->fills_columns ? 0 : r->done[y]);
    }
    finish_up_to(r, &rows, rows.window.y1);
}

void rlf_registration_apply_rows(rlf_registration *r, const float *depth, int32_t begin,
                                 int32_t end, const rlf_plane_f32 *out_depth,
                                 const rlf_plane_u8 *out_state)
{
    if (!RLF_ASSERT(r != NULL && depth != NULL && out_depth != NULL && out_state != NULL) ||
        !RLF_ASSERT(out_depth->width == r->color.width && out_depth->height == r->color.height &&
                    out_state->width == r->color.width && out_state->height == r->color.height) ||
        !RLF_ASSERT(begin >= 0 && end <= r->color.height)) {
        return;
    }
    const pixel_rect rows = {0, begin, r->color.width, end};
    registration_apply_window(r, depth, &rows, 0.0, out_depth, out_state);
}

void rlf_registration_apply(rlf_registration *r, const float *depth, const rlf_plane_f32 *out_depth,
                            const rlf_plane_u8 *out_state)
{
    if (RLF_ASSERT(out_depth != NULL)) {
        rlf_registration_apply_rows(r, depth, 0, out_depth->height, out_depth, out_state);
    }
}
