/* The outline of a sheet's solid in the image: where it ends, which way it faces, how wide it is.
 */
#ifndef RLF_PHYSICS_GRID_EDGE_H
#define RLF_PHYSICS_GRID_EDGE_H

#include "physics/grid/field.h"

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
