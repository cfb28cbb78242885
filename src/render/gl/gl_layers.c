/* Full-screen layers. */
#include "gl_layers.h"

#include "gl_program.h"
#include "gl_view.h"

enum { UNIT_COLOR = 0, UNIT_REAL_DEPTH = 1, UNIT_BODY_DEPTH = 2 };

/* Texel centres meet pixel centres when image and picture have one size; the fetch is then exact.
 */
#define REAL_COLOR                                                                                 \
    "uniform sampler2D u_color;\n"                                                                 \
    "uniform vec2 u_size;\n"                                                                       \
    "vec3 real_color()\n"                                                                          \
    "{\n"                                                                                          \
    "    if (ivec2(u_size) == textureSize(u_color, 0)) {\n"                                        \
    "        return texelFetch(u_color, ivec2(gl_FragCoord.xy), 0).rgb;\n"                         \
    "    }\n"                                                                                      \
    "    return textureLod(u_color, gl_FragCoord.xy / u_size, 0.0).rgb;\n"                         \
    "}\n"

static const char background_fragment[] = REAL_COLOR "out vec4 o_color;\n"
                                                     "void main()\n"
                                                     "{\n"
                                                     "    o_color = vec4(real_color(), 0.0);\n"
                                                     "}\n";

/* The body's z is per pixel, from the depth buffer it alone was drawn into (errata 8):
 * depth d in 0..1 is (f + n - 2 f n / z) / (f - n) / 2 + 1/2. */
static const char occlusion_fragment[] =
    REAL_COLOR "uniform sampler2D u_real_depth;\n"
               "uniform sampler2D u_body_depth;\n"
               "uniform vec2 u_near_far;\n"
               "out vec4 o_color;\n"
               "void main()\n"
               "{\n"
               "    ivec2 pixel = ivec2(gl_FragCoord.xy);\n"
               "    float real_z = texelFetch(u_real_depth, pixel, 0).r;\n"
               "    float d = texelFetch(u_body_depth, pixel, 0).r;\n"
               "    float n = u_near_far.x;\n"
               "    float f = u_near_far.y;\n"
               "    float body_z = n * f / (f - d * (f - n));\n"
               "    bool is_in_front = real_z > 0.0 && real_z < body_z;\n"
               "    o_color = vec4(real_color(), is_in_front ? 1.0 : 0.0);\n"
               "}\n";

rlf_result gl_layers_create(bool is_es, gl_layers *out)
{
    *out = (gl_layers){0};
    const gl_program_source background = {"background", gl_program_screen_vertex,
                                          background_fragment};
    const gl_program_source occlusion = {"occlusion layer", gl_program_screen_vertex,
                                         occlusion_fragment};
    out->background_program = gl_program_build(is_es, &background);
    if (out->background_program != 0) {
        out->occlusion_program = gl_program_build(is_es, &occlusion);
    }
    if (out->occlusion_program == 0) {
        gl_layers_destroy(out);
        return RLF_ERROR_DEVICE;
    }
    out->background_size = glGetUniformLocation(out->background_program, "u_size");
    out->occlusion_size = glGetUniformLocation(out->occlusion_program, "u_size");
    GLuint p = out->occlusion_program;
    glUseProgram(p);
    glUniform1i(glGetUniformLocation(p, "u_color"), UNIT_COLOR);
    glUniform1i(glGetUniformLocation(p, "u_real_depth"), UNIT_REAL_DEPTH);
    glUniform1i(glGetUniformLocation(p, "u_body_depth"), UNIT_BODY_DEPTH);
    glUniform2f(glGetUniformLocation(p, "u_near_far"), (GLfloat)VIEW_NEAR_M, (GLfloat)VIEW_FAR_M);
    glUseProgram(0);
    glGenVertexArrays(1, &out->empty_array);
    return RLF_OK;
}

void gl_layers_destroy(gl_layers *layers)
{
    glDeleteProgram(layers->background_program);
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

void gl_layers_draw_background(const gl_layers *layers, const gl_layer_images *images)
{
    glUseProgram(layers->background_program);
    glUniform2f(layers->background_size, (GLfloat)images->width, (GLfloat)images->height);
    gl_texture_bind(images->color, UNIT_COLOR);
    draw_screen(layers);
}

void gl_layers_draw_occlusion(const gl_layers *layers, const gl_layer_images *images)
{
    glUseProgram(layers->occlusion_program);
    glUniform2f(layers->occlusion_size, (GLfloat)images->width, (GLfloat)images->height);
    gl_texture_bind(images->color, UNIT_COLOR);
    gl_texture_bind(images->real_depth, UNIT_REAL_DEPTH);
    gl_texture_bind(images->body_depth, UNIT_BODY_DEPTH);
    draw_screen(layers);
}
