/* The view of the triangle mesh. */
#ifndef RLF_RENDER_SOFT_VIEW_MESH_H
#define RLF_RENDER_SOFT_VIEW_MESH_H

#include "render/soft/soft.h"

void soft_draw_mesh(soft *s, const rlf_surface *surface);

#endif
