/* Bodies that take light away, in shaders: the same formulas as caster.c. */
#ifndef RLF_RENDER_GL_CASTER_H
#define RLF_RENDER_GL_CASTER_H

#include "render/gl/gl_context.h"

#include "render/caster.h"

typedef struct gl_caster_uniforms {
    GLint center, to_body, half_size, to_light, numbers;
} gl_caster_uniforms;

/* GLSL: `struct caster` and `vec2 light_lost(caster c, vec2 ray, float z)`: shares of the light
 * around and of the directed light that are lost at z (ray, 1). */
extern const char gl_caster_glsl[];

/* Uniforms of a caster called `name`, e.g. "u_casters[1]". */
gl_caster_uniforms gl_caster_find_uniforms(GLuint program, const char *name);
void gl_caster_set_uniforms(const gl_caster_uniforms *uniforms, const caster *c);

#endif
