/* The room beyond the camera's view: the planes of its border go on. */
#ifndef RLF_PHYSICS_GRID_BORDER_H
#define RLF_PHYSICS_GRID_BORDER_H

#include "physics/grid_field.h"

/* The plane that goes on at q, a point out of view or in the ring of missing pixels that a depth
 * camera leaves at its image's border: mean of the like-minded pixels where q's direction leaves
 * the image. False behind the camera, or when nothing was seen near that place. */
bool grid_border_read(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q,
                      field_cell *out);

#endif
