/* Absolute orientation in closed form (Horn 1987: Closed-form solution of absolute orientation
 * using unit quaternions). */
#include "known/align.h"

#include "math/eigen.h"

/* Points whose spread across a line is less than this share of that along it are on the line. */
#define LINE_SHARE 0.03
/* Of what the sums know of an unknown no more than this share is left by the others: it is open. */
#define NOTHING_OWN 1e-12

static rlf_vec3 centre_of(const rlf_vec3 *points, int32_t count)
{
    rlf_vec3 sum = {0, 0, 0};
    for (int32_t i = 0; i < count; i++) {
        sum = rlf_add(sum, points[i]);
    }
    return rlf_scale(sum, 1.0 / count);
}

double known_spread(const rlf_vec3 *points, int32_t count)
{
    rlf_vec3 centre = centre_of(points, count);
    double sum = 0.0;
    for (int32_t i = 0; i < count; i++) {
        rlf_vec3 d = rlf_sub(points[i], centre);
        sum += rlf_dot(d, d);
    }
    return sqrt(sum / count);
}

bool known_is_line(const rlf_vec3 *points, int32_t count)
{
    double a[6][6] = {{0}}, values[6], vectors[6][6];
    rlf_vec3 centre = centre_of(points, count);
    for (int32_t i = 0; i < count; i++) {
        rlf_vec3 v = rlf_sub(points[i], centre);
        const double d[3] = {v.x, v.y, v.z};
        for (int32_t k = 0; k < 9; k++) {
            a[k / 3][k % 3] += d[k / 3] * d[k % 3];
        }
    }
    math_eigen(a, 3, values, vectors);
    double most = rlf_max(values[0], rlf_max(values[1], values[2]));
    double least = rlf_min(values[0], rlf_min(values[1], values[2]));
    double middle = values[0] + values[1] + values[2] - most - least;
    return !(middle > LINE_SHARE * LINE_SHARE * most);
}

/* Horn's matrix N, whose eigenvector of the largest eigenvalue is the rotation (w, x, y, z). */
static rlf_quat rotation_of(const rlf_vec3 *model, const rlf_vec3 *world, int32_t count,
                            rlf_vec3 model_centre, rlf_vec3 world_centre)
{
    double s[3][3] = {{0}};
    for (int32_t i = 0; i < count; i++) {
        rlf_vec3 m = rlf_sub(model[i], model_centre), w = rlf_sub(world[i], world_centre);
        const double a[3] = {m.x, m.y, m.z}, b[3] = {w.x, w.y, w.z};
        for (int32_t k = 0; k < 9; k++) {
            s[k / 3][k % 3] += a[k / 3] * b[k % 3];
        }
    }
    double trace = s[0][0] + s[1][1] + s[2][2];
    const double d[3] = {s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0]};
    double n[6][6] = {{trace, d[0], d[1], d[2]}};
    for (int32_t i = 0; i < 3; i++) {
        n[i + 1][0] = d[i];
        for (int32_t k = 0; k < 3; k++) {
            n[i + 1][k + 1] = s[i][k] + s[k][i] - (i == k ? trace : 0.0);
        }
    }
    double values[6], vectors[6][6];
    math_eigen(n, 4, values, vectors);
    int32_t best = 0;
    for (int32_t i = 1; i < 4; i++) {
        best = values[i] > values[best] ? i : best;
    }
    rlf_quat q = {vectors[1][best], vectors[2][best], vectors[3][best], vectors[0][best]};
    return rlf_quat_normalize(q);
}

static bool are_finite(const rlf_vec3 *points, int32_t count)
{
    for (int32_t i = 0; i < count; i++) {
        if (!rlf_vec3_is_finite(points[i]) || !(rlf_length(points[i]) < 1e6)) {
            return false;
        }
    }
    return true;
}

rlf_result rlf_align_points(const rlf_vec3 *model, const rlf_vec3 *world, int32_t count,
                            rlf_pose *out_T_world_model, double *out_rms)
{
    if (!RLF_ASSERT(model != NULL && world != NULL && out_T_world_model != NULL)) {
        return RLF_ERROR_INVALID;
    }
    if (count < RLF_KNOWN_POINTS_MIN) {
        return rlf_fail(RLF_ERROR_INVALID, "%d points do not give a pose: pick at least %d",
                        (int)count, RLF_KNOWN_POINTS_MIN);
    }
    if (!are_finite(model, count) || !are_finite(world, count)) {
        return rlf_fail(RLF_ERROR_INVALID, "a point is not finite: give metres");
    }
    if (known_is_line(model, count) || known_is_line(world, count)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "the points lie on a line, which leaves a turn about it open: pick one "
                        "beside it");
    }
    rlf_vec3 model_centre = centre_of(model, count), world_centre = centre_of(world, count);
    rlf_pose T = {.q = rotation_of(model, world, count, model_centre, world_centre)};
    T.p = rlf_sub(world_centre, rlf_rotate(T.q, model_centre));
    double sum = 0.0;
    for (int32_t i = 0; i < count; i++) {
        rlf_vec3 d = rlf_sub(rlf_transform(&T, model[i]), world[i]);
        sum += rlf_dot(d, d);
    }
    *out_T_world_model = T;
    if (out_rms != NULL) {
        *out_rms = sqrt(sum / count);
    }
    return RLF_OK;
}

bool known_step(const math_rigid_sums *n, rlf_pose *T)
{
    double x[6];
    if (!math_rigid_solve(n, NOTHING_OWN, x)) {
        return false;
    }
    const rlf_vec3 shift = {x[0], x[1], x[2]}, turn = {x[3], x[4], x[5]};
    if (!rlf_vec3_is_finite(turn) || !rlf_vec3_is_finite(shift) || rlf_length(turn) > 3.0) {
        return false;
    }
    T->q = rlf_quat_normalize(rlf_quat_mul(rlf_quat_from_rotation_vector(turn), T->q));
    T->p = rlf_add(T->p, shift);
    return true;
}
