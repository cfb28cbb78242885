/* The view of contacts. */
#ifndef RLF_RENDER_SOFT_VIEW_CONTACTS_H
#define RLF_RENDER_SOFT_VIEW_CONTACTS_H

#include "render/soft/soft.h"

/* Over the camera's picture. */
void soft_draw_contacts(soft *s, const rlf_render_input *input);

#endif
