/* One row of a texture for each body that real things take light from. */
#include "render/gl/gl_light.h"

#include <string.h>

enum { ROWS_MAX = 2048 }; /* every driver has so many; more bodies in real shade stay lit */

gl_shade gl_shade_create(void)
{
    gl_shade shade = {.texture = gl_texture_create(GL_NEAREST)};
    return shade;
}

void gl_shade_destroy(gl_shade *shade)
{
    gl_texture_destroy(&shade->texture);
    rlf_free(shade->maps);
    rlf_free(shade->rows);
    rlf_free(shade->row_of);
    *shade = (gl_shade){0};
}

static rlf_result reserve(gl_shade *shade, int32_t count)
{
    if (count <= shade->capacity) {
        return RLF_OK;
    }
    rlf_free(shade->maps);
    rlf_free(shade->rows);
    rlf_free(shade->row_of);
    shade->capacity = 2 * count;
    size_t cells = (size_t)shade->capacity * REAL_SHADE_CELLS;
    shade->maps = rlf_alloc_array((size_t)shade->capacity, sizeof(*shade->maps));
    shade->rows = rlf_alloc_array(cells, sizeof(*shade->rows));
    shade->row_of = rlf_alloc_array((size_t)shade->capacity, sizeof(*shade->row_of));
    if (shade->maps == NULL || shade->rows == NULL || shade->row_of == NULL) {
        shade->capacity = 0;
        return RLF_ERROR_MEMORY;
    }
    return RLF_OK;
}

rlf_result gl_shade_update(gl_shade *shade, const real_shade_world *world, const caster *casters,
                           int32_t count)
{
    rlf_result result = reserve(shade, count);
    int32_t rows = 0;
    for (int32_t i = 0; i < count && result == RLF_OK; i++) {
        real_shade *map = &shade->maps[i];
        real_shade_make(world, &casters[i], map);
        bool has_row = map->takes && rows < ROWS_MAX;
        shade->row_of[i] = has_row ? rows : -1;
        if (has_row) {
            float *row = shade->rows + (size_t)rows++ * REAL_SHADE_CELLS;
            memcpy(row, map->left, sizeof(map->left));
        }
    }
    if (rows > 0) {
        gl_texture_upload_f32(&shade->texture, shade->rows, REAL_SHADE_CELLS, rows);
    }
    return result;
}

gl_shade_uniforms gl_shade_find_uniforms(GLuint program)
{
    gl_shade_uniforms u = {glGetUniformLocation(program, "u_shade_row"),
                           glGetUniformLocation(program, "u_shade_center"),
                           glGetUniformLocation(program, "u_shade_across"),
                           glGetUniformLocation(program, "u_shade_down")};
    return u;
}

void gl_shade_set(const gl_shade_uniforms *uniforms, const gl_shade *shade, int32_t index)
{
    const int32_t row = shade != NULL ? shade->row_of[index] : -1;
    glUniform1i(uniforms->row, row);
    if (row >= 0) {
        const real_shade *map = &shade->maps[index];
        glUniform3fv(uniforms->center, 1, map->center);
        glUniform3fv(uniforms->across, 1, map->across);
        glUniform3fv(uniforms->down, 1, map->down);
    }
}
