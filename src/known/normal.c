/* Normal equations of a small motion. */
#include "known/align.h"

void known_normal_add(known_normal *n, const double jacobian[6], double residual, double weight)
{
    for (int32_t i = 0; i < 6; i++) {
        for (int32_t k = 0; k <= i; k++) {
            n->a[i][k] += weight * jacobian[i] * jacobian[k];
        }
        n->b[i] -= weight * jacobian[i] * residual;
    }
}

/* Cholesky; the lower half of a holds the sums. */
static bool solve(const known_normal *n, double x[6])
{
    double l[6][6];
    for (int32_t i = 0; i < 6; i++) {
        for (int32_t k = 0; k <= i; k++) {
            double sum = n->a[i][k];
            for (int32_t j = 0; j < k; j++) {
                sum -= l[i][j] * l[k][j];
            }
            if (i != k) {
                l[i][k] = sum / l[k][k];
            } else if (sum > 1e-12 * n->a[i][i] && sum > 0.0) {
                l[i][i] = sqrt(sum);
            } else {
                return false;
            }
        }
    }
    for (int32_t i = 0; i < 6; i++) {
        x[i] = n->b[i];
        for (int32_t k = 0; k < i; k++) {
            x[i] -= l[i][k] * x[k];
        }
        x[i] /= l[i][i];
    }
    for (int32_t i = 5; i >= 0; i--) {
        for (int32_t k = i + 1; k < 6; k++) {
            x[i] -= l[k][i] * x[k];
        }
        x[i] /= l[i][i];
    }
    return true;
}

bool known_normal_apply(const known_normal *n, rlf_pose *T)
{
    double x[6];
    if (!solve(n, x)) {
        return false;
    }
    rlf_vec3 turn = {x[0], x[1], x[2]}, shift = {x[3], x[4], x[5]};
    if (!rlf_vec3_is_finite(turn) || !rlf_vec3_is_finite(shift) || rlf_length(turn) > 3.0) {
        return false;
    }
    T->q = rlf_quat_normalize(rlf_quat_mul(rlf_quat_from_rotation_vector(turn), T->q));
    T->p = rlf_add(T->p, shift);
    return true;
}
