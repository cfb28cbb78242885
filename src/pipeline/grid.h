/* The real surface as physics sees it: an rlf_grid that borrows the planes of an rlf_surface. */
#ifndef RLF_PIPELINE_GRID_H
#define RLF_PIPELINE_GRID_H

#include "relief/surface.h"
#include "relief/world.h"

/* Fills *out with views of `surface`. `regions` has room for region_capacity entries; further ones
 * are left out. All of it stays valid as long as the surface. */
void grid_from_surface(const rlf_surface *surface, const rlf_pose *T_world_camera,
                       rlf_grid_region *regions, int32_t region_capacity, rlf_grid *out);

#endif
