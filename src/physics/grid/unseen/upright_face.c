/* Search for an upright face above a hidden place. */
#include "physics/grid/unseen/room_planes.h"
#include "physics/grid/field.h"

#define HIGHEST_M 2.5               /* above the place that is searched: a room's height */
#define DEEPEST_M (2 * GRID_THIN_M) /* a place farther behind a face came there another way */
#define BEFORE_M                                                                                   \
    (3 * GRID_THIN_M) /* what hides a face stands this far before it, else it ends it */
#define TRIES 6       /* pixels in sight, of which the first may be mixed */
#define SLANT 0.1     /* m of error of a face's plane per metre along it */

/* Square to `up`, and before q or just behind it. */
static bool is_upright(const field_cell *cell, rlf_vec3 q, rlf_vec3 up, double reach)
{
    double slope = rlf_dot(cell->normal, up);
    double height = rlf_dot(cell->normal, rlf_sub(q, cell->point));
    return slope < ASIDE_COS && slope > -ASIDE_COS && height > -DEEPEST_M && height < reach;
}

/* Whether the camera sees past the face's plane at r's foot on it: the face ends before that, as
 * the side of a column does, and a wall does not. */
static bool is_past_end(const rlf_grid *grid, const field_cell *face, rlf_vec3 r)
{
    rlf_vec3 way = rlf_sub(r, face->point);
    rlf_vec3 foot = rlf_mad(r, face->normal, -rlf_dot(face->normal, way));
    double off = SLANT * rlf_length(rlf_sub(foot, face->point));
    foot = rlf_scale(foot, 1.0 + off / foot.z);
    return grid_field_is_seen_through(grid, &grid->background, foot);
}

bool upright_face_find(const rlf_grid *grid, rlf_vec3 q, rlf_vec3 up, double reach, room_plane *out)
{
    double pixel = rlf_max(q.z * grid->pixel_angle, 0.002), hidden_by = q.z;
    int32_t tries = 0;
    for (double above = 0.0; above < HIGHEST_M && tries < TRIES; above += pixel) {
        field_cell cell;
        rlf_vec3 r = rlf_mad(q, up, above);
        int32_t x, y;
        if (!grid_pixel_of(grid, r, &x, &y)) {
            return false;
        }
        if (!grid_cell_read(grid, &grid->background, x, y, &cell)) {
            continue;
        }
        if (cell.point.z < r.z - DEEPEST_M) {
            hidden_by = cell.point.z;
            tries = 0;
        } else if (cell.point.z > hidden_by + BEFORE_M && is_upright(&cell, q, up, reach) &&
                   !is_past_end(grid, &cell, r)) {
            *out = (room_plane){cell.normal, rlf_dot(cell.normal, cell.point)};
            return true;
        } else {
            tries++;
        }
    }
    return false;
}
