/* Orientation by eq. 4.5, forces and torques by eq. 4.6 to 4.9, motion by Algorithm 1. */
#include "physics/thesis/thesis.h"

static rlf_vec3 column(const rlf_mat3 *R, int32_t i)
{
    return rlf_vec3_make(R->m[0][i], R->m[1][i], R->m[2][i]);
}

static void set_column(rlf_mat3 *R, int32_t i, rlf_vec3 v)
{
    R->m[0][i] = v.x;
    R->m[1][i] = v.y;
    R->m[2][i] = v.z;
}

/* Biased: the order of the columns decides, C_x keeps its direction. */
static void orthogonalise(rlf_mat3 *R)
{
    rlf_vec3 cx = rlf_normalize(column(R, 0));
    rlf_vec3 cy = rlf_normalize(rlf_cross(column(R, 2), cx));
    rlf_vec3 cz = rlf_normalize(rlf_cross(cx, cy));
    set_column(R, 0, cx);
    set_column(R, 1, cy);
    set_column(R, 2, cz);
}

void thesis_rotate(rlf_mat3 *R, rlf_vec3 w, double dt)
{
    for (int32_t i = 0; i < 3; i++) {
        rlf_vec3 c = column(R, i); /* w* R, column by column, is w x C */
        set_column(R, i, rlf_mad(c, rlf_cross(w, c), dt));
    }
    orthogonalise(R);
}

void thesis_integrate(phys_body *body, rlf_vec3 gravity, double dt)
{
    rlf_vec3 force = rlf_mad(body->force, gravity, body->mass * body->gravity_scale); /* 4.6 */
    body->v = rlf_mad(body->v, force, dt / body->mass);                               /* 4.8 */
    rlf_vec3 turn = rlf_mat3_mul_vec(&body->inverse_inertia_world, body->torque);
    body->w = rlf_mad(body->w, turn, dt); /* 4.7, 4.9 */
    body->x = rlf_mad(body->x, body->v, dt);
    thesis_rotate(&body->R, body->w, dt);
    body->q = rlf_quat_from_mat3(&body->R);
    rlf_mat3 half = rlf_mat3_mul(&body->R, &body->inverse_inertia);
    rlf_mat3 transposed = rlf_mat3_transpose(&body->R);
    body->inverse_inertia_world = rlf_mat3_mul(&half, &transposed);
}
