/* Left or right. An owner at the picture's border looks into it, an owner in the picture looks at
 * the camera: whoever turns the back to it is taken for the other way round. */
#include "hands/side.h"

#define BODY_NEAR_M 0.6  /* cells of one body are this close to where its arm leaves it */
#define BODY_SIDE_M 0.05 /* an arm leaves its body at least so far from the middle */
#define LEAN_SIN 0.17    /* 10 degrees: a forearm leans towards the middle of its body */
#define PAIR_M 1.2       /* two arms of one owner come in this close to each other */
#define PAIR_LEAST_M 0.1
#define PAIR_WEIGHT 2.0
#define BODY_WEIGHT 1.5
#define LEAN_WEIGHT 0.5

typedef struct entry {
    bool is_border;
    double x, y;               /* cells */
    double inward_x, inward_y; /* unit, from the border that is closest */
    double cell_m;
} entry;

static entry entry_of(const hand_cells *c, const hand_limb *limb)
{
    entry e = {.is_border = limb->root == HAND_ROOT_BORDER};
    e.x = limb->source % c->width;
    e.y = (double)(limb->source / c->width);
    e.cell_m = (double)(c->spacing * c->z[limb->source]);
    const double left = e.x / c->width, right = 1.0 - left;
    const double top = e.y / c->height, bottom = 1.0 - top;
    const double least = rlf_min(rlf_min(left, right), rlf_min(top, bottom));
    if (least == left || least == right) {
        e.inward_x = least == left ? 1.0 : -1.0;
    } else {
        e.inward_y = least == top ? 1.0 : -1.0;
    }
    return e;
}

/* How far right an owner at the border has this entry. */
static double rightness(const entry *e)
{
    return -e->inward_y * e->x + e->inward_x * e->y;
}

/* > 0: right of the other arm that comes in at the same border. */
static double by_pair(const entry *e, const hand_seen *seen, int32_t count, int32_t self,
                      const hand_cells *c, const hand_limbs *l)
{
    double vote = 0.0;
    for (int32_t i = 0; i < count; i++) {
        const entry other = entry_of(c, &l->limb[seen[i].limb]);
        const double apart = (rightness(e) - rightness(&other)) * e->cell_m;
        const double size = apart < 0.0 ? -apart : apart;
        if (i != self && other.is_border && other.inward_x == e->inward_x &&
            other.inward_y == e->inward_y && seen[i].hand.confidence >= RLF_HAND_SURE &&
            size > PAIR_LEAST_M && size < PAIR_M) {
            vote += apart > 0.0 ? PAIR_WEIGHT : -PAIR_WEIGHT;
        }
    }
    return rlf_clamp(vote, -PAIR_WEIGHT, PAIR_WEIGHT);
}

/* A right forearm leans to the left of the way into the picture. */
static double by_lean(const entry *e, rlf_vec3 arm)
{
    const double cross = e->inward_x * arm.y - e->inward_y * arm.x;
    return cross < -LEAN_SIN ? LEAN_WEIGHT : (cross > LEAN_SIN ? -LEAN_WEIGHT : 0.0);
}

/* Of someone who faces the camera: the right arm leaves the body on the picture's left. */
static double by_body(const entry *e, const hand_cells *c)
{
    double sum = 0.0;
    int32_t count = 0;
    for (int32_t i = 0; i < c->count; i++) {
        const double dx = i % c->width - e->x, dy = (double)(i / c->width) - e->y;
        if (c->root[i] == HAND_ROOT_BODY &&
            (dx * dx + dy * dy) * e->cell_m * e->cell_m < BODY_NEAR_M * BODY_NEAR_M) {
            sum += dx * e->cell_m;
            count++;
        }
    }
    const double middle = count > 0 ? sum / count : 0.0;
    return middle > BODY_SIDE_M ? BODY_WEIGHT : (middle < -BODY_SIDE_M ? -BODY_WEIGHT : 0.0);
}

void hand_sides_tell(hand_seen *seen, int32_t count, const hand_cells *c, const hand_limbs *l)
{
    for (int32_t i = 0; i < count; i++) {
        const entry e = entry_of(c, &l->limb[seen[i].limb]);
        seen[i].right = 0.0;
        if (e.is_border) {
            seen[i].right = by_pair(&e, seen, count, i, c, l);
            seen[i].right += by_lean(&e, seen[i].hand.arm_direction);
        } else if (l->limb[seen[i].limb].root == HAND_ROOT_BODY) {
            seen[i].right = by_body(&e, c);
        }
    }
}
