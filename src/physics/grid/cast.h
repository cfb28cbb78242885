/* Contacts of a point that moves with the solid that one sheet of the organised grid describes.
 *
 * All coordinates are in the grid's frame. */
#ifndef RLF_PHYSICS_GRID_CAST_H
#define RLF_PHYSICS_GRID_CAST_H

#include "physics/grid/field.h"

/* A place to touch: `normal` points out of the solid, separation = normal.(query - point). */
typedef struct field_hit {
    rlf_vec3 point, normal, velocity;
    double separation;
    int32_t label;
} field_hit;

/* Where the body is that a point is of. */
typedef struct field_side {
    field_state state; /* of the sheet that it belongs to; FIELD_INSIDE: the solid swept over it */
    rlf_vec3 centre;   /* while state is FIELD_NONE and has_centre: there is nothing on its ray */
    bool has_centre;
} field_side;

/* First contact of a point that moves from q by `path`: within `margin` of the surface at q, inside
 * the solid, or entering it on the way. The separation is that of q. False when it stays free.
 * A point inside a solid leaves it towards its body's side, not through the other face: on the
 * own side; from FIELD_NONE by the shortest way, of the sides of a thin solid by one that looks
 * to the body's centre; from FIELD_INSIDE through the front even from behind; never through a back
 * that leaves no room before the background. */
bool grid_cast(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q, rlf_vec3 path,
               double margin, const field_side *side, field_hit *out);

#endif
