/* Draws bodies: textured, lit, and hidden per pixel by the real depth. */
#ifndef RLF_RENDER_GL_BODIES_H
#define RLF_RENDER_GL_BODIES_H

#include "relief/frame.h"
#include "relief/model.h"
#include "render/gl/gl_context.h"
#include "render/gl/gl_light.h"
#include "render/gl/gl_view.h"
#include "render/shape_mesh.h"

/* ---- gl_models.c: models on the GPU: vertices and textures are uploaded when a model is first
 * drawn. */

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
    int unit;      /* where textures of colour are bound, and behind it: */
    GLuint white;  /* the texture of parts that have none */
} gl_models;

/* Units of textures, from the first one on. */
enum { GL_MODELS_COLOR, GL_MODELS_SURFACE, GL_MODELS_NORMALS };

/* Textures are bound to `unit`, when they are uploaded and when they are drawn. */
rlf_result gl_models_create(int unit, gl_models **out);
/* Nulls the pointer; NULL is allowed. */
void gl_models_destroy(gl_models **models);
/* The model's objects, uploaded if they are not there. Binds its vertex array, whose attributes 0,
 * 1 and 2 are position, normal and texture coordinates. */
const gl_model *gl_models_bind(gl_models *models, const rlf_model *model);
/* Draws a part of the model that is bound, with its textures. */
void gl_models_draw_part(const gl_models *models, const gl_model *item, const rlf_model_part *part);

/* ---- All bodies. */

typedef struct gl_bodies {
    GLuint program;
    struct {
        GLint picture_body, camera_body, picture_camera, shift, color, light, layer, level,
            has_skin, has_normals, occlusion, noise, intrinsics, shader_count;
        gl_probe_uniforms probe;
        gl_caster_uniforms shaders[CASTER_BODIES];
        gl_shade_uniforms shade;
        gl_obscurance_uniforms near_by;
    } uniforms;
    gl_view_uniforms view_uniforms;
    GLuint vertex_array, vertex_buffer, index_buffer; /* unit meshes */
    GLuint hull_array, hull_buffer;                   /* a hull's triangles, streamed */
    GLuint textures;                                  /* array: one layer per texture kind */
    gl_models *models;
    shape_mesh_range range[SHAPE_MESH_UNIT_COUNT];
    shape_vertex *hull_vertices; /* a batch on its way to hull_buffer */
} gl_bodies;

/* What all bodies of a picture share. */
typedef struct gl_bodies_pass {
    const gl_view *view;
    const gl_probes *probes;      /* of the snapshot's bodies */
    rlf_vec3 light_direction;     /* depth camera frame, from the light into the scene */
    const gl_texture *backdrop;   /* shows through where the real world hides a part of a pixel */
    const gl_texture *real_depth; /* z in the picture's camera per pixel; NULL = none */
    const gl_soft_real *soft; /* instead of real_depth; NULL = none. Without both nothing hides */
    const caster *casters;    /* as the snapshot's bodies; NULL = no shadows */
    const gl_shade *shade;    /* NULL = real things take no light */
    const gl_obscurance *near_by; /* NULL = nor the light around */
} gl_bodies_pass;

rlf_result gl_bodies_create(bool is_es, gl_bodies *out);
void gl_bodies_destroy(gl_bodies *bodies);
/* Binds the program and what the pass shares. Depth test and masks are the caller's. */
void gl_bodies_begin(const gl_bodies *bodies, const gl_bodies_pass *pass);
void gl_bodies_draw(const gl_bodies *bodies, const gl_bodies_pass *pass,
                    const rlf_snapshot *snapshot, int32_t index);
void gl_bodies_end(void);

#endif
