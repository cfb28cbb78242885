/* Shows an image in a window: black bars around it or its edges cut, and askew where a projector
 * is; and others over it. */
#include "render/gl/gl_context.h"

#include "relief/gl.h"

/* Straight pictures go by a program of their own: where OpenGL runs on the CPU it takes half the
 * time. */
struct rlf_gl_presenter {
    GLuint straight, askew, empty_array;
    GLint u_flip, u_map, u_fit;
    gl_texture texture, over;
    bool is_mirrored, fills, is_askew;
    GLfloat map[9]; /* by columns, as GL takes it */
};

/* A rectangle of the framebuffer, from its lower left; may reach beyond it. */
typedef struct image_rect {
    int32_t x, y, width, height;
} image_rect;

/* Row 0 of the image is the top of the window. */
static const char straight_vertex[] =
    "uniform float u_flip;\n" /* 1: left and right changed */
    "out vec2 v_uv;\n"
    "void main()\n"
    "{\n"
    "    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);\n"
    "    v_uv = vec2(0.5 + (0.5 - u_flip) * corner.x, 0.5 - 0.5 * corner.y);\n"
    "    gl_Position = vec4(corner, 0.0, 1.0);\n"
    "}\n";

static const char straight_fragment[] = "in vec2 v_uv;\n"
                                        "uniform sampler2D u_image;\n"
                                        "out vec4 o_color;\n"
                                        "void main()\n"
                                        "{\n"
                                        "    o_color = texture(u_image, v_uv);\n"
                                        "}\n";

static const char askew_fragment[] =
    "in vec2 v_uv;\n"
    "uniform sampler2D u_image;\n"
    "uniform mat3 u_map;\n"
    "uniform vec4 u_fit;\n" /* scale, shift: from a place of the window to one of the image */
    "out vec4 o_color;\n"
    "bool is_outside(vec2 at)\n"
    "{\n"
    "    return any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0)));\n"
    "}\n"
    "void main()\n"
    "{\n"
    "    vec3 mapped = u_map * vec3(v_uv, 1.0);\n"
    "    vec2 place = mapped.xy / mapped.z;\n"
    "    vec2 uv = u_fit.xy * place + u_fit.zw;\n"
    "    vec4 color = textureLod(u_image, uv, 0.0);\n"
    "    bool is_bar = mapped.z <= 0.0 || is_outside(place) || is_outside(uv);\n"
    "    o_color = is_bar ? vec4(0.0, 0.0, 0.0, 1.0) : color;\n"
    "}\n";

static bool make_programs(rlf_gl_presenter *p, bool is_es)
{
    const gl_program_source straight = {"presenter", {straight_vertex}, {straight_fragment}};
    const gl_program_source askew = {"keystone", {straight_vertex}, {askew_fragment}};
    p->straight = gl_program_build(is_es, &straight);
    p->askew = p->straight != 0 ? gl_program_build(is_es, &askew) : 0;
    return p->askew != 0;
}

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
    if (!make_programs(p, context.is_es)) {
        glDeleteProgram(p->straight);
        rlf_free(p);
        return RLF_ERROR_DEVICE;
    }
    glGenVertexArrays(1, &p->empty_array);
    p->u_flip = glGetUniformLocation(p->straight, "u_flip");
    p->u_map = glGetUniformLocation(p->askew, "u_map");
    p->u_fit = glGetUniformLocation(p->askew, "u_fit");
    p->texture = gl_texture_create(GL_LINEAR);
    p->over = gl_texture_create(GL_NEAREST);
    p->is_mirrored = p->fills = p->is_askew = false;
    *out = p;
    return RLF_OK;
}

void rlf_gl_presenter_destroy(rlf_gl_presenter **presenter)
{
    if (presenter == NULL || *presenter == NULL) {
        return;
    }
    rlf_gl_presenter *p = *presenter;
    glDeleteProgram(p->straight);
    glDeleteProgram(p->askew);
    glDeleteVertexArrays(1, &p->empty_array);
    gl_texture_destroy(&p->texture);
    gl_texture_destroy(&p->over);
    rlf_free(p);
    *presenter = NULL;
}

/* Largest rectangle of the image's proportions inside the framebuffer, or the smallest around it,
 * at least one pixel. */
static image_rect fit_image(const rlf_gl_presenter *p, const rlf_image_rgba8 *image, int32_t width,
                            int32_t height)
{
    const int64_t fitted_width = (int64_t)image->width * height / image->height;
    const int64_t fitted_height = (int64_t)image->height * width / image->width;
    const bool by_height = (fitted_width < width) != p->fills;
    int32_t w = by_height ? (int32_t)fitted_width : width;
    int32_t h = by_height ? height : (int32_t)fitted_height;
    w = w > 0 ? w : 1;
    h = h > 0 ? h : 1;
    return (image_rect){(width - w) / 2, (height - h) / 2, w, h};
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
    presenter->is_askew = map != NULL;
    for (int i = 0; map != NULL && i < 9; i++) {
        presenter->map[i] = (GLfloat)map->m[i % 3][i / 3];
    }
}

static void draw_triangle(const rlf_gl_presenter *p, const gl_texture *texture)
{
    gl_texture_bind(texture, 0);
    glBindVertexArray(p->empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
    glUseProgram(0);
}

static void draw_straight(const rlf_gl_presenter *p, const gl_texture *texture, bool is_flipped)
{
    glUseProgram(p->straight);
    glUniform1f(p->u_flip, is_flipped ? 1.0f : 0.0f);
    draw_triangle(p, texture);
}

/* The rectangle is where the image would be if nothing were askew. */
static void draw_askew(const rlf_gl_presenter *p, const image_rect *r, int32_t width,
                       int32_t height)
{
    const GLfloat w = (GLfloat)r->width, h = (GLfloat)r->height;
    const GLfloat x = -(GLfloat)r->x / w, y = -(GLfloat)r->y / h;
    const GLfloat scale = (GLfloat)width / w;
    glUseProgram(p->askew);
    glUniformMatrix3fv(p->u_map, 1, GL_FALSE, p->map);
    glUniform4f(p->u_fit, p->is_mirrored ? -scale : scale, (GLfloat)height / h,
                p->is_mirrored ? 1.0f - x : x, y);
    draw_triangle(p, &p->texture);
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
    const image_rect r = fit_image(presenter, image, framebuffer_width, framebuffer_height);
    if (presenter->is_askew) {
        draw_askew(presenter, &r, framebuffer_width, framebuffer_height);
    } else {
        glViewport(r.x, r.y, r.width, r.height);
        draw_straight(presenter, &presenter->texture, presenter->is_mirrored);
    }
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
    draw_straight(presenter, &presenter->over, false);
    glDisable(GL_BLEND);
}
