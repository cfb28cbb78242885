/* Depth seen from the colour camera: what is worked out once for a pair of cameras. */
#include "camera/register.h"

#include <string.h>

#define SPLAT_MAX 48.0 /* pixels: half the widest rectangle */
#define NEAREST_M 0.02 /* rows are left out for what they show from here on */

static double magnitude(double x)
{
    return x < 0.0 ? -x : x;
}

/* Tables of the pinhole part: K_color [R | t] applied to each ray. */
static void fill_tables(rlf_registration *r, const float *ray_x, const float *ray_y,
                        const rlf_pose *T)
{
    const rlf_camera *k = &r->color;
    size_t count = (size_t)r->width * (size_t)r->height;
    for (size_t i = 0; i < count; i++) {
        rlf_vec3 d = rlf_rotate(T->q, rlf_vec3_make(ray_x[i], ray_y[i], 1.0));
        r->a[i] = (float)(k->fx * d.x + k->cx * d.z);
        r->b[i] = (float)(k->fy * d.y + k->cy * d.z);
        r->c[i] = (float)d.z;
    }
    r->pinhole.ta = (float)(k->fx * T->p.x + k->cx * T->p.z);
    r->pinhole.tb = (float)(k->fy * T->p.y + k->cy * T->p.z);
    r->pinhole.tc = (float)T->p.z;
    r->pinhole.width = (float)k->width;
    r->pinhole.height = (float)k->height;
}

/* From a row of a table to the next: 0 where all are the first to the bit. */
static ptrdiff_t step_of_rows(const rlf_registration *r, const float *table)
{
    const size_t bytes = (size_t)r->width * sizeof(*table);
    for (int32_t y = 1; y < r->height; y++) {
        if (memcmp(table, table + (ptrdiff_t)y * r->width, bytes) != 0) {
            return r->width;
        }
    }
    return 0;
}

/* Size of the rectangles and how wide a hole may be to be filled. */
static void measure(rlf_registration *r, const rlf_camera *depth, const rlf_pose *T)
{
    rlf_mat3 R = rlf_quat_to_mat3(T->q);
    const rlf_camera *k = &r->color;
    double width = k->fx * (magnitude(R.m[0][0]) / depth->fx + magnitude(R.m[0][1]) / depth->fy);
    double height = k->fy * (magnitude(R.m[1][0]) / depth->fx + magnitude(R.m[1][1]) / depth->fy);
    r->pinhole.half_x = (float)rlf_min(0.5 * width, SPLAT_MAX);
    r->pinhole.half_y = (float)rlf_min(0.5 * height, SPLAT_MAX);
    double shift_x = magnitude(k->fx * T->p.x);
    double shift_y = magnitude(k->fy * T->p.y);
    r->fills_columns = shift_y > shift_x;
    r->shadow_px_m = (float)rlf_max(shift_x, shift_y);
    double along = rlf_min(r->fills_columns ? height : width, RLF_IMAGE_SIZE_MAX);
    r->gap_px = along > 1.0 + 1e-6 ? 2 * (int32_t)(along + 0.999) : 0;
}

/* Rows of the picture that a row of the grid reaches, whatever its depths are. v(z) is a ratio of
 * linear functions and so lies between its values at both ends; a lens moves it by shift[0] to
 * shift[1]. */
static void mark_row(rlf_registration *r, const double shift[2], int32_t y)
{
    const double far_off = 1e9;
    double top = far_off;
    double bottom = -far_off;
    for (int32_t x = 0; x < r->width; x++) {
        size_t i = (size_t)y * (size_t)r->width + (size_t)x;
        double near_z = NEAREST_M * r->c[i] + r->pinhole.tc;
        double near_v = (NEAREST_M * r->b[i] + r->pinhole.tb) / near_z;
        double far_v = (double)r->b[i] / r->c[i];
        double size = r->size != NULL ? r->size[i] : 1.0;
        double half = size * r->pinhole.half_y * rlf_max(1.0 / r->c[i], NEAREST_M / near_z);
        bool is_known = r->c[i] > 0.1f && near_z > 0.1 * NEAREST_M;
        top = is_known ? rlf_min(top, rlf_min(near_v, far_v) - half) : -far_off;
        bottom = is_known ? rlf_max(bottom, rlf_max(near_v, far_v) + half) : far_off;
        if (!is_known) {
            break;
        }
    }
    r->row_top[y] = (float)(top + shift[0] - 1.0);
    r->row_bottom[y] = (float)(bottom + shift[1] + 1.0);
}

static void mark_rows(rlf_registration *r, const double shift[2])
{
    double next = r->color.height;
    for (int32_t y = r->height - 1; y >= 0; y--) {
        mark_row(r, shift, y);
        r->done[y] = (int32_t)next;
        next = rlf_clamp((double)r->row_top[y], 0.0, next);
    }
}

static rlf_result allocate(rlf_registration *r)
{
    size_t count = (size_t)r->width * (size_t)r->height;
    size_t width = (size_t)r->width;
    r->a = rlf_alloc_array(count, sizeof(*r->a));
    r->b = rlf_alloc_array(count, sizeof(*r->b));
    r->c = rlf_alloc_array(count, sizeof(*r->c));
    r->row_top = rlf_alloc_array((size_t)r->height, sizeof(*r->row_top));
    r->row_bottom = rlf_alloc_array((size_t)r->height, sizeof(*r->row_bottom));
    r->done = rlf_alloc_array((size_t)r->height, sizeof(*r->done));
    r->column_low = rlf_alloc_array(width, sizeof(*r->column_low));
    r->column_high = rlf_alloc_array(width, sizeof(*r->column_high));
    r->line = rlf_alloc_array((size_t)r->color.width, sizeof(*r->line));
    float **floats[4] = {&r->points.u, &r->points.v, &r->points.scale, &r->points.z};
    int32_t **integers[4] = {&r->row.x0, &r->row.x1, &r->row.y, &r->row.y0};
    bool has_all = r->a != NULL && r->b != NULL && r->c != NULL && r->row_top != NULL &&
                   r->row_bottom != NULL && r->done != NULL && r->column_low != NULL &&
                   r->column_high != NULL && r->line != NULL;
    for (int i = 0; i < 4; i++) {
        *floats[i] = rlf_alloc_array(width, sizeof(float));
        *integers[i] = rlf_alloc_array(width, sizeof(int32_t));
        has_all = has_all && *floats[i] != NULL && *integers[i] != NULL;
    }
    for (int32_t i = 0; has_all && i < r->color.width; i++) {
        r->line[i] = RLF_KERNEL_NOTHING;
    }
    return has_all ? RLF_OK : RLF_ERROR_MEMORY;
}

rlf_result rlf_registration_create(const rlf_camera *depth, const float *ray_x, const float *ray_y,
                                   const rlf_camera *color, const rlf_pose *T_color_depth,
                                   rlf_registration **out)
{
    if (!RLF_ASSERT(depth != NULL && ray_x != NULL && ray_y != NULL && color != NULL &&
                    T_color_depth != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    rlf_result result = rlf_camera_check(depth, "registration: depth camera");
    if (result == RLF_OK) {
        result = rlf_camera_check(color, "registration: colour camera");
    }
    if (result != RLF_OK) {
        return result;
    }
    rlf_pose T = {T_color_depth->p, rlf_quat_normalize(T_color_depth->q)};
    if (!rlf_vec3_is_finite(T.p)) {
        return rlf_fail(RLF_ERROR_INVALID, "registration: depth_to_color is not finite; calibrate");
    }
    rlf_registration *r = rlf_alloc(sizeof(*r));
    if (r == NULL) {
        return RLF_ERROR_MEMORY;
    }
    r->width = depth->width;
    r->height = depth->height;
    r->color = *color;
    registration_shift shift = {{0.0, 0.0}, {0.0, 0.0}};
    result = allocate(r);
    if (result == RLF_OK && color->distortion_model != RLF_DISTORTION_NONE) {
        result = registration_make_lens(r, &shift);
    }
    if (result != RLF_OK) {
        rlf_registration_destroy(&r);
        return result;
    }
    fill_tables(r, ray_x, ray_y, &T);
    r->row_a = step_of_rows(r, r->a);
    r->row_c = step_of_rows(r, r->c);
    measure(r, depth, &T);
    result = registration_make_sizes(r);
    if (result != RLF_OK) {
        rlf_registration_destroy(&r);
        return result;
    }
    mark_rows(r, shift.v);
    registration_make_columns(r, &shift);
    *out = r;
    return RLF_OK;
}

void rlf_registration_destroy(rlf_registration **registration)
{
    if (registration == NULL || *registration == NULL) {
        return;
    }
    rlf_registration *r = *registration;
    void *parts[20] = {r->a,        r->b,          r->c,        r->row_top,      r->line,
                       r->points.u, r->points.v,   r->points.z, r->points.scale, r->row.x0,
                       r->row.x1,   r->row.y,      r->row.y0,   r->lens.du,      r->lens.dv,
                       r->size,     r->row_bottom, r->done,     r->column_low,   r->column_high};
    for (int i = 0; i < 20; i++) {
        rlf_free(parts[i]);
    }
    rlf_free(r);
    *registration = NULL;
}
