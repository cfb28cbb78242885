/* Occlusion as the thesis does it (4.2.2, figs. 4.13 and 4.14): one layer of reality per body. */
#ifndef RLF_RENDER_GL_THESIS_H
#define RLF_RENDER_GL_THESIS_H

#include "render/gl/gl_bodies.h"
#include "render/gl/gl_context.h"

/* ---- gl_layers.c: full-screen layers: the backdrop under the bodies, and the thesis's layer of
 * the real world in front of a body. */

typedef struct gl_layers {
    GLuint backdrop_program, occlusion_program;
    GLuint empty_array;
} gl_layers;

rlf_result gl_layers_create(bool is_es, gl_layers *out);
void gl_layers_destroy(gl_layers *layers);

/* Textures of the picture's size. */
typedef struct gl_layer_images {
    const gl_texture *backdrop;
    const gl_texture *real_depth; /* occlusion only */
    const gl_texture *body_depth; /* occlusion only: depth buffer of the one body */
} gl_layer_images;

/* Fills the picture with the backdrop, alpha 0. */
void gl_layers_draw_backdrop(const gl_layers *layers, const gl_layer_images *images);
/* Section 4.2.2: the backdrop, opaque where the real depth is less than the body's z and
 * transparent elsewhere. Stencil and blending are the caller's. */
void gl_layers_draw_occlusion(const gl_layers *layers, const gl_layer_images *images);

/* ---- gl_thesis.c: a body and its layer. */

typedef struct gl_thesis {
    GLuint framebuffer;    /* depth only */
    gl_texture body_depth; /* of the one body being layered */
} gl_thesis;

rlf_result gl_thesis_create(int32_t width, int32_t height, gl_thesis *out);
void gl_thesis_destroy(gl_thesis *thesis);

typedef struct gl_thesis_pass {
    const gl_target *target;
    const gl_bodies *bodies;
    const gl_layers *layers;
    gl_bodies_pass body_pass; /* real_depth NULL: the layer hides, not the body's shader */
    gl_layer_images images;   /* body_depth is filled in */
} gl_thesis_pass;

/* Draws one body and the layer over it. Expects the depth test and culling on and the target bound;
 * leaves them so. The order of bodies does not matter: the depth buffer keeps a far body from both
 * drawing and stencilling over a nearer one. */
void gl_thesis_draw(const gl_thesis *thesis, const gl_thesis_pass *pass,
                    const rlf_snapshot *snapshot, int32_t index);

#endif
