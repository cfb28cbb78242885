/* All bodies of a picture as faces. */
#ifndef RLF_RENDER_SOFT_SCENE_H
#define RLF_RENDER_SOFT_SCENE_H

#include "render/soft/soft.h"

/* What the picture is seen from. */
void soft_set_viewpoint(soft *s, const rlf_camera *camera, const rlf_pose *T_picture_depth);
/* All bodies in the picture as faces; then, with what is real read, what takes light from them. */
rlf_result soft_scene_build(soft *s, const rlf_render_input *input);
void soft_scene_light(soft *s, const rlf_render_input *input);

#endif
