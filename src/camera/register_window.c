/* Which columns of the depth grid a part of the picture needs.
 *
 * Depth pixel i lands at u(z) = (z a + ta) / (z c + tc), which differs from a / c, where it lands
 * if it is endlessly far, by (ta - tc a / c) / (z c + tc): the less the farther. So the nearest
 * depth of a frame bounds how far its pixels shift. */
#include "camera/register.h"

#define LEAST_C 0.1   /* what looks away more may land anywhere */
#define ANYWHERE 1e9f /* pixels */
#define ALIGN 16      /* columns */

static double magnitude(double x)
{
    return x < 0.0 ? -x : x;
}

void registration_make_columns(rlf_registration *r, const registration_shift *shift)
{
    const size_t count = (size_t)r->width * (size_t)r->height;
    double size = 1.0;
    r->least_c = 1.0;
    for (int32_t x = 0; x < r->width; x++) {
        r->column_low[x] = ANYWHERE;
        r->column_high[x] = -ANYWHERE;
    }
    for (size_t i = 0; i < count; i++) {
        const size_t x = i % (size_t)r->width;
        const double c = r->c[i];
        const double far_u = r->a[i] / c;
        const bool is_known = c > LEAST_C && rlf_is_finite(far_u);
        const double low = is_known ? far_u + shift->u[0] : -ANYWHERE;
        const double high = is_known ? far_u + shift->u[1] : ANYWHERE;
        const double parallax = magnitude(r->pinhole.ta - r->pinhole.tc * far_u);
        r->column_low[x] = (float)rlf_min(r->column_low[x], low);
        r->column_high[x] = (float)rlf_max(r->column_high[x], high);
        r->least_c = is_known ? rlf_min(r->least_c, c) : r->least_c;
        r->parallax_px_m = is_known ? rlf_max(r->parallax_px_m, parallax) : r->parallax_px_m;
        size = r->size != NULL ? rlf_max(size, r->size[i]) : size;
    }
    r->half_px = size * r->pinhole.half_x;
}

/* Depth in the colour camera of what is `nearest` metres away, at least; 0: it cannot be told. */
static double least_z(const rlf_registration *r, double nearest)
{
    const double z = nearest * r->least_c + r->pinhole.tc;
    return nearest > 0.0 && z > LEAST_C * nearest ? z : 0.0;
}

pixel_rect registration_widen(const rlf_registration *r, const pixel_rect *window, double nearest)
{
    const double z = least_z(r, nearest);
    pixel_rect out = *window;
    if (r->fills_columns) {
        return (pixel_rect){0, 0, r->color.width, r->color.height};
    }
    /* A hole that reaches further than it may be filled is one, wherever it ends. */
    const double hole =
        z > 0.0 ? REGISTRATION_SHADOW * r->shadow_px_m / z + r->gap_px + 2.0 : ANYWHERE;
    out.x0 = (int32_t)rlf_max(window->x0 - hole, 0.0);
    out.x1 = (int32_t)rlf_min(window->x1 + hole, r->color.width);
    return out;
}

void registration_columns(const rlf_registration *r, int32_t x0, int32_t x1, double nearest,
                          int32_t out[2])
{
    const double z = least_z(r, nearest);
    out[0] = 0;
    out[1] = r->width;
    if (!(z > 0.0)) {
        return;
    }
    const double reach =
        r->parallax_px_m / z + r->half_px * rlf_max(1.0 / r->least_c, nearest / z) + 1.0;
    while (out[0] < out[1] && r->column_high[out[0]] + reach < x0) {
        out[0]++;
    }
    while (out[0] < out[1] && r->column_low[out[1] - 1] - reach > x1) {
        out[1]--;
    }
    out[0] -= out[0] % ALIGN;
}
