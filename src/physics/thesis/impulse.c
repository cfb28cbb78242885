/* The impulse of a collision, eq. 4.10 to 4.15 (Baraff 1997), with the brackets of errata 6. */
#include "physics/thesis/thesis.h"

double thesis_impulse(phys_body *a, phys_body *b, rlf_vec3 p, rlf_vec3 n, double restitution)
{
    rlf_vec3 r_a = rlf_sub(p, a->x);
    rlf_vec3 r_b = b != NULL ? rlf_sub(p, b->x) : r_a;
    rlf_vec3 velocity = phys_body_velocity_at(a, r_a);
    double mobility = phys_body_mobility(a, r_a, n); /* t1 + t3 */
    if (b != NULL) {
        velocity = rlf_sub(velocity, phys_body_velocity_at(b, r_b));
        mobility += phys_body_mobility(b, r_b, n); /* t2 + t4; 0 for a surface */
    }
    double v_rel = rlf_dot(n, velocity); /* 4.11 */
    if (!(v_rel < 0.0) || !(mobility > 0.0)) {
        return 0.0;
    }
    double j = -(1.0 + restitution) * v_rel / mobility; /* 4.10, 4.12 */
    phys_body_push(a, rlf_scale(n, j), r_a);            /* 4.13 to 4.15 */
    if (b != NULL) {
        phys_body_push(b, rlf_scale(n, -j), r_b);
    }
    return j;
}
