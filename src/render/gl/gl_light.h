/* Inside the OpenGL renderer: what takes light from a body, and what hides it, as GLSL with its
 * uniforms. */
#ifndef RLF_RENDER_GL_GL_LIGHT_H
#define RLF_RENDER_GL_GL_LIGHT_H

#include "render/caster.h"
#include "render/gl/gl_context.h"
#include "render/probe.h"
#include "render/real_shade.h"

/* ---- gl_caster.c: bodies that take light away, in shaders: the same formulas as caster.c. */

typedef struct gl_caster_uniforms {
    GLint center, to_body, half_size, to_light, numbers, crease, edge_count, edges;
} gl_caster_uniforms;

/* GLSL: `struct caster` and `vec2 light_lost(caster c, vec2 ray, float z)`: shares of the light
 * around and of the directed light that are lost at z (ray, 1). */
extern const char gl_caster_glsl[];

/* Uniforms of a caster called `name`, e.g. "u_casters[1]". */
gl_caster_uniforms gl_caster_find_uniforms(GLuint program, const char *name);
void gl_caster_set_uniforms(const gl_caster_uniforms *uniforms, const caster *c);

/* ---- gl_obscurance.c: light around that real surfaces close to bodies keep from them, for the
 * bodies' shader. */

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

/* ---- gl_probe.c: light by place, and gloss: see probe.h. */

/* GLSL: `vec3 sent(vec3 color, vec3 n, vec3 to_lamp, vec3 to_eye, vec2 left)`: the codes of what a
 * surface of a linear colour and of `material` sends. */
extern const char gl_probe_glsl[];

/* The probes of a picture's bodies, and their maps. */
typedef struct gl_probes {
    probe_set *set;
    float *rows;
    gl_texture texture;
} gl_probes;

typedef struct gl_probe_uniforms {
    GLint around, rough, direct, row, material;
} gl_probe_uniforms;

rlf_result gl_probes_create(gl_probes *out);
void gl_probes_destroy(gl_probes *probes);
rlf_result gl_probes_update(gl_probes *probes, const probe_def *def, const rlf_render_input *input);
gl_probe_uniforms gl_probe_find_uniforms(GLuint program);
/* For the program in use: body `index`, and what its surface is of. */
void gl_probes_set(const gl_probe_uniforms *uniforms, const gl_probes *probes, int32_t index);
void gl_probes_set_material(const gl_probe_uniforms *uniforms, probe_material material);

/* ---- gl_shade.c: what real things take of bodies' light, for the bodies' shader. */

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

/* ---- How much of a body shows before the real world: the comparison that both ways of
 * occlusion share. */

/* GLSL: `float share_in_front(sampler2D real_depth, float z)`, 0..1 in sixths: the real depth of
 * the pixel counts twice and that of its four neighbours once, so that edges are not jagged; 0 in
 * the texture is unknown and hides nothing. */
#define GL_OCCLUSION_GLSL                                                                          \
    "float hides(sampler2D real_depth, ivec2 pixel, float z)\n"                                    \
    "{\n"                                                                                          \
    "    ivec2 last = textureSize(real_depth, 0) - 1;\n"                                           \
    "    float real_z = texelFetch(real_depth, clamp(pixel, ivec2(0), last), 0).r;\n"              \
    "    return real_z > 0.0 && real_z < z ? 1.0 : 0.0;\n"                                         \
    "}\n"                                                                                          \
    "float share_in_front(sampler2D real_depth, float z)\n"                                        \
    "{\n"                                                                                          \
    "    ivec2 pixel = ivec2(gl_FragCoord.xy);\n"                                                  \
    "    float hidden = 2.0 * hides(real_depth, pixel, z)\n"                                       \
    "        + hides(real_depth, pixel - ivec2(1, 0), z)\n"                                        \
    "        + hides(real_depth, pixel + ivec2(1, 0), z)\n"                                        \
    "        + hides(real_depth, pixel - ivec2(0, 1), z)\n"                                        \
    "        + hides(real_depth, pixel + ivec2(0, 1), z);\n"                                       \
    "    return 1.0 - hidden / 6.0;\n"                                                             \
    "}\n"

/* The real world of soft occlusion: see environment/edge_matte.h. */
typedef struct gl_soft_real {
    const gl_texture *near_z, *far_z, *cover;
    const rlf_depth_noise *noise;
} gl_soft_real;

/* GLSL: `float share_of_soft(near_z, far_z, cover, noise, z)`: as soft occlusion in soft/soft.h. A
 * pixel shows `cover` of near_z and the rest of far_z. */
#define GL_SOFT_OCCLUSION_GLSL                                                                     \
    "float share_of_soft(sampler2D near_z, sampler2D far_z, sampler2D cover, vec3 noise, float z)" \
    "\n"                                                                                           \
    "{\n"                                                                                          \
    "    ivec2 pixel = ivec2(gl_FragCoord.xy);\n"                                                  \
    "    float fade = 0.25 / max(noise.x + z * (noise.y + z * noise.z), 0.0003);\n"                \
    "    vec2 real = vec2(texelFetch(near_z, pixel, 0).r, texelFetch(far_z, pixel, 0).r);\n"       \
    "    vec2 share = clamp(0.5 + (real - z) * fade, 0.0, 1.0);\n"                                 \
    "    return mix(share.y, share.x, texelFetch(cover, pixel, 0).r);\n"                           \
    "}\n"

#endif
