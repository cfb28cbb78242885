/* Pixels of a sheet that are read side by side, so that their ways from memory overlap: each of
 * them is in seven places far apart. */
#ifndef RLF_PHYSICS_GRID_PIXELS_H
#define RLF_PHYSICS_GRID_PIXELS_H

#include "relief/world.h"

#define GRID_PIXELS_MAX 64

typedef struct grid_pixels {
    int32_t count;
    int32_t x[GRID_PIXELS_MAX], y[GRID_PIXELS_MAX];
    float point[3][GRID_PIXELS_MAX], normal[3][GRID_PIXELS_MAX]; /* grid frame, m */
} grid_pixels;

/* Fills in points and normals of pixels x, y, which are in the image. */
void grid_pixels_read(grid_pixels *pixels, const rlf_grid *grid, const rlf_grid_sheet *sheet);

/* Drops the pixels whose solid, of a thickness in metres that is a guess (see grid_cell_inward), is
 * farther than `reach` from p; of those at the border some stay. */
void grid_pixels_keep_near(grid_pixels *pixels, rlf_vec3 p, double thickness, double reach);

#endif
