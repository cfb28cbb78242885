/* From where a picture is drawn: appendix A, as corrected, and the lens of the picture's camera. */
#ifndef RLF_RENDER_GL_VIEW_H
#define RLF_RENDER_GL_VIEW_H

#include "relief/camera.h"

#include <epoxy/gl.h>

#define VIEW_NEAR_M 0.02
#define VIEW_FAR_M 100.0

typedef struct gl_view {
    rlf_camera camera;         /* of the picture */
    rlf_mat4 projection;       /* A.1 from the intrinsics */
    rlf_pose T_picture_camera; /* depth camera to the picture's: the view matrix, A.2 */
    rlf_pose T_camera_world;
    rlf_pose T_picture_world;
    double lens_limit2; /* squared length of (x, y) up to which the lens model holds; 0 = pinhole */
} gl_view;

/* Row 0 of the picture comes out at the framebuffer's row 0, so that reading back needs no flip;
 * triangles that are counter-clockwise to the eye are then clockwise to OpenGL. T_camera_world is
 * the identity until gl_view_place. */
gl_view gl_view_make(const rlf_camera *picture, const rlf_pose *T_picture_camera);
void gl_view_place(gl_view *view, const rlf_pose *T_world_camera);

/* GLSL: uniforms and `vec4 clip_of(vec3 p)`, p in the picture camera's frame. Distortion moves
 * vertices only, so long edges stay straight. */
extern const char gl_view_glsl[];

typedef struct gl_view_uniforms {
    GLint projection, lens, lens_limit2;
} gl_view_uniforms;

gl_view_uniforms gl_view_find_uniforms(GLuint program);
/* For the program in use. */
void gl_view_set_uniforms(const gl_view_uniforms *uniforms, const gl_view *view);
void gl_view_set_matrix(GLint location, const rlf_mat4 *m);

#endif
