/* Shows an image in a window: one textured rectangle with black bars, and others over it. */
#include "render/gl/gl_context.h"

#include "relief/gl.h"

struct rlf_gl_presenter {
    GLuint program, empty_array;
    GLint u_flip;
    gl_texture texture, over;
    bool is_mirrored;
};

/* Row 0 of the image is the top of the window. */
static const char presenter_vertex[] =
    "uniform float u_flip;\n" /* 1: left and right changed */
    "out vec2 v_uv;\n"
    "void main()\n"
    "{\n"
    "    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);\n"
    "    v_uv = vec2(0.5 + (0.5 - u_flip) * corner.x, 0.5 - 0.5 * corner.y);\n"
    "    gl_Position = vec4(corner, 0.0, 1.0);\n"
    "}\n";

static const char presenter_fragment[] = "in vec2 v_uv;\n"
                                         "uniform sampler2D u_image;\n"
                                         "out vec4 o_color;\n"
                                         "void main()\n"
                                         "{\n"
                                         "    o_color = texture(u_image, v_uv);\n"
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
    p->u_flip = glGetUniformLocation(p->program, "u_flip");
    p->texture = gl_texture_create(GL_LINEAR);
    p->over = gl_texture_create(GL_NEAREST);
    p->is_mirrored = false;
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

/* Largest rectangle of the image's proportions inside the framebuffer, at least one pixel. */
static void set_letterbox(const rlf_image_rgba8 *image, int32_t width, int32_t height)
{
    int64_t fitted_width = (int64_t)image->width * height / image->height;
    int64_t fitted_height = (int64_t)image->height * width / image->width;
    int32_t w = fitted_width < width ? (int32_t)fitted_width : width;
    int32_t h = fitted_width < width ? height : (int32_t)fitted_height;
    w = w > 0 ? w : 1;
    h = h > 0 ? h : 1;
    glViewport((width - w) / 2, (height - h) / 2, w, h);
}

void rlf_gl_presenter_set_mirror(rlf_gl_presenter *presenter, bool is_mirrored)
{
    if (RLF_ASSERT(presenter != NULL)) {
        presenter->is_mirrored = is_mirrored;
    }
}

static void draw_texture(const rlf_gl_presenter *p, const gl_texture *texture, bool is_flipped)
{
    glUseProgram(p->program);
    glUniform1f(p->u_flip, is_flipped ? 1.0f : 0.0f);
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
    set_letterbox(image, framebuffer_width, framebuffer_height);
    draw_texture(presenter, &presenter->texture, presenter->is_mirrored);
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
    draw_texture(presenter, &presenter->over, false);
    glDisable(GL_BLEND);
}
