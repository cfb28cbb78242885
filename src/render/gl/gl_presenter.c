/* Shows an image in a window: black bars around it or its edges cut, and askew where a projector
 * is; and others over it. */
#include "render/gl/gl_context.h"

#include "relief/gl.h"

#include <string.h>

struct rlf_gl_presenter {
    GLuint program, empty_array;
    GLint u_map, u_fit;
    gl_texture texture, over;
    bool is_mirrored, fills;
    GLfloat map[9]; /* by columns, as GL takes it */
};

/* From a place of the framebuffer to one of the image. */
typedef struct image_fit {
    GLfloat scale[2], shift[2];
} image_fit;

static const GLfloat same_place[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

/* Row 0 of the image is the top of the window. */
static const char presenter_vertex[] =
    "out vec2 v_at;\n"
    "void main()\n"
    "{\n"
    "    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);\n"
    "    v_at = 0.5 + vec2(0.5, -0.5) * corner;\n"
    "    gl_Position = vec4(corner, 0.0, 1.0);\n"
    "}\n";

static const char presenter_fragment[] =
    "in vec2 v_at;\n"
    "uniform sampler2D u_image;\n"
    "uniform mat3 u_map;\n"
    "uniform vec4 u_fit;\n" /* scale, shift */
    "out vec4 o_color;\n"
    "bool is_outside(vec2 at)\n"
    "{\n"
    "    return any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0)));\n"
    "}\n"
    "void main()\n"
    "{\n"
    "    vec3 mapped = u_map * vec3(v_at, 1.0);\n"
    "    vec2 place = mapped.xy / mapped.z;\n"
    "    vec2 uv = u_fit.xy * place + u_fit.zw;\n"
    "    vec4 color = texture(u_image, uv);\n"
    "    bool is_bar = mapped.z <= 0.0 || is_outside(place) || is_outside(uv);\n"
    "    o_color = is_bar ? vec4(0.0, 0.0, 0.0, 1.0) : color;\n"
    "}\n";

rlf_result rlf_gl_presenter_create(rlf_gl_presenter **out)
{
    gl_context context;
    if (!RLF_ASSERT(out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    rlf_result result = gl_context_adopt(&context);
    if (result != RLF_OK) {
        return result;
    }
    rlf_gl_presenter *p = rlf_alloc(sizeof *p);
    if (p == NULL) {
        return RLF_ERROR_MEMORY;
    }
    const gl_program_source source = {"presenter", {presenter_vertex}, {presenter_fragment}};
    p->program = gl_program_build(context.is_es, &source);
    if (p->program == 0) {
        rlf_free(p);
        return RLF_ERROR_DEVICE;
    }
    glGenVertexArrays(1, &p->empty_array);
    p->u_map = glGetUniformLocation(p->program, "u_map");
    p->u_fit = glGetUniformLocation(p->program, "u_fit");
    p->texture = gl_texture_create(GL_LINEAR);
    p->over = gl_texture_create(GL_NEAREST);
    p->is_mirrored = p->fills = false;
    memcpy(p->map, same_place, sizeof p->map);
    *out = p;
    return RLF_OK;
}

void rlf_gl_presenter_destroy(rlf_gl_presenter **presenter)
{
    if (presenter == NULL || *presenter == NULL) {
        return;
    }
    rlf_gl_presenter *p = *presenter;
    glDeleteProgram(p->program);
    glDeleteVertexArrays(1, &p->empty_array);
    gl_texture_destroy(&p->texture);
    gl_texture_destroy(&p->over);
    rlf_free(p);
    *presenter = NULL;
}

/* Largest rectangle of the image's proportions inside the framebuffer, or the smallest around it,
 * in whole pixels and at least one. */
static image_fit fit_image(const rlf_gl_presenter *p, const rlf_image_rgba8 *image, int32_t width,
                           int32_t height)
{
    const int64_t fitted_width = (int64_t)image->width * height / image->height;
    const int64_t fitted_height = (int64_t)image->height * width / image->width;
    const bool by_height = (fitted_width < width) != p->fills;
    int32_t w = by_height ? (int32_t)fitted_width : width;
    int32_t h = by_height ? height : (int32_t)fitted_height;
    w = w > 0 ? w : 1;
    h = h > 0 ? h : 1;
    const GLfloat x = (GLfloat)((width - w) / 2), y = (GLfloat)((height - h) / 2);
    image_fit fit = {{(GLfloat)width / (GLfloat)w, (GLfloat)height / (GLfloat)h},
                     {-x / (GLfloat)w, -y / (GLfloat)h}};
    if (p->is_mirrored) {
        fit.scale[0] = -fit.scale[0];
        fit.shift[0] = 1.0f - fit.shift[0];
    }
    return fit;
}

void rlf_gl_presenter_set_mirror(rlf_gl_presenter *presenter, bool is_mirrored)
{
    if (RLF_ASSERT(presenter != NULL)) {
        presenter->is_mirrored = is_mirrored;
    }
}

void rlf_gl_presenter_set_place(rlf_gl_presenter *presenter, bool fills, const rlf_mat3 *map)
{
    if (!RLF_ASSERT(presenter != NULL)) {
        return;
    }
    presenter->fills = fills;
    for (int i = 0; i < 9; i++) {
        presenter->map[i] = map != NULL ? (GLfloat)map->m[i % 3][i / 3] : same_place[i];
    }
}

static void draw_texture(const rlf_gl_presenter *p, const gl_texture *texture, const GLfloat map[9],
                         const image_fit *fit)
{
    glUseProgram(p->program);
    glUniformMatrix3fv(p->u_map, 1, GL_FALSE, map);
    glUniform4f(p->u_fit, fit->scale[0], fit->scale[1], fit->shift[0], fit->shift[1]);
    gl_texture_bind(texture, 0);
    glBindVertexArray(p->empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
    glUseProgram(0);
}

/* The default framebuffer, and nothing between it and what is drawn. */
static void prepare(void)
{
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_STENCIL_TEST);
}

void rlf_gl_presenter_draw(rlf_gl_presenter *presenter, const rlf_image_rgba8 *image,
                           int32_t framebuffer_width, int32_t framebuffer_height)
{
    if (!RLF_ASSERT(presenter != NULL && image != NULL && image->data != NULL) ||
        framebuffer_width < 1 || framebuffer_height < 1) {
        return;
    }
    prepare();
    gl_texture_upload_rgba8(&presenter->texture, image);
    glViewport(0, 0, framebuffer_width, framebuffer_height);
    glClearColor(0.0f, 0.0f, 0.0f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    const image_fit fit = fit_image(presenter, image, framebuffer_width, framebuffer_height);
    draw_texture(presenter, &presenter->texture, presenter->map, &fit);
}

void rlf_gl_presenter_draw_over(rlf_gl_presenter *presenter, const rlf_image_rgba8 *image,
                                int32_t x, int32_t y, int32_t framebuffer_height)
{
    if (!RLF_ASSERT(presenter != NULL && image != NULL && image->data != NULL)) {
        return;
    }
    prepare();
    gl_texture_upload_rgba8(&presenter->over, image);
    glViewport(x, framebuffer_height - y - image->height, image->width, image->height);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    const image_fit whole = {{1.0f, 1.0f}, {0.0f, 0.0f}};
    draw_texture(presenter, &presenter->over, same_place, &whole);
    glDisable(GL_BLEND);
}
