/* Draws the surface's triangle mesh as a wireframe over the colour image (4.1.1, fig. 4.5). */
#ifndef RLF_RENDER_GL_WIREFRAME_H
#define RLF_RENDER_GL_WIREFRAME_H

#include "render/gl/gl_view.h"

#include "relief/surface.h"

typedef struct gl_wire_vertex {
    float p[3];       /* depth camera frame, metres; z = 0 where missing */
    uint8_t color[4]; /* by depth */
} gl_wire_vertex;

typedef struct gl_wireframe {
    GLuint program;
    GLint picture_camera; /* uniform */
    gl_view_uniforms view_uniforms;
    GLuint vertex_array, vertex_buffer, index_buffer;
    int32_t width, height; /* points that are drawn: every step-th of the grid */
    int32_t step;
    double near_z, far_z; /* of the colours */
    gl_wire_vertex *vertices;
    uint32_t *triangles; /* index list of the mesh */
    uint32_t *lines;     /* two indices per edge */
} gl_wireframe;

/* `scale_factor` is the surface's: every so many depth pixels is one of the grid. */
rlf_result gl_wireframe_create(bool is_es, const rlf_rig *rig, const rlf_camera *grid,
                               int32_t scale_factor, gl_wireframe *out);
void gl_wireframe_destroy(gl_wireframe *wireframe);
/* The surface must have the grid's size. */
void gl_wireframe_draw(gl_wireframe *wireframe, const rlf_surface *surface, const gl_view *view);

#endif
