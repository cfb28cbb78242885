/* What touches bodies beside the depth: a headset's hands, and what they hold.
 *
 * A hand's bone is a capsule, a model of a real thing: it pushes and is pushed by nothing. It moves
 * with the velocity that brings it to where it shall be at the end of the frame, so what it meets
 * is hit as hard as by the hand. What a hand holds is driven alike, but stays a body: it stops at
 * the table. */
#include "page.h"

#include <math.h>
#include <string.h>

enum {
    HANDS = 2,
    BONES = 24,      /* between the 25 joints of a WebXR hand */
    BONE_NUMBERS = 8 /* two ends and a radius; the last is not used */
};

#define JUMP_M 0.3         /* in a frame: a hand that was found again, not one that moved */
#define BONE_CHANGE_M 0.01 /* of a bone's length or radius: it is another hand */
#define REACH_M 0.06       /* from the pinch to a body that it takes: a thumb's length */
#define CARRY_MAX 20.0     /* m/s, of what is held: faster than an arm */
#define ROLLING 0.05       /* a ball on a carpet: what is put down in a room stays there */
#define APART_S 0.5        /* after a hand lets go its bones do not push: its fingers open */

typedef struct bone {
    rlf_body_id body;
    double length, radius;
    rlf_pose target; /* at the end of the next frame */
} bone;

typedef struct hand {
    bone bones[BONES];
    bool is_seen;
    rlf_body_id held;
    rlf_pose T_world_pinch, T_pinch_body;
    double apart_s; /* left until the bones push again */
} hand;

static struct {
    double numbers[16]; /* in: of a call that says so; out: none */
    float bones[BONES * BONE_NUMBERS];
    hand hands[HANDS];
    uint32_t ids[2];
} touch;

/* ---- what the page writes, and reads -----------------------------------------------------------
 */

/* 16 doubles: a pose (place, quaternion x y z w) first. */
double *EXPORT(relief_touch_numbers)(void)
{
    return touch.numbers;
}

/* 24 bones of 8 floats: an end, the other end, radius, 0; metres, world. */
float *EXPORT(relief_touch_bones)(void)
{
    return touch.bones;
}

bool page_pose_read(rlf_pose *out)
{
    const double *n = touch.numbers;
    double length = 0.0;
    for (int i = 0; i < 7; i++) {
        length += i < 3 ? 0.0 * n[i] : n[i] * n[i];
    }
    *out = (rlf_pose){{n[0], n[1], n[2]}, {n[3], n[4], n[5], n[6]}};
    const bool is_unit = fabs(length - 1.0) < 0.01;
    if (!is_unit) {
        (void)rlf_fail(RLF_ERROR_INVALID, "pose: it is not finite, or its quaternion not unit");
    }
    return is_unit;
}

/* Index and generation of body `at` of the snapshot, two uint32; 0, 0: there is none. */
const uint32_t *EXPORT(relief_touch_id)(int32_t at)
{
    rlf_world *world = page_world();
    const rlf_snapshot *s = world != NULL ? rlf_world_get_snapshot(world) : NULL;
    const bool is_there = s != NULL && at >= 0 && at < s->body_count;
    touch.ids[0] = is_there ? s->bodies[at].id.index1 : 0;
    touch.ids[1] = is_there ? s->bodies[at].id.generation : 0;
    return touch.ids;
}

static const rlf_body_state *state_of(rlf_body_id id)
{
    const rlf_snapshot *s = rlf_world_get_snapshot(page_world());
    for (int32_t i = 0; i < s->body_count + s->known_count; i++) {
        const rlf_body_state *b = i < s->body_count ? &s->bodies[i] : &s->known[i - s->body_count];
        if (b->id.index1 == id.index1 && b->id.generation == id.generation) {
            return b;
        }
    }
    return NULL;
}

/* Adds a body where relief_touch_numbers says: after the pose its velocity, its sizes (three, as of
 * relief_add_body), mass, friction, restitution. Returns an rlf_result. */
int32_t EXPORT(relief_touch_add)(int32_t type)
{
    rlf_body_def def = rlf_body_def_default();
    const double *n = touch.numbers;
    rlf_pose pose;
    if (page_world() == NULL || !page_pose_read(&pose)) {
        return page_world() != NULL ? RLF_ERROR_INVALID
                                    : rlf_fail(RLF_ERROR_INVALID, "no room is open");
    }
    def.shape.type = (rlf_shape_type)type;
    def.position = pose.p;
    def.orientation = pose.q;
    def.velocity = rlf_vec3_make(n[7], n[8], n[9]);
    def.shape.size = rlf_vec3_make(n[10], n[11], n[12]);
    def.shape.radius = n[10];
    def.shape.height = n[11];
    def.mass = n[13];
    def.friction = n[14];
    def.restitution = n[15];
    def.rolling_resistance = ROLLING;
    return rlf_world_add_body(page_world(), &def, NULL);
}

/* Puts a body where relief_touch_numbers says, at rest: an anchor has moved. Returns 0 when there
 * is no such body or pose. */
int32_t EXPORT(relief_touch_place)(uint32_t index1, uint32_t generation)
{
    rlf_pose pose;
    const rlf_vec3 zero = {0, 0, 0};
    const rlf_body_id id = {index1, generation};
    return page_world() != NULL && page_pose_read(&pose) &&
           rlf_world_set_body(page_world(), id, &pose, zero, zero);
}

void EXPORT(relief_touch_remove)(uint32_t index1, uint32_t generation)
{
    if (page_world() != NULL) {
        rlf_world_remove_body(page_world(), (rlf_body_id){index1, generation});
    }
}

/* ---- hands -------------------------------------------------------------------------------------
 */

/* A capsule's axis is its y. */
static rlf_pose pose_of_bone(const float *b, double *out_length)
{
    const rlf_vec3 from = {b[0], b[1], b[2]}, to = {b[3], b[4], b[5]};
    const rlf_vec3 way = rlf_sub(to, from);
    *out_length = rlf_length(way);
    const rlf_vec3 up = rlf_scale(way, 1.0 / rlf_max(*out_length, 1e-6));
    const rlf_vec3 side = rlf_cross((rlf_vec3){0, 1, 0}, up);
    const double w = 1.0 + up.y; /* half-way quaternion from y to the axis */
    rlf_quat q = {side.x, side.y, side.z, w};
    q = w > 1e-6 ? rlf_quat_normalize(q) : (rlf_quat){1, 0, 0, 0};
    return (rlf_pose){rlf_scale(rlf_add(from, to), 0.5), q};
}

static void drop_bones(hand *h)
{
    for (int i = 0; i < BONES; i++) {
        rlf_world_remove_body(page_world(), h->bones[i].body);
        h->bones[i].body = (rlf_body_id){0, 0};
    }
    h->is_seen = false;
}

static rlf_result make_bone(bone *b, double length, double radius)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape.type = RLF_SHAPE_CAPSULE;
    def.shape.radius = radius;
    def.shape.height = rlf_max(length, 0.001);
    def.is_real = true;
    def.position = b->target.p;
    def.orientation = b->target.q;
    b->length = length;
    b->radius = radius;
    rlf_world_remove_body(page_world(), b->body);
    return rlf_world_add_body(page_world(), &def, &b->body);
}

static rlf_result put_bone(bone *b, const float *numbers)
{
    double length, sum = 0.0;
    for (int i = 0; i < 7; i++) {
        sum += 0.0 * (double)numbers[i];
    }
    const double radius = numbers[6];
    if (!(sum + 1.0 > 0.0) || !(radius > 0.0)) {
        return rlf_fail(RLF_ERROR_INVALID, "hand: a joint is not finite, or has no radius");
    }
    b->target = pose_of_bone(numbers, &length);
    const bool is_other =
        fabs(length - b->length) > BONE_CHANGE_M || fabs(radius - b->radius) > BONE_CHANGE_M;
    return b->body.index1 == 0 || is_other ? make_bone(b, length, radius) : RLF_OK;
}

/* The bones of hand 0 or 1 are where relief_touch_bones says at the end of the next frame. seen 0:
 * the hand is not tracked. Returns an rlf_result. */
int32_t EXPORT(relief_touch_hand)(int32_t which, int32_t seen)
{
    if (page_world() == NULL || which < 0 || which >= HANDS) {
        return rlf_fail(RLF_ERROR_INVALID, "hand %d: no room is open, or no such hand", (int)which);
    }
    hand *h = &touch.hands[which];
    if (seen == 0 || h->held.index1 != 0 || h->apart_s > 0.0) {
        drop_bones(h);
        return RLF_OK;
    }
    rlf_result result = RLF_OK;
    for (int i = 0; i < BONES && result == RLF_OK; i++) {
        result = put_bone(&h->bones[i], &touch.bones[(ptrdiff_t)BONE_NUMBERS * i]);
    }
    if (result != RLF_OK) {
        drop_bones(h);
    }
    h->is_seen = result == RLF_OK;
    return result;
}

/* ---- grabbing ----------------------------------------------------------------------------------
 */

static const rlf_body_state *nearest_body(rlf_vec3 p)
{
    const rlf_snapshot *s = rlf_world_get_snapshot(page_world());
    const rlf_body_state *best = NULL;
    double least = REACH_M;
    for (int32_t i = 0; i < s->body_count; i++) {
        const rlf_vec3 local = rlf_transform_inverse(&s->bodies[i].T_world_body, p);
        rlf_vec3 way;
        const double d = rlf_shape_distance(&s->bodies[i].shape, local, &way);
        if (d < least) {
            least = d;
            best = &s->bodies[i];
        }
    }
    return best;
}

/* A hand pinches where relief_touch_numbers says: it takes the nearest body within reach and holds
 * it until pinches is 0, when the body flies on. Returns 1 while it holds one. */
int32_t EXPORT(relief_touch_pinch)(int32_t which, int32_t pinches)
{
    rlf_pose pinch;
    if (page_world() == NULL || which < 0 || which >= HANDS) {
        return 0;
    }
    hand *h = &touch.hands[which];
    if (pinches == 0 || !page_pose_read(&pinch)) {
        h->apart_s = h->held.index1 != 0 ? APART_S : h->apart_s;
        h->held = (rlf_body_id){0, 0};
        return 0;
    }
    h->T_world_pinch = pinch;
    const rlf_body_state *body = h->held.index1 == 0 ? nearest_body(pinch.p) : NULL;
    if (body != NULL) {
        const rlf_pose back = rlf_pose_invert(&pinch);
        h->T_pinch_body = rlf_pose_mul(&back, &body->T_world_body);
        h->held = body->id;
        drop_bones(h); /* they would push it out of the fingers */
    }
    return h->held.index1 != 0;
}

/* ---- each frame --------------------------------------------------------------------------------
 */

/* The velocities that take a body from a pose to another in dt. */
static void drive(rlf_body_id id, const rlf_pose *from, const rlf_pose *to, double dt)
{
    const rlf_quat back = rlf_quat_conjugate(from->q);
    rlf_quat turn = rlf_quat_mul(to->q, back);
    const double sign = turn.w < 0.0 ? -1.0 : 1.0;
    const rlf_vec3 axis = {sign * turn.x, sign * turn.y, sign * turn.z};
    const double sine = rlf_length(axis);
    const double angle = 2.0 * rlf_atan2(sine, sign * turn.w);
    const rlf_vec3 spin = rlf_scale(axis, angle / (rlf_max(sine, 1e-9) * dt));
    rlf_vec3 velocity = rlf_scale(rlf_sub(to->p, from->p), 1.0 / dt);
    const double speed = rlf_length(velocity);
    velocity = rlf_scale(velocity, speed > CARRY_MAX ? CARRY_MAX / speed : 1.0);
    (void)rlf_world_set_body(page_world(), id, from, velocity, spin);
}

static void move_bones(hand *h, double dt)
{
    const rlf_vec3 zero = {0, 0, 0};
    for (int i = 0; i < BONES && h->is_seen; i++) {
        const bone *b = &h->bones[i];
        const rlf_body_state *now = state_of(b->body);
        if (now == NULL) {
            continue; /* added since the last frame: it is where it shall be */
        }
        const double way = rlf_length(rlf_sub(b->target.p, now->T_world_body.p));
        if (way > JUMP_M) {
            (void)rlf_world_set_body(page_world(), b->body, &b->target, zero, zero);
        } else {
            drive(b->body, &now->T_world_body, &b->target, dt);
        }
    }
}

void page_touch_move(double dt)
{
    for (int i = 0; i < HANDS && dt > 0.0; i++) {
        hand *h = &touch.hands[i];
        h->apart_s -= dt;
        move_bones(h, dt);
        const rlf_body_state *held = h->held.index1 != 0 ? state_of(h->held) : NULL;
        if (held != NULL) {
            const rlf_pose to = rlf_pose_mul(&h->T_world_pinch, &h->T_pinch_body);
            drive(h->held, &held->T_world_body, &to, dt);
        }
    }
}

void page_touch_forget(void)
{
    page_stand_forget();
    memset(touch.hands, 0, sizeof(touch.hands));
}
