/* Boxes and rays. */
#include "surface/plate/plate.h"

static const double least_z = 0.1;

rlf_plate_view rlf_plate_look(const rlf_plate *plate)
{
    rlf_plate_view view = {.centre = plate->pose.p};
    for (int k = 0; k < 3; k++) {
        view.axis[k] = rlf_rotate(plate->pose.q, rlf_vec3_make(k == 0, k == 1, k == 2));
        view.half[k] = plate->half[k];
    }
    return view;
}

rlf_vec3 rlf_plate_local(const rlf_plate_view *view, rlf_vec3 p)
{
    rlf_vec3 d = rlf_sub(p, view->centre);
    return rlf_vec3_make(rlf_dot(d, view->axis[0]), rlf_dot(d, view->axis[1]),
                         rlf_dot(d, view->axis[2]));
}

bool rlf_plate_cut_ray(const rlf_plate_view *view, double x, double y, rlf_plate_cut *out)
{
    const double parallel = 1e-9;
    rlf_vec3 ray = rlf_vec3_make(x, y, 1.0);
    *out = (rlf_plate_cut){.enter = least_z, .leave = 1e9, .face = -1};
    for (int k = 0; k < 3; k++) {
        double along = rlf_dot(ray, view->axis[k]), from = rlf_dot(view->centre, view->axis[k]);
        double sign = along > 0.0 ? -1.0 : 1.0;
        if (along < parallel && along > -parallel) {
            if (from > view->half[k] || from < -view->half[k]) {
                return false;
            }
            continue;
        }
        double enter = (from + sign * view->half[k]) / along;
        double leave = (from - sign * view->half[k]) / along;
        if (enter > out->enter) {
            out->enter = enter;
            out->face = k;
            out->sign = sign;
        }
        out->leave = leave < out->leave ? leave : out->leave;
    }
    return out->face >= 0 && out->enter < out->leave;
}

bool rlf_plate_is_near(const rlf_plate_view *view, rlf_vec3 p, double metres)
{
    rlf_vec3 local = rlf_plate_local(view, p);
    const double q[3] = {local.x, local.y, local.z};
    double square = 0.0;
    for (int k = 0; k < 3; k++) {
        double beyond = rlf_max((q[k] < 0.0 ? -q[k] : q[k]) - view->half[k], 0.0);
        square += beyond * beyond;
    }
    return square < metres * metres;
}

rlf_plate_window rlf_plate_window_of(const rlf_grid *grid, const rlf_plate_view *view,
                                     int32_t margin)
{
    const rlf_plate_window none = {0, 0, 0, 0};
    double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
    for (int corner = 0; corner < 8; corner++) {
        rlf_vec3 p = view->centre;
        for (int k = 0; k < 3; k++) {
            p = rlf_mad(p, view->axis[k], (corner >> k & 1) != 0 ? view->half[k] : -view->half[k]);
        }
        double at[2];
        if (p.z < least_z || !rlf_camera_project(&grid->camera, p, &at[0], &at[1])) {
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
    return (rlf_plate_window){(int32_t)x0, (int32_t)y0, (int32_t)x1, (int32_t)y1};
}

int32_t rlf_plate_stride(const rlf_plate_window *window, int32_t most)
{
    int32_t area = (window->x1 - window->x0) * (window->y1 - window->y0), stride = 1;
    while (area > most * stride * stride) {
        stride++;
    }
    return stride;
}
