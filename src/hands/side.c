/* Left or right. An owner at the picture's border looks into it, an owner in the picture looks at
 * the camera: whoever turns the back to it is taken for the other way round. */
#include "hands/limbs.h"

#define BODY_NEAR_M 0.6 /* cells of one body are this close to where its arm leaves it */
#define BODY_SIDE_M 0.1 /* a hand is at least so far from its body's middle */

/* A right forearm leans to the left of the way into the picture, by 10 degrees and more. */
static double by_lean(const hand_cells *c, int32_t source, rlf_vec3 arm)
{
    const double lean = 0.17;
    const double left = (double)(source % c->width) / c->width;
    const double top = (double)(source / c->width) / c->height;
    const double x = rlf_min(left, 1.0 - left), y = rlf_min(top, 1.0 - top);
    const double inward_x = x <= y ? (left < 0.5 ? 1.0 : -1.0) : 0.0;
    const double inward_y = x <= y ? 0.0 : (top < 0.5 ? 1.0 : -1.0);
    const double cross = inward_x * arm.y - inward_y * arm.x;
    return cross < -lean ? 1.0 : (cross > lean ? -1.0 : 0.0);
}

/* Of someone who faces the camera the right hand is mostly on the picture's left. */
static double by_body(const hand_cells *c, int32_t source, int32_t tip)
{
    const double cell_m = (double)(c->spacing * c->z[source]);
    double sum = 0.0;
    int32_t count = 0;
    for (int32_t i = 0; i < c->count; i++) {
        const double dx = cell_m * (i % c->width - source % c->width);
        const double dy = cell_m * ((double)(i / c->width) - source / c->width);
        if (c->root[i] == HAND_ROOT_BODY && dx * dx + dy * dy < BODY_NEAR_M * BODY_NEAR_M) {
            sum += cell_m * (i % c->width - tip % c->width);
            count++;
        }
    }
    const double middle = count > 0 ? sum / count : 0.0;
    return middle > BODY_SIDE_M ? 1.0 : (middle < -BODY_SIDE_M ? -1.0 : 0.0);
}

double hand_side_of(const hand_cells *c, const hand_limb *limb, rlf_vec3 arm)
{
    switch (limb->root) {
    case HAND_ROOT_BORDER: return by_lean(c, limb->source, arm);
    case HAND_ROOT_BODY: return by_body(c, limb->source, limb->tip);
    case HAND_ROOT_FRONT:
    case HAND_ROOT_ALONE:
    case HAND_ROOT_NONE: break;
    }
    return 0.0;
}
