/* Which samples of a group of rows see which face. */
#ifndef RLF_RENDER_SOFT_RASTER_H
#define RLF_RENDER_SOFT_RASTER_H

#include "render/soft/soft.h"

/* Which of the group's first `count` faces are alone: no other one is before or behind them. */
void soft_find_alone(const soft_scene *scene, int32_t count, soft_group *group);
/* Where the face begins and ends in the group's rows; false when it touches no sample. */
bool soft_find_ends(const soft_face *face, const soft_group *group, soft_ends *out);
/* Lets the face win the samples of the group's rows where it is nearest so far, unless it is alone;
 * marks the parts of rows that it touches. */
void soft_raster_face(const soft_face *face, const soft_ends *ends, soft_group *group);

#endif
