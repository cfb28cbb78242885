/* Extrema of the way from the roots (Plagemann et al. 2010). */
#include "hands/limbs.h"

#define REACH_LEAST_M 0.12f /* a shorter bump is no limb, */
#define FROM_BODY_M 0.25f   /* nor is one of the body */
#define SEEDS_MAX 96        /* the furthest local maxima */
#define APART_M 0.25f       /* fingers of one hand are closer to each other */
#define BUMP_M 0.06f        /* a first look */

static bool is_maximum(const hand_cells *c, int32_t i)
{
    const int32_t x = i % c->width;
    const int32_t y = i / c->width;
    for (int32_t k = 0; k < 9; k++) {
        const int32_t at_x = x + k % 3 - 1;
        const int32_t at_y = y + k / 3 - 1;
        const int32_t at = at_y * c->width + at_x;
        const bool is_inside = at_x >= 0 && at_y >= 0 && at_x < c->width && at_y < c->height;
        if (is_inside && at != i && c->reach[at] < CELL_FAR &&
            (c->reach[at] > c->reach[i] || (c->reach[at] == c->reach[i] && at < i))) {
            return false;
        }
    }
    return true;
}

static float least_reach(const hand_cells *c, int32_t i)
{
    return hand_cells_root(c, i) == HAND_ROOT_BODY ? FROM_BODY_M : REACH_LEAST_M;
}

/* The furthest first; of equal ones the first in the picture. */
static int32_t find_seeds(const hand_cells *c, int32_t *seeds)
{
    int32_t count = 0;
    for (int32_t i = 0; i < c->count; i++) {
        if (c->z[i] <= 0.0f || c->reach[i] >= CELL_FAR || c->reach[i] < least_reach(c, i) ||
            (count == SEEDS_MAX && c->reach[i] <= c->reach[seeds[count - 1]]) ||
            !is_maximum(c, i)) {
            continue;
        }
        int32_t k = count < SEEDS_MAX ? count++ : SEEDS_MAX - 1;
        for (; k > 0 && c->reach[seeds[k - 1]] < c->reach[i]; k--) {
            seeds[k] = seeds[k - 1];
        }
        seeds[k] = i;
    }
    return count;
}

/* Something near goes on further: a bump on a limb, and no end. */
static bool goes_on(const hand_limbs *l, const hand_cells *c, int32_t seed)
{
    for (int32_t k = 0; k < c->touched_count; k++) {
        const int32_t i = c->touched[k];
        if (l->from_tip[i] < APART_M && c->reach[i] > c->reach[seed] + 0.01f) {
            return true;
        }
    }
    return false;
}

static void take_cell(hand_limbs *l, const hand_cells *c, hand_limb *limb, int32_t i)
{
    const int32_t x = i % c->width;
    const int32_t y = i / c->width;
    l->owner[i] = (uint8_t)(l->count + 1);
    l->along[i] = l->from_tip[i];
    limb->x0 = x < limb->x0 ? x : limb->x0;
    limb->y0 = y < limb->y0 ? y : limb->y0;
    limb->x1 = x + 1 > limb->x1 ? x + 1 : limb->x1;
    limb->y1 = y + 1 > limb->y1 ? y + 1 : limb->y1;
}

/* Takes the cells of an end that belong to no other. */
static void take_end(hand_limbs *l, const hand_cells *c, hand_limb *limb)
{
    limb->x0 = limb->y0 = INT32_MAX;
    limb->x1 = limb->y1 = 0;
    take_cell(l, c, limb, limb->tip);
    for (int32_t k = 0; k < c->touched_count; k++) {
        const int32_t i = c->touched[k];
        if (l->owner[i] == 0 && l->from_tip[i] <= LIMB_PART_M) {
            take_cell(l, c, limb, i);
        }
    }
}

static void spread_from(hand_limbs *l, hand_cells *c, int32_t seed, float limit)
{
    l->from_tip[seed] = 0.0f;
    c->queue[0] = seed;
    c->touched_count = 0;
    hand_cells_spread(c, l->from_tip, 1, limit);
}

static void clear_spread(hand_limbs *l, const hand_cells *c, int32_t seed)
{
    l->from_tip[seed] = CELL_FAR;
    for (int32_t k = 0; k < c->touched_count; k++) {
        l->from_tip[c->touched[k]] = CELL_FAR;
    }
}

/* Most seeds are bumps, which a small surrounding tells. */
static void try_seed(hand_limbs *l, hand_cells *c, int32_t seed)
{
    hand_limb *limb = &l->limb[l->count];
    *limb = (hand_limb){.tip = seed,
                        .root = hand_cells_root(c, seed),
                        .source = c->source[seed],
                        .length = c->reach[seed],
                        .rise = c->z[c->source[seed]] - c->z[seed]};
    spread_from(l, c, seed, BUMP_M);
    const bool is_bump = goes_on(l, c, seed);
    clear_spread(l, c, seed);
    if (is_bump) {
        return;
    }
    spread_from(l, c, seed, LIMB_PART_M);
    if (!goes_on(l, c, seed)) {
        take_end(l, c, limb);
        l->count++;
    }
    clear_spread(l, c, seed);
}

void hand_limbs_find(hand_limbs *l, hand_cells *c)
{
    int32_t seeds[SEEDS_MAX];
    const int32_t count = find_seeds(c, seeds);
    l->count = 0;
    for (int32_t i = 0; i < c->count; i++) {
        l->owner[i] = 0;
        l->from_tip[i] = CELL_FAR;
    }
    for (int32_t k = 0; k < count && l->count < LIMBS_MAX; k++) {
        if (l->owner[seeds[k]] == 0) {
            try_seed(l, c, seeds[k]);
        }
    }
}
