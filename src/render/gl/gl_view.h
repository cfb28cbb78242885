/* From where a picture is drawn: the matrices of appendix A, as corrected. */
#ifndef RLF_RENDER_GL_VIEW_H
#define RLF_RENDER_GL_VIEW_H

#include "relief/camera.h"

#include <epoxy/gl.h>

#define VIEW_NEAR_M 0.02
#define VIEW_FAR_M 100.0

typedef struct gl_view {
    rlf_mat4 clip_camera;      /* projection times view, A.4: depth camera frame to clip space */
    rlf_pose T_picture_camera; /* depth camera to the picture's camera: the view matrix, A.2 */
    rlf_pose T_camera_world;
    double focal; /* of the picture's camera, pixels */
} gl_view;

/* Row 0 of the picture comes out at the framebuffer's row 0, so that reading back needs no flip;
 * triangles that are counter-clockwise to the eye are then clockwise to OpenGL. */
gl_view gl_view_make(const rlf_camera *picture, const rlf_pose *T_picture_camera,
                     const rlf_pose *T_world_camera);

/* Sets a mat4 uniform. */
void gl_view_set_matrix(GLint location, const rlf_mat4 *m);

#endif
