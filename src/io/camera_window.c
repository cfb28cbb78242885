/* Windows and binning of a camera's picture. */
#include "io/camera_json.h"

/* One direction. Centres of pixels are whole numbers, so the first pixel of n joined ones begins at
 * -0.5 and their common centre is at (n - 1) / 2. */
static bool cut(uint32_t begin, uint32_t length, uint32_t binning, int32_t *size, double *focal,
                double *centre)
{
    const uint32_t whole = *size > 0 ? (uint32_t)*size : 0;
    const uint32_t kept = length > 0 ? length : whole;
    const uint32_t joined = binning > 0 ? binning : 1;
    if (begin > whole || kept > whole - begin || kept / joined == 0) {
        return false;
    }
    *size = (int32_t)(kept / joined);
    if (joined > 1 || begin > 0) {
        *focal /= joined;
        *centre = (*centre - begin + 0.5) / joined - 0.5;
    }
    return true;
}

bool io_camera_window_apply(const io_camera_window *window, rlf_camera *camera)
{
    const bool is_part = window->width > 0 || window->height > 0;
    const uint32_t x = is_part ? window->x : 0;
    const uint32_t y = is_part ? window->y : 0;
    rlf_camera c = *camera;
    if (!cut(x, window->width, window->binning_x, &c.width, &c.fx, &c.cx) ||
        !cut(y, window->height, window->binning_y, &c.height, &c.fy, &c.cy)) {
        return false;
    }
    *camera = c;
    return true;
}
