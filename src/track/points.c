/* Of each 4 x 4 depth pixels the 2 x 2 in the middle, to a point. */
#include "track/tracker.h"

/* Four pixels lie on one surface when their depths are within so many sigma, or within the slope of
 * a surface at a low angle, 80 degrees: so many times a pixel's width there. */
#define SAME_SIGMAS 4.0
#define SAME_SLOPE 5.67

typedef struct block {
    double z[4];
    double sum, least, most;
    double grey;
    int32_t lit;
    bool is_whole;
} block;

static block read_block(const rlf_rig *rig, const rlf_track_view *view, const size_t at[4])
{
    block b = {.least = 1e9, .most = 0.0, .is_whole = true};
    for (int k = 0; k < 4; k++) {
        const double z = (double)view->depth[at[k]];
        const bool is_room = view->is_static == NULL || view->is_static[at[k]] != 0;
        if (!(z >= rig->depth_min_m && z <= rig->depth_max_m) || !is_room) {
            b.is_whole = false;
            return b;
        }
        b.sum += z;
        b.least = rlf_min(b.least, z);
        b.most = rlf_max(b.most, z);
        if (view->grey != NULL && view->grey[at[k]] != 0) {
            b.grey += view->grey[at[k]];
            b.lit++;
        }
    }
    return b;
}

void track_points_row(const track_points *points, const rlf_rig *rig, const float *ray_x,
                      const float *ray_y, const rlf_track_view *view, int32_t row)
{
    const size_t width = (size_t)rig->depth.width;
    const double slope = SAME_SLOPE / rlf_min(rig->depth.fx, rig->depth.fy);
    for (int32_t column = 0; column < points->width; column++) {
        const size_t to = (size_t)row * (size_t)points->width + (size_t)column;
        const size_t first = (4 * (size_t)row + 1) * width + 4 * (size_t)column + 1;
        const size_t at[4] = {first, first + 1, first + width, first + width + 1};
        const block b = read_block(rig, view, at);
        points->z[to] = 0.0f;
        points->grey[to] = 0;
        if (!b.is_whole) {
            continue;
        }
        const double z = 0.25 * b.sum, sigma = rlf_depth_noise_sigma(&rig->noise, z);
        if (b.most - b.least > SAME_SIGMAS * sigma + slope * z) {
            continue;
        }
        double x = 0.0, y = 0.0;
        for (int k = 0; k < 4; k++) {
            x += 0.25 * (double)ray_x[at[k]] * (double)view->depth[at[k]];
            y += 0.25 * (double)ray_y[at[k]] * (double)view->depth[at[k]];
        }
        points->x[to] = (float)x;
        points->y[to] = (float)y;
        points->z[to] = (float)z;
        points->sigma[to] = (float)(0.5 * sigma);
        points->grey[to] = b.lit == 4 ? (uint8_t)(0.25 * b.grey + 0.5) : 0;
    }
}
