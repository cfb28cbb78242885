/* Depth seen from the colour camera: forward warp with a z-buffer.
 *
 * Each depth pixel is a small rectangle in the colour image, as wide as the ratio of the focal
 * lengths and the lenses there make it, so that a smooth surface leaves no gaps; the nearest one
 * wins. Neighbours in a row of
 * the grid mostly share their rows of the picture: they are drawn into one line, which then goes
 * into all of those rows at once. */
#include "camera/register.h"

/* Draws rectangles from `begin` on into the line, as long as they lie in the rows `y`; returns
 * where they end. Those without pixels draw nothing at the line's start. */
static int32_t draw_run(const rlf_registration *r, int32_t begin, int32_t y)
{
    const float *z = r->points.z;
    const int32_t *row_x0 = r->row.x0;
    const int32_t *row_x1 = r->row.x1;
    const int32_t *row_y = r->row.y;
    float *line = r->line;
    int32_t i = begin;
    for (; i < r->width && (row_y[i] == y || row_y[i] < 0); i++) {
        int32_t x0 = row_x0[i];
        int32_t x1 = row_x1[i];
        float here = z[i];
        float left = line[x0];
        float right = line[x1];
        line[x0] = here < left ? here : left;
        line[x1] = here < right ? here : right;
        for (int32_t x = x0 + 1; x < x1; x++) {
            line[x] = here < line[x] ? here : line[x];
        }
    }
    return i;
}

/* Rows of the picture that are wanted, and how far they have been cleared: just before they are
 * drawn into, while they are in the processor's cache. */
typedef struct wanted_rows {
    int32_t begin, end, cleared;
} wanted_rows;

static void clear_up_to(wanted_rows *rows, int32_t end, const rlf_plane_f32 *out)
{
    for (; rows->cleared < end; rows->cleared++) {
        rlf_kernel_clear_row(out->width, rlf_f32_row(out, rows->cleared));
    }
}

static void splat(const rlf_registration *r, const rlf_plane_f32 *out, wanted_rows *rows)
{
    const int32_t *row_y = r->row.y;
    for (int32_t i = 0; i < r->width;) {
        int32_t y = row_y[i];
        if (y < 0) {
            i++;
            continue;
        }
        int32_t end = draw_run(r, i, y);
        int32_t x[2];
        rlf_kernel_splat_bounds(&r->row, i, end, x);
        int32_t count = x[1] - x[0] + 1;
        int32_t first = y / RLF_KERNEL_ROWS;
        int32_t last = y % RLF_KERNEL_ROWS;
        first = first > rows->begin ? first : rows->begin;
        last = last < rows->end ? last : rows->end - 1;
        clear_up_to(rows, last + 1, out);
        for (int32_t line = first; line <= last; line++) {
            rlf_kernel_nearer_row(r->line + x[0], count, rlf_f32_row(out, line) + x[0]);
        }
        rlf_kernel_clear_row(count, r->line + x[0]);
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
    wanted_rows rows = {begin, end, begin};
    if (r->fills_columns) {
        rows = (wanted_rows){0, r->color.height, 0};
    }
    for (int32_t y = 0; y < r->height; y++) {
        if (r->row_bottom[y] < (float)rows.begin || r->row_top[y] > (float)rows.end) {
            continue;
        }
        registration_project(r, depth, y);
        rlf_kernel_splat_row(&r->pinhole, &r->points, r->width, &r->row);
        splat(r, out_depth, &rows);
    }
    clear_up_to(&rows, rows.end, out_depth);
    registration_fill_holes(r, rows.begin, rows.end, out_depth, out_state);
}

void rlf_registration_apply(rlf_registration *r, const float *depth, const rlf_plane_f32 *out_depth,
                            const rlf_plane_u8 *out_state)
{
    if (RLF_ASSERT(out_depth != NULL)) {
        rlf_registration_apply_rows(r, depth, 0, out_depth->height, out_depth, out_state);
    }
}
