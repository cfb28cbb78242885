/* The framebuffer that pictures are drawn into, four samples per pixel, and its read back. Row 0 of
 * the picture is the framebuffer's row 0; alpha is the matte. */
#ifndef RLF_RENDER_GL_TARGET_H
#define RLF_RENDER_GL_TARGET_H

#include "render/gl/gl_context.h"

#include "relief/image.h"

#define TARGET_SAMPLES 4

typedef struct gl_target {
    GLuint framebuffer, resolved;        /* multisampled, and one sample to read from */
    GLuint color, depth, resolved_color; /* renderbuffers: RGBA8, DEPTH24_STENCIL8, RGBA8 */
    int32_t width, height;
} gl_target;

/* RLF_ERROR_DEVICE when the size is beyond the driver's limits or it lacks the memory. */
rlf_result gl_target_create(int32_t width, int32_t height, gl_target *out);
void gl_target_destroy(gl_target *target);
/* Binds the framebuffer and sets the viewport. */
void gl_target_bind(const gl_target *target);
/* Averages the samples and reads the whole picture into an image of the target's size without row
 * padding. */
void gl_target_read(const gl_target *target, const rlf_image_rgba8 *out);

#endif
