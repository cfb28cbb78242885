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

/* Rows of the picture that are wanted, how many of them are drawn into, and how many are done:
 * each while it is in the processor's cache. */
typedef struct wanted_rows {
    int32_t begin, end, drawn, done;
    const rlf_plane_f32 *depth;
    const rlf_plane_u8 *state;
} wanted_rows;

static void clear_up_to(wanted_rows *rows, int32_t end)
{
    for (; rows->drawn < end; rows->drawn++) {
        rlf_kernel_clear_row(rows->depth->width, rlf_f32_row(rows->depth, rows->drawn));
    }
}

/* Rows before `end` change no more. */
static void finish_up_to(const rlf_registration *r, wanted_rows *rows, int32_t end)
{
    end = end < rows->end ? end : rows->end;
    if (rows->done < end) {
        clear_up_to(rows, end);
        registration_fill_holes(r, rows->done, end, rows->depth, rows->state);
        rows->done = end;
    }
}

/* Puts pixels x[0] .. x[1] of the line into row y: the first that is drawn into it. */
static void put_row(const rlf_registration *r, const int32_t x[2], wanted_rows *rows)
{
    float *out = rlf_f32_row(rows->depth, rows->drawn);
    rlf_kernel_clear_row(x[0], out);
    memcpy(out + x[0], r->line + x[0], (size_t)(x[1] + 1 - x[0]) * sizeof(*out));
    rlf_kernel_clear_row(rows->depth->width - x[1] - 1, out + x[1] + 1);
    rows->drawn++;
}

static void put_line(const rlf_registration *r, const int32_t x[2], int32_t y, wanted_rows *rows)
{
    const int32_t first = y / RLF_KERNEL_ROWS;
    const int32_t last = y % RLF_KERNEL_ROWS < rows->end ? y % RLF_KERNEL_ROWS : rows->end - 1;
    const int32_t count = x[1] - x[0] + 1;
    clear_up_to(rows, first < rows->end ? first : rows->end);
    for (int32_t row = first > rows->begin ? first : rows->begin; row <= last; row++) {
        if (row < rows->drawn) {
            rlf_kernel_nearer_row(r->line + x[0], count, rlf_f32_row(rows->depth, row) + x[0]);
        } else {
            put_row(r, x, rows);
        }
    }
    rlf_kernel_clear_row(count, r->line + x[0]);
}

static void splat(const rlf_registration *r, wanted_rows *rows)
{
    const int32_t *row_y = r->row.y;
    for (int32_t i = 0; i < r->width;) {
        if (row_y[i] < 0) {
            i++;
            continue;
        }
        int32_t x[3];
        const int32_t end = rlf_kernel_splat_run(&r->row, i, r->width, x);
        draw_run(r, i, end, x[2]);
        put_line(r, x, row_y[i], rows);
        i = end;
    }
}

void registration_project(rlf_registration *r, const float *depth, int32_t y)
{
    size_t first = (size_t)y * (size_t)r->width;
    rlf_kernel_rays rays = {r->a + first, r->b + first, r->c + first};
    rlf_kernel_project_row(&r->pinhole, &rays, depth + first, r->width, &r->points);
    if (r->lens.du != NULL) {
        rlf_kernel_distort_row(&r->lens, r->width, &r->points);
    }
    if (r->size != NULL) {
        rlf_kernel_stretch_row(r->size + first, r->width, r->points.scale);
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
    wanted_rows rows = {begin, end, begin, begin, out_depth, out_state};
    if (r->fills_columns) {
        rows = (wanted_rows){0, r->color.height, 0, 0, out_depth, out_state};
    }
    for (int32_t y = 0; y < r->height; y++) {
        if (r->row_bottom[y] < (float)rows.begin || r->row_top[y] > (float)rows.end) {
            continue;
        }
        registration_project(r, depth, y);
        rlf_kernel_splat_row(&r->pinhole, &r->points, r->width, &r->row);
        splat(r, &rows);
        finish_up_to(r, &rows, r->fills_columns ? 0 : r->done[y]);
    }
    finish_up_to(r, &rows, rows.end);
}

void rlf_registration_apply(rlf_registration *r, const float *depth, const rlf_plane_f32 *out_depth,
                            const rlf_plane_u8 *out_state)
{
    if (RLF_ASSERT(out_depth != NULL)) {
        rlf_registration_apply_rows(r, depth, 0, out_depth->height, out_depth, out_state);
    }
}
