/* Models on the GPU: vertices and textures are uploaded when a model is first drawn. */
#ifndef RLF_RENDER_GL_MODELS_H
#define RLF_RENDER_GL_MODELS_H

#include "render/gl/gl_context.h"

#include "relief/model.h"

enum { GL_MODELS_MAX = 64 }; /* that stay there: beyond it the one longest unused goes */

typedef struct gl_model {
    uint64_t id;       /* of the model; equal ones share this */
    uint64_t last_use; /* 0 = this place is free */
    GLuint vertex_array, vertex_buffer, index_buffer;
    GLuint textures[RLF_MODEL_TEXTURES_MAX];
    int32_t texture_count;
} gl_model;

typedef struct gl_models {
    gl_model items[GL_MODELS_MAX];
    uint64_t uses; /* so far */
    int unit;      /* where textures are bound */
    GLuint white;  /* the texture of parts that have none */
} gl_models;

/* Textures are bound to `unit`, when they are uploaded and when they are drawn. */
rlf_result gl_models_create(int unit, gl_models **out);
/* Nulls the pointer; NULL is allowed. */
void gl_models_destroy(gl_models **models);
/* The model's objects, uploaded if they are not there. Binds its vertex array, whose attributes 0,
 * 1 and 2 are position, normal and texture coordinates. */
const gl_model *gl_models_bind(gl_models *models, const rlf_model *model);
/* Draws a part of the model that is bound, with its texture. */
void gl_models_draw_part(const gl_models *models, const gl_model *item, const rlf_model_part *part);

#endif
