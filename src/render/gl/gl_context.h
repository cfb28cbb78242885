/* Inside the OpenGL renderer: contexts, programs, textures, and targets to draw into. */
#ifndef RLF_RENDER_GL_CONTEXT_H
#define RLF_RENDER_GL_CONTEXT_H

#include "relief/base.h"
#include "relief/image.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

typedef enum gl_api {
    CONTEXT_API_ANY = 0, /* OpenGL 3.3 core, else ES 3.0 */
    CONTEXT_API_CORE_33 = 1,
    CONTEXT_API_ES_30 = 2
} gl_api;

typedef struct gl_context {
    EGLDisplay display; /* own context only, like the next two */
    EGLContext context;
    EGLSurface surface; /* EGL_NO_SURFACE where the context works without one */
    bool is_own;
    bool is_es;
    bool tells_reset;   /* glGetGraphicsResetStatus is there */
    char renderer[128]; /* GL_RENDERER, for messages */
} gl_context;

/* Opens a context without a display and leaves it not current: Mesa's surfaceless platform first,
 * then EGL devices; one that is not a software renderer wins. RLF_ERROR_DEVICE says what failed. */
rlf_result gl_context_open(gl_api api, gl_context *out);
/* Takes the calling thread's current context. RLF_ERROR_DEVICE when there is none or it is older
 * than OpenGL 3.3 or ES 3.0. */
rlf_result gl_context_adopt(gl_context *out);
void gl_context_close(gl_context *context);

/* What was current before gl_context_enter. */
typedef struct gl_context_saved {
    EGLDisplay display;
    EGLContext context;
    EGLSurface draw, read;
    EGLenum api;
} gl_context_saved;

/* Makes an own context current; an adopted one is current already. False when that fails. */
bool gl_context_enter(const gl_context *context, gl_context_saved *out_saved);
void gl_context_leave(const gl_context *context, const gl_context_saved *saved);
/* True when the driver has reset the entered context: what it drew since is lost. */
bool gl_context_is_lost(const gl_context *context);

/* ---- gl_program.c: shader programs for OpenGL 3.3 and ES 3.0 from one source. */

enum { GL_PROGRAM_PIECES = 4 };

typedef struct gl_program_source {
    const char *name;                        /* for messages */
    const char *vertex[GL_PROGRAM_PIECES];   /* GLSL without its #version line, in pieces; NULL = no
                                                such piece */
    const char *fragment[GL_PROGRAM_PIECES]; /* likewise */
} gl_program_source;

/* Compiles and links; 0 (and the error line) when the driver refuses. */
GLuint gl_program_build(bool is_es, const gl_program_source *source);

/* Covers the viewport with one triangle from gl_VertexID 0..2, no buffers. */
extern const char gl_program_screen_vertex[];

/* ---- gl_texture.c: small helpers for textures. */

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

/* ---- gl_target.c: the framebuffer that pictures are drawn into, four samples per pixel, and
 * its read back. Row 0 of the picture is the framebuffer's row 0; alpha is the matte. */

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
