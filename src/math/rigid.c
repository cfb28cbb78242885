/* Normal equations of a rigid motion, solved by Cholesky (Golub and Van Loan, algorithm 4.2.1). */
#include "math/rigid.h"

void math_rigid_add(math_rigid_sums *sums, rlf_vec3 n, rlf_vec3 turn, double off, double weight)
{
    const double row[6] = {n.x, n.y, n.z, turn.x, turn.y, turn.z};
    sums->weight += weight;
    for (int r = 0; r < 6; r++) {
        sums->b[r] += weight * row[r] * off;
        for (int c = 0; c <= r; c++) {
            sums->a[r][c] += weight * row[r] * row[c];
        }
    }
}

bool math_rigid_solve(const math_rigid_sums *sums, double least, double x[6])
{
    double l[6][6];
    bool is_told = true;
    for (int i = 0; i < 6; i++) {
        double sum = sums->b[i];
        for (int j = 0; j <= i; j++) {
            double s = sums->a[i][j];
            for (int k = 0; k < j; k++) {
                s -= l[i][k] * l[j][k];
            }
            is_told = is_told && (i != j || s > least * sums->a[i][i]);
            l[i][j] = i == j ? sqrt(rlf_max(s, 1e-12)) : s / l[j][j];
        }
        for (int k = 0; k < i; k++) {
            sum -= l[i][k] * x[k];
        }
        x[i] = sum / l[i][i];
    }
    for (int i = 5; i >= 0; i--) {
        for (int k = i + 1; k < 6; k++) {
            x[i] -= l[k][i] * x[k];
        }
        x[i] /= l[i][i];
    }
    return is_told;
}

rlf_vec3 math_rotation_vector(rlf_quat q)
{
    const double sign = q.w < 0.0 ? -1.0 : 1.0;
    const rlf_vec3 axis = {sign * q.x, sign * q.y, sign * q.z};
    const double half = rlf_length(axis);
    return rlf_scale(axis, half > 1e-9 ? 2.0 * rlf_atan2(half, sign * q.w) / half : 2.0);
}

bool math_pose_is_sound(const rlf_pose *T)
{
    const rlf_quat q = T->q;
    const double length2 = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    return rlf_dot(T->p, T->p) < 1e12 && length2 > 0.98 && length2 < 1.02;
}
