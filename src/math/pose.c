/* Matrices, quaternion conversions and model matrices. */
#include "relief/math.h"

rlf_mat3 rlf_mat3_mul(const rlf_mat3 *a, const rlf_mat3 *b)
{
    rlf_mat3 r = {{{0}}};
    if (!RLF_ASSERT(a != NULL && b != NULL)) {
        return r;
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            r.m[i][j] = a->m[i][0] * b->m[0][j] + a->m[i][1] * b->m[1][j] + a->m[i][2] * b->m[2][j];
        }
    }
    return r;
}

rlf_mat3 rlf_mat3_transpose(const rlf_mat3 *a)
{
    rlf_mat3 r = {{{0}}};
    if (!RLF_ASSERT(a != NULL)) {
        return r;
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            r.m[i][j] = a->m[j][i];
        }
    }
    return r;
}

bool rlf_mat3_invert(const rlf_mat3 *a, rlf_mat3 *out)
{
    if (!RLF_ASSERT(a != NULL && out != NULL)) {
        return false;
    }
    const double(*m)[3] = a->m;
    double c00 = m[1][1] * m[2][2] - m[1][2] * m[2][1];
    double c01 = m[1][2] * m[2][0] - m[1][0] * m[2][2];
    double c02 = m[1][0] * m[2][1] - m[1][1] * m[2][0];
    double det = m[0][0] * c00 + m[0][1] * c01 + m[0][2] * c02;
    if (det == 0.0 || !rlf_is_finite(det) || !rlf_is_finite(1.0 / det)) {
        *out = rlf_mat3_diagonal(0, 0, 0);
        return false;
    }
    double s = 1.0 / det;
    rlf_mat3 r = {{{c00 * s, (m[0][2] * m[2][1] - m[0][1] * m[2][2]) * s,
                    (m[0][1] * m[1][2] - m[0][2] * m[1][1]) * s},
                   {c01 * s, (m[0][0] * m[2][2] - m[0][2] * m[2][0]) * s,
                    (m[0][2] * m[1][0] - m[0][0] * m[1][2]) * s},
                   {c02 * s, (m[0][1] * m[2][0] - m[0][0] * m[2][1]) * s,
                    (m[0][0] * m[1][1] - m[0][1] * m[1][0]) * s}}};
    *out = r;
    return true;
}

rlf_quat rlf_quat_from_axis_angle(rlf_vec3 axis, double angle)
{
    double s = rlf_sin(0.5 * angle);
    rlf_quat q = {axis.x * s, axis.y * s, axis.z * s, rlf_cos(0.5 * angle)};
    return q;
}

rlf_quat rlf_quat_from_rotation_vector(rlf_vec3 v)
{
    double angle = rlf_length(v);
    if (angle < 1e-8) {
        rlf_quat q = {0.5 * v.x, 0.5 * v.y, 0.5 * v.z, 1.0};
        return rlf_quat_normalize(q);
    }
    return rlf_quat_from_axis_angle(rlf_scale(v, 1.0 / angle), angle);
}

rlf_mat3 rlf_quat_to_mat3(rlf_quat q)
{
    rlf_mat3 r = {{{1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y - q.w * q.z),
                    2 * (q.x * q.z + q.w * q.y)},
                   {2 * (q.x * q.y + q.w * q.z), 1 - 2 * (q.x * q.x + q.z * q.z),
                    2 * (q.y * q.z - q.w * q.x)},
                   {2 * (q.x * q.z - q.w * q.y), 2 * (q.y * q.z + q.w * q.x),
                    1 - 2 * (q.x * q.x + q.y * q.y)}}};
    return r;
}

rlf_quat rlf_quat_from_mat3(const rlf_mat3 *matrix)
{
    if (!RLF_ASSERT(matrix != NULL)) {
        return rlf_quat_identity();
    }
    const double(*m)[3] = matrix->m;
    double trace = m[0][0] + m[1][1] + m[2][2];
    rlf_quat q;
    if (trace > 0.0) {
        double s = 2.0 * sqrt(trace + 1.0);
        q = (rlf_quat){(m[2][1] - m[1][2]) / s, (m[0][2] - m[2][0]) / s, (m[1][0] - m[0][1]) / s,
                       0.25 * s};
    } else if (m[0][0] > m[1][1] && m[0][0] > m[2][2]) {
        double s = 2.0 * sqrt(rlf_max(1.0 + m[0][0] - m[1][1] - m[2][2], 0.0));
        q = (rlf_quat){0.25 * s, (m[0][1] + m[1][0]) / s, (m[0][2] + m[2][0]) / s,
                       (m[2][1] - m[1][2]) / s};
    } else if (m[1][1] > m[2][2]) {
        double s = 2.0 * sqrt(rlf_max(1.0 + m[1][1] - m[0][0] - m[2][2], 0.0));
        q = (rlf_quat){(m[0][1] + m[1][0]) / s, 0.25 * s, (m[1][2] + m[2][1]) / s,
                       (m[0][2] - m[2][0]) / s};
    } else {
        double s = 2.0 * sqrt(rlf_max(1.0 + m[2][2] - m[0][0] - m[1][1], 0.0));
        q = (rlf_quat){(m[0][2] + m[2][0]) / s, (m[1][2] + m[2][1]) / s, 0.25 * s,
                       (m[1][0] - m[0][1]) / s};
    }
    return rlf_quat_normalize(q);
}

rlf_mat4 rlf_mat4_mul(const rlf_mat4 *a, const rlf_mat4 *b)
{
    rlf_mat4 r = {{{0}}};
    if (!RLF_ASSERT(a != NULL && b != NULL)) {
        return r;
    }
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            double sum = 0.0;
            for (int k = 0; k < 4; k++) {
                sum += a->m[i][k] * b->m[k][j];
            }
            r.m[i][j] = sum;
        }
    }
    return r;
}

rlf_mat4 rlf_mat4_from_pose(const rlf_pose *T)
{
    return rlf_mat4_model(T, rlf_vec3_make(1, 1, 1));
}

rlf_mat4 rlf_mat4_model(const rlf_pose *T, rlf_vec3 scale)
{
    rlf_mat4 r = {{{0}}};
    if (!RLF_ASSERT(T != NULL)) {
        return r;
    }
    rlf_mat3 R = rlf_quat_to_mat3(T->q);
    const double s[3] = {scale.x, scale.y, scale.z};
    const double t[3] = {T->p.x, T->p.y, T->p.z};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            r.m[i][j] = R.m[i][j] * s[j];
        }
        r.m[i][3] = t[i];
    }
    r.m[3][3] = 1.0;
    return r;
}
