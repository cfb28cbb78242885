/* Small helpers for textures. */
#ifndef RLF_RENDER_GL_TEXTURE_H
#define RLF_RENDER_GL_TEXTURE_H

#include "render/gl/gl_context.h"

#include "relief/image.h"

/* A 2D texture that keeps its size between uploads. */
typedef struct gl_texture {
    GLuint name;
    int32_t width, height;
} gl_texture;

/* One level, no wrapping. `filter` is GL_NEAREST or GL_LINEAR. */
gl_texture gl_texture_create(GLint filter);
void gl_texture_destroy(gl_texture *texture);
/* Replaces the content; storage is made anew only when the size changes. */
void gl_texture_upload_rgba8(gl_texture *texture, const rlf_image_rgba8 *image);
/* width * height floats without padding, as GL_R32F: for texelFetch. */
void gl_texture_upload_f32(gl_texture *texture, const float *data, int32_t width, int32_t height);
/* width * height bytes without padding, as GL_R8. */
void gl_texture_upload_u8(gl_texture *texture, const uint8_t *data, int32_t width, int32_t height);
/* Storage without content, for a framebuffer. */
void gl_texture_allocate_rgba8(gl_texture *texture, int32_t width, int32_t height);
void gl_texture_allocate_depth(gl_texture *texture, int32_t width, int32_t height);
/* Makes the texture visible to samplers of the unit. */
void gl_texture_bind(const gl_texture *texture, int unit);

#endif
