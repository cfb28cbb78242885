/* Room for new blocks. */
#ifndef RLF_MAP_EVICT_H
#define RLF_MAP_EVICT_H

#include "map/volume.h"

/* Removes the blocks farthest from the camera, but none of this frame; returns how many. Sets
 * reach2: blocks farther than that would be the next to leave. */
int32_t map_evict(rlf_map *map, rlf_vec3 eye);

#endif
