/* The OpenGL compositor with a choice of API, for tests of both. */
#ifndef RLF_RENDER_GL_COMPOSITOR_H
#define RLF_RENDER_GL_COMPOSITOR_H

#include "render/gl/gl_context.h"

#include "relief/gl.h"

/* As rlf_gl_compositor_create without a window, with this API only. */
rlf_result gl_compositor_create_offscreen(const rlf_compositor_def *def, gl_api api,
                                          rlf_compositor **out);

#endif
