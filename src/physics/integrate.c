/* Position and orientation over one substep.
 *
 * The rotation is the commutator-free Lie group method of order 4 (Celledoni, Marthinsen and Owren
 * 2003, "CF4") for q' = 1/2 w(q) q with w(q) = R I^-1 R^T L and the angular momentum L constant:
 * a quaternion stays a rotation by construction, and L is conserved exactly. */
#include "physics/solver.h"

static rlf_vec3 omega_of(const phys_body *body, rlf_quat q, rlf_vec3 L)
{
    rlf_vec3 L_body = rlf_rotate(rlf_quat_conjugate(q), L);
    return rlf_rotate(q, rlf_mat3_mul_vec(&body->inverse_inertia, L_body));
}

static bool is_same_state(const phys_body *body)
{
    rlf_vec3 w = body->momentum_w;
    rlf_quat q = body->momentum_q;
    return w.x == body->w.x && w.y == body->w.y && w.z == body->w.z && q.x == body->q.x &&
           q.y == body->q.y && q.z == body->q.z && q.w == body->q.w;
}

/* The one of the last step while nothing has turned the body since: no rounding adds up. */
static rlf_vec3 angular_momentum(const phys_body *body)
{
    if (is_same_state(body)) {
        return body->momentum;
    }
    rlf_vec3 w_body = rlf_rotate(rlf_quat_conjugate(body->q), body->w);
    return rlf_rotate(body->q, rlf_mat3_mul_vec(&body->inertia, w_body));
}

/* exp(v) q */
static rlf_quat turn(rlf_vec3 v, rlf_quat q)
{
    return rlf_quat_normalize(rlf_quat_mul(rlf_quat_from_rotation_vector(v), q));
}

static rlf_quat turn_cf4(const phys_body *body, rlf_vec3 L, double h)
{
    rlf_quat q = body->q;
    rlf_vec3 k1 = rlf_scale(omega_of(body, q, L), h);
    rlf_quat q2 = turn(rlf_scale(k1, 0.5), q);
    rlf_vec3 k2 = rlf_scale(omega_of(body, q2, L), h);
    rlf_vec3 k3 = rlf_scale(omega_of(body, turn(rlf_scale(k2, 0.5), q), L), h);
    rlf_quat q4 = turn(rlf_mad(k3, k1, -0.5), q2);
    rlf_vec3 k4 = rlf_scale(omega_of(body, q4, L), h);
    rlf_vec3 middle = rlf_scale(rlf_add(k2, k3), 2.0);
    rlf_vec3 first = rlf_scale(rlf_sub(rlf_mad(middle, k1, 3.0), k4), 1.0 / 12.0);
    rlf_vec3 second = rlf_scale(rlf_sub(rlf_mad(middle, k4, 3.0), k1), 1.0 / 12.0);
    return turn(second, turn(first, q));
}

void phys_integrate_rotation(phys_body *body, double h)
{
    double angle = rlf_length(body->w) * h;
    body->turned += angle;
    if (angle == 0.0) {
        return;
    }
    /* Below this angle the change of w within the step is beyond double's last digits. */
    const double NEARLY_STILL = 1e-5;
    if (body->is_isotropic || body->inverse_mass == 0.0 || angle < NEARLY_STILL) {
        body->q = turn(rlf_scale(body->w, h), body->q);
        phys_body_reorient(body);
        return;
    }
    rlf_vec3 L = angular_momentum(body);
    body->q = turn_cf4(body, L, h);
    body->w = omega_of(body, body->q, L);
    body->momentum = L;
    body->momentum_w = body->w;
    body->momentum_q = body->q;
    phys_body_reorient(body);
}

void phys_integrate_position(phys_body *body, double h)
{
    body->x = rlf_mad(rlf_add(body->x, body->impact_shift), body->v, h);
    if (!body->is_pressed) {
        body->x = rlf_mad(body->x, body->acceleration, -0.5 * h * h);
    }
    if (rlf_dot(body->impact_turn, body->impact_turn) > 0.0) {
        body->q = turn(body->impact_turn, body->q);
        body->turned += rlf_length(body->impact_turn);
        phys_body_reorient(body);
    }
    phys_integrate_rotation(body, h);
}
