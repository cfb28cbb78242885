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

#endif
