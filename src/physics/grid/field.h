/* The solid that one sheet of the organised grid describes, asked point by point.
 *
 * Along a pixel's ray the sheet is solid from its depth to depth + thickness; where its thickness
 * is a guess, only under what is seen of its faces. All coordinates are in the grid's frame. Where
 * a pixel has no depth there is nothing: holes are neither walls nor traps.
 */
#ifndef RLF_PHYSICS_GRID_FIELD_H
#define RLF_PHYSICS_GRID_FIELD_H

#include "relief/world.h"

/* Thickness of a solid that never ends, metres. */
#define FIELD_ENDLESS 1e9

typedef enum field_state {
    FIELD_NONE = 0, /* no surface on this ray, or out of view */
    FIELD_FRONT,    /* in free space before the sheet */
    FIELD_INSIDE,
    FIELD_BEHIND /* beyond its back */
} field_state;

/* One pixel of a sheet. */
typedef struct field_cell {
    int32_t x, y;
    int32_t label;
    rlf_vec3 point, normal, velocity;
    double thickness; /* metres along z, or FIELD_ENDLESS; of a guess square to the face */
    bool is_guess;    /* nobody has measured how thick it is */
    double back;      /* z of the back on the query's ray */
} field_cell;

/* A place to touch: `normal` points out of the solid, separation = normal.(query - point). */
typedef struct field_hit {
    rlf_vec3 point, normal, velocity;
    double separation;
    int32_t label;
} field_hit;

/* Where the body is that a point is of. */
typedef struct field_home {
    field_state side; /* of the sheet that it belongs to; FIELD_INSIDE: the solid swept over it */
    rlf_vec3 centre;  /* while side is FIELD_NONE and has_centre: there is nothing on its ray */
    bool has_centre;
} field_home;

/* Reads pixel (x, y); false when the sheet has no surface there. */
bool grid_cell_read(const rlf_grid *grid, const rlf_grid_sheet *sheet, int32_t x, int32_t y,
                    field_cell *out);

/* Where q stands to the sheet; *out is set unless FIELD_NONE. */
field_state grid_field_at(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q,
                          field_cell *out);

/* First contact of a point that moves from q by `path`: within `margin` of the surface at q, inside
 * the solid, or entering it on the way. The separation is that of q. False when it stays free.
 * A point inside a solid leaves it towards its body's home, not through the other face: on the
 * home's side; from FIELD_NONE by the shortest way, of the sides of a thin solid by one that looks
 * to the body's centre; from FIELD_INSIDE through the front even from behind. */
bool grid_field_cast(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q, rlf_vec3 path,
                     double margin, const field_home *home, field_hit *out);

/* Outline of the solid around q, as seen in the image, on the sides that look to the home's centre
 * if it has one: unit direction out of the solid, square to the view ray, and the distance to the
 * free side, metres. False when none is within `radius_px`. */
bool grid_field_side(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q,
                     const field_home *home, int32_t radius_px, rlf_vec3 *out_normal,
                     double *out_distance);

/* Which way the solid goes from the cell's point, and how far per metre of thickness: along the
 * ray, on which thickness was found; but where it is a guess, square to the face. What is behind
 * the far edge of a table's top is no part of the table. */
rlf_vec3 grid_cell_inward(const field_cell *cell);

/* Whether q is before all that may be on its ray by the depth of its pixel alone: false says
 * nothing. */
bool grid_field_is_open(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q);

/* Whether the sheet is seen well behind q, so that nothing of it is there. */
bool grid_field_is_seen_through(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q);

/* Central differences of the back surface, turned away from the camera. */
rlf_vec3 grid_back_normal(const rlf_grid *grid, const rlf_grid_sheet *sheet,
                          const field_cell *cell);

#endif
