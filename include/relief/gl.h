/* Relief: the OpenGL renderer (librelief_gl): OpenGL 3.3 or ES 3.0, with a window's context or
 * none. SPDX-License-Identifier: MIT */
#ifndef RELIEF_GL_H
#define RELIEF_GL_H

#include "relief/compositor.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Makes a compositor that draws with OpenGL into its own framebuffer and reads it back: its
 * picture and matte are planes in memory, as the soft renderer's. They are close to those, but
 * not the same bits, and differ between drivers.
 *
 * use_current_context: true draws with the calling thread's context (a window's), whose bindings
 * it changes; false opens an EGL context without a display (surfaceless or device platform).
 * RLF_ERROR_DEVICE says why GL is not to be had: the caller goes on with
 * rlf_compositor_create_soft. rlf_compositor_destroy ends it, while its context lives.
 *
 * Thread-safety: all calls from the thread that created it. */
RLF_API rlf_result rlf_gl_compositor_create(const rlf_compositor_def *def, bool use_current_context,
                                            rlf_compositor **out);

/* Draws an image to the current context's default framebuffer, scaled to fit with black bars. Needs
 * a current context (OpenGL 3.3), the same one in all calls, and thus one thread. */
typedef struct rlf_gl_presenter rlf_gl_presenter;
/* Compiles its program. RLF_ERROR_DEVICE with the driver's words when that fails. */
RLF_API rlf_result rlf_gl_presenter_create(rlf_gl_presenter **out);
/* Frees what it has in the context and nulls the pointer. NULL and a NULL presenter are allowed. */
RLF_API void rlf_gl_presenter_destroy(rlf_gl_presenter **presenter);
/* How later images are placed. `fills`: as large as the framebuffer, and what is beyond it is cut;
 * default false: black bars. `map` takes places of the framebuffer to places of the
 * rectangle that images are fitted into, both as shares of width and height from the top left: a
 * homography, for a projector that stands askew. What it takes to outside is black. NULL = the same
 * place, the default. */
RLF_API void rlf_gl_presenter_set_place(rlf_gl_presenter *presenter, bool fills,
                                        const rlf_mat3 *map);
/* `image` is borrowed for the call: any size, opaque. framebuffer_width and height in pixels, which
 * is more than a window's size on screens with fine pixels. Does not swap buffers. */
RLF_API void rlf_gl_presenter_draw(rlf_gl_presenter *presenter, const rlf_image_rgba8 *image,
                                   int32_t framebuffer_width, int32_t framebuffer_height);
/* True: images are shown as in a mirror, left and right changed; those over them are not. default
 * false */
RLF_API void rlf_gl_presenter_set_mirror(rlf_gl_presenter *presenter, bool is_mirrored);
/* Blends an image over what was drawn, pixel by pixel, by its alpha (not premultiplied). (x, y) is
 * where its top left corner goes, from the top left of a framebuffer of that height; what reaches
 * beyond is cut. For text and marks at the window's own resolution. */
RLF_API void rlf_gl_presenter_draw_over(rlf_gl_presenter *presenter, const rlf_image_rgba8 *image,
                                        int32_t x, int32_t y, int32_t framebuffer_height);

#ifdef __cplusplus
}
#endif
#endif
