/* What samples see of faces. */
#ifndef RLF_RENDER_SOFT_SHADE_H
#define RLF_RENDER_SOFT_SHADE_H

#include "render/soft/soft.h"

/* Adds what the samples see of the faces to the sums of the group's rows. */
void soft_shade_faces(const soft *s, const soft_ends *ends, int32_t count, const soft_group *group);

#endif
