/* The camera that an organised cloud was made with. */
#include "io/formats/pcd.h"

#include <math.h>
#include <string.h>

#define POINTS_MIN 16
#define RESIDUAL_MAX_PX 0.1

/* Sums of a line pixel = f slope + c. */
typedef struct line_fit {
    double n, s, p, ss, sp, pp;
} line_fit;

static void add(line_fit *l, double slope, double pixel)
{
    l->n += 1.0;
    l->s += slope;
    l->p += pixel;
    l->ss += slope * slope;
    l->sp += slope * pixel;
    l->pp += pixel * pixel;
}

static bool solve(const line_fit *l, double *out_f, double *out_c)
{
    const double spread = l->ss - l->s * l->s / l->n;
    const double common = l->sp - l->s * l->p / l->n;
    const double whole = l->pp - l->p * l->p / l->n;
    if (!(l->n >= POINTS_MIN) || !(spread > 0.0) || !(common > 0.0)) {
        return false;
    }
    *out_f = common / spread;
    *out_c = (l->p - *out_f * l->s) / l->n;
    const double rest = fmax(whole - *out_f * common, 0.0);
    return isfinite(*out_f) && isfinite(*out_c) && sqrt(rest / l->n) <= RESIDUAL_MAX_PX;
}

bool io_pcd_lens_fit(const io_pcd_header *header, const io_pcd_points *points, rlf_camera *out)
{
    line_fit u = {0}, v = {0};
    for (int32_t y = 0; y < header->height; y++) {
        for (int32_t x = 0; x < header->width; x++) {
            const size_t i = (size_t)y * (size_t)header->width + (size_t)x;
            const double z = points->z[i];
            if (z > 0.0 && isfinite(z) && isfinite(points->x[i]) && isfinite(points->y[i])) {
                add(&u, points->x[i] / z, x);
                add(&v, points->y[i] / z, y);
            }
        }
    }
    memset(out, 0, sizeof(*out));
    out->width = header->width;
    out->height = header->height;
    return solve(&u, &out->fx, &out->cx) && solve(&v, &out->fy, &out->cy);
}
