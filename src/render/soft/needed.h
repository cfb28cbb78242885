/* Which part of the registered depth a picture needs. */
#ifndef RLF_RENDER_SOFT_NEEDED_H
#define RLF_RENDER_SOFT_NEEDED_H

#include "render/soft/soft.h"

/* Scene and matte's bodies must be in place. */
real_windows soft_needed_depth(const soft *s, const rlf_render_input *input);

#endif
