/* Draws bodies: textured, lit, and hidden per pixel by the real depth. */
#ifndef RLF_RENDER_GL_BODIES_H
#define RLF_RENDER_GL_BODIES_H

#include "render/gl/gl_caster.h"
#include "render/gl/gl_models.h"
#include "render/gl/gl_obscurance.h"
#include "render/gl/gl_shade.h"
#include "render/gl/gl_texture.h"
#include "render/gl/gl_view.h"

#include "relief/frame.h"
#include "render/shape_mesh.h"

typedef struct gl_bodies {
    GLuint program;
    struct {
        GLint picture_body, camera_body, shift, color, light, layer, level, has_skin, occlusion,
            noise, intrinsics, shader_count;
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

/* The real world of soft occlusion: see environment/edge_matte.h. */
typedef struct gl_soft_real {
    const gl_texture *near_z, *far_z, *cover;
    const rlf_depth_noise *noise;
} gl_soft_real;

/* What all bodies of a picture share. */
typedef struct gl_bodies_pass {
    const gl_view *view;
    const float *light_color;     /* three shares of the bodies' colours */
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
