/* Relief: the OpenGL renderer (librelief_gl): OpenGL 3.3 or ES 3.0, with a window's context or
 * none. SPDX-License-Identifier: MIT */
#ifndef RELIEF_GL_H
#define RELIEF_GL_H

#include "relief/compositor.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Makes a compositor that draws with OpenGL into its own framebuffer and reads it back.
 * use_current_context: true draws with the calling thread's context (a window's); false opens an
 * EGL context without a display (surfaceless or device platform). RLF_ERROR_DEVICE says why GL is
 * not to be had. Thread-safety: all calls from the thread that created it. */
RLF_API rlf_result rlf_gl_compositor_create(const rlf_compositor_def *def, bool use_current_context,
                                            rlf_compositor **out);

/* Draws an image to the current context's default framebuffer, scaled to fit with black bars.
 * Needs a current context (OpenGL 3.3). framebuffer_width and height in pixels. */
typedef struct rlf_gl_presenter rlf_gl_presenter;
RLF_API rlf_result rlf_gl_presenter_create(rlf_gl_presenter **out);
RLF_API void rlf_gl_presenter_destroy(rlf_gl_presenter **presenter);
RLF_API void rlf_gl_presenter_draw(rlf_gl_presenter *presenter, const rlf_image_rgba8 *image,
                                   int32_t framebuffer_width, int32_t framebuffer_height);

#ifdef __cplusplus
}
#endif
#endif
