/* Feet by gravity alone: a hand that rests on a table, or on the floor, has less of its body above
 * it than a leg carries, and the hand of who stands has the feet below it. */
#include "hands/limbs.h"

/* Across gravity, from the foot: a wide step to the head, and what counts as lower. */
#define BODY_WITHIN_M 0.7
#define BELOW_WITHIN_M 0.9
#define THICK_M 0.065 /* radius of a head and of a trunk; no arm and no hand has it */
/* Below a hand that hangs are the feet, 0.7 m; below a knee 0.5 m, below a lifted foot 0.3 m. */
#define LOWER_LEAST_M 0.5
#define LOWER_MOST_M 0.7
/* From a hand that hangs, or rests on a table, to the head's middle; from the foot of a seated one.
 */
#define CARRIES_LEAST_M 0.97
#define CARRIES_SURE_M 1.12

/* What of the foreground is in the place of a limb's end, along gravity from there. */
typedef struct foot_place {
    double lowest; /* metres below it */
    double body;   /* metres above it that the body ends, or its head */
} foot_place;

static foot_place look(const hand_cells *c, rlf_vec3 point, rlf_vec3 down)
{
    foot_place found = {0.0, 0.0};
    const rlf_surface *s = c->surface;
    for (int32_t i = 0; i < c->count; i++) {
        if (c->z[i] <= 0.0f) {
            continue;
        }
        const int32_t x = i % c->width * c->step + c->step / 2;
        const int32_t y = i / c->width * c->step + c->step / 2;
        const int32_t pixel = y * s->width + x;
        const double z = (double)c->z[i];
        const rlf_vec3 there =
            rlf_vec3_make(z * (double)s->ray_x[pixel], z * (double)s->ray_y[pixel], z);
        const rlf_vec3 way = rlf_sub(there, point);
        const double below = rlf_dot(way, down);
        const double across2 = rlf_dot(way, way) - below * below;
        const double radius = (double)((float)c->disc[i] / CHAMFER * c->spacing * c->z[i]);
        if (across2 < BELOW_WITHIN_M * BELOW_WITHIN_M) {
            found.lowest = rlf_max(found.lowest, below);
        }
        if (across2 < BODY_WITHIN_M * BODY_WITHIN_M && radius >= THICK_M) {
            found.body = rlf_max(found.body, -below);
        }
    }
    return found;
}

double hand_foot_likeness(const hand_cells *c, rlf_vec3 point, rlf_vec3 down)
{
    if (rlf_dot(down, down) < 0.5) {
        return 0.0;
    }
    const foot_place place = look(c, point, down);
    const double is_low =
        rlf_clamp((LOWER_MOST_M - place.lowest) / (LOWER_MOST_M - LOWER_LEAST_M), 0.0, 1.0);
    const double carries =
        rlf_clamp((place.body - CARRIES_LEAST_M) / (CARRIES_SURE_M - CARRIES_LEAST_M), 0.0, 1.0);
    return is_low * carries;
}
