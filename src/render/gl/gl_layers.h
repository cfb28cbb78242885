/* Full-screen layers: the colour image behind the bodies, and the thesis's layer of the real world
 * in front of a body. */
#ifndef RLF_RENDER_GL_LAYERS_H
#define RLF_RENDER_GL_LAYERS_H

#include "gl_texture.h"

typedef struct gl_layers {
    GLuint background_program, occlusion_program;
    GLint background_size, occlusion_size; /* uniforms: size of the picture, pixels */
    GLuint empty_array;
} gl_layers;

rlf_result gl_layers_create(bool is_es, gl_layers *out);
void gl_layers_destroy(gl_layers *layers);

/* Textures of a picture and its size. */
typedef struct gl_layer_images {
    const gl_texture *color;
    const gl_texture *real_depth; /* occlusion only */
    const gl_texture *body_depth; /* occlusion only: depth buffer of the one body */
    int32_t width, height;
} gl_layer_images;

/* Fills the picture with the colour image, alpha 0. */
void gl_layers_draw_background(const gl_layers *layers, const gl_layer_images *images);
/* Section 4.2.2: the colour image with alpha 1 where the real depth is less than the body's z, and
 * alpha 0 elsewhere. Stencil and blending are the caller's. */
void gl_layers_draw_occlusion(const gl_layers *layers, const gl_layer_images *images);

#endif
