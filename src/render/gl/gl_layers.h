/* Full-screen layers: the backdrop under the bodies, and the thesis's layer of the real world in
 * front of a body. */
#ifndef RLF_RENDER_GL_LAYERS_H
#define RLF_RENDER_GL_LAYERS_H

#include "render/gl/gl_texture.h"

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

#endif
