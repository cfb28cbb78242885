/* Side walls of a sheet's solids against a body. */
#ifndef RLF_PHYSICS_GRID_WALL_H
#define RLF_PHYSICS_GRID_WALL_H

#include "physics/grid/scan.h"

/* Adds what the body touches of the walls at the outline's pixels between this cell and the next
 * ones that are looked at, `stride` pixels on. */
void grid_wall_look(grid_job *job, const field_cell *cell, int32_t stride);

#endif
