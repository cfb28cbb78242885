/* The steps of a search for contacts, in their order. */
#ifndef RLF_PHYSICS_GRID_CONTACT_SEARCH_H
#define RLF_PHYSICS_GRID_CONTACT_SEARCH_H

#include "kernel/lanes.h"
#include "physics/grid/job.h"

#define GRID_NEAR_MAX RLF_BOX_LANES

/* Rectangle of pixels (ends excluded) under a sphere about `centre`, grid frame; false when it is
 * out of view. *stride thins it to a bounded number of samples. */
bool grid_footprint(const rlf_grid *grid, rlf_vec3 centre, double reach, int32_t rect[4],
                    int32_t *stride);

/* Whether nothing of the layer is within `reach` of the body's centre, by its tiles alone. */
bool grid_is_free(const grid_job *job, const grid_tiles *tiles, double reach);

/* Reads the pixels under the body's footprint: fills `scan`, a ball's touches, and hits with side
 * walls. */
void grid_scan_footprint(grid_job *job);

/* Side walls behind the contour's pixels next to `cell`, of every stride-th pixel. */
void grid_wall_look(grid_job *job, const field_cell *cell, int32_t stride);

/* Of `count` points of the body's surface, at most GRID_NEAR_MAX, body frame, those that may touch
 * the layer before the next search, as bits: by the planes of flat tiles and the boxes of other
 * blocks alone. Inside a solid, or where not all is listed, any of them may. */
uint32_t grid_points_near(const grid_job *job, const rlf_vec3 *points, int32_t count);

/* Casts the points of the body that can touch what was scanned, and adds what is hit. */
void grid_cast_points(grid_job *job);

/* Adds to body->surface the contacts that matter among job->hits: for up to three directions the
 * deepest one, the farthest from it, and those that span the largest area. */
void grid_reduce(grid_job *job, phys_body *body, int32_t body_index, rlf_contact_other other);

/* Carries the impulses of the old contacts to the new ones at the same place. */
void grid_keep_impulses(phys_body *body, const phys_trace *old, int32_t old_count);

#endif
