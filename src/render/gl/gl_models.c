/* Uploads of models, and who stays. */
#include "render/gl/gl_bodies.h"

#include <stddef.h>

/* Leaves it bound to `unit`, which must be the skin's own: uploads happen while bodies are drawn.
 */
static GLuint create_texture(const rlf_model_texture *texture, int unit)
{
    GLuint name;
    glGenTextures(1, &name);
    glActiveTexture(GL_TEXTURE0 + (GLenum)unit);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_REPEAT);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_REPEAT);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, texture->level_count - 1);
    for (int32_t i = 0; i < texture->level_count; i++) {
        int32_t width, height;
        size_t offset = rlf_model_texture_level(texture, i, &width, &height);
        glTexImage2D(GL_TEXTURE_2D, i, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                     texture->texels + offset);
    }
    return name;
}

static void describe_vertices(void)
{
    const GLsizei stride = (GLsizei)sizeof(rlf_model_vertex);
    const uintptr_t normal = offsetof(rlf_model_vertex, normal);
    const uintptr_t uv = offsetof(rlf_model_vertex, uv);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, stride, NULL);
    glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, stride, (const void *)normal);
    glVertexAttribPointer(2, 2, GL_FLOAT, GL_FALSE, stride, (const void *)uv);
    for (GLuint i = 0; i < 3; i++) {
        glEnableVertexAttribArray(i);
    }
}

static void upload(const rlf_model *model, int unit, gl_model *out)
{
    glGenVertexArrays(1, &out->vertex_array);
    glGenBuffers(1, &out->vertex_buffer);
    glGenBuffers(1, &out->index_buffer);
    glBindVertexArray(out->vertex_array);
    glBindBuffer(GL_ARRAY_BUFFER, out->vertex_buffer);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)sizeof(rlf_model_vertex) * model->vertex_count,
                 model->vertices, GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, out->index_buffer);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)sizeof(int32_t) * 3 * model->triangle_count,
                 model->triangles, GL_STATIC_DRAW);
    describe_vertices();
    for (int32_t i = 0; i < model->texture_count; i++) {
        out->textures[i] = create_texture(&model->textures[i], unit);
    }
    out->texture_count = model->texture_count;
    out->id = model->id;
}

static void discard(gl_model *item)
{
    const GLuint buffers[2] = {item->vertex_buffer, item->index_buffer};
    glDeleteVertexArrays(1, &item->vertex_array);
    glDeleteBuffers(2, buffers);
    glDeleteTextures(item->texture_count, item->textures);
    *item = (gl_model){0};
}

rlf_result gl_models_create(int unit, gl_models **out)
{
    static const uint8_t white[4] = {255, 255, 255, 255};
    const rlf_model_texture texture = {white, 1, 1, 1};
    *out = rlf_alloc(sizeof(**out));
    if (*out == NULL) {
        return RLF_ERROR_MEMORY;
    }
    (*out)->unit = unit;
    (*out)->white = create_texture(&texture, unit);
    return RLF_OK;
}

void gl_models_destroy(gl_models **models)
{
    if (*models == NULL) {
        return;
    }
    for (int i = 0; i < GL_MODELS_MAX; i++) {
        discard(&(*models)->items[i]);
    }
    glDeleteTextures(1, &(*models)->white);
    rlf_free(*models);
    *models = NULL;
}

const gl_model *gl_models_bind(gl_models *models, const rlf_model *model)
{
    gl_model *oldest = &models->items[0];
    gl_model *found = NULL;
    for (int i = 0; i < GL_MODELS_MAX && found == NULL; i++) {
        gl_model *item = &models->items[i];
        bool is_it = item->last_use > 0 && item->id == model->id;
        found = is_it ? item : NULL;
        oldest = item->last_use < oldest->last_use ? item : oldest;
    }
    if (found == NULL) {
        discard(oldest);
        upload(model, models->unit, oldest);
        found = oldest;
    }
    found->last_use = ++models->uses;
    glBindVertexArray(found->vertex_array);
    return found;
}

/* Number 0 = none. */
static void bind_texture(const gl_models *models, const gl_model *item, int unit, int32_t number)
{
    glActiveTexture(GL_TEXTURE0 + (GLenum)(models->unit + unit));
    glBindTexture(GL_TEXTURE_2D, number > 0 ? item->textures[number - 1] : models->white);
}

void gl_models_draw_part(const gl_models *models, const gl_model *item, const rlf_model_part *part)
{
    const uintptr_t first = 3 * sizeof(int32_t) * (uintptr_t)part->first_triangle;
    bind_texture(models, item, GL_MODELS_COLOR, part->texture + 1);
    bind_texture(models, item, GL_MODELS_SURFACE, part->surface_texture);
    bind_texture(models, item, GL_MODELS_NORMALS, part->normal_texture);
    glDrawElements(GL_TRIANGLES, 3 * part->triangle_count, GL_UNSIGNED_INT, (const void *)first);
}
