/* When the memory is full. */
#ifndef RLF_MAP_EVICT_H
#define RLF_MAP_EVICT_H

#include "map/volume.h"

/* Makes room for a block at the squared distance `distance2` from the eye, m^2: some of those that
 * are farther and that this frame did not see are removed; returns how many. When there are none
 * `reach2` is where the farthest of the others is: nothing beyond has room. */
int32_t map_evict(rlf_map *map, rlf_vec3 eye, double distance2, double *reach2);

#endif
