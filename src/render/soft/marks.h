/* Lines and texts that the caller wants over the picture. */
#ifndef RLF_RENDER_SOFT_MARKS_H
#define RLF_RENDER_SOFT_MARKS_H

#include "render/soft/soft.h"

void soft_draw_marks(soft *s, const rlf_render_input *input);

#endif
