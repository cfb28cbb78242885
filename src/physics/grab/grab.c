/* The life of a grab: begun by a grip, carried by the hand's motion, ended by open fingers. */
#include "physics/grab/grab.h"

/* Frames in a row in which the sides grip before the body is held: one may be noise. */
#define GRIP_FRAMES 2
/* Frames in a row in which a side is seen to be gone before the body is let go. */
#define OPEN_FRAMES 4
/* The hand may be lost for so many frames: noise, or something passes before it. */
#define LOST_FRAMES 3
/* Of the joint, rad/s: errors fade within two frames, without a swing. */
#define JOINT_OMEGA 50.0
/* Sides that move apart, or past each other, faster are no grip, m/s. */
#define APART_SPEED 0.15
#define PAST_SPEED 0.3
/* A body that passes the sides faster is not held by them yet, m/s. */
#define CATCH_SPEED 0.6
/* Of the pixels that touched, fewer than this share still do: the hand is open. */
#define OPEN_SHARE 0.35
/* Of what is seen, so much is believed in one frame: a share. */
#define SETTLE 0.05
#define KEEP_PIXELS 2.0
#define HAND_POINTS_MIN 12

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

static void begin(rlf_world *world, const grid_query *query, phys_body *body, const grab_grip *grip,
                  double weight)
{
    phys_grab *grab = free_grab(world);
    if (grab == NULL) {
        return;
    }
    rlf_vec3 flow = rlf_add(grip->sides[0].velocity, grip->sides[1].velocity);
    *grab = (phys_grab){.is_used = true, .body = (int32_t)(body - world->bodies)};
    grab->v = rlf_rotate(body->q, rlf_scale(flow, 0.5));
    grab->T_world_hand = phys_body_pose(body); /* now; the grid shows the hand -tau later */
    grab->T_world_hand.p = rlf_mad(grab->T_world_hand.p, grab->v, -query->tau);
    grab->axis = grip->axis;
    grab->ends[0] = grip->sides[0].point;
    grab->ends[1] = grip->sides[1].point;
    grab->weight = weight;
    grab_learn_hand(query, body, grab);
    grab->is_used = grab->point_count >= HAND_POINTS_MIN;
    if (grab->is_used) {
        body->grab = grab;
        phys_body_wake(body);
    }
}

static void seek(rlf_world *world, const grid_query *query, phys_body *body)
{
    grab_touches touches;
    grab_grip grip = {.axis = {0, 0, 0}};
    double tolerance = grab_tolerance(query, body->x);
    bool is_gripped = false;
    if (grid_collide_prepare(query, body)) {
        rlf_pose pose = phys_body_pose(body);
        grab_look(query, body, &pose, query->tau, tolerance, &touches);
        rlf_vec3 v = rlf_rotate(rlf_quat_conjugate(body->q), body->v);
        is_gripped = grab_find_grip(&touches, &grip) && moves_as_one(&grip, v);
    }
    body->grip_frames = is_gripped ? body->grip_frames + 1 : body->grip_frames / 2;
    if (is_gripped && body->grip_frames >= GRIP_FRAMES && !phys_body_is_fixed(body)) {
        body->grip_frames = 0;
        begin(world, query, body, &grip, touches.weight + touches.deep);
    }
}

/* Whether the hand is seen to be open: much less of it touches than when it closed, or nothing on
 * one side, and the camera sees beyond where that was. */
static bool is_open(const grid_query *query, phys_grab *grab, const grab_touches *touches)
{
    double weight = touches->weight + touches->deep;
    double tolerance = GRID_NOISE_M + grab_tolerance(query, grab->T_world_hand.p);
    bool has_left = weight < OPEN_SHARE * grab->weight;
    for (int32_t side = 0; side < 2; side++) {
        grab_patch patch = grab_side(touches, grab->axis, side == 0 ? -1.0 : 1.0);
        if (patch.weight >= KEEP_PIXELS) {
            grab->ends[side] = rlf_add(grab->seat, patch.point);
        } else if (grab_is_seen_through(query, grab, grab->ends[side], tolerance)) {
            has_left = true;
        }
    }
    grab->weight += has_left ? 0.0 : SETTLE * (weight - grab->weight);
    return has_left;
}

/* The body settles in the middle between its two sides, where both touch. */
static void settle(phys_grab *grab, const grab_touches *touches)
{
    grab_patch a = grab_side(touches, grab->axis, -1.0);
    grab_patch b = grab_side(touches, grab->axis, 1.0);
    if (rlf_min(a.weight, b.weight) >= KEEP_PIXELS) {
        grab->seat = rlf_mad(grab->seat, grab->axis, SETTLE * 0.5 * (b.off - a.off));
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

/* Whether the hand holds on. */
static bool hold(const grid_query *query, phys_body *body, double dt)
{
    phys_grab *grab = body->grab;
    if (!grab_follow_hand(query, grab, dt)) {
        grab->T_world_hand.p = rlf_mad(grab->T_world_hand.p, grab->v, dt);
        return ++grab->lost_frames < LOST_FRAMES;
    }
    grab->lost_frames = 0;
    rlf_pose pose = grab->T_world_hand;
    grab_touches touches;
    pose.p = rlf_transform(&grab->T_world_hand, grab->seat);
    grab_look(query, body, &pose, 0.0, grab_tolerance(query, pose.p), &touches);
    bool has_opened = is_open(query, grab, &touches);
    settle(grab, &touches);
    grab->open_frames = has_opened ? grab->open_frames + 1 : 0;
    if (!has_opened) {
        note_past(grab);
    }
    /* What does not come along is held by something stronger. */
    double left = rlf_length(rlf_sub(pose.p, body->x)) - rlf_length(grab->v) * dt;
    return grab->open_frames < OPEN_FRAMES && left < body->shape.radius;
}

void phys_grab_update(rlf_world *world, const grid_query *query, double dt)
{
    const rlf_grid_sheet *sheet = &query->grid->foreground;
    if (sheet->depth == NULL || sheet->normal_x == NULL) {
        return;
    }
    for (int32_t i = 0; i < world->body_top; i++) {
        phys_body *body = &world->bodies[i];
        if (!body->is_alive || (phys_body_is_fixed(body) && !body->is_held)) {
            continue;
        }
        if (body->grab == NULL) {
            seek(world, query, body);
        } else if (!hold(query, body, dt)) {
            phys_grab_release(body);
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
    rlf_vec3 place = rlf_mad(rlf_transform(&grab->T_world_hand, grab->seat), grab->v, tau);
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
