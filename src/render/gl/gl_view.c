/* Matrices and lens of a picture. */
#include "render/gl/gl_view.h"

const char gl_view_glsl[] =
    "uniform mat4 u_projection;\n"
    "uniform float u_lens[8];\n"
    "uniform float u_lens_limit2;\n"
    "vec4 clip_of(vec3 p)\n"
    "{\n"
    "    vec2 m = p.xy / max(p.z, 0.001);\n"
    "    float r2 = dot(m, m);\n"
    "    if (p.z > 0.001 && r2 < u_lens_limit2) {\n"
    "        float n = 1.0 + r2 * (u_lens[0] + r2 * (u_lens[1] + r2 * u_lens[4]));\n"
    "        float d = 1.0 + r2 * (u_lens[5] + r2 * (u_lens[6] + r2 * u_lens[7]));\n"
    "        vec2 tangential = 2.0 * m.x * m.y * vec2(u_lens[2], u_lens[3])\n"
    "            + (r2 + 2.0 * m * m) * vec2(u_lens[3], u_lens[2]);\n"
    "        p.xy = p.z * (m * (n / d) + tangential);\n"
    "    }\n"
    "    return u_projection * vec4(p, 1.0);\n"
    "}\n";

/* How far from the axis the lens model holds along both axes, searched in steps. */
static double find_lens_limit2(const rlf_camera *camera)
{
    const double step = 0.02;
    if (camera->distortion_model == RLF_DISTORTION_NONE) {
        return 0.0;
    }
    double limit = step;
    for (double r = step; r < 3.0; r += step) {
        const rlf_vec3 rays[4] = {{r, 0, 1}, {-r, 0, 1}, {0, r, 1}, {0, -r, 1}};
        for (int i = 0; i < 4; i++) {
            double u;
            double v;
            if (!rlf_camera_project(camera, rays[i], &u, &v)) {
                return limit * limit;
            }
        }
        limit = r;
    }
    return limit * limit;
}

gl_view gl_view_make(const rlf_camera *picture, const rlf_pose *T_picture_camera)
{
    gl_view view;
    view.camera = *picture;
    view.projection = rlf_camera_projection(picture, VIEW_NEAR_M, VIEW_FAR_M);
    for (int column = 0; column < 4; column++) {
        view.projection.m[1][column] = -view.projection.m[1][column];
    }
    view.T_picture_camera = *T_picture_camera;
    view.lens_limit2 = find_lens_limit2(picture);
    rlf_pose identity = rlf_pose_identity();
    gl_view_place(&view, &identity);
    return view;
}

void gl_view_place(gl_view *view, const rlf_pose *T_world_camera)
{
    view->T_camera_world = rlf_pose_invert(T_world_camera);
    view->T_picture_world = rlf_pose_mul(&view->T_picture_camera, &view->T_camera_world);
}

gl_view_uniforms gl_view_find_uniforms(GLuint program)
{
    gl_view_uniforms uniforms = {glGetUniformLocation(program, "u_projection"),
                                 glGetUniformLocation(program, "u_lens"),
                                 glGetUniformLocation(program, "u_lens_limit2")};
    return uniforms;
}

void gl_view_set_uniforms(const gl_view_uniforms *uniforms, const gl_view *view)
{
    GLfloat lens[8];
    for (int i = 0; i < 8; i++) {
        lens[i] = (GLfloat)view->camera.distortion[i];
    }
    gl_view_set_matrix(uniforms->projection, &view->projection);
    glUniform1fv(uniforms->lens, 8, lens);
    glUniform1f(uniforms->lens_limit2, (GLfloat)view->lens_limit2);
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
