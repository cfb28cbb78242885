/* Light around that real surfaces close to bodies keep from them, for the bodies' shader. */
#ifndef RLF_RENDER_GL_OBSCURANCE_H
#define RLF_RENDER_GL_OBSCURANCE_H

#include "render/gl/gl_context.h"

#include "render/obscurance.h"

/* GLSL: `float near_left(vec3 p, vec3 normal)`, the share of the light around that real surfaces
 * leave at p (picture camera frame; the normal in the depth camera's); as obscurance_take. */
#define GL_OBSCURANCE_GLSL                                                                         \
    "uniform int u_near_count;\n"                                                                  \
    "uniform vec4 u_near_planes[3];\n" /* height = xyz . p + w, picture camera frame */            \
    "uniform vec3 u_near_normals[3];\n"                                                            \
    "uniform vec3 u_near_shares;\n"                                                                \
    "uniform float u_near_per_reach;\n"                                                            \
    "float near_lost(float facing, float height)\n"                                                \
    "{\n"                                                                                          \
    "    float near_share = 1.0 - clamp(height, 0.0, 1.0);\n"                                      \
    "    float square = near_share * near_share;\n"                                                \
    "    float horizon = sqrt(near_share * (2.0 - near_share));\n"                                 \
    "    float seen = max(0.0, (horizon - facing) / (horizon + 1.0));\n"                           \
    "    return square * seen * mix(seen, 1.0, square * square * square);\n"                       \
    "}\n"                                                                                          \
    "float near_left(vec3 p, vec3 normal)\n"                                                       \
    "{\n"                                                                                          \
    "    float left = 1.0;\n"                                                                      \
    "    for (int i = 0; i < u_near_count; i++) {\n"                                               \
    "        float height = dot(u_near_planes[i], vec4(p, 1.0)) * u_near_per_reach;\n"             \
    "        left *= 1.0 - u_near_shares[i] * near_lost(dot(normal, u_near_normals[i]), "          \
    "height);\n"                                                                                   \
    "    }\n"                                                                                      \
    "    return left;\n"                                                                           \
    "}\n"

/* The surfaces near a picture's bodies. */
typedef struct gl_obscurance {
    obscurance *bodies; /* as the snapshot's */
    int32_t capacity;
    rlf_pose T_depth_picture;
} gl_obscurance;

typedef struct gl_obscurance_uniforms {
    GLint count, planes, normals, shares, per_reach;
} gl_obscurance_uniforms;

void gl_obscurance_destroy(gl_obscurance *near_by);
/* Finds what so many bodies are near. */
rlf_result gl_obscurance_update(gl_obscurance *near_by, const rlf_surface *surface,
                                const rlf_pose *T_depth_picture, const caster *casters,
                                int32_t count);

gl_obscurance_uniforms gl_obscurance_find_uniforms(GLuint program);
/* For the program in use and body `index`; NULL = real surfaces take nothing. */
void gl_obscurance_set(const gl_obscurance_uniforms *uniforms, const gl_obscurance *near_by,
                       int32_t index);

#endif
