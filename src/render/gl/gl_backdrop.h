/* The real world behind the bodies: the colour image, or depth in grey, with the bodies' shadows on
 * it, in a texture of the picture's size. */
#ifndef RLF_RENDER_GL_BACKDROP_H
#define RLF_RENDER_GL_BACKDROP_H

#include "render/gl/gl_light.h"
#include "render/gl/gl_context.h"
#include "render/gl/gl_view.h"

typedef struct gl_backdrop {
    GLuint framebuffer, empty_array;
    gl_texture texture; /* the result */
    GLuint color_program, grey_program, shadow_program;
    struct {
        GLint color_size;
        GLint grey_range;
        gl_caster_uniforms caster;
        GLint intrinsics, has_sides;
    } uniforms;
} gl_backdrop;

rlf_result gl_backdrop_create(bool is_es, int32_t width, int32_t height, gl_backdrop *out);
void gl_backdrop_destroy(gl_backdrop *backdrop);

/* Nothing: black, for bodies alone. */
void gl_backdrop_clear(const gl_backdrop *backdrop);
/* Each draws over what is there; the framebuffer stays bound after the first of the two. */
void gl_backdrop_draw_color(const gl_backdrop *backdrop, const gl_texture *color);
/* Near is light, far is dark, unknown is black. */
void gl_backdrop_draw_grey(const gl_backdrop *backdrop, const gl_texture *real_depth, double near_z,
                           double far_z);

/* Darkens what the bodies keep the light from. to_light: unit, picture camera frame. */
typedef struct gl_backdrop_shadows {
    const gl_view *view;
    const gl_texture *real_depth;
    const gl_soft_real *sides; /* of edges; NULL = none */
    rlf_vec3 to_light;
    const caster *casters;
    int32_t caster_count;
} gl_backdrop_shadows;
void gl_backdrop_draw_shadows(const gl_backdrop *backdrop, const gl_backdrop_shadows *shadows);

#endif
