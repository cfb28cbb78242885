/* Reading pixels side by side. */
#include "physics/grid/contact/pixels.h"

/* Far more than floats of some metres are rounded by: a share, and m^2. */
#define ROUNDING 1e-4
#define ROUNDING_2 1e-5

void grid_pixels_read(grid_pixels *pixels, const rlf_grid *grid, const rlf_grid_sheet *sheet)
{
    for (int32_t k = 0; k < pixels->count; k++) {
        int32_t i = pixels->y[k] * grid->width + pixels->x[k];
        float z = sheet->depth[i];
        pixels->point[0][k] = z * grid->ray_x[i];
        pixels->point[1][k] = z * grid->ray_y[i];
        pixels->point[2][k] = z;
        pixels->normal[0][k] = sheet->normal_x[i];
        pixels->normal[1][k] = sheet->normal_y[i];
        pixels->normal[2][k] = sheet->normal_z[i];
    }
}

/* Squares of the distances from p to the solids. */
static void measure(const grid_pixels *pixels, rlf_vec3 p, float thickness, float *distance2)
{
    const float at[3] = {(float)p.x, (float)p.y, (float)p.z};
    for (int32_t k = 0; k < pixels->count; k++) {
        float px = pixels->point[0][k], py = pixels->point[1][k], pz = pixels->point[2][k];
        float nx = pixels->normal[0][k], ny = pixels->normal[1][k], nz = pixels->normal[2][k];
        float dx = at[0] - px, dy = at[1] - py, dz = at[2] - pz, scale = 1.0f / pz;
        float facing = (nx * px + ny * py + nz * pz) * scale;
        bool is_along = facing > -0.02f; /* as in grid_cell_inward */
        float ix = is_along ? px * scale : nx * facing;
        float iy = is_along ? py * scale : ny * facing;
        float iz = is_along ? 1.0f : nz * facing;
        float level = (dx * ix + dy * iy + dz * iz) / (ix * ix + iy * iy + iz * iz);
        level = level > 0.0f ? level : 0.0f;
        level = level < thickness ? level : thickness;
        dx -= ix * level;
        dy -= iy * level;
        dz -= iz * level;
        bool is_sure = facing > -0.0199f || facing < -0.0201f;
        distance2[k] = is_sure ? dx * dx + dy * dy + dz * dz : 0.0f;
    }
}

void grid_pixels_keep_near(grid_pixels *pixels, rlf_vec3 p, double thickness, double reach)
{
    float distance2[GRID_PIXELS_MAX];
    float limit = (float)(reach * reach * (1.0 + ROUNDING) + ROUNDING_2);
    int32_t kept = 0;
    measure(pixels, p, (float)thickness, distance2);
    for (int32_t k = 0; k < pixels->count; k++) {
        if (!(distance2[k] > limit)) {
            pixels->x[kept] = pixels->x[k];
            pixels->y[kept++] = pixels->y[k];
        }
    }
    pixels->count = kept;
}
