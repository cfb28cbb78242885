/* The camera's noise in shaders: the formula of soft/compose.c. */
#include "render/gl/gl_light.h"

const char gl_grain_glsl[] =
    "uniform sampler2D u_grain;\n"
    "uniform vec3 u_sigma[16];\n" /* of codes 0..1 */
    "uniform ivec2 u_grain_offset;\n"
    "vec3 grainy(vec3 code)\n"
    "{\n"
    "    float mean = (code.r + code.g + code.b) * (255.0 / 3.0);\n"
    "    int bin = int(min(mean, 255.0)) / 16;\n"
    "    ivec2 at = (ivec2(gl_FragCoord.xy) + u_grain_offset) & 127;\n"
    "    vec3 noise = vec3(texelFetch(u_grain, ivec2(3 * at.x, at.y), 0).r,\n"
    "        texelFetch(u_grain, ivec2(3 * at.x + 1, at.y), 0).r,\n"
    "        texelFetch(u_grain, ivec2(3 * at.x + 2, at.y), 0).r);\n"
    "    return clamp(code + u_sigma[bin] * noise, 0.0, 1.0);\n"
    "}\n";

rlf_result gl_grain_create(gl_grain *out)
{
    out->measured = rlf_alloc(sizeof(*out->measured));
    if (out->measured == NULL) {
        return RLF_ERROR_MEMORY;
    }
    grain_init(out->measured);
    out->texture = gl_texture_create(GL_NEAREST);
    gl_texture_upload_f32(&out->texture, out->measured->tile[0], 3 * GRAIN_TILE, GRAIN_TILE);
    out->blur[0] = -1;
    return RLF_OK;
}

void gl_grain_destroy(gl_grain *noise)
{
    gl_texture_destroy(&noise->texture);
    rlf_free(noise->measured);
    *noise = (gl_grain){0};
}

void gl_grain_update(gl_grain *noise, const rlf_frame *frame)
{
    const grain *g = noise->measured;
    grain_update(noise->measured, frame);
    if (g->blur[0] != noise->blur[0] || g->blur[1] != noise->blur[1] || g->mixed != noise->mixed) {
        gl_texture_upload_f32(&noise->texture, g->tile[0], 3 * GRAIN_TILE, GRAIN_TILE);
        noise->blur[0] = g->blur[0];
        noise->blur[1] = g->blur[1];
        noise->mixed = g->mixed;
    }
}

gl_grain_uniforms gl_grain_find_uniforms(GLuint program)
{
    gl_grain_uniforms u = {glGetUniformLocation(program, "u_sigma"),
                           glGetUniformLocation(program, "u_grain_offset")};
    return u;
}

void gl_grain_set(const gl_grain_uniforms *uniforms, const gl_grain *noise)
{
    const grain *g = noise->measured;
    GLfloat sigma[3 * GRAIN_BINS];
    for (int32_t i = 0; i < 3 * GRAIN_BINS; i++) {
        sigma[i] = g->is_known ? g->sigma[i / 3][i % 3] * (1.0f / 255.0f) : 0.0f;
    }
    glUniform3fv(uniforms->sigma, GRAIN_BINS, sigma);
    glUniform2i(uniforms->offset, g->offset_x, g->offset_y);
}
