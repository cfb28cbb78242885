/* Where a ball is seen, by the corners of the box around it. */
#include "camera/pixel_rect.h"

/* Of a ball's box: what the lens bends between the corners. */
static const double BALL_MARGIN = 1.05;

bool pixel_rect_of_ball(const rlf_camera *camera, rlf_vec3 center, double radius, pixel_rect *out)
{
    double low[2] = {camera->width, camera->height};
    double high[2] = {-1.0, -1.0};
    double reach = BALL_MARGIN * radius;
    *out = (pixel_rect){0, 0, camera->width, camera->height};
    if (!rlf_vec3_is_finite(center) || !rlf_is_finite(radius) || center.z + radius < 0.0) {
        return false;
    }
    for (int i = 0; i < 8; i++) {
        rlf_vec3 corner = {center.x + ((i & 1) != 0 ? reach : -reach),
                           center.y + ((i & 2) != 0 ? reach : -reach),
                           center.z + ((i & 4) != 0 ? reach : -reach)};
        double u, v;
        if (corner.z < 0.01 || !rlf_camera_project(camera, corner, &u, &v)) {
            return true; /* around the camera or beyond its lens: anywhere */
        }
        low[0] = rlf_min(low[0], u);
        low[1] = rlf_min(low[1], v);
        high[0] = rlf_max(high[0], u);
        high[1] = rlf_max(high[1], v);
    }
    out->x0 = (int32_t)rlf_clamp(low[0] - 1.0, 0.0, camera->width);
    out->y0 = (int32_t)rlf_clamp(low[1] - 1.0, 0.0, camera->height);
    out->x1 = (int32_t)rlf_clamp(high[0] + 2.0, 0.0, camera->width);
    out->y1 = (int32_t)rlf_clamp(high[1] + 2.0, 0.0, camera->height);
    return out->x0 < out->x1 && out->y0 < out->y1;
}
