/* Which of a body's points can come to what the scan of its footprint listed. */
#ifndef RLF_PHYSICS_GRID_NEAR_H
#define RLF_PHYSICS_GRID_NEAR_H

#include "kernel/box_lanes.h"
#include "physics/grid/scan.h"

#define GRID_NEAR_MAX RLF_BOX_LANES

/* Of `count` points of the body's surface, at most GRID_NEAR_MAX, body frame, those that may touch
 * the sheet before the next query, as bits: by the planes of flat tiles and the boxes of other
 * blocks alone. What is inside a solid, or where not all is listed, any of them may. */
uint32_t grid_points_near(const grid_job *job, const rlf_vec3 *points, int32_t count);

#endif
