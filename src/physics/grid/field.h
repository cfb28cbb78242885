/* The solid that one sheet of the organised grid describes, asked point by point.
 *
 * Along a pixel's ray the sheet is solid from its depth to depth + thickness; where its thickness
 * is a guess, only under what is seen of its faces. All coordinates are in the grid's frame. Where
 * a pixel has no depth there is nothing: holes are neither walls nor traps.
 */
#ifndef RLF_PHYSICS_GRID_FIELD_H
#define RLF_PHYSICS_GRID_FIELD_H

#include "relief/world.h"

/* ---- The tolerances that this folder shares. Lengths are multiples of these, angles are
 * cosines. */

/* Distance kept ready for contacts that are not there yet, metres. */
#define GRID_MARGIN 0.004

/* What differs from a face by no more than this is noise, metres. */
#define GRID_NOISE_M 0.01

/* How far a body or a surface goes at 10 m/s between two searches, and some, metres. What is
 * thinner is thin. */
#define GRID_THIN_M 0.05

/* Cosines between normals: */
#define ONE_PLANE_COS 0.97 /* of one plane */
#define ONE_FACE_COS 0.95  /* side by side on a face that may be curved */
#define SAME_FACE_COS 0.9  /* of one face, with noise; of one direction of contact */
#define NOISY_FACE_COS 0.8 /* the same beside an edge */
#define APART_COS 0.7      /* what bends less may be one round face */
#define ASIDE_COS 0.3      /* square to each other, up to noise */

/* Cosine between a face's normal and the view ray: a face that is seen at a lower angle has no
 * plane that the ray meets. */
#define GRAZING_COS 0.02

/* ---- The field. */

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

/* ---- contour.c: the outline of a sheet's solid in the image: where it ends, which way it
 * faces, how wide it is. */

/* Two pixels side by side differ by more than this only across an outline, metres. */
double grid_depth_step(double z);

/* z at which the side wall between `cell` and the pixel at (x, y) ends: that pixel is off the sheet
 * or farther than the cell's own plane explains. 0 when there is no wall. */
double grid_contour_end(const rlf_grid *grid, const rlf_grid_sheet *sheet, const field_cell *cell,
                        int32_t x, int32_t y);

/* Which way the outline near `cell` faces: the mean direction to the free pixels of a window around
 * it, square to the view ray, unit, out of the solid. False where no outline is near. */
bool grid_contour_normal(const rlf_grid *grid, const rlf_grid_sheet *sheet, const field_cell *cell,
                         rlf_vec3 *out);

/* How deep a guessed solid is at the cell, up to `limit` metres: no more than it is wide, by the
 * shorter of its row's and its column's run between steps in depth, and no more than is hidden at
 * the ends of these, as far as the camera looks past them. Not counted is a flat side that
 * is seen beside its front, all of whose pixels face one way: missing ones, and most of those of
 * what is round, do count. */
double grid_guess_depth(const rlf_grid *grid, const rlf_grid_sheet *sheet, const field_cell *cell,
                        double limit);

/* The direction of a side wall's outline, unit, square to its face and to where it goes inward. */
rlf_vec3 grid_wall_along(rlf_vec3 inward, rlf_vec3 side);

/* A side wall's direction at an outline's pixel: its face, which is `side` turned so that the wall
 * goes `inward`, and at its front (edge < 0) and back edge (> 0) all between that face and inward.
 * `normal` brought into them. */
rlf_vec3 grid_wall_normal(rlf_vec3 inward, rlf_vec3 side, rlf_vec3 normal, int32_t edge);

#endif
