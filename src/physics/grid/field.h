/* The solid that one sheet of the organised grid describes, asked point by point.
 *
 * Along a pixel's ray the sheet is solid from its depth to depth + thickness; where its thickness
 * is a guess, only under what is seen of its faces. All coordinates are in the grid's frame. Where
 * a pixel has no depth there is nothing: holes are neither walls nor traps.
 */
#ifndef RLF_PHYSICS_GRID_FIELD_H
#define RLF_PHYSICS_GRID_FIELD_H

#include "physics/grid/tolerance.h"
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

/* Whether all planes and functions that are read without a further look are there. */
bool grid_is_whole(const rlf_grid *grid);

/* The pixel on q's ray; false when q is out of view. */
bool grid_pixel_of(const rlf_grid *grid, rlf_vec3 q, int32_t *x, int32_t *y);

/* Reads pixel (x, y); false when the sheet has no surface there. */
bool grid_cell_read(const rlf_grid *grid, const rlf_grid_sheet *sheet, int32_t x, int32_t y,
                    field_cell *out);

/* Where q stands to the sheet; *out is set unless FIELD_NONE. */
field_state grid_field_at(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q,
                          field_cell *out);

/* The same, but thickness and back of *out may be left as they were guessed: much cheaper. */
field_state grid_field_state(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q,
                             field_cell *out);

/* Which way the solid goes from the cell's point, and how far per metre of thickness: along the
 * ray, on which thickness was found; but where it is a guess, square to the face. What is behind
 * the far edge of a table's top is no part of the table. */
static inline rlf_vec3 grid_cell_inward(const field_cell *cell)
{
    double facing = rlf_dot(cell->normal, cell->point) / cell->point.z;
    if (!cell->is_guess || facing > -GRAZING_COS) {
        return rlf_scale(cell->point, 1.0 / cell->point.z);
    }
    return rlf_scale(cell->normal, facing);
}

/* What a pixel shows of a face is at most so many times longer than it is wide. */
#define GRID_LONGEST 10.0

/* Half of the diagonal of what a pixel of every `stride` shows of its face, metres: pixels are far
 * apart on a face that is seen at a low angle, and a small body fits between their points. */
static inline double grid_cell_half(const rlf_grid *grid, const field_cell *cell, int32_t stride)
{
    double cosine = -rlf_dot(cell->normal, cell->point) / rlf_length(cell->point);
    double pitch = stride * cell->point.z * grid->pixel_angle;
    return 0.7 * pitch / rlf_max(cosine, 1.0 / GRID_LONGEST);
}

/* Whether q is before all that may be on its ray by the depth of its pixel alone: false says
 * nothing. */
bool grid_field_is_open(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q);

/* Whether q is before the pixel on its ray, higher than `height` over its plane: most of what is
 * asked about is, and the pixel's depth and normal tell it. */
bool grid_field_is_well_before(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q,
                               double height);

/* Whether the sheet is seen well behind q, so that nothing of it is there. */
bool grid_field_is_seen_through(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q);

/* Whether something that was behind the sheet may still be at q: no pixel there looks past it, as
 * where one has no depth, or where the sheet has lost what hides q. */
bool grid_field_may_hide(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q);

/* Where the cell's ray leaves the solid. */
rlf_vec3 grid_back_point(const field_cell *cell);

/* Central differences of the back surface, turned away from the camera. */
rlf_vec3 grid_back_normal(const rlf_grid *grid, const rlf_grid_sheet *sheet,
                          const field_cell *cell);

#endif
