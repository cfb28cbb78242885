/* Boxes and rays. */
#include "surface/thin/slab.h"

slab_view slab_look(const slab *s)
{
    slab_view view = {.centre = s->pose.p};
    for (int k = 0; k < 3; k++) {
        view.axis[k] = rlf_rotate(s->pose.q, rlf_vec3_make(k == 0, k == 1, k == 2));
        view.half[k] = s->half[k];
    }
    return view;
}

slab_point slab_local(const slab_view *view, rlf_vec3 p)
{
    const rlf_vec3 d = rlf_sub(p, view->centre);
    slab_point at = {.square = 0.0};
    for (int k = 0; k < 3; k++) {
        at.q[k] = rlf_dot(d, view->axis[k]);
        at.beyond[k] = rlf_max((at.q[k] < 0.0 ? -at.q[k] : at.q[k]) - view->half[k], 0.0);
        at.square += at.beyond[k] * at.beyond[k];
    }
    return at;
}

bool slab_cut_ray(const slab_view *view, double x, double y, double *enter, double *leave)
{
    const double parallel = 1e-9, far_m = 1e9;
    const rlf_vec3 ray = rlf_vec3_make(x, y, 1.0);
    *enter = THIN_LEAST_Z;
    *leave = far_m;
    for (int k = 0; k < 3; k++) {
        double along = rlf_dot(ray, view->axis[k]), from = rlf_dot(view->centre, view->axis[k]);
        double half = along > 0.0 ? view->half[k] : -view->half[k];
        if (along < parallel && along > -parallel) {
            if (from > view->half[k] || from < -view->half[k]) {
                return false;
            }
            continue;
        }
        *enter = rlf_max(*enter, (from - half) / along);
        *leave = rlf_min(*leave, (from + half) / along);
    }
    return *enter > THIN_LEAST_Z && *enter < *leave;
}

bool slab_is_near(const slab_view *view, rlf_vec3 p, double metres)
{
    return slab_local(view, p).square < metres * metres;
}

rlf_rect slab_window(const image_grid *grid, const slab_view *view, int32_t margin)
{
    const rlf_rect none = {0, 0, 0, 0};
    double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
    for (int corner = 0; corner < 8; corner++) {
        rlf_vec3 p = view->centre;
        for (int k = 0; k < 3; k++) {
            p = rlf_mad(p, view->axis[k], (corner >> k & 1) != 0 ? view->half[k] : -view->half[k]);
        }
        double at[2];
        if (p.z < THIN_LEAST_Z || !rlf_camera_project(&grid->camera, p, &at[0], &at[1])) {
            return none;
        }
        for (int c = 0; c < 2; c++) {
            low[c] = rlf_min(low[c], at[c]);
            high[c] = rlf_max(high[c], at[c]);
        }
    }
    double x0 = rlf_clamp(low[0] - margin, 0.0, grid->width);
    double y0 = rlf_clamp(low[1] - margin, 0.0, grid->height);
    double x1 = rlf_clamp(high[0] + margin + 1.0, 0.0, grid->width);
    double y1 = rlf_clamp(high[1] + margin + 1.0, 0.0, grid->height);
    return (rlf_rect){(int32_t)x0, (int32_t)y0, (int32_t)x1, (int32_t)y1};
}

int32_t slab_stride(const rlf_rect *window, int32_t most)
{
    int32_t area = (window->x1 - window->x0) * (window->y1 - window->y0), stride = 1;
    while (area > most * stride * stride) {
        stride++;
    }
    return stride;
}
