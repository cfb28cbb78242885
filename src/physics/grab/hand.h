/* What follow.c and learn.c share: where a hand ends in the picture. */
#ifndef RLF_PHYSICS_GRAB_HAND_H
#define RLF_PHYSICS_GRAB_HAND_H

#include "physics/grab/grab.h"
#include "physics/grid/contact/search.h"

/* A step in depth beyond which the next pixel is another thing, metres. */
#define GRAB_STEP_M (2.0 * GRID_NOISE_M)

/* Whether the foreground is at pixel (x, y) and the next one, dx and dy away, is none of it or far
 * behind: the outline of what is nearer. */
static inline bool grab_is_rim(const rlf_grid *grid, int32_t x, int32_t y, int32_t dx, int32_t dy)
{
    const rlf_grid_sheet *sheet = &grid->foreground;
    int32_t nx = x + dx, ny = y + dy;
    if (x < 0 || y < 0 || x >= grid->width || y >= grid->height || nx < 0 || ny < 0 ||
        nx >= grid->width || ny >= grid->height) {
        return false;
    }
    int32_t i = y * grid->width + x, k = ny * grid->width + nx;
    bool is_here = (sheet->mask == NULL || sheet->mask[i] != 0) && sheet->depth[i] > 0.0f;
    bool is_next = (sheet->mask == NULL || sheet->mask[k] != 0) && sheet->depth[k] > 0.0f;
    return is_here && (!is_next || (double)sheet->depth[k] > (double)sheet->depth[i] + GRAB_STEP_M);
}

#endif
