/* Draws the surface's triangle mesh as a wireframe over the colour image (4.1.1, fig. 4.5). */
#ifndef RLF_RENDER_GL_WIREFRAME_H
#define RLF_RENDER_GL_WIREFRAME_H

#include "gl_view.h"

#include "relief/surface.h"

typedef struct gl_wireframe {
    GLuint program;
    GLint clip_camera, color; /* uniforms */
    GLuint vertex_array, ray_buffer, depth_buffer, index_buffer;
    uint32_t *triangles; /* index list of the mesh */
    uint32_t *lines;     /* two indices per edge */
    int32_t width, height;
} gl_wireframe;

/* ray_x, ray_y: rays of a grid of width x height, constant for the wireframe's life. */
rlf_result gl_wireframe_create(bool is_es, const rlf_camera *grid, const float *ray_x,
                               const float *ray_y, gl_wireframe *out);
void gl_wireframe_destroy(gl_wireframe *wireframe);
/* The surface must have the grid's size. */
void gl_wireframe_draw(gl_wireframe *wireframe, const rlf_surface *surface, const gl_view *view,
                       const float color[3]);

#endif
