/* The planes near each body as uniforms. */
#include "render/gl/gl_light.h"

void gl_obscurance_destroy(gl_obscurance *near_by)
{
    rlf_free(near_by->bodies);
    *near_by = (gl_obscurance){0};
}

rlf_result gl_obscurance_update(gl_obscurance *near_by, const rlf_surface *surface,
                                const rlf_pose *T_depth_picture, const caster *casters,
                                int32_t count)
{
    if (count > near_by->capacity) {
        rlf_free(near_by->bodies);
        near_by->capacity = 2 * count;
        near_by->bodies = rlf_alloc_array(2 * (size_t)count, sizeof(*near_by->bodies));
    }
    if (near_by->bodies == NULL) {
        near_by->capacity = 0;
        return RLF_ERROR_MEMORY;
    }
    near_by->T_depth_picture = *T_depth_picture;
    for (int32_t i = 0; i < count; i++) {
        obscurance_find(surface, T_depth_picture, &casters[i], &near_by->bodies[i]);
    }
    return RLF_OK;
}

gl_obscurance_uniforms gl_obscurance_find_uniforms(GLuint program)
{
    gl_obscurance_uniforms u = {glGetUniformLocation(program, "u_near_count"),
                                glGetUniformLocation(program, "u_near_planes"),
                                glGetUniformLocation(program, "u_near_normals"),
                                glGetUniformLocation(program, "u_near_shares"),
                                glGetUniformLocation(program, "u_near_per_reach")};
    return u;
}

void gl_obscurance_set(const gl_obscurance_uniforms *uniforms, const gl_obscurance *near_by,
                       int32_t index)
{
    const int32_t count = near_by != NULL ? near_by->bodies[index].count : 0;
    GLfloat planes[NEAR_PLANES_MOST][4] = {{0}};
    GLfloat normals[NEAR_PLANES_MOST][3] = {{0}};
    GLfloat shares[NEAR_PLANES_MOST] = {0};
    glUniform1i(uniforms->count, count);
    if (count == 0) {
        return;
    }
    const obscurance *o = &near_by->bodies[index];
    for (int32_t i = 0; i < count; i++) {
        const float *n = o->normal[i];
        const rlf_vec3 turned = rlf_rotate(near_by->T_depth_picture.q,
                                           rlf_vec3_make((double)n[0], (double)n[1], (double)n[2]));
        normals[i][0] = (GLfloat)turned.x;
        normals[i][1] = (GLfloat)turned.y;
        normals[i][2] = (GLfloat)turned.z;
        for (int k = 0; k < 3; k++) {
            planes[i][k] = n[k];
        }
        planes[i][3] = o->offset[i];
        shares[i] = (GLfloat)OBSCURANCE_SHARE * o->presence[i];
    }
    glUniform4fv(uniforms->planes, NEAR_PLANES_MOST, planes[0]);
    glUniform3fv(uniforms->normals, NEAR_PLANES_MOST, normals[0]);
    glUniform3fv(uniforms->shares, 1, shares);
    glUniform1f(uniforms->per_reach, o->per_reach);
}
