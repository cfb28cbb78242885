/* Bodies that are drawn as models. */
#ifndef RLF_RENDER_SOFT_SCENE_MODEL_H
#define RLF_RENDER_SOFT_SCENE_MODEL_H

#include "render/soft/soft.h"

/* The faces of a body; its colour is that of the body. */
rlf_result soft_scene_add_model(soft *s, const rlf_look *look, const rlf_pose *T_picture_body,
                                int32_t body);

#endif
