/* How much of a body shows before the real world: the comparison that both ways of occlusion share.
 */
#ifndef RLF_RENDER_GL_OCCLUSION_H
#define RLF_RENDER_GL_OCCLUSION_H

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
