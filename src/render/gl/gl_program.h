/* Shader programs for OpenGL 3.3 and ES 3.0 from one source. */
#ifndef RLF_RENDER_GL_PROGRAM_H
#define RLF_RENDER_GL_PROGRAM_H

#include "render/gl/gl_context.h"

enum { GL_PROGRAM_PIECES = 3 };

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

#endif
