/* The triangle mesh as lines: points by eq. 4.1, placed by A.4. */
#include "render/gl/gl_wireframe.h"

#include "render/gl/gl_context.h"

#include "render/soft/draw.h"

#include <stddef.h>

#define SPACING_PX 8  /* of the full depth image, as with the thesis's scale factor */
#define JUMP_MAX 0.15 /* of the nearer depth: a longer edge bridges two things */

static const char wireframe_vertex[] =
    "layout(location = 0) in vec3 a_position;\n"
    "layout(location = 1) in vec4 a_color;\n"
    "uniform mat4 u_picture_camera;\n"
    "out vec3 v_color;\n"
    "void main()\n"
    "{\n"
    "    gl_Position = clip_of((u_picture_camera * vec4(a_position, 1.0)).xyz);\n"
    "    v_color = a_color.rgb;\n"
    "}\n";

static const char wireframe_fragment[] = "in vec3 v_color;\n"
                                         "out vec4 o_color;\n"
                                         "void main()\n"
                                         "{\n"
                                         "    o_color = vec4(v_color, 0.0);\n"
                                         "}\n";

static void create_buffers(gl_wireframe *wireframe)
{
    GLuint names[2];
    const GLsizei stride = (GLsizei)sizeof(gl_wire_vertex);
    glGenVertexArrays(1, &wireframe->vertex_array);
    glGenBuffers(2, names);
    wireframe->vertex_buffer = names[0];
    wireframe->index_buffer = names[1];
    glBindVertexArray(wireframe->vertex_array);
    glBindBuffer(GL_ARRAY_BUFFER, wireframe->vertex_buffer);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, stride, NULL);
    glVertexAttribPointer(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride,
                          (const void *)(uintptr_t)offsetof(gl_wire_vertex, color));
    glEnableVertexAttribArray(0);
    glEnableVertexAttribArray(1);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, wireframe->index_buffer);
    glBindVertexArray(0);
}

static rlf_result create_arrays(gl_wireframe *wireframe)
{
    size_t count = (size_t)wireframe->width * (size_t)wireframe->height;
    size_t index_count = rlf_mesh_index_count(wireframe->width, wireframe->height);
    wireframe->vertices = rlf_alloc_array(count, sizeof(gl_wire_vertex));
    wireframe->triangles = rlf_alloc_array(index_count, sizeof(uint32_t));
    wireframe->lines = rlf_alloc_array(2 * index_count, sizeof(uint32_t));
    if (wireframe->vertices == NULL || wireframe->triangles == NULL || wireframe->lines == NULL) {
        return RLF_ERROR_MEMORY;
    }
    if (index_count > 0) {
        rlf_mesh_indices(wireframe->width, wireframe->height, wireframe->triangles);
    }
    create_buffers(wireframe);
    return RLF_OK;
}

rlf_result gl_wireframe_create(bool is_es, const rlf_rig *rig, const rlf_camera *grid,
                               int32_t scale_factor, gl_wireframe *out)
{
    *out = (gl_wireframe){0};
    int32_t factor = scale_factor > 0 ? scale_factor : 1;
    out->step = factor < SPACING_PX ? SPACING_PX / factor : 1;
    out->width = (grid->width - 1) / out->step + 1;
    out->height = (grid->height - 1) / out->step + 1;
    bool has_range = rig->depth_max_m > rig->depth_min_m;
    out->near_z = has_range ? rig->depth_min_m : 0.5;
    out->far_z = has_range ? rig->depth_max_m : 4.5;
    const gl_program_source source = {
        "wireframe", {gl_view_glsl, wireframe_vertex}, {wireframe_fragment}};
    out->program = gl_program_build(is_es, &source);
    rlf_result result = out->program == 0 ? RLF_ERROR_DEVICE : create_arrays(out);
    if (result != RLF_OK) {
        gl_wireframe_destroy(out);
        return result;
    }
    out->picture_camera = glGetUniformLocation(out->program, "u_picture_camera");
    out->view_uniforms = gl_view_find_uniforms(out->program);
    return RLF_OK;
}

void gl_wireframe_destroy(gl_wireframe *wireframe)
{
    const GLuint buffers[2] = {wireframe->vertex_buffer, wireframe->index_buffer};
    glDeleteProgram(wireframe->program);
    glDeleteVertexArrays(1, &wireframe->vertex_array);
    glDeleteBuffers(2, buffers);
    rlf_free(wireframe->vertices);
    rlf_free(wireframe->triangles);
    rlf_free(wireframe->lines);
    *wireframe = (gl_wireframe){0};
}

static void make_vertices(gl_wireframe *wireframe, const rlf_surface *surface)
{
    gl_wire_vertex *vertex = wireframe->vertices;
    double range = wireframe->far_z - wireframe->near_z;
    for (int32_t y = 0; y < wireframe->height; y++) {
        for (int32_t x = 0; x < wireframe->width; x++) {
            int32_t i = (y * surface->width + x) * wireframe->step;
            rlf_vec3 p = rlf_surface_point(surface, i);
            soft_color color = soft_color_near_far(0.7 * (p.z - wireframe->near_z) / range);
            *vertex++ = (gl_wire_vertex){{(float)p.x, (float)p.y, (float)p.z},
                                         {color.r, color.g, color.b, 255}};
        }
    }
}

static bool is_joined(const gl_wireframe *wireframe, uint32_t from, uint32_t to)
{
    float a = wireframe->vertices[from].p[2];
    float b = wireframe->vertices[to].p[2];
    float nearer = a < b ? a : b;
    float farther = a < b ? b : a;
    return nearer > 0.0f && farther - nearer <= (float)JUMP_MAX * nearer;
}

/* Edges of all triangles; opaque lines hide that an edge of two triangles is drawn twice. */
static size_t make_lines(gl_wireframe *wireframe)
{
    size_t count = rlf_mesh_index_count(wireframe->width, wireframe->height);
    uint32_t *line = wireframe->lines;
    for (size_t i = 0; i < count; i += 3) {
        const uint32_t *corner = &wireframe->triangles[i];
        for (int edge = 0; edge < 3; edge++) {
            uint32_t from = corner[edge];
            uint32_t to = corner[(edge + 1) % 3];
            if (is_joined(wireframe, from, to)) {
                *line++ = from;
                *line++ = to;
            }
        }
    }
    return (size_t)(line - wireframe->lines);
}

void gl_wireframe_draw(gl_wireframe *wireframe, const rlf_surface *surface, const gl_view *view)
{
    make_vertices(wireframe, surface);
    size_t line_indices = make_lines(wireframe);
    if (line_indices == 0) {
        return;
    }
    size_t count = (size_t)wireframe->width * (size_t)wireframe->height;
    rlf_mat4 picture_camera = rlf_mat4_from_pose(&view->T_picture_camera);
    glUseProgram(wireframe->program);
    gl_view_set_uniforms(&wireframe->view_uniforms, view);
    gl_view_set_matrix(wireframe->picture_camera, &picture_camera);
    glBindVertexArray(wireframe->vertex_array);
    glBindBuffer(GL_ARRAY_BUFFER, wireframe->vertex_buffer);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(count * sizeof(gl_wire_vertex)), wireframe->vertices,
                 GL_STREAM_DRAW);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(line_indices * sizeof(uint32_t)),
                 wireframe->lines, GL_STREAM_DRAW);
    glDrawElements(GL_LINES, (GLsizei)line_indices, GL_UNSIGNED_INT, NULL);
    glBindVertexArray(0);
    glUseProgram(0);
}
