/* The triangle mesh as lines: points by eq. 4.1 in the vertex shader, placed by A.4. */
#include "gl_wireframe.h"

#include "gl_program.h"

/* Neighbours whose depths differ by more than this part of the nearer one are not joined. */
#define JOIN_MAX_JUMP 0.05

static const char wireframe_vertex[] =
    "layout(location = 0) in vec2 a_ray;\n"
    "layout(location = 1) in float a_depth;\n"
    "uniform mat4 u_clip_camera;\n"
    "void main()\n"
    "{\n"
    "    gl_Position = u_clip_camera * vec4(a_depth * a_ray, a_depth, 1.0);\n"
    "}\n";

static const char wireframe_fragment[] = "uniform vec3 u_color;\n"
                                         "out vec4 o_color;\n"
                                         "void main()\n"
                                         "{\n"
                                         "    o_color = vec4(u_color, 0.0);\n"
                                         "}\n";

static void create_buffers(gl_wireframe *wireframe, const float *rays, size_t count)
{
    GLuint names[3];
    glGenVertexArrays(1, &wireframe->vertex_array);
    glGenBuffers(3, names);
    wireframe->ray_buffer = names[0];
    wireframe->depth_buffer = names[1];
    wireframe->index_buffer = names[2];
    glBindVertexArray(wireframe->vertex_array);
    glBindBuffer(GL_ARRAY_BUFFER, wireframe->ray_buffer);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(2 * count * sizeof(float)), rays, GL_STATIC_DRAW);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, NULL);
    glBindBuffer(GL_ARRAY_BUFFER, wireframe->depth_buffer);
    glVertexAttribPointer(1, 1, GL_FLOAT, GL_FALSE, 0, NULL);
    glEnableVertexAttribArray(0);
    glEnableVertexAttribArray(1);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, wireframe->index_buffer);
    glBindVertexArray(0);
}

static rlf_result create_arrays(gl_wireframe *wireframe, const float *ray_x, const float *ray_y)
{
    size_t count = (size_t)wireframe->width * (size_t)wireframe->height;
    size_t index_count = rlf_mesh_index_count(wireframe->width, wireframe->height);
    float *rays = rlf_alloc_array(2 * count, sizeof(float));
    wireframe->triangles = rlf_alloc_array(index_count, sizeof(uint32_t));
    wireframe->lines = rlf_alloc_array(2 * index_count, sizeof(uint32_t));
    if (rays == NULL || wireframe->triangles == NULL || wireframe->lines == NULL) {
        rlf_free(rays);
        return RLF_ERROR_MEMORY;
    }
    for (size_t i = 0; i < count; i++) {
        rays[2 * i] = ray_x[i];
        rays[2 * i + 1] = ray_y[i];
    }
    create_buffers(wireframe, rays, count);
    rlf_free(rays);
    return RLF_OK;
}

rlf_result gl_wireframe_create(bool is_es, const rlf_camera *grid, const float *ray_x,
                               const float *ray_y, gl_wireframe *out)
{
    *out = (gl_wireframe){0};
    out->width = grid->width;
    out->height = grid->height;
    const gl_program_source source = {"wireframe", wireframe_vertex, wireframe_fragment};
    out->program = gl_program_build(is_es, &source);
    rlf_result result = out->program == 0 ? RLF_ERROR_DEVICE : create_arrays(out, ray_x, ray_y);
    if (result != RLF_OK) {
        gl_wireframe_destroy(out);
        return result;
    }
    out->clip_camera = glGetUniformLocation(out->program, "u_clip_camera");
    out->color = glGetUniformLocation(out->program, "u_color");
    return RLF_OK;
}

void gl_wireframe_destroy(gl_wireframe *wireframe)
{
    const GLuint buffers[3] = {wireframe->ray_buffer, wireframe->depth_buffer,
                               wireframe->index_buffer};
    glDeleteProgram(wireframe->program);
    glDeleteVertexArrays(1, &wireframe->vertex_array);
    glDeleteBuffers(3, buffers);
    rlf_free(wireframe->triangles);
    rlf_free(wireframe->lines);
    *wireframe = (gl_wireframe){0};
}

/* Edges of all triangles; an edge of two triangles is listed twice, which opaque lines hide. */
static size_t make_lines(gl_wireframe *wireframe, const rlf_surface *surface)
{
    size_t count = rlf_mesh_indices_valid(surface, JOIN_MAX_JUMP, wireframe->triangles);
    uint32_t *line = wireframe->lines;
    for (size_t i = 0; i < count; i += 3) {
        const uint32_t *corner = &wireframe->triangles[i];
        for (int edge = 0; edge < 3; edge++) {
            *line++ = corner[edge];
            *line++ = corner[(edge + 1) % 3];
        }
    }
    return 2 * count;
}

void gl_wireframe_draw(gl_wireframe *wireframe, const rlf_surface *surface, const gl_view *view,
                       const float color[3])
{
    size_t count = (size_t)wireframe->width * (size_t)wireframe->height;
    size_t index_count = make_lines(wireframe, surface);
    if (index_count == 0) {
        return;
    }
    glUseProgram(wireframe->program);
    gl_view_set_matrix(wireframe->clip_camera, &view->clip_camera);
    glUniform3f(wireframe->color, color[0], color[1], color[2]);
    glBindVertexArray(wireframe->vertex_array);
    glBindBuffer(GL_ARRAY_BUFFER, wireframe->depth_buffer);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(count * sizeof(float)), surface->depth,
                 GL_STREAM_DRAW);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(index_count * sizeof(uint32_t)),
                 wireframe->lines, GL_STREAM_DRAW);
    glDrawElements(GL_LINES, (GLsizei)index_count, GL_UNSIGNED_INT, NULL);
    glBindVertexArray(0);
    glUseProgram(0);
}
