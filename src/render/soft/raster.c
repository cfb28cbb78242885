/* Which face every sample sees, row by row.
 *
 * Four samples per pixel lie on a rotated grid. Along one line of samples a convex face is one run
 * of pixels, whose ends come from its edges; a shared edge is worked out from the same two corners
 * in the same order, so neighbouring faces neither overlap nor leave gaps. */
#include "kernel/kernel.h"
#include "render/soft/soft.h"

#define NOWHERE 1e30

/* Offsets from the pixel's centre: no two share a row or a column. */
static const double sample_x[SOFT_SAMPLES] = {-0.125, 0.375, -0.375, 0.125};
static const double sample_y[SOFT_SAMPLES] = {-0.375, -0.125, 0.125, 0.375};

/* Ends of the face on each line of samples; left > right where it has none. */
RLF_KERNEL_PART void find_ends(const soft_face *f, int32_t y, double *restrict left,
                               double *restrict right)
{
    for (int k = 0; k < SOFT_SAMPLES; k++) {
        left[k] = NOWHERE;
        right[k] = -NOWHERE;
    }
    for (int e = 0; e < SOFT_CORNERS; e++) {
        const double x0 = f->edge_x[e];
        const double y0 = f->edge_y[e];
        const double end = f->edge_end[e];
        const double slope = f->slope[e];
        for (int k = 0; k < SOFT_SAMPLES; k++) {
            double at_y = y + sample_y[k];
            double at = x0 + slope * (at_y - y0);
            double low = at_y >= y0 ? at : NOWHERE;
            low = at_y < end ? low : NOWHERE;
            double high = low < NOWHERE ? low : -NOWHERE;
            left[k] = low < left[k] ? low : left[k];
            right[k] = high > right[k] ? high : right[k];
        }
    }
}

/* First pixels whose sample is at or beyond x, within 0..width. */
RLF_KERNEL_PART void first_pixels(const double x[SOFT_SAMPLES], int32_t width,
                                  int32_t out[SOFT_SAMPLES])
{
    for (int k = 0; k < SOFT_SAMPLES; k++) {
        double at = x[k] - sample_x[k];
        at = at > 0.0 ? at : 0.0;
        at = at < width ? at : width;
        int32_t cell = (int32_t)at;
        out[k] = cell + (cell < at ? 1 : 0);
    }
}

/* Keeps the larger 1/z. */
RLF_KERNEL_PART void test_run(float *restrict inverse_z, int32_t *restrict face, int32_t count,
                              float at0, float step, int32_t id)
{
    for (int32_t i = 0; i < count; i++) {
        float value = at0 + step * (float)i;
        float before = inverse_z[i];
        int32_t last = face[i];
        inverse_z[i] = value > before ? value : before;
        face[i] = value > before ? id : last;
    }
}

RLF_KERNEL bool soft_raster_row(const soft_face *f, int32_t id, const soft_row *row, soft_span *out)
{
    double left[SOFT_SAMPLES];
    double right[SOFT_SAMPLES];
    int32_t begin[SOFT_SAMPLES];
    int32_t end[SOFT_SAMPLES];
    find_ends(f, row->y, left, right);
    first_pixels(left, row->width, begin);
    first_pixels(right, row->width, end);
    *out = (soft_span){id, row->width, 0};
    float down = (float)row->y - f->origin_y;
    for (int k = 0; k < SOFT_SAMPLES; k++) {
        if (begin[k] < end[k]) {
            const soft_plane *plane = &f->inverse_z;
            float across = (float)begin[k] + (float)sample_x[k] - f->origin_x;
            float at0 = plane->at0 + plane->dx * across + plane->dy * (down + (float)sample_y[k]);
            ptrdiff_t first = k * row->stride + begin[k];
            test_run(row->inverse_z + first, row->face + first, end[k] - begin[k], at0, plane->dx,
                     id);
            out->x0 = begin[k] < out->x0 ? begin[k] : out->x0;
            out->x1 = end[k] > out->x1 ? end[k] : out->x1;
        }
    }
    return out->x0 < out->x1;
}
