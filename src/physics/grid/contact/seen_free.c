/* Free space that a camera sees: what another one guesses there is not there. */
#include "physics/grid/cast.h"
#include "physics/grid/contact/contact.h"

/* Surfaces of two cameras lie on each other up to their noise and to the error of their poses; and
 * what moves is seen by each at its own time, up to a frame apart. */
#define BEHIND_M 0.02
#define FRAME_S 0.034

/* Depth of what the camera sees at a pixel, metres; 0 = nothing. */
static double depth_at(const rlf_grid *grid, int32_t x, int32_t y)
{
    const ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
    const rlf_grid_sheet *front = &grid->foreground, *back = &grid->background;
    if (front->depth != NULL && front->mask != NULL && front->mask[i] != 0) {
        return front->depth[i];
    }
    return back->depth != NULL ? back->depth[i] : 0.0;
}

/* Whether all that the camera shows at the place and beside it is clearly farther. */
static bool sees_past(const grid_query *query, rlf_vec3 place, double behind)
{
    const rlf_grid *grid = query->grid;
    const rlf_vec3 p = rlf_transform(&query->T_grid_world, place);
    int32_t x, y;
    if (!(p.z > 0.0) || !grid_pixel_of(grid, p, &x, &y) || x < 1 || y < 1 || x + 1 >= grid->width ||
        y + 1 >= grid->height) {
        return false;
    }
    for (int32_t k = 0; k < 9; k++) {
        if (!(depth_at(grid, x + k % 3 - 1, y + k / 3 - 1) > p.z + behind)) {
            return false;
        }
    }
    return true;
}

bool grid_is_seen_free(const grid_query *query, rlf_vec3 place, rlf_vec3 velocity)
{
    const double behind = BEHIND_M + FRAME_S * rlf_length(velocity);
    const grid_query *first = query->first;
    if (first == NULL || first->next == NULL) {
        return false; /* one camera sees nothing behind what it guesses */
    }
    for (const grid_query *one = first; one != NULL; one = one->next) {
        if (sees_past(one, place, behind)) {
            return true;
        }
    }
    return false;
}
