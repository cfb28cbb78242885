/* Matrices of a picture. */
#include "gl_view.h"

gl_view gl_view_make(const rlf_camera *picture, const rlf_pose *T_picture_camera,
                     const rlf_pose *T_world_camera)
{
    gl_view view;
    rlf_mat4 projection = rlf_camera_projection(picture, VIEW_NEAR_M, VIEW_FAR_M);
    for (int column = 0; column < 4; column++) {
        projection.m[1][column] = -projection.m[1][column];
    }
    rlf_mat4 camera_to_picture = rlf_mat4_from_pose(T_picture_camera);
    view.clip_camera = rlf_mat4_mul(&projection, &camera_to_picture);
    view.T_picture_camera = *T_picture_camera;
    view.T_camera_world = rlf_pose_invert(T_world_camera);
    view.focal = 0.5 * (picture->fx + picture->fy);
    return view;
}

void gl_view_set_matrix(GLint location, const rlf_mat4 *m)
{
    GLfloat columns[16];
    for (int row = 0; row < 4; row++) {
        for (int column = 0; column < 4; column++) {
            columns[4 * column + row] = (GLfloat)m->m[row][column];
        }
    }
    glUniformMatrix4fv(location, 1, GL_FALSE, columns);
}
