/* Of each 4 x 4 depth pixels the 2 x 2 in the middle, to a point. */
#include "track/tracker.h"

/* Four pixels lie on one surface when their depths are within so many sigma, or within the slope of
 * a surface at a low angle, 80 degrees: so many times a pixel's width there. */
#define SAME_SIGMAS 4.0
#define SAME_SLOPE 5.67

void track_points_row(const track_points *points, const rlf_rig *rig, const float *ray_x,
                      const float *ray_y, const rlf_track_view *view, int32_t row)
{
    const size_t width = (size_t)rig->depth.width;
    const double slope = SAME_SLOPE / rlf_min(rig->depth.fx, rig->depth.fy);
    for (int32_t column = 0; column < points->width; column++) {
        const size_t to = (size_t)row * (size_t)points->width + (size_t)column;
        const size_t first = (4 * (size_t)row + 1) * width + 4 * (size_t)column + 1;
        const size_t at[4] = {first, first + 1, first + width, first + width + 1};
        double x = 0.0, y = 0.0, z = 0.0, grey = 0.0, least = 1e9, most = 0.0;
        bool is_whole = true, is_lit = view->grey != NULL;
        for (int k = 0; k < 4; k++) {
            const double depth = (double)view->depth[at[k]];
            const bool is_room = view->is_static == NULL || view->is_static[at[k]] != 0;
            is_whole =
                is_whole && is_room && depth >= rig->depth_min_m && depth <= rig->depth_max_m;
            x += 0.25 * (double)ray_x[at[k]] * depth;
            y += 0.25 * (double)ray_y[at[k]] * depth;
            z += 0.25 * depth;
            least = rlf_min(least, depth);
            most = rlf_max(most, depth);
            is_lit = is_lit && view->grey[at[k]] != 0;
            grey += is_lit ? 0.25 * view->grey[at[k]] : 0.0;
        }
        const double sigma = rlf_depth_noise_sigma(&rig->noise, z);
        const bool is_one = is_whole && most - least <= SAME_SIGMAS * sigma + slope * z;
        points->x[to] = is_one ? (float)x : 0.0f;
        points->y[to] = is_one ? (float)y : 0.0f;
        points->z[to] = is_one ? (float)z : 0.0f;
        points->sigma[to] = is_one ? (float)(0.5 * sigma) : 0.0f;
        points->grey[to] = is_one && is_lit ? (uint8_t)(grey + 0.5) : 0;
    }
}
