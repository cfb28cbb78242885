/* The blocks near the surfaces that a view sees. */
#ifndef RLF_MAP_MARK_H
#define RLF_MAP_MARK_H

#include "map/volume.h"

/* Fills map->seen from the view's planes; makes the blocks that there are not yet. */
void map_mark(rlf_map *map, const rlf_pose *T_world_camera, rlf_map_change *change);

#endif
