/* When a hand takes a body, and when it lets go. Both by the hand's bends: against those before it
 * touched (Valkov et al. 2025: the closing alone tells a grasp; Furmanek et al. 2019: it begins
 * before the touch), and against those with which it took the body (as hand trackers' own grab
 * classifiers do). */
#include "physics/grab/grab.h"

#define OPPOSED_COS (-0.25) /* of the body's normals under two sides */
#define BENEATH_COS 0.3     /* of a normal that points down */
#define FACING_COS 0.5      /* a palm that carries looks up within 60 degrees */
#define TILT_COS 0.64       /* ... and lets slide beyond 50 */
#define SUPPORTS_MIN 2      /* cones beneath */
#define CATCH_SPEED 0.6     /* of what falls on a hand */
#define PALM_SPEED 0.25     /* m/s by the body: hands slow down to grasp */
#define OPENED_M 0.024      /* beyond what it was at the grab: fits are 15 mm off in the mean */
#define FALL 0.25           /* of the least bends, downward, a frame, */
#define RISE_M 0.0002       /* and upward: 6 mm/s, where a hand opens by 40 and more */
#define PALM_M 0.05         /* of two palms, seen at their edges, from what is between them */
#define APART_M 0.025       /* two palms farther than at the grab */
#define VOTES 4             /* of the last VOTES_OF sure frames */
#define VOTES_OF 6
#define VOTES_UNSEEN 10 /* all of so many where the hand looks as before: a digit is hidden */

static bool is_opposed(const grab_touch *a, const grab_touch *b)
{
    const bool is_other = a->hand == b->hand && (a->group == 0 || a->group == GRAB_PALM) &&
                          b->group >= 1 && b->group <= 4;
    return is_other && rlf_dot(a->normal, b->normal) < OPPOSED_COS;
}

/* By the body, or by the room where the body tips over. */
static bool comes_slowly(const struct phys_grab_hand *h, const phys_body *body, double most)
{
    const double by_body = rlf_length(rlf_sub(h->velocity, body->v));
    return rlf_min(by_body, rlf_length(h->velocity)) < most;
}

static bool rests_on_room(const phys_body *body)
{
    for (int32_t k = 0; k < body->surface_count; k++) {
        if (body->surface[k].other == RLF_CONTACT_BACKGROUND) {
            return true;
        }
    }
    return false;
}

/* The hand beneath it that alone bears it; -1 = none. */
static int32_t carrier(const rlf_world *world, const grid_query *query, const phys_body *body,
                       const grab_touches *touches)
{
    const double g = rlf_length(world->def.gravity);
    if (g <= 0.0 || rests_on_room(body)) {
        return -1;
    }
    const rlf_vec3 down = rlf_scale(world->def.gravity, 1.0 / g);
    const rlf_vec3 down_body = rlf_rotate(rlf_quat_conjugate(body->q), down);
    int32_t beneath[RLF_GRID_HANDS_MAX] = {0};
    for (int32_t i = 0; i < touches->count; i++) {
        beneath[touches->touch[i].hand] +=
            rlf_dot(touches->touch[i].normal, down_body) > BENEATH_COS;
    }
    for (int32_t k = 0; k < query->grid->hand_count; k++) {
        const struct phys_grab_hand *h = grab_hand_of(world, query->grid->hands[k].id);
        if (beneath[k] >= SUPPORTS_MIN && h != NULL && rlf_dot(h->facing, down) < -FACING_COS &&
            comes_slowly(h, body, CATCH_SPEED)) {
            return k;
        }
    }
    return -1;
}

/* One side is touched, the other hidden or a little off: the body lies where the hand closes. */
static void seek_hidden(const rlf_world *world, const grid_query *query, const phys_body *body,
                        const grab_touches *touches, grab_reason *reason)
{
    uint32_t groups[RLF_GRID_HANDS_MAX] = {0};
    for (int32_t i = 0; i < touches->count; i++) {
        groups[touches->touch[i].hand] |= 1u << touches->touch[i].group;
    }
    for (int32_t k = 0; k < query->grid->hand_count; k++) {
        const struct phys_grab_hand *h = grab_hand_of(world, query->grid->hands[k].id);
        const uint32_t g = groups[k],
                       fingers = (g >> 1 & 1u) + (g >> 2 & 1u) + (g >> 3 & 1u) + (g >> 4 & 1u);
        const bool is_held = fingers >= 2 || (fingers == 1 && (g & 1u) != 0);
        if (is_held && touches->is_in[k] && grab_hand_closes(h) &&
            comes_slowly(h, body, PALM_SPEED)) {
            reason->kind = GRAB_OPPOSE;
            reason->hands[0] = k;
            return;
        }
    }
}

/* Thumb or palm and a finger face each other across the body. */
static void seek_opposed(const rlf_world *world, const grid_query *query, const phys_body *body,
                         const grab_touches *touches, grab_reason *reason)
{
    for (int32_t i = 0; i < touches->count; i++) {
        const grab_touch *a = &touches->touch[i];
        const struct phys_grab_hand *h = grab_hand_of(world, query->grid->hands[a->hand].id);
        const bool is_closing = h != NULL && touches->is_in[a->hand] && grab_hand_closes(h);
        reason->is_closing = reason->is_closing || is_closing;
        for (int32_t k = 0; k < touches->count && is_closing; k++) {
            if (is_opposed(a, &touches->touch[k]) && comes_slowly(h, body, PALM_SPEED)) {
                reason->kind = GRAB_OPPOSE;
                reason->hands[0] = a->hand;
                return;
            }
        }
    }
}

/* Whether two palms have come nearer, and do not part. */
static bool come_together(const struct phys_grab_hand *a, const struct phys_grab_hand *b)
{
    const double now = rlf_length(rlf_sub(a->palm, b->palm));
    bool has_come = false;
    for (int32_t i = 1, k = 1; i < a->past_count && k < b->past_count;) {
        const double ti = a->past[i].time, tk = b->past[k].time;
        if (ti == tk && a->past[0].time - ti < GRAB_WINDOW_S) {
            const double then = rlf_length(rlf_sub(a->past[i].palm, b->past[k].palm));
            has_come = has_come || then > now + GRAB_CLOSED_M;
        }
        i += ti >= tk;
        k += tk >= ti;
    }
    return has_come;
}

/* Two palms are at two sides of it. */
static void seek_between(const rlf_world *world, const grid_query *query, const phys_body *body,
                         const grab_touches *touches, grab_reason *reason)
{
    for (int32_t i = 0; i < query->grid->hand_count; i++) {
        const struct phys_grab_hand *a = grab_hand_of(world, query->grid->hands[i].id);
        for (int32_t k = 0; k < i && a != NULL; k++) {
            const struct phys_grab_hand *b = grab_hand_of(world, query->grid->hands[k].id);
            const double off = rlf_max(touches->palm_off[i], touches->palm_off[k]);
            const double cosine = rlf_dot(touches->palm_normal[i], touches->palm_normal[k]);
            if (b == NULL || off > 2.0 * PALM_M || cosine > OPPOSED_COS || !come_together(a, b)) {
                continue;
            }
            reason->is_closing = true;
            if (off < PALM_M && comes_slowly(a, body, PALM_SPEED) &&
                comes_slowly(b, body, PALM_SPEED)) {
                reason->kind = GRAB_BETWEEN;
                reason->hands[0] = i;
                reason->hands[1] = k;
                return;
            }
        }
    }
}

grab_reason grab_decide(const rlf_world *world, const grid_query *query, const phys_body *body,
                        const grab_touches *touches)
{
    grab_reason reason = {.hands = {carrier(world, query, body, touches), -1}};
    if (reason.hands[0] >= 0) {
        reason.kind = GRAB_CARRY; /* and the palm's contact stays on */
        return reason;
    }
    seek_between(world, query, body, touches, &reason);
    if (reason.kind == GRAB_NONE) {
        seek_opposed(world, query, body, touches, &reason);
    }
    if (reason.kind == GRAB_NONE) {
        seek_hidden(world, query, body, touches, &reason);
    }
    return reason;
}

void grab_begin_hold(const rlf_world *world, phys_grab *grab)
{
    const struct phys_grab_hand *a = grab_hand_of(world, grab->hands[0]);
    const struct phys_grab_hand *b = grab_hand_of(world, grab->hands[1]);
    if (a != NULL && a->past_count > 0) {
        grab->aperture = a->past[0].aperture;
        grab->curl = a->past[0].curl;
    }
    if (a != NULL && b != NULL) {
        grab->apart[0] = rlf_length(rlf_sub(a->palm, b->palm));
        grab->apart[1] = rlf_length(rlf_sub(a->core, b->core));
    }
    const rlf_vec3 up = rlf_neg(rlf_normalize(world->def.gravity));
    grab->up = rlf_rotate(rlf_quat_conjugate(grab->T_world_hand.q), up);
}

/* The least so far: a frame's fit that is off counts a quarter, and it rises slowly. */
static void follow_least(double *least, double now)
{
    *least += now < *least ? FALL * (now - *least) : rlf_min(RISE_M, now - *least);
}

static bool bends_back(phys_grab *grab, const grab_moment *now)
{
    const bool is_open =
        now->aperture > grab->aperture + OPENED_M || now->curl > grab->curl + OPENED_M;
    follow_least(&grab->aperture, rlf_max(now->aperture, 0.0));
    follow_least(&grab->curl, now->curl);
    return is_open;
}

bool grab_has_opened(const rlf_world *world, phys_grab *grab)
{
    const struct phys_grab_hand *a = grab_hand_of(world, grab->hands[0]);
    const struct phys_grab_hand *b = grab_hand_of(world, grab->hands[1]);
    if (grab->kind == GRAB_CARRY) {
        const rlf_vec3 up = rlf_rotate(grab->T_world_hand.q, grab->up);
        return rlf_dot(up, rlf_neg(rlf_normalize(world->def.gravity))) < TILT_COS;
    }
    bool is_open = false;
    if (grab->kind == GRAB_BETWEEN) {
        if (a == NULL || b == NULL || a->seen < world->time || b->seen < world->time) {
            return false;
        }
        const bool is_sure = a->sure >= world->time && b->sure >= world->time;
        const double more = is_sure ? APART_M : 2.0 * APART_M;
        is_open = rlf_length(rlf_sub(a->palm, b->palm)) > grab->apart[0] + more &&
                  rlf_length(rlf_sub(a->core, b->core)) > grab->apart[1] + more;
    } else if (a == NULL || a->sure < world->time || a->past_count == 0) {
        return false;
    } else {
        is_open = bends_back(grab, &a->past[0]);
    }
    const uint32_t all = (1u << VOTES_UNSEEN) - 1u;
    grab->open_votes = (grab->open_votes << 1 | (is_open ? 1u : 0u)) & all;
    int32_t votes = 0;
    for (int32_t k = 0; k < VOTES_OF; k++) {
        votes += grab->open_votes >> k & 1u;
    }
    return (votes >= VOTES && (grab->has_changed || grab->kind == GRAB_BETWEEN)) ||
           grab->open_votes == all;
}
