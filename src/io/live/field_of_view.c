/* A lens model from fields of view. */
#include "io/live/driver.h"

/* Horizontal focal length over width of PrimeSense cameras: 58.5 degrees (Kinect v1, Xtion). */
#define FOCAL_TYPICAL 0.9

static bool is_angle(double radians)
{
    return radians > 0.1 && radians < 3.0;
}

bool io_camera_from_fov(int32_t width, int32_t height, double fov_x, double fov_y, rlf_camera *out)
{
    const double w = width;
    const double h = height;
    *out = (rlf_camera){.width = width,
                        .height = height,
                        .fx = FOCAL_TYPICAL * w,
                        .fy = FOCAL_TYPICAL * w,
                        .cx = 0.5 * (w - 1.0),
                        .cy = 0.5 * (h - 1.0)};
    if (!is_angle(fov_x) || !is_angle(fov_y)) {
        return false;
    }
    out->fx = 0.5 * w * rlf_cos(0.5 * fov_x) / rlf_sin(0.5 * fov_x);
    out->fy = 0.5 * h * rlf_cos(0.5 * fov_y) / rlf_sin(0.5 * fov_y);
    return true;
}
