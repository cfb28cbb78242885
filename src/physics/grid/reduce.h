/* A few good contacts out of many. */
#ifndef RLF_PHYSICS_GRID_REDUCE_H
#define RLF_PHYSICS_GRID_REDUCE_H

#include "physics/grid/scan.h"

/* Adds to body->surface the contacts that matter among job->hits: for up to three directions the
 * deepest one, the farthest from it, and those that span the largest area. */
void grid_reduce(grid_job *job, phys_body *body, int32_t body_index, rlf_contact_other other);

/* Carries the impulses of the old contacts to the new ones at the same place. */
void grid_keep_impulses(phys_body *body, const phys_trace *old, int32_t old_count);

#endif
