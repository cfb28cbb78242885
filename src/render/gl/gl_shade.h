/* What real things take of bodies' light, for the bodies' shader. */
#ifndef RLF_RENDER_GL_SHADE_H
#define RLF_RENDER_GL_SHADE_H

#include "render/gl/gl_texture.h"

#include "render/real_shade.h"

/* GLSL: `float real_left(vec3 p)`, the share of the directed light that real things leave at p
 * (picture camera frame); as real_shade_take. */
#define GL_REAL_SHADE_GLSL                                                                         \
    "uniform sampler2D u_shade_maps;\n"                                                            \
    "uniform int u_shade_row;\n"                                                                   \
    "uniform vec3 u_shade_center, u_shade_across, u_shade_down;\n"                                 \
    "const int shade_side = 13;\n"                                                                 \
    "float real_left(vec3 p)\n"                                                                    \
    "{\n"                                                                                          \
    "    if (u_shade_row < 0) {\n"                                                                 \
    "        return 1.0;\n"                                                                        \
    "    }\n"                                                                                      \
    "    vec3 v = p - u_shade_center;\n"                                                           \
    "    vec2 at = vec2(dot(u_shade_across, v), dot(u_shade_down, v));\n"                          \
    "    at = clamp(at + float(shade_side - 1) * 0.5, 0.0, float(shade_side) - 1.001);\n"          \
    "    ivec2 cell = ivec2(at);\n"                                                                \
    "    int i = cell.y * shade_side + cell.x;\n"                                                  \
    "    vec4 left = vec4(texelFetch(u_shade_maps, ivec2(i, u_shade_row), 0).r,\n"                 \
    "        texelFetch(u_shade_maps, ivec2(i + 1, u_shade_row), 0).r,\n"                          \
    "        texelFetch(u_shade_maps, ivec2(i + shade_side, u_shade_row), 0).r,\n"                 \
    "        texelFetch(u_shade_maps, ivec2(i + shade_side + 1, u_shade_row), 0).r);\n"            \
    "    vec2 rest = at - vec2(cell);\n"                                                           \
    "    vec2 rows = mix(left.xz, left.yw, rest.x);\n"                                             \
    "    return mix(rows.x, rows.y, rest.y);\n"                                                    \
    "}\n"

/* The maps of a picture's bodies. */
typedef struct gl_shade {
    real_shade *maps; /* as the snapshot's bodies; NULL = none */
    float *rows;      /* of those that take light, one after the other */
    int32_t *row_of;  /* as maps: the body's row, -1 = none */
    int32_t capacity; /* bodies */
    gl_texture texture;
} gl_shade;

typedef struct gl_shade_uniforms {
    GLint row, center, across, down;
} gl_shade_uniforms;

gl_shade gl_shade_create(void);
void gl_shade_destroy(gl_shade *shade);
/* Works out the maps of so many bodies, and uploads them. */
rlf_result gl_shade_update(gl_shade *shade, const real_shade_world *world, const caster *casters,
                           int32_t count);

gl_shade_uniforms gl_shade_find_uniforms(GLuint program);
/* For the program in use and body `index`; shade NULL = real things take nothing. */
void gl_shade_set(const gl_shade_uniforms *uniforms, const gl_shade *shade, int32_t index);

#endif
