/* The faces of a scene. */
#ifndef RLF_RENDER_SOFT_FACE_H
#define RLF_RENDER_SOFT_FACE_H

#include "render/soft/soft.h"

/* Room for so many faces, here and with every worker. */
rlf_result soft_scene_reserve(soft *s, int32_t face_count);
/* Clips at the near plane, drops what faces away or lies outside, and adds the rest; 3 or 4 corners
 * in one plane. */
void soft_scene_add_face(soft *s, const soft_corner *corners, int32_t corner_count, int32_t body);

#endif
