/* What carries something far heavier: solved as it is, few passes leave it pressed deep into what
 * is below, for an impulse that is little to the one is much to the other, and a contact's spring
 * is as weak as its lighter side. Such a body is solved for as though it weighed a good part of its
 * burden: the heavier one notices as little of that as it did of the light one. */
#include "physics/solver.h"

#define RATIO_MAX 10.0f /* of the masses of what lies on something and that */
#define SWEEPS 8        /* so many bodies bear a burden, one below the other, at least */

/* kg^-1, of a body as it is solved for. */
static float mobility_of(const rlf_world *world, const phys_body *body)
{
    return (float)body->inverse_mass * world->lightness[body - world->bodies];
}

/* Whether a lies on b, -1: b on a; 0: neither. */
static int32_t who_is_above(const phys_group *g, rlf_vec3 gravity)
{
    double fall = rlf_dot(g->points[0].normal, gravity);
    bool is_level = !(4.0 * fall * fall > rlf_dot(gravity, gravity)); /* 60 degrees */
    return is_level ? 0 : fall < 0.0 ? 1 : -1;
}

/* Gives the burden of the body above to the one below, also one that the upper itself only bears.
 * Returns whether that is new. */
static bool bear(rlf_world *world, const phys_group *g)
{
    float a = mobility_of(world, g->a), b = mobility_of(world, g->b);
    if (a == b) {
        return false;
    }
    int32_t side = who_is_above(g, world->def.gravity);
    const phys_body *above = side > 0 ? g->a : g->b, *below = side > 0 ? g->b : g->a;
    float *lightness = &world->lightness[below - world->bodies];
    float most = (float)above->inverse_mass * RATIO_MAX;
    if (world->lightness[above - world->bodies] < 1.0f) {
        float borne = mobility_of(world, above);
        most = borne < most ? borne : most;
    }
    if (side == 0 || !((float)below->inverse_mass * *lightness > most)) {
        return false;
    }
    *lightness = most / (float)below->inverse_mass;
    return true;
}

void phys_bear_burdens(rlf_world *world, const phys_group *groups, int32_t count)
{
    bool is_new = true;
    for (int32_t sweep = 0; sweep < SWEEPS && is_new; sweep++) {
        is_new = false;
        for (int32_t k = 0; k < count && groups[k].b != NULL; k++) {
            const phys_group *g = &groups[k];
            if (phys_body_is_moving(g->a) && phys_body_is_moving(g->b)) {
                is_new |= bear(world, g);
            }
        }
    }
}
