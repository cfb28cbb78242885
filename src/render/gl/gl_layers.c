/* Full-screen layers. */
#include "render/gl/gl_thesis.h"

#include "render/gl/gl_light.h"
#include "render/gl/gl_context.h"
#include "render/gl/gl_view.h"

enum { UNIT_BACKDROP = 0, UNIT_REAL_DEPTH = 1, UNIT_BODY_DEPTH = 2 };

static const char backdrop_fragment[] =
    "uniform sampler2D u_backdrop;\n"
    "out vec4 o_color;\n"
    "void main()\n"
    "{\n"
    "    o_color = vec4(texelFetch(u_backdrop, ivec2(gl_FragCoord.xy), 0).rgb, 0.0);\n"
    "}\n";

/* The body's z is per pixel, from the depth buffer it alone was drawn into (errata 8): depth d in
 * 0..1 is (f + n - 2 f n / z) / (f - n) / 2 + 1/2. Where the body touches a pixel but not its
 * centre, the buffer is empty (d = 1) and a neighbour stands in. */
static const char occlusion_fragment[] =
    "uniform sampler2D u_backdrop;\n"
    "uniform sampler2D u_real_depth;\n"
    "uniform sampler2D u_body_depth;\n"
    "uniform vec2 u_near_far;\n"
    "out vec4 o_color;\n"
    "float body_depth(ivec2 pixel)\n"
    "{\n"
    "    float d = texelFetch(u_body_depth, pixel, 0).r;\n"
    "    ivec2 last = textureSize(u_body_depth, 0) - 1;\n"
    "    for (int i = 0; d == 1.0 && i < 9; i++) {\n"
    "        ivec2 other = clamp(pixel + ivec2(i % 3 - 1, i / 3 - 1), ivec2(0), last);\n"
    "        d = min(d, texelFetch(u_body_depth, other, 0).r);\n"
    "    }\n"
    "    return d;\n"
    "}\n"
    "void main()\n"
    "{\n"
    "    ivec2 pixel = ivec2(gl_FragCoord.xy);\n"
    "    float n = u_near_far.x;\n"
    "    float f = u_near_far.y;\n"
    "    float body_z = n * f / (f - body_depth(pixel) * (f - n));\n"
    "    float shown = share_in_front(u_real_depth, body_z);\n"
    "    o_color = vec4(texelFetch(u_backdrop, pixel, 0).rgb, 1.0 - shown);\n"
    "}\n";

rlf_result gl_layers_create(bool is_es, gl_layers *out)
{
    *out = (gl_layers){0};
    const gl_program_source backdrop = {
        "backdrop layer", {gl_program_screen_vertex}, {backdrop_fragment}};
    const gl_program_source occlusion = {
        "occlusion layer", {gl_program_screen_vertex}, {GL_OCCLUSION_GLSL, occlusion_fragment}};
    out->backdrop_program = gl_program_build(is_es, &backdrop);
    if (out->backdrop_program != 0) {
        out->occlusion_program = gl_program_build(is_es, &occlusion);
    }
    if (out->occlusion_program == 0) {
        gl_layers_destroy(out);
        return RLF_ERROR_DEVICE;
    }
    GLuint p = out->occlusion_program;
    glUseProgram(p);
    glUniform1i(glGetUniformLocation(p, "u_backdrop"), UNIT_BACKDROP);
    glUniform1i(glGetUniformLocation(p, "u_real_depth"), UNIT_REAL_DEPTH);
    glUniform1i(glGetUniformLocation(p, "u_body_depth"), UNIT_BODY_DEPTH);
    glUniform2f(glGetUniformLocation(p, "u_near_far"), (GLfloat)VIEW_NEAR_M, (GLfloat)VIEW_FAR_M);
    glUseProgram(0);
    glGenVertexArrays(1, &out->empty_array);
    return RLF_OK;
}

void gl_layers_destroy(gl_layers *layers)
{
    glDeleteProgram(layers->backdrop_program);
    glDeleteProgram(layers->occlusion_program);
    glDeleteVertexArrays(1, &layers->empty_array);
    *layers = (gl_layers){0};
}

static void draw_screen(const gl_layers *layers)
{
    glBindVertexArray(layers->empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
    glUseProgram(0);
}

void gl_layers_draw_backdrop(const gl_layers *layers, const gl_layer_images *images)
{
    glUseProgram(layers->backdrop_program);
    gl_texture_bind(images->backdrop, UNIT_BACKDROP);
    draw_screen(layers);
}

void gl_layers_draw_occlusion(const gl_layers *layers, const gl_layer_images *images)
{
    glUseProgram(layers->occlusion_program);
    gl_texture_bind(images->backdrop, UNIT_BACKDROP);
    gl_texture_bind(images->real_depth, UNIT_REAL_DEPTH);
    gl_texture_bind(images->body_depth, UNIT_BODY_DEPTH);
    draw_screen(layers);
}
