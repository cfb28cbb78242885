/* Information about the translation, with the rotation left free. */
#include "track/constraint.h"

#include "math/eigen.h"

static double entry(const track_sums *sums, int row, int column)
{
    const int r = row > column ? row : column, c = row > column ? column : row;
    return sums->a[r * (r + 1) / 2 + c];
}

track_constraint track_constraint_of(const track_sums *sums)
{
    track_constraint out = {{0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    rlf_mat3 turn, inverse;
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            turn.m[r][c] = entry(sums, r, c);
        }
    }
    const double turning = turn.m[0][0] + turn.m[1][1] + turn.m[2][2];
    for (int i = 0; i < 3; i++) { /* a turn that nothing tells, as a wall's about its normal */
        turn.m[i][i] += 1e-6 * turning;
    }
    if (!(sums->information > 0.0) || !rlf_mat3_invert(&turn, &inverse)) {
        return out;
    }
    double left[4][4] = {{0}}, values[4], vectors[4][4];
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            double sum = entry(sums, 3 + r, 3 + c);
            for (int i = 0; i < 3; i++) {
                for (int k = 0; k < 3; k++) {
                    sum -= entry(sums, 3 + r, i) * inverse.m[i][k] * entry(sums, k, 3 + c);
                }
            }
            left[r][c] = sum;
        }
    }
    math_eigen(left, 3, values, vectors);
    for (int i = 0; i < 3; i++) {
        out.share[i] = rlf_max(0.0, values[i] / sums->information);
        out.way[i] = rlf_vec3_make(vectors[0][i], vectors[1][i], vectors[2][i]);
    }
    return out;
}
