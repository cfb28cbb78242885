/* The colour camera's distortion as a table of offsets, which is cheaper than the polynomial. */
#include "camera/register.h"

#define LENS_CELL 16      /* pixels between knots: error below 0.02 px */
#define LENS_KNOT_MAX 512 /* per axis */

/* Pinhole pixels that the distorted image shows, from its border. */
static void lens_bounds(const rlf_camera *k, double bounds[4])
{
    double ends[4] = {0, 0, k->width - 1.0, k->height - 1.0};
    for (int i = 0; i <= 64; i++) {
        double u = ends[2] * i / 64.0;
        double v = ends[3] * i / 64.0;
        const double border[4][2] = {{u, 0}, {u, ends[3]}, {0, v}, {ends[2], v}};
        for (int side = 0; side < 4; side++) {
            rlf_vec3 ray;
            if (rlf_camera_unproject(k, border[side][0], border[side][1], &ray)) {
                bounds[0] = rlf_min(bounds[0], k->fx * ray.x + k->cx);
                bounds[1] = rlf_min(bounds[1], k->fy * ray.y + k->cy);
                bounds[2] = rlf_max(bounds[2], k->fx * ray.x + k->cx);
                bounds[3] = rlf_max(bounds[3], k->fy * ray.y + k->cy);
            }
        }
    }
}

static void widen(double range[2], double by)
{
    range[0] = rlf_min(range[0], by);
    range[1] = rlf_max(range[1], by);
}

rlf_result registration_make_lens(rlf_registration *r, registration_shift *shift)
{
    const rlf_camera *k = &r->color;
    rlf_kernel_lens *lens = &r->lens;
    double bounds[4] = {0, 0, k->width - 1.0, k->height - 1.0};
    lens_bounds(k, bounds);
    double cell_x = rlf_max(LENS_CELL, (bounds[2] - bounds[0]) / (LENS_KNOT_MAX - 3));
    double cell_y = rlf_max(LENS_CELL, (bounds[3] - bounds[1]) / (LENS_KNOT_MAX - 3));
    lens->columns = (int32_t)((bounds[2] - bounds[0]) / cell_x) + 3;
    lens->rows = (int32_t)((bounds[3] - bounds[1]) / cell_y) + 3;
    lens->left = (float)(bounds[0] - 0.5 * cell_x);
    lens->top = (float)(bounds[1] - 0.5 * cell_y);
    lens->per_pixel_x = (float)(1.0 / cell_x);
    lens->per_pixel_y = (float)(1.0 / cell_y);
    size_t count = (size_t)lens->columns * (size_t)lens->rows;
    lens->du = rlf_alloc_array(count, sizeof(float));
    lens->dv = rlf_alloc_array(count, sizeof(float));
    if (lens->du == NULL || lens->dv == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (size_t i = 0; i < count; i++) {
        double u0 = lens->left + (double)(i % (size_t)lens->columns) * cell_x;
        double v0 = lens->top + (double)(i / (size_t)lens->columns) * cell_y;
        rlf_vec3 ray = {(u0 - k->cx) / k->fx, (v0 - k->cy) / k->fy, 1.0};
        double u, v;
        bool is_inside = rlf_camera_project(k, ray, &u, &v);
        lens->du[i] = is_inside ? (float)(u - u0) : RLF_KERNEL_NOTHING;
        lens->dv[i] = is_inside ? (float)(v - v0) : RLF_KERNEL_NOTHING;
        if (is_inside) {
            widen(shift->u, lens->du[i]);
            widen(shift->v, lens->dv[i]);
        }
    }
    return RLF_OK;
}
