/* The rays of the kept pixels: eq. 4.1 without the factor z, undistorted, once per source. */
#include "surface/stage.h"

void image_grid_fill_rays(const image_grid *grid, float *ray_x, float *ray_y, uint8_t *has_ray)
{
    for (int32_t y = 0; y < grid->height; y++) {
        for (int32_t x = 0; x < grid->width; x++) {
            int32_t i = y * grid->width + x;
            rlf_vec3 ray;
            bool inside = rlf_camera_unproject(&grid->camera, x, y, &ray);
            has_ray[i] = inside;
            ray_x[i] = inside ? (float)ray.x : 0.0f;
            ray_y[i] = inside ? (float)ray.y : 0.0f;
        }
    }
}
