/* The life of a grab: begun by a hand that closes, carried by the hand's motion, ended by one that
 * opens. */
#include "physics/grab/grab.h"

/* Frames of the last four in which it is grasped before the body is held: one may be noise. */
#define GRASP_FRAMES 3
#define GRASP_MASK 0xfu
/* The hand may be lost for so many frames: noise, or something passes before it. */
#define LOST_FRAMES 3
#define KNOWN_FRAMES 9 /* the same where its fit is sure: 0.3 s */
/* Of the joint, rad/s: errors fade within two frames, without a swing. */
#define JOINT_OMEGA 50.0
/* A hand does not push a body for so long after it closed on it, s. */
#define SOFT_S 0.2
/* A body that was let go is not taken again for so long, s. */
#define COOL_S 0.3
#define HAND_POINTS_MIN 12
/* So long a fit's velocity is worth something, s. */
#define UNSURE_S 0.3
/* A hand that opens looks another way at once: by this share, in so many frames. */
#define OTHER_SHARE 0.5
#define OTHER_FRAMES 2
/* By less than this it has not moved a finger, whatever its fit says. */
#define CHANGED_SHARE 0.85
/* Where no fit is sure: of the pixels that touched, fewer than this share do, in so many. */
#define OPEN_SHARE 0.35
#define OPEN_FRAMES 4
/* Of pixels: frames in a row in which they grip. */
#define GRIP_FRAMES 2
/* Sides that move apart, or past each other, faster are no grip, m/s. */
#define APART_SPEED 0.15
#define PAST_SPEED 0.3
/* A body that passes the sides faster is not held by them yet, m/s. */
#define CATCH_SPEED 0.25
/* Of what is seen, so much is believed in one frame: a share. */
#define SETTLE 0.05

/* Whether the two sides move as one hand that does not open, and the body with it. */
static bool moves_as_one(const grab_grip *grip, rlf_vec3 body_v)
{
    rlf_vec3 a = grip->sides[0].velocity, b = grip->sides[1].velocity;
    rlf_vec3 apart = rlf_sub(b, a);
    double opening = rlf_dot(apart, grip->axis);
    rlf_vec3 past = rlf_mad(apart, grip->axis, -opening);
    rlf_vec3 slip = rlf_mad(body_v, rlf_add(a, b), -0.5);
    return opening < APART_SPEED && rlf_length(past) < PAST_SPEED && rlf_length(slip) < CATCH_SPEED;
}

static phys_grab *free_grab(rlf_world *world)
{
    for (int32_t i = 0; i < world->grab_count; i++) {
        if (!world->grabs[i].is_used) {
            return &world->grabs[i];
        }
    }
    return NULL;
}

/* The hand's frame begins where the body is; the grid shows the hand -tau later. */
static phys_grab *begin(rlf_world *world, const grid_query *query, phys_body *body, rlf_vec3 v)
{
    phys_grab *grab = free_grab(world);
    if (grab == NULL || phys_body_is_fixed(body)) {
        return NULL;
    }
    *grab = (phys_grab){.is_used = true, .body = (int32_t)(body - world->bodies), .v = v};
    grab->T_world_hand = phys_body_pose(body);
    grab->T_world_hand.p = rlf_mad(grab->T_world_hand.p, grab->v, -query->tau);
    grab_learn_hand(query, body, grab);
    grab->is_used = grab->point_count >= HAND_POINTS_MIN;
    if (!grab->is_used) {
        return NULL;
    }
    body->grab = grab;
    phys_body_wake(body);
    return grab;
}

/* How many pixels touch the body in its hand. */
static double weight_of(const grid_query *query, const phys_body *body, const phys_grab *grab)
{
    grab_front front;
    grab_look(query, body, &grab->T_world_hand, 0.0, grab_tolerance(query, body->x), &front);
    return front.weight + front.deep;
}

/* Where no hand is sure. */
static void seek_front(rlf_world *world, const grid_query *query, phys_body *body)
{
    grab_front front;
    grab_grip grip = {.axis = {0, 0, 0}};
    rlf_pose pose = phys_body_pose(body);
    grab_look(query, body, &pose, query->tau, grab_tolerance(query, body->x), &front);
    rlf_vec3 v = rlf_rotate(rlf_quat_conjugate(body->q), body->v);
    const bool is_gripped = grab_find_grip(&front, &grip) && moves_as_one(&grip, v);
    body->grip_frames = is_gripped ? body->grip_frames + 1 : body->grip_frames / 2;
    if (!is_gripped || body->grip_frames < GRIP_FRAMES) {
        return;
    }
    body->grip_frames = 0;
    const rlf_vec3 flow = rlf_add(grip.sides[0].velocity, grip.sides[1].velocity);
    phys_grab *grab = begin(world, query, body, rlf_rotate(body->q, rlf_scale(flow, 0.5)));
    if (grab != NULL) {
        grab->kind = GRAB_PIXELS;
        grab->weight = weight_of(query, body, grab);
    }
}

static void take(rlf_world *world, const grid_query *query, phys_body *body,
                 const grab_reason *reason)
{
    const rlf_grid_hand *a = &query->grid->hands[reason->hands[0]];
    const rlf_grid_hand *b = reason->hands[1] >= 0 ? &query->grid->hands[reason->hands[1]] : a;
    const rlf_vec3 v =
        rlf_add(grab_hand_of(world, a->id)->velocity, grab_hand_of(world, b->id)->velocity);
    phys_grab *grab = begin(world, query, body, rlf_scale(v, 0.5));
    if (grab != NULL) {
        grab->weight = weight_of(query, body, grab);
        body->grasp_votes = 0;
        grab->kind = reason->kind;
        grab->hands[0] = a->id;
        grab->hands[1] = b != a ? b->id : 0;
        grab_begin_hold(world, grab);
    }
}

static void seek(rlf_world *world, const grid_query *query, phys_body *body)
{
    grab_touches touches;
    grab_reason reason = {.kind = GRAB_NONE};
    const rlf_pose pose = phys_body_pose(body);
    if (world->time < body->free_until || !grid_collide_prepare(query, body)) {
        body->grip_frames /= 2;
        body->grasp_votes = 0;
        return;
    }
    grab_touch_hands(world, query, body, &pose, query->tau, &touches);
    reason = grab_decide(world, query, body, &touches);
    body->soft_until = reason.is_closing ? world->time + SOFT_S : body->soft_until;
    if (reason.kind == GRAB_NONE && !touches.is_judged && !reason.is_closing) {
        body->grasp_votes = body->grasp_votes << 1 & GRASP_MASK;
        seek_front(world, query, body);
        return;
    }
    body->grip_frames = 0;
    body->grasp_votes = (body->grasp_votes << 1 | (reason.kind != GRAB_NONE)) & GRASP_MASK;
    uint32_t v = body->grasp_votes;
    const uint32_t votes = (v & 1u) + (v >> 1 & 1u) + (v >> 2 & 1u) + (v >> 3);
    if (reason.kind != GRAB_NONE && votes >= GRASP_FRAMES) {
        take(world, query, body, &reason);
    }
}

static void note_past(phys_grab *grab)
{
    for (int32_t i = GRAB_PAST - 1; i > 0; i--) {
        grab->past_v[i] = grab->past_v[i - 1];
        grab->past_w[i] = grab->past_w[i - 1];
    }
    grab->past_v[0] = grab->v;
    grab->past_w[0] = grab->w;
    grab->past_count += grab->past_count < GRAB_PAST;
}

/* The hand that holds it by its pixels is known by now: its bends tell more. */
static void recognise(const rlf_world *world, const grid_query *query, const phys_body *body,
                      phys_grab *grab)
{
    grab_touches touches;
    grab_touch_hands(world, query, body, &grab->T_world_hand, 0.0, &touches);
    for (int32_t k = 0; k < query->grid->hand_count; k++) {
        if (touches.is_in[k] && grab->kind == GRAB_PIXELS) {
            grab->kind = GRAB_OPPOSE;
            grab->hands[0] = query->grid->hands[k].id;
            grab_begin_hold(world, grab);
        }
    }
}

/* The look of the hand is lost: its fit carries on for a while, and shows a new look. */
static bool go_on(const rlf_world *world, const grid_query *query, phys_body *body,
                  const struct phys_grab_hand *hand, double dt)
{
    phys_grab *grab = body->grab;
    const bool is_known = hand != NULL && world->time - hand->sure < UNSURE_S;
    const rlf_vec3 v = is_known ? hand->velocity : grab->v;
    grab->T_world_hand.p = rlf_mad(grab->T_world_hand.p, v, dt);
    if (++grab->lost_frames >= LOST_FRAMES && is_known && grab->lost_frames < KNOWN_FRAMES) {
        grab->v = v;
        grab->w = rlf_vec3_make(0, 0, 0);
        grab_learn_hand(query, body, grab);
        return grab->point_count >= HAND_POINTS_MIN;
    }
    return grab->lost_frames < LOST_FRAMES;
}

/* Whether the hand looks as if it had opened: another way at once, or where no fit is sure, much
 * less of it touches. */
static bool looks_open(const grid_query *query, const phys_body *body, phys_grab *grab,
                       bool is_known)
{
    const bool was_seen = grab->past_count == GRAB_PAST;
    bool is_open = was_seen && grab->alike < OTHER_SHARE * grab->usual;
    grab->has_changed = was_seen && grab->alike < CHANGED_SHARE * grab->usual;
    const double share = grab->has_changed ? SETTLE : 4.0 * SETTLE;
    grab->usual = was_seen ? grab->usual + share * (grab->alike - grab->usual) : grab->alike;
    if (!is_known) {
        const double weight = weight_of(query, body, grab);
        is_open = is_open || (grab->has_changed && weight < OPEN_SHARE * grab->weight);
        grab->weight += is_open ? 0.0 : SETTLE * (weight - grab->weight);
    }
    grab->open_frames = is_open ? grab->open_frames + 1 : 0;
    return is_open;
}

/* What a hand that opens holds flies on. */
static void fly_on(phys_grab *grab, rlf_pose before, double dt)
{
    grab->v = grab->past_v[0];
    grab->w = grab->past_w[0];
    grab->T_world_hand = before;
    grab->T_world_hand.p = rlf_mad(before.p, grab->v, dt);
}

/* Whether the hand holds on. */
static bool hold(const rlf_world *world, const grid_query *query, phys_body *body, double dt)
{
    phys_grab *grab = body->grab;
    const rlf_pose before = grab->T_world_hand;
    const struct phys_grab_hand *hand = grab_hand_of(world, grab->hands[0]);
    if (!grab_follow_hand(query, grab, dt)) {
        return go_on(world, query, body, hand, dt);
    }
    grab->lost_frames = 0;
    const bool is_known = hand != NULL && world->time - hand->sure < UNSURE_S;
    const bool is_open = grab->kind != GRAB_CARRY && looks_open(query, body, grab, is_known);
    const bool has_opened = grab->kind != GRAB_PIXELS && grab_has_opened(world, grab);
    if (is_open && grab->past_count > 0) {
        fly_on(grab, before, dt);
    } else if ((grab->open_votes & 1u) == 0) {
        note_past(grab);
    }
    if (grab->past_count < GRAB_PAST) { /* it may still be closing */
        grab_learn_hand(query, body, grab);
    }
    if (grab->kind == GRAB_PIXELS) {
        recognise(world, query, body, grab);
    }
    /* What does not come along is held by something stronger. */
    const rlf_vec3 off = rlf_sub(grab->T_world_hand.p, body->x);
    const double left = rlf_length(off) - rlf_length(grab->v) * dt;
    const int32_t frames = is_known ? OTHER_FRAMES : OPEN_FRAMES;
    return !has_opened && grab->open_frames < frames && left < body->shape.radius;
}

void phys_grab_update(rlf_world *world, const grid_query *query, double dt)
{
    const rlf_grid_sheet *sheet = &query->grid->foreground;
    if (sheet->depth == NULL || sheet->normal_x == NULL) {
        return;
    }
    grab_note_hands(world, query);
    for (int32_t i = 0; i < world->body_top; i++) {
        phys_body *body = &world->bodies[i];
        const grab_kind kind = body->grab != NULL ? body->grab->kind : GRAB_NONE;
        if (!body->is_alive || (phys_body_is_fixed(body) && !body->is_held)) {
            continue;
        }
        if (body->grab == NULL) {
            seek(world, query, body);
        } else if (!hold(world, query, body, dt)) {
            phys_grab_release(body);
            body->free_until = world->time + COOL_S;
            body->soft_until = world->time + (kind == GRAB_CARRY ? 0.0 : SOFT_S);
        }
        if (body->grab != NULL) {
            phys_body_wake(body);
        }
    }
}

/* A line through the velocities of the last frames, at the newest of them: a throw speeds up, so
 * their mean is late. */
static rlf_vec3 last_of(const rlf_vec3 past[GRAB_PAST], int32_t count)
{
    rlf_vec3 mean = {0, 0, 0}, slope = {0, 0, 0};
    double middle = 0.5 * (count - 1), spread = 0.0;
    for (int32_t i = 0; i < count; i++) {
        mean = rlf_mad(mean, past[i], 1.0 / count);
        slope = rlf_mad(slope, past[i], middle - i);
        spread += (middle - i) * (middle - i);
    }
    return spread > 0.0 ? rlf_mad(mean, slope, middle / spread) : mean;
}

void phys_grab_forget(phys_body *body)
{
    if (body->grab != NULL) {
        body->grab->is_used = false;
        body->grab = NULL;
    }
    body->grip_frames = 0;
    body->grasp_votes = 0;
}

void phys_grab_release(phys_body *body)
{
    const phys_grab *grab = body->grab;
    if (grab->past_count > 0) {
        body->v = last_of(grab->past_v, grab->past_count);
        body->w = last_of(grab->past_w, grab->past_count);
    }
    phys_grab_forget(body);
}

void phys_grab_release_all(rlf_world *world)
{
    for (int32_t i = 0; i < world->grab_count; i++) {
        if (world->grabs[i].is_used) {
            phys_grab_release(&world->bodies[world->grabs[i].body]);
        }
    }
}

void phys_grab_pull(const rlf_world *world, phys_body *body)
{
    const phys_grab *grab = body->grab;
    double tau = rlf_clamp(world->views[0].tau, -1.0, 0.1);
    rlf_vec3 place = rlf_mad(grab->T_world_hand.p, grab->v, tau);
    rlf_quat turn = rlf_quat_from_rotation_vector(rlf_scale(grab->w, tau));
    turn = rlf_quat_mul(rlf_quat_mul(turn, grab->T_world_hand.q), rlf_quat_conjugate(body->q));
    double sign = turn.w < 0.0 ? -2.0 : 2.0;
    rlf_vec3 angle = rlf_vec3_make(sign * turn.x, sign * turn.y, sign * turn.z);
    const double spring = JOINT_OMEGA * JOINT_OMEGA, damper = 2.0 * JOINT_OMEGA;
    body->acceleration =
        rlf_mad(rlf_scale(rlf_sub(place, body->x), spring), rlf_sub(grab->v, body->v), damper);
    body->angular_acceleration =
        rlf_mad(rlf_scale(angle, spring), rlf_sub(grab->w, body->w), damper);
}
