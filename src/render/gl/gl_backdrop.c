/* Colour or grey depth, and shadows on it. */
#include "render/gl/gl_backdrop.h"

#include "render/gl/gl_context.h"

enum { UNIT_COLOR = 0, UNIT_REAL_DEPTH = 0, UNIT_NEAR = 1, UNIT_FAR = 2, UNIT_COVER = 3 };

static const char color_fragment[] =
    "uniform sampler2D u_color;\n"
    "uniform vec2 u_size;\n"
    "out vec4 o_color;\n"
    "void main()\n"
    "{\n"
    "    vec3 color = ivec2(u_size) == textureSize(u_color, 0)\n"
    "        ? texelFetch(u_color, ivec2(gl_FragCoord.xy), 0).rgb\n"
    "        : textureLod(u_color, gl_FragCoord.xy / u_size, 0.0).rgb;\n"
    "    o_color = vec4(color, 0.0);\n"
    "}\n";

static const char grey_fragment[] =
    "uniform sampler2D u_real_depth;\n"
    "uniform vec2 u_range;\n"
    "out vec4 o_color;\n"
    "void main()\n"
    "{\n"
    "    float z = texelFetch(u_real_depth, ivec2(gl_FragCoord.xy), 0).r;\n"
    "    float t = (z - u_range.x) / (u_range.y - u_range.x);\n"
    "    float grey = floor(clamp(240.0 - 200.0 * t, 40.0, 240.0)) / 255.0;\n"
    "    o_color = vec4(vec3(z > 0.0 ? grey : 0.0), 0.0);\n"
    "}\n";

/* On an edge the light of both sides is mixed as the matte says. */
static const char shadow_fragment[] =
    "const float ambient_share = 0.5;\n"
    "const float direct_share = 0.35;\n"
    "uniform sampler2D u_real_depth;\n"
    "uniform sampler2D u_near_z;\n"
    "uniform sampler2D u_far_z;\n"
    "uniform sampler2D u_cover;\n"
    "uniform bool u_has_sides;\n"
    "uniform caster u_caster;\n"
    "uniform vec4 u_intrinsics;\n" /* fx fy cx cy */
    "out vec4 o_light;\n"
    "float left_at(ivec2 pixel, float z)\n"
    "{\n"
    "    if (z <= 0.0 || z >= 1e8) {\n"
    "        return 1.0;\n"
    "    }\n"
    "    vec2 ray = (vec2(pixel) - u_intrinsics.zw) / u_intrinsics.xy;\n"
    "    vec2 lost = light_lost(u_caster, ray, z);\n"
    "    return (1.0 - ambient_share * lost.x) * (1.0 - direct_share * lost.y);\n"
    "}\n"
    "void main()\n"
    "{\n"
    "    ivec2 pixel = ivec2(gl_FragCoord.xy);\n"
    "    float left;\n"
    "    if (u_has_sides) {\n"
    "        left = mix(left_at(pixel, texelFetch(u_far_z, pixel, 0).r),\n"
    "            left_at(pixel, texelFetch(u_near_z, pixel, 0).r),\n"
    "            texelFetch(u_cover, pixel, 0).r);\n"
    "    } else {\n"
    "        left = left_at(pixel, texelFetch(u_real_depth, pixel, 0).r);\n"
    "    }\n"
    "    o_light = vec4(left);\n"
    "}\n";

static rlf_result make_programs(bool is_es, gl_backdrop *backdrop)
{
    const gl_program_source color = {"backdrop", {gl_program_screen_vertex}, {color_fragment}};
    const gl_program_source grey = {"grey depth", {gl_program_screen_vertex}, {grey_fragment}};
    const gl_program_source shadow = {
        "shadow", {gl_program_screen_vertex}, {gl_caster_glsl, shadow_fragment}};
    backdrop->color_program = gl_program_build(is_es, &color);
    if (backdrop->color_program != 0) {
        backdrop->grey_program = gl_program_build(is_es, &grey);
    }
    if (backdrop->grey_program != 0) {
        backdrop->shadow_program = gl_program_build(is_es, &shadow);
    }
    if (backdrop->shadow_program == 0) {
        return RLF_ERROR_DEVICE;
    }
    /* All other samplers read unit 0, the value that they start with. */
    GLuint p = backdrop->shadow_program;
    glUseProgram(p);
    glUniform1i(glGetUniformLocation(p, "u_near_z"), UNIT_NEAR);
    glUniform1i(glGetUniformLocation(p, "u_far_z"), UNIT_FAR);
    glUniform1i(glGetUniformLocation(p, "u_cover"), UNIT_COVER);
    glUseProgram(0);
    backdrop->uniforms.has_sides = glGetUniformLocation(p, "u_has_sides");
    backdrop->uniforms.color_size = glGetUniformLocation(backdrop->color_program, "u_size");
    backdrop->uniforms.grey_range = glGetUniformLocation(backdrop->grey_program, "u_range");
    backdrop->uniforms.caster = gl_caster_find_uniforms(p, "u_caster");
    backdrop->uniforms.intrinsics = glGetUniformLocation(p, "u_intrinsics");
    return RLF_OK;
}

static rlf_result make_framebuffer(int32_t width, int32_t height, gl_backdrop *backdrop)
{
    backdrop->texture = gl_texture_create(GL_NEAREST);
    gl_texture_allocate_rgba8(&backdrop->texture, width, height);
    glGenFramebuffers(1, &backdrop->framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, backdrop->framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                           backdrop->texture.name, 0);
    GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        return rlf_fail(RLF_ERROR_DEVICE,
                        "OpenGL: no texture of %d x %d to draw into (status 0x%x): use --renderer "
                        "soft",
                        (int)width, (int)height, (unsigned)status);
    }
    return RLF_OK;
}

rlf_result gl_backdrop_create(bool is_es, int32_t width, int32_t height, gl_backdrop *out)
{
    *out = (gl_backdrop){0};
    rlf_result result = make_programs(is_es, out);
    if (result == RLF_OK) {
        result = make_framebuffer(width, height, out);
    }
    if (result != RLF_OK) {
        gl_backdrop_destroy(out);
        return result;
    }
    glGenVertexArrays(1, &out->empty_array);
    return RLF_OK;
}

void gl_backdrop_destroy(gl_backdrop *backdrop)
{
    glDeleteProgram(backdrop->color_program);
    glDeleteProgram(backdrop->grey_program);
    glDeleteProgram(backdrop->shadow_program);
    glDeleteVertexArrays(1, &backdrop->empty_array);
    glDeleteFramebuffers(1, &backdrop->framebuffer);
    gl_texture_destroy(&backdrop->texture);
    *backdrop = (gl_backdrop){0};
}

static void bind(const gl_backdrop *backdrop)
{
    glBindFramebuffer(GL_FRAMEBUFFER, backdrop->framebuffer);
    glViewport(0, 0, backdrop->texture.width, backdrop->texture.height);
    glBindVertexArray(backdrop->empty_array);
}

static void unbind(void)
{
    glBindVertexArray(0);
    glUseProgram(0);
}

void gl_backdrop_clear(const gl_backdrop *backdrop)
{
    bind(backdrop);
    glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    unbind();
}

void gl_backdrop_draw_color(const gl_backdrop *backdrop, const gl_texture *color)
{
    bind(backdrop);
    glUseProgram(backdrop->color_program);
    glUniform2f(backdrop->uniforms.color_size, (GLfloat)backdrop->texture.width,
                (GLfloat)backdrop->texture.height);
    gl_texture_bind(color, UNIT_COLOR);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    unbind();
}

void gl_backdrop_draw_grey(const gl_backdrop *backdrop, const gl_texture *real_depth, double near_z,
                           double far_z)
{
    bind(backdrop);
    glUseProgram(backdrop->grey_program);
    glUniform2f(backdrop->uniforms.grey_range, (GLfloat)near_z, (GLfloat)far_z);
    gl_texture_bind(real_depth, UNIT_REAL_DEPTH);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    unbind();
}

void gl_backdrop_draw_shadows(const gl_backdrop *backdrop, const gl_backdrop_shadows *shadows)
{
    const rlf_camera *k = &shadows->view->camera;
    bind(backdrop);
    glUseProgram(backdrop->shadow_program);
    glUniform4f(backdrop->uniforms.intrinsics, (GLfloat)k->fx, (GLfloat)k->fy, (GLfloat)k->cx,
                (GLfloat)k->cy);
    gl_texture_bind(shadows->real_depth, UNIT_REAL_DEPTH);
    glUniform1i(backdrop->uniforms.has_sides, shadows->sides != NULL ? 1 : 0);
    if (shadows->sides != NULL) {
        gl_texture_bind(shadows->sides->near_z, UNIT_NEAR);
        gl_texture_bind(shadows->sides->far_z, UNIT_FAR);
        gl_texture_bind(shadows->sides->cover, UNIT_COVER);
    }
    glEnable(GL_SCISSOR_TEST);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ZERO, GL_SRC_COLOR);
    for (int32_t i = 0; i < shadows->caster_count; i++) {
        const caster *c = &shadows->casters[i];
        pixel_rect r;
        if (c->near_m > 0.0f && caster_reach(c, k, shadows->to_light, &r)) {
            glScissor(r.x0, r.y0, r.x1 - r.x0, r.y1 - r.y0);
            gl_caster_set_uniforms(&backdrop->uniforms.caster, c);
            glDrawArrays(GL_TRIANGLES, 0, 3);
        }
    }
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    unbind();
}
