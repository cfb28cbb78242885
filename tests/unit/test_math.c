/* Elementary functions against libm, poses and matrices against their defining properties. */

#include "relief/math.h"
#include "test.h"

#include "math/eigen.h"
#include "math/inverse.h"
#include "math/rigid.h"

#include <math.h>

TEST_CASE(elementary_functions_agree_with_libm)
{
    for (int i = -20000; i <= 20000; i++) {
        double x = i * 0.00137;
        assert_true(fabs(rlf_sin(x) - sin(x)) < 3e-15);
        assert_true(fabs(rlf_cos(x) - cos(x)) < 3e-15);
        assert_true(fabs(rlf_exp(x) / exp(x) - 1.0) < 1e-14);
        assert_true(fabs(rlf_acos(x / 30.0) - acos(x / 30.0 > 1 ? 1 : (x < -30 ? -1 : x / 30))) <
                    1e-14);
        assert_true(fabs(rlf_atan2(x, 1.3) - atan2(x, 1.3)) < 2e-15);
        assert_true(fabs(rlf_atan2(-0.7, x) - atan2(-0.7, x)) < 2e-15);
        if (i > 0) {
            assert_true(fabs(rlf_log_e(x) - log(x)) < 1e-14);
        }
    }
    assert_true(rlf_sin(1e9) == 0.0);
    assert_true(rlf_exp(-1000.0) == 0.0);
}

TEST_CASE(poses_compose_and_invert)
{
    rlf_pose a = {{1, -2, 3},
                  rlf_quat_from_axis_angle(rlf_normalize(rlf_vec3_make(1, 2, -1)), 1.1)};
    rlf_pose b = {{0.5, 0.1, -4}, rlf_quat_from_rotation_vector(rlf_vec3_make(-0.3, 2.5, 0.4))};
    rlf_vec3 p = rlf_vec3_make(0.2, -0.7, 1.9);
    rlf_pose ab = rlf_pose_mul(&a, &b);
    rlf_vec3 direct = rlf_transform(&a, rlf_transform(&b, p));
    assert_true(rlf_length(rlf_sub(direct, rlf_transform(&ab, p))) < 1e-14);
    assert_true(rlf_length(rlf_sub(p, rlf_transform_inverse(&ab, direct))) < 1e-14);
    rlf_pose inverse = rlf_pose_invert(&ab);
    assert_true(rlf_length(rlf_sub(p, rlf_transform(&inverse, direct))) < 1e-14);
    rlf_mat3 R = rlf_quat_to_mat3(b.q);
    rlf_quat q = rlf_quat_from_mat3(&R);
    double dot = q.x * b.q.x + q.y * b.q.y + q.z * b.q.z + q.w * b.q.w;
    assert_true(fabs(fabs(dot) - 1.0) < 1e-14);
}

TEST_CASE(inverse_of_a_matrix)
{
    rlf_mat3 a = {{{2, 1, 0.5}, {-1, 3, 0.25}, {0.1, 0.2, 4}}};
    rlf_mat3 inverse;
    assert_true(rlf_mat3_invert(&a, &inverse));
    rlf_mat3 product = rlf_mat3_mul(&a, &inverse);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            assert_true(fabs(product.m[i][j] - (i == j)) < 1e-14);
        }
    }
    rlf_mat3 singular = {{{1, 2, 3}, {2, 4, 6}, {0, 1, 1}}};
    assert_false(rlf_mat3_invert(&singular, &inverse));
}

TEST_CASE(inverse_of_a_covariance)
{
    enum { N = 7 };
    double a[N][N], inverse[N][N];
    for (int r = 0; r < N; r++) {
        for (int c = 0; c < N; c++) {
            a[r][c] = 1.0 / (r + c + 1) + (r == c ? 0.01 * (r + 1) : 0.0); /* Hilbert's, and more */
            inverse[r][c] = a[r][c];
        }
    }
    math_invert(&inverse[0][0], N);
    for (int r = 0; r < N; r++) {
        for (int c = 0; c < N; c++) {
            double sum = 0.0;
            for (int k = 0; k < N; k++) {
                sum += a[r][k] * inverse[k][c];
            }
            assert_true(fabs(sum - (r == c)) < 1e-11);
        }
    }
}

/* Planes all round tell a motion; those of a tunnel leave the way along it open. */
TEST_CASE(rigid_motion_of_planes)
{
    static const double moved[6] = {0.01, -0.02, 0.03, 0.004, -0.005, 0.006};
    for (int open = 0; open < 2; open++) {
        math_rigid_sums sums = {.weight = 0.0};
        for (int k = 0; k < 27; k++) {
            const rlf_vec3 p = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
            const rlf_vec3 n = rlf_normalize(
                rlf_vec3_make(k % 4 - 1.5, k % 5 - 2.2, open != 0 ? 0.0 : k % 7 - 3.1));
            const rlf_vec3 turn = rlf_cross(p, n);
            const double off = n.x * moved[0] + n.y * moved[1] + n.z * moved[2] +
                               turn.x * moved[3] + turn.y * moved[4] + turn.z * moved[5];
            math_rigid_add(&sums, n, turn, off, 1.0 + k);
        }
        double x[6];
        assert_int_equal(math_rigid_solve(&sums, 1e-9, x), open == 0);
        assert_true(fabs(sums.weight - 27 * 14) < 1e-9);
        for (int k = 0; k < 6 && open == 0; k++) {
            assert_true(fabs(x[k] - moved[k]) < 1e-12);
        }
    }
    for (int k = 0; k < 20; k++) {
        const rlf_vec3 v = rlf_scale(rlf_vec3_make(0.2, -0.1, 0.05), 0.65 * k);
        const rlf_quat q = rlf_quat_from_rotation_vector(v), other = {-q.x, -q.y, -q.z, -q.w};
        assert_true(rlf_length(rlf_sub(math_rotation_vector(q), v)) < 1e-12);
        assert_true(rlf_length(rlf_sub(math_rotation_vector(other), v)) < 1e-12);
    }
}

TEST_CASE(model_matrix_scales_then_rotates_then_translates)
{
    rlf_pose T = {{1, 2, 3}, rlf_quat_from_axis_angle(rlf_vec3_make(0, 0, 1), RLF_PI / 2)};
    rlf_mat4 m = rlf_mat4_model(&T, rlf_vec3_make(2, 3, 4));
    /* (1,0,0) -> scaled (2,0,0) -> rotated (0,2,0) -> moved (1,4,3) */
    assert_true(fabs(m.m[0][0] + m.m[0][3] - 1.0) < 1e-14);
    assert_true(fabs(m.m[1][0] + m.m[1][3] - 4.0) < 1e-14);
    assert_true(fabs(m.m[2][0] + m.m[2][3] - 3.0) < 1e-14);
}

/* A v = value v, and the vectors are square to each other: of a plate seen aslant, of a needle, of
 * one whose values are the same, and of nothing. */
TEST_CASE(eigenvectors_are_only_scaled)
{
    static const double all[4][6] = {{2e-2, 1e-3, -4e-3, 1e-2, 3e-3, 1e-3}, /* xx xy xz yy yz zz */
                                     {4.0, 6.0, 2.0, 9.0, 3.0, 1.0},
                                     {1.0, 1e-25, 0.0, 1.0, 0.0, 1.0},
                                     {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}};
    for (int m = 0; m < 4; m++) {
        const double *s = all[m];
        const double a[3][3] = {{s[0], s[1], s[2]}, {s[1], s[3], s[4]}, {s[2], s[4], s[5]}};
        double work[6][6] = {{0.0}}, values[6], v[6][6];
        for (int k = 0; k < 9; k++) {
            work[k / 3][k % 3] = a[k / 3][k % 3];
        }
        math_eigen(work, 3, values, v);
        for (int k = 0; k < 9; k++) {
            int r = k / 3, c = k % 3;
            double turned = a[r][0] * v[0][c] + a[r][1] * v[1][c] + a[r][2] * v[2][c];
            assert_true(fabs(turned - values[c] * v[r][c]) <= 1e-14 * (s[0] + s[3] + s[5]));
            double dot = v[0][r] * v[0][c] + v[1][r] * v[1][c] + v[2][r] * v[2][c];
            assert_true(fabs(dot - (r == c)) < 1e-14);
        }
    }
}
