/* The true bounce of a ball, by conservative advancement: the scene's distance says how far it may
 * fly without a touch (Mirtich 1996, "Impulse-based dynamic simulation of rigid body systems"). */
#include "eval/ball.h"

#define SURFACE_SPEED_MAX 8.0 /* m/s; nothing in the synthetic room moves faster */
#define TOUCH 1e-5            /* m */
#define STEP_MIN 2e-6         /* s */
#define EVENTS_MAX 4000

double eval_angle_between(rlf_vec3 a, rlf_vec3 b)
{
    double angle = rlf_atan2(rlf_length(rlf_cross(a, b)), rlf_dot(a, b));
    return angle * 180.0 / RLF_PI;
}

/* Normal impulse by Newton's restitution, tangential by Coulomb: a solid ball's touching point has
 * the mobility 1/m + r^2 / (2/5 m r^2) = 7/2 1/m. */
static void bounce(eval_ball *ball, const rlf_synthetic_hit *hit, double approach)
{
    rlf_vec3 n = hit->normal;
    rlf_vec3 arm = rlf_scale(n, -ball->radius);
    rlf_vec3 point_v = rlf_add(ball->v, rlf_cross(ball->w, arm));
    rlf_vec3 slip = rlf_sub(point_v, hit->velocity);
    slip = rlf_mad(slip, n, -rlf_dot(slip, n));
    double normal_dv = (1.0 + ball->restitution) * approach;
    double slip_speed = rlf_length(slip);
    double stick_dv = slip_speed * (2.0 / 7.0);
    double friction_dv = rlf_min(stick_dv, ball->friction * normal_dv);
    ball->v = rlf_mad(ball->v, n, normal_dv);
    if (slip_speed > 1e-9) {
        rlf_vec3 dv = rlf_scale(slip, -friction_dv / slip_speed);
        ball->v = rlf_add(ball->v, dv);
        double inverse_inertia = 1.0 / (0.4 * ball->radius * ball->radius); /* per mass */
        ball->w = rlf_mad(ball->w, rlf_cross(arm, dv), inverse_inertia);
    }
}

void eval_ball_fly(rlf_source *source, eval_ball *ball, rlf_vec3 gravity, double begin, double end)
{
    double t = begin;
    for (int32_t i = 0; i < EVENTS_MAX && t < end; i++) {
        rlf_synthetic_hit hit;
        if (rlf_synthetic_nearest(source, t, ball->x, &hit) != RLF_OK) {
            return;
        }
        double gap = hit.distance - ball->radius;
        double approach = rlf_dot(hit.normal, rlf_sub(hit.velocity, ball->v));
        if (gap < TOUCH && approach > 0.0) {
            if (ball->bounces++ == 0) {
                ball->first = hit;
                ball->first_approach = approach;
                ball->first_point = rlf_mad(ball->x, hit.normal, -hit.distance);
            }
            ball->hard_bounces += approach > EVAL_HARD_SPEED;
            bounce(ball, &hit, approach);
            gap = 0.0;
        }
        double speed = rlf_length(ball->v) + SURFACE_SPEED_MAX;
        double step = rlf_min(rlf_max(STEP_MIN, gap / speed), end - t);
        ball->x = rlf_mad(rlf_mad(ball->x, ball->v, step), gravity, 0.5 * step * step);
        ball->v = rlf_mad(ball->v, gravity, step);
        t += step;
    }
}
