/* Which triangle every sample sees, row by row.
 *
 * Four samples per pixel lie on a rotated grid. Along one line of samples a triangle is one run of
 * pixels, whose ends come from its edges; a shared edge is worked out from the same two corners in
 * the same order, so neighbouring triangles neither overlap nor leave gaps. */
#include "render/soft/soft.h"

/* Offsets from the pixel's centre: no two share a row or a column. */
static const double sample_x[SOFT_SAMPLES] = {-0.125, 0.375, -0.375, 0.125};
static const double sample_y[SOFT_SAMPLES] = {-0.375, -0.125, 0.125, 0.375};

/* First pixel whose sample is at or beyond x, within 0..width. */
static int32_t first_pixel(double x, int32_t width)
{
    if (!(x > 0.0)) {
        return 0;
    }
    if (x >= width) {
        return width;
    }
    int32_t cell = (int32_t)x;
    return cell < x ? cell + 1 : cell;
}

/* Keeps the larger 1/z; the loop is one compare and two selects, which compilers vectorise. */
static void test_run(float *restrict inverse_z, int32_t *restrict triangle, int32_t count,
                     const float line[2], int32_t id)
{
    float at0 = line[0];
    float step = line[1];
    for (int32_t i = 0; i < count; i++) {
        float value = at0 + step * (float)i;
        bool is_nearer = value > inverse_z[i];
        inverse_z[i] = is_nearer ? value : inverse_z[i];
        triangle[i] = is_nearer ? id : triangle[i];
    }
}

void soft_raster_row(const soft_triangle *t, int32_t id, const soft_row *row)
{
    for (int k = 0; k < SOFT_SAMPLES; k++) {
        double y = row->y + sample_y[k];
        if (y < t->y[0] || y >= t->y[2]) {
            continue;
        }
        int upper = y < t->y[1] ? 0 : 1;
        double on_long = t->x[0] + t->slope[2] * (y - t->y[0]);
        double on_short = t->x[upper] + t->slope[upper] * (y - t->y[upper]);
        int32_t begin = first_pixel(rlf_min(on_long, on_short) - sample_x[k], row->width);
        int32_t end = first_pixel(rlf_max(on_long, on_short) - sample_x[k], row->width);
        if (begin >= end) {
            continue;
        }
        const soft_plane *plane = &t->inverse_z;
        const float line[2] = {plane->at0 + plane->dx * (float)(begin + sample_x[k] - t->x[0]) +
                                   plane->dy * (float)(y - t->y[0]),
                               plane->dx};
        ptrdiff_t first = (ptrdiff_t)k * row->width + begin;
        test_run(row->inverse_z + first, row->triangle + first, end - begin, line, id);
    }
}
