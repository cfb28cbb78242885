/* Starts are turns about the forearm, bends of the fingers, and both sides. */
#include "hands/search.h"

#include <string.h>

#define ROLLS 8
#define CURLS 5
#define WAYS 3
#define STARTS (ROLLS * CURLS * 2 * WAYS)
#define VARIANTS (CURLS + 2)
#define FIRST_TRIES 120 /* of a new hand, */
#define TRIES 24        /* and of one that fits ill or is looked at again */
#define AGAIN_FRAMES 10
#define FINALISTS 8
#define REFINED 2
#define COARSE 4 /* every fourth sample */
#define COARSE_STEPS 3
#define STEPS 5
#define SETTLE 0.35  /* of a hope's energy, each frame */
#define SAME_COS 0.9 /* of the backs of two hopes that are one */
#define SAME_STRETCH 0.15
#define SIDE_ENERGY 4.0 /* of a hope whose side the arm denies */
#define EXPECT_ENERGY 25.0
#define EXPECT_M 0.06 /* from the fit: the detector has gone elsewhere */
#define HALF_PALM_M 0.013

/* Open, at rest, fist, pointing, pinch: first and middle joint of the index and of the others, and
 * the thumb's angles. */
/* Of the hand from the forearm's way, across the view, radians: it is hard to tell. */
static const double ways[WAYS] = {0.0, 1.1, -1.1};
static const double curls[CURLS][9] = {{0.10, 0.15, 0.10, 0.15, 0.85, 0.30, 0.70, 0.10, 0.10},
                                       {0.55, 0.80, 0.55, 0.80, 0.60, 0.55, 0.70, 0.30, 0.30},
                                       {1.35, 1.65, 1.35, 1.65, 0.25, 0.75, 0.80, 0.60, 0.80},
                                       {0.10, 0.15, 1.35, 1.65, 0.25, 0.75, 0.80, 0.60, 0.80},
                                       {0.90, 0.80, 0.50, 0.60, 0.40, 0.80, 0.70, 0.10, 0.20}};

void hand_search_begin(hand_search *h)
{
    memset(h, 0, sizeof(*h));
}

/* Bends the digits as row `curl` says. */
static void bend(hand_model_pose *pose, int32_t curl)
{
    memcpy(pose->angle, hand_model_mean, (MODEL_WRIST - MODEL_THUMB) * sizeof(pose->angle[0]));
    memcpy(pose->angle, &curls[curl][4], 5 * sizeof(pose->angle[0]));
    for (int32_t f = 0; f < 4; f++) {
        const double *bends = &curls[curl][f == 0 ? 0 : 2];
        memcpy(&pose->angle[MODEL_FINGER - MODEL_THUMB + 3 * f + 1], bends, 2 * sizeof(bends[0]));
    }
}

static rlf_vec3 turned(rlf_vec3 v, rlf_vec3 axis, double angle)
{
    return rlf_rotate(rlf_quat_from_axis_angle(axis, angle), v);
}

/* The forearm lies as its detector says, as far as a wrist allows. */
static void bend_wrist(hand_model_pose *pose, rlf_vec3 arm)
{
    const rlf_vec3 seen = rlf_rotate(rlf_quat_conjugate(pose->q), arm);
    const double across = pose->is_left ? seen.x : -seen.x;
    double *wrist = &pose->angle[MODEL_WRIST - MODEL_THUMB];
    wrist[0] = rlf_clamp(0.5 * RLF_PI - rlf_acos(seen.z), hand_model_low[17], hand_model_high[17]);
    wrist[1] = rlf_clamp(rlf_atan2(across, seen.y), hand_model_low[18], hand_model_high[18]);
}

/* Start `n` of STARTS: a hand at the palm, along the arm or bent to one of its sides. */
static hand_model_pose start_pose(const hand_sight *sight, int32_t n)
{
    const int32_t roll = n % ROLLS, curl = n / ROLLS % CURLS, way = n / (ROLLS * CURLS * 2);
    hand_model_pose pose = {.is_left = n / (ROLLS * CURLS) % 2 != 0};
    const rlf_vec3 sight_way = rlf_normalize(sight->palm);
    const rlf_vec3 y = turned(sight->arm, sight_way, ways[way]);
    rlf_vec3 z = rlf_mad(sight_way, y, -rlf_dot(sight_way, y));
    z = rlf_length(z) > 0.1 ? rlf_normalize(z) : rlf_perpendicular(y);
    z = turned(z, y, 2.0 * RLF_PI * roll / ROLLS);
    const rlf_vec3 x = rlf_cross(y, z);
    const rlf_mat3 m = {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
    pose.q = rlf_quat_from_mat3(&m);
    bend(&pose, curl);
    const rlf_vec3 palm = rlf_mad(sight->palm, sight_way, HALF_PALM_M);
    pose.at = rlf_mad(palm, y, -0.047);
    bend_wrist(&pose, sight->arm);
    return pose;
}

/* The best hope with other bends, with the other side in front, or of the other side. */
static hand_model_pose variant(const hand_search *h, rlf_vec3 arm, int32_t n)
{
    hand_model_pose pose = h->hope[0].fit.pose;
    if (n < CURLS) {
        bend(&pose, n);
    } else if (n == CURLS) {
        pose.q = rlf_quat_mul(pose.q, rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), RLF_PI));
        bend_wrist(&pose, arm);
    } else {
        pose.is_left = !pose.is_left;
    }
    return pose;
}

static double side_energy(const hand_sight *sight, const hand_model_pose *pose)
{
    const bool is_denied = pose->is_left ? sight->right > 0.0 : sight->right < 0.0;
    return is_denied ? SIDE_ENERGY : 0.0;
}

static bool is_same(const hand_fit *a, const hand_fit *b)
{
    hand_model m, n;
    if (a->pose.is_left != b->pose.is_left) {
        return false;
    }
    hand_model_build(&m, &a->pose);
    hand_model_build(&n, &b->pose);
    double apart = 0.0;
    for (int32_t digit = 0; digit < 5; digit++) {
        const double d = hand_model_stretch(&m, digit) - hand_model_stretch(&n, digit);
        apart = rlf_max(apart, d < 0.0 ? -d : d);
    }
    return rlf_dot(m.z, n.z) > SAME_COS && apart < SAME_STRETCH;
}

/* Keeps it where it is better than the worst, or than one that is the same. */
static void offer(hand_search *h, const hand_hope *hope)
{
    int32_t at = h->count;
    for (int32_t k = 0; k < h->count; k++) {
        if (is_same(&h->hope[k].fit, &hope->fit)) {
            at = k;
            break;
        }
    }
    if (at == h->count && h->count < SEARCH_HOPES) {
        h->hope[h->count++] = *hope;
        return;
    }
    at = at < h->count ? at : h->count - 1;
    if (hope->energy < h->hope[at].energy) {
        h->hope[at] = *hope;
    }
}

static void sort(hand_search *h)
{
    for (int32_t i = 1; i < h->count; i++) {
        for (int32_t k = i; k > 0 && h->hope[k].energy < h->hope[k - 1].energy; k--) {
            const hand_hope swap = h->hope[k];
            h->hope[k] = h->hope[k - 1];
            h->hope[k - 1] = swap;
        }
    }
}

/* Where it belongs among the `count` best so far; returns how many there are then. */
static int32_t rank(hand_hope *best, int32_t most, int32_t count, const hand_hope *hope)
{
    int32_t at = count < most ? count : most - 1;
    if (count == most && hope->energy >= best[at].energy) {
        return count;
    }
    for (; at > 0 && best[at - 1].energy > hope->energy; at--) {
        best[at] = best[at - 1];
    }
    best[at] = *hope;
    return count < most ? count + 1 : count;
}

/* The best of `tries` starts, improved. */
static void try_starts(hand_search *h, const hand_crop *crop, const hand_sight *sight,
                       int32_t tries)
{
    hand_hope best[FINALISTS];
    int32_t count = 0;
    for (int32_t n = h->count > 0 ? -VARIANTS : 0; n < tries; n++) {
        hand_hope hope = {.velocity = h->count > 0 ? h->hope[0].velocity : rlf_vec3_make(0, 0, 0)};
        hope.fit.pose =
            n < 0 ? variant(h, sight->arm, n + VARIANTS) : start_pose(sight, h->next * 77 % STARTS);
        h->next = n < 0 ? h->next : (h->next + 1) % STARTS;
        hand_fit_judge(&hope.fit, crop, COARSE);
        hope.energy = hope.fit.energy + side_energy(sight, &hope.fit.pose);
        count = rank(best, FINALISTS, count, &hope);
    }
    hand_hope finer[REFINED];
    int32_t refined = 0;
    for (int32_t k = 0; k < count; k++) {
        hand_fit_improve(&best[k].fit, crop, NULL, COARSE_STEPS, COARSE);
        hand_fit_judge(&best[k].fit, crop, COARSE);
        best[k].energy = best[k].fit.energy + side_energy(sight, &best[k].fit.pose);
        refined = rank(finer, REFINED, refined, &best[k]);
    }
    for (int32_t k = 0; k < refined; k++) {
        hand_fit_improve(&finer[k].fit, crop, NULL, 3, 2);
        hand_fit_judge(&finer[k].fit, crop, 1);
        finer[k].energy = finer[k].fit.energy + side_energy(sight, &finer[k].fit.pose);
        offer(h, &finer[k]);
        sort(h);
    }
}

/* Moves on as it did, or as its detector's palm: what fits better. */
static void move_on(hand_hope *hope, const hand_crop *crop, rlf_vec3 way, double dt)
{
    hand_fit other = hope->fit;
    other.pose.at = rlf_add(other.pose.at, way);
    hope->fit.pose.at = rlf_mad(hope->fit.pose.at, hope->velocity, dt);
    hand_fit_judge(&hope->fit, crop, COARSE);
    hand_fit_judge(&other, crop, COARSE);
    hope->fit = other.energy < hope->fit.energy ? other : hope->fit;
}

/* One frame's steps. */
static void follow(hand_hope *hope, const hand_crop *crop, const hand_sight *sight, rlf_vec3 way,
                   double dt, int32_t steps)
{
    const hand_model_pose before = hope->fit.pose;
    move_on(hope, crop, way, dt);
    hand_fit_improve(&hope->fit, crop, &before, steps, 1);
    hand_fit_judge(&hope->fit, crop, 1);
    const double energy = hope->fit.energy + side_energy(sight, &hope->fit.pose);
    hope->energy += SETTLE * (energy - hope->energy);
    if (dt > 0.0) {
        const rlf_vec3 v = rlf_scale(rlf_sub(hope->fit.pose.at, before.at), 1.0 / dt);
        hope->velocity = rlf_mad(hope->velocity, rlf_sub(v, hope->velocity), 0.5);
    }
}

/* Two hopes that have become one are one. */
static void merge(hand_search *h)
{
    for (int32_t i = 0; i + 1 < h->count; i++) {
        for (int32_t k = i + 1; k < h->count; k++) {
            if (is_same(&h->hope[i].fit, &h->hope[k].fit)) {
                h->hope[k--] = h->hope[--h->count];
            }
        }
    }
}

bool hand_search_update(hand_search *h, const hand_crop *crop, const hand_sight *sight, double dt)
{
    const rlf_vec3 way = rlf_sub(sight->palm, h->palm);
    h->palm = sight->palm;
    for (int32_t k = 0; k < h->count; k++) {
        follow(&h->hope[k], crop, sight, way, dt, k == 0 ? STEPS : 3);
    }
    sort(h);
    merge(h);
    sort(h);
    if (h->count == 0) {
        try_starts(h, crop, sight, FIRST_TRIES);
    } else if (h->hope[0].energy > SEARCH_SURE || h->frame % AGAIN_FRAMES == 0) {
        try_starts(h, crop, sight, TRIES);
    }
    h->frame++;
    return h->count > 0;
}

void hand_search_expect(const hand_search *h, hand_sight *sight, double dt)
{
    hand_model m;
    if (h->count == 0 || h->hope[0].energy > EXPECT_ENERGY) {
        return;
    }
    hand_model_build(&m, &h->hope[0].fit.pose);
    const rlf_vec3 palm = rlf_mad(m.palm, h->hope[0].velocity, dt);
    if (palm.z > 0.1 && rlf_length(rlf_sub(palm, sight->palm)) > EXPECT_M) {
        sight->palm = rlf_mad(palm, rlf_normalize(palm), -HALF_PALM_M);
        sight->arm = rlf_normalize(rlf_sub(m.a[MODEL_HAND], m.b[MODEL_CONES - 1]));
    }
}
