/* Search for an upright face above a hidden place. */
#include "physics/grid/upright.h"
#include "physics/grid/field.h"

#define HIGHEST 2.5 /* metres above the place that are searched */
#define UPRIGHT 0.2 /* sine of the angle between an upright face and the vertical */
#define DEEPEST 0.1 /* a place farther behind a face than this came there another way, metres */
#define STEP 0.15   /* what hides a face stands this far before it: else the face ends on it */
#define TRIES 6     /* pixels in sight, of which the first may be mixed */

static bool is_upright_face(const field_cell *cell, rlf_vec3 q, rlf_vec3 up, double reach)
{
    double slope = rlf_dot(cell->normal, up);
    double height = rlf_dot(cell->normal, rlf_sub(q, cell->point));
    return slope < UPRIGHT && slope > -UPRIGHT && height > -DEEPEST && height < reach;
}

/* Whether the camera sees past the face's plane at r's foot on it: the face ends before that, as
 * the side of a column does, and a wall does not. */
static bool is_past_end(const rlf_grid *grid, const field_cell *face, rlf_vec3 r)
{
    const double SLANT = 0.1; /* m of error of the plane per metre along it */
    rlf_vec3 way = rlf_sub(r, face->point);
    rlf_vec3 foot = rlf_mad(r, face->normal, -rlf_dot(face->normal, way));
    double off = SLANT * rlf_length(rlf_sub(foot, face->point));
    foot = rlf_scale(foot, 1.0 + off / foot.z);
    return grid_field_is_seen_through(grid, &grid->background, foot);
}

bool grid_upright_find(const rlf_grid *grid, rlf_vec3 q, rlf_vec3 up, double reach,
                       shell_plane *out)
{
    double pixel = rlf_max(q.z * grid->pixel_angle, 0.002), hidden_by = q.z;
    int32_t tries = 0;
    for (double above = 0.0; above < HIGHEST && tries < TRIES; above += pixel) {
        field_cell cell;
        rlf_vec3 r = rlf_mad(q, up, above);
        int32_t x, y;
        if (!grid_pixel_of(grid, r, &x, &y)) {
            return false;
        }
        if (!grid_cell_read(grid, &grid->background, x, y, &cell)) {
            continue;
        }
        if (cell.point.z < r.z - DEEPEST) {
            hidden_by = cell.point.z;
            tries = 0;
        } else if (cell.point.z > hidden_by + STEP && is_upright_face(&cell, q, up, reach) &&
                   !is_past_end(grid, &cell, r)) {
            *out = (shell_plane){cell.normal, rlf_dot(cell.normal, cell.point)};
            return true;
        } else {
            tries++;
        }
    }
    return false;
}
