/* An OpenGL context: the calling thread's, or one that EGL opens without a display. */
#ifndef RLF_RENDER_GL_CONTEXT_H
#define RLF_RENDER_GL_CONTEXT_H

#include "relief/base.h"

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

#endif
