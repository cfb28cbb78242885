/* Scripts that grasp: where the hand must be for its fingers to meet the body, and when. */
#include "sim/hands/hands.h"
#include "sim/hash.h"

#define DEGREE (RLF_PI / 180.0)
#define RISE 0.15     /* metres */
#define CARRY 0.5     /* metres, across */
#define BACK_OFF 0.10 /* metres before the body */
#define OVER_TABLE 0.012
#define PAD 0.018        /* metres that finger tips reach over a flat side */
#define UPPER 0.2        /* of its height: so far over the middle two hands hold a box */
#define HOLLOW 0.6       /* of the way from a flat hand to a cup */
#define PALM_CLEAR 0.006 /* metres between palm and body in a pinch */
#define THROW_UP_S 0.35  /* s of speeding up */
#define THROW_OPEN_S 0.12

/* How one hand takes the body. */
typedef struct hold {
    rlf_pose at;       /* of the hand, stage frame */
    rlf_vec3 approach; /* unit: how it comes there */
    synth_grip open, closed, let_go;
    rlf_quat away; /* how it is turned to let go; as `at` when fingers do that */
} hold;

typedef struct plan {
    synth_hands *hands;
    synth_draw *draw;
    double press;  /* metres that the skin presses into the body */
    double clear;  /* metres that open fingers pass it by */
    double yaw;    /* of the grasp about the vertical */
    rlf_pose body; /* stage frame */
} plan;

static rlf_vec3 turned(const plan *p, double x, double y, double z)
{
    rlf_quat q = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), p->yaw);
    return rlf_normalize(rlf_rotate(q, rlf_vec3_make(x, y, z)));
}

static synth_shape body_in_hand(const plan *p, const rlf_pose *at)
{
    rlf_pose T_hand_stage = rlf_pose_invert(at);
    rlf_pose T_hand_body = rlf_pose_mul(&T_hand_stage, &p->body);
    return synth_hands_body(&p->hands->task, &T_hand_body);
}

/* Opens and closes the fingers between two grips, each as far as the body asks. */
static void set_grips(const plan *p, const synth_hand_form *form, const synth_grip *a,
                      const synth_grip *b, double most, hold *h)
{
    double share[SYNTH_FINGERS];
    synth_shape body = body_in_hand(p, &h->at);
    synth_hand_close(form, a, b, &body, -p->press, most, share);
    h->closed = synth_grip_mix_each(a, b, share);
    synth_hand_close(form, a, b, &body, p->clear, most, share);
    h->open = synth_grip_mix_each(a, b, share);
    h->let_go = h->open;
}

/* The hand's rotation and place: its span's middle on the body, its axis along `axis`. */
static void aim_pinch(const plan *p, const synth_hand_form *form, rlf_vec3 axis, hold *h)
{
    rlf_vec3 middle, a;
    double width = p->hands->task.size.x;
    (void)synth_hand_span(form, width, &middle, &a);
    rlf_vec3 d = rlf_normalize(rlf_mad(middle, a, -rlf_dot(middle, a)));
    rlf_quat q_hand = synth_hands_turn(a, d), q_stage = synth_hands_turn(axis, h->approach);
    h->at.q = rlf_quat_mul(q_stage, rlf_quat_conjugate(q_hand));
    h->at.p = rlf_sub(p->body.p, rlf_rotate(h->at.q, middle));
}

/* From the body's middle back to where the tips meet it: flat sides are held near their end, what
 * is round at its widest. */
static double held_back(const plan *p, rlf_vec3 approach)
{
    const rlf_synthetic_task *task = &p->hands->task;
    const bool is_above = approach.y > 0.9;
    const bool is_round = task->body == RLF_SYNTHETIC_BODY_BALL ||
                          (task->body == RLF_SYNTHETIC_BODY_CAN && !is_above);
    return is_round ? 0.0 : rlf_max(0.0, 0.5 * (is_above ? task->size.y : task->size.z) - PAD);
}

/* Thumb against fingers along `axis`, level. */
static hold pinch(const plan *p, const synth_hand_form *form, rlf_vec3 axis, rlf_vec3 approach)
{
    const synth_grip wide = synth_grip_named(SYNTH_GRIP_WIDE);
    const synth_grip shut = synth_grip_named(SYNTH_GRIP_CLOSED);
    hold h = {.approach = approach};
    rlf_vec3 middle, a;
    aim_pinch(p, form, axis, &h);
    h.at.p = rlf_mad(h.at.p, approach, -held_back(p, approach));
    double common = synth_hand_span(form, p->hands->task.size.x, &middle, &a);
    synth_hand_shape hand;
    synth_grip grip = synth_grip_mix(&wide, &shut, common);
    synth_hand_form_shape(form, &grip, &hand);
    synth_shape body = body_in_hand(p, &h.at);
    double room = synth_hand_distance(&hand, 0, SYNTH_HAND_PALM, &body) - PALM_CLEAR;
    h.at.p = rlf_mad(h.at.p, approach, rlf_min(0.0, room));
    set_grips(p, form, &wide, &shut, common, &h);
    h.away = h.at.q;
    return h;
}

/* The palm against the body: comes along its own normal until it touches. */
static void press_palm(const plan *p, const synth_hand_form *form, const synth_grip *grip,
                       rlf_vec3 middle, double press, hold *h)
{
    rlf_vec3 normal = rlf_rotate(h->at.q, rlf_vec3_make(0, 0, -1));
    synth_hand_shape hand;
    synth_hand_form_shape(form, grip, &hand);
    h->at.p = rlf_sub(p->body.p, rlf_rotate(h->at.q, middle));
    h->at.p = rlf_mad(h->at.p, normal, -0.2);
    for (int k = 0; k < 12; k++) { /* convex solids: sphere tracing cannot pass the surface */
        synth_shape body = body_in_hand(p, &h->at);
        double room = synth_hand_distance(&hand, 0, SYNTH_HAND_SOLIDS, &body);
        h->at.p = rlf_mad(h->at.p, normal, room + press);
    }
}

static hold bar(const plan *p, const synth_hand_form *form)
{
    const synth_grip wide = synth_grip_named(SYNTH_GRIP_RELAXED);
    const synth_grip shut = synth_grip_named(SYNTH_GRIP_ROUND);
    synth_grip open = synth_grip_named(SYNTH_GRIP_OPEN);
    double half, side = form->is_left ? -1.0 : 1.0;
    rlf_vec3 palm = synth_hand_palm(form, &half);
    hold h = {.approach = turned(p, 0.4 * side, 0, -1)};
    h.at.q = synth_hands_turn(turned(p, 0, 0, -1), turned(p, -side, 0, 0));
    palm.y += 0.3 * palm.y; /* at the roots of the fingers */
    open.spread = 0.0;
    press_palm(p, form, &open, palm, 0.5 * p->press, &h);
    set_grips(p, form, &wide, &shut, 1.0, &h);
    h.open = h.let_go = open;
    h.away = h.at.q;
    return h;
}

static hold flat_side(const plan *p, const synth_hand_form *form)
{
    const synth_grip flat = synth_grip_named(SYNTH_GRIP_FLAT);
    double half, side = form->is_left ? -1.0 : 1.0;
    rlf_vec3 palm = synth_hand_palm(form, &half);
    hold h = {.approach = turned(p, side, 0, 0), .open = flat, .closed = flat, .let_go = flat};
    h.at.q = synth_hands_turn(turned(p, 0, 0.1, -1), turned(p, -side, 0, 0));
    palm.y *= 1.7; /* fingers and palm share the load */
    /* flat sides are held over their middle, where hands have room over the table */
    bool is_ball = p->hands->task.body == RLF_SYNTHETIC_BODY_BALL;
    rlf_vec3 up = {0, is_ball ? 0.0 : -UPPER * p->hands->task.size.y, 0};
    palm = rlf_sub(palm, rlf_rotate(rlf_quat_conjugate(h.at.q), up));
    press_palm(p, form, &flat, palm, p->press, &h);
    h.away = h.at.q;
    return h;
}

static hold under(const plan *p, const synth_hand_form *form, double hollow)
{
    const synth_grip flat = synth_grip_named(SYNTH_GRIP_FLAT);
    const synth_grip cup = synth_grip_named(SYNTH_GRIP_CUP);
    const synth_grip grip = synth_grip_mix(&flat, &cup, hollow);
    double half, side = form->is_left ? -1.0 : 1.0;
    rlf_vec3 palm = synth_hand_palm(form, &half);
    hold h = {.approach = turned(p, 0.3 * side, 0, -1), .open = grip, .closed = grip};
    h.let_go = synth_grip_named(SYNTH_GRIP_OPEN);
    h.at.q = synth_hands_turn(turned(p, 0, 0, -1), rlf_vec3_make(0, 1, 0));
    palm.y *= 1.25;
    press_palm(p, form, &grip, palm, 0.0, &h);
    rlf_quat roll =
        rlf_quat_from_axis_angle(rlf_rotate(h.at.q, rlf_vec3_make(0, 1, 0)), -side * 2.3);
    h.away = rlf_quat_mul(roll, h.at.q);
    return h;
}

static hold take(const plan *p, int32_t track)
{
    const synth_hand_form *form = &p->hands->tracks[track].form;
    double side = form->is_left ? 1.0 : -1.0;
    switch (p->hands->def.act) {
    case RLF_SYNTHETIC_ACT_PINCH_ABOVE:
        return pinch(p, form, turned(p, 0, 0, -1), rlf_vec3_make(0, 1, 0));
    case RLF_SYNTHETIC_ACT_FIST_BAR: return bar(p, form);
    case RLF_SYNTHETIC_ACT_TWO_HANDS: return flat_side(p, form);
    case RLF_SYNTHETIC_ACT_SCOOP: return under(p, form, 1.0);
    case RLF_SYNTHETIC_ACT_UNDER: /* no ball stays on a flat hand */
        return under(p, form, p->hands->task.body == RLF_SYNTHETIC_BODY_BALL ? HOLLOW : 0.0);
    default: return pinch(p, form, turned(p, side, 0, 0), turned(p, 0, 0.25, -1));
    }
}

/* How far the hand, open or closed, reaches under the table's top. */
static double sunk(const synth_hand_form *form, const hold *h)
{
    const synth_grip *grips[2] = {&h->open, &h->closed};
    double lowest = -1e9;
    for (int g = 0; g < 2; g++) {
        synth_hand_shape hand;
        synth_hand_form_shape(form, grips[g], &hand);
        for (int i = 0; i < SYNTH_HAND_SOLIDS; i++) {
            const synth_shape *s = &hand.solids[i];
            bool is_egg = s->type == SYNTH_ELLIPSOID;
            rlf_vec3 end = {0, s->length, 0}, a = rlf_transform(&h->at, s->T_camera_shape.p);
            rlf_vec3 b = rlf_transform(&h->at, rlf_transform(&s->T_camera_shape, end));
            lowest = rlf_max(lowest, a.y + (is_egg ? s->size.x : s->radius_a));
            lowest = rlf_max(lowest, b.y + (is_egg ? 0.0 : s->radius_b));
        }
    }
    return lowest;
}

static void draw_body(plan *p)
{
    static const double range[RLF_SYNTHETIC_ACT_PASS][2] = {
        {0.04, 0.075}, {0.04, 0.075}, {0.030, 0.045}, {0.08, 0.12},
        {0.04, 0.07},  {0.05, 0.10},  {0.04, 0.07}};
    rlf_synthetic_task *task = &p->hands->task;
    const rlf_synthetic_hands_def *def = &p->hands->def;
    double drawn = synth_draw_range(p->draw, range[def->act][0], range[def->act][1]);
    double size = def->size > 0.0 ? def->size : drawn;
    task->body_count = 1;
    task->body = def->body;
    task->size = rlf_vec3_make(size, size, size);
    if (def->act == RLF_SYNTHETIC_ACT_FIST_BAR) {
        task->body = RLF_SYNTHETIC_BODY_CAN;
        task->size.y = 0.18;
    } else if (def->body == RLF_SYNTHETIC_BODY_CAN) {
        task->size.y = 1.3 * size;
    }
    p->body.p = rlf_scale(p->hands->across, -0.5 * CARRY);
    p->body.p.y = -0.5 * task->size.y;
    p->body.q = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), p->yaw);
}

/* Both hands' holds; the body is raised where a hand would reach into the table. */
static void take_all(plan *p, hold holds[RLF_SYNTHETIC_HANDS_MAX])
{
    synth_hands *hands = p->hands;
    double raise = 0.0;
    for (int32_t i = 0; i < hands->track_count; i++) {
        holds[i] = take(p, i);
        raise = rlf_max(raise, sunk(&hands->tracks[i].form, &holds[i]) + OVER_TABLE);
    }
    p->body.p.y -= raise;
    hands->task.release = raise > 0.0 ? 1.0 : 0.0; /* the time is set with the others */
    for (int32_t i = 0; i < hands->track_count; i++) {
        holds[i].at.p.y -= raise;
    }
}

static void find_times(synth_hands *hands)
{
    rlf_synthetic_task *task = &hands->task;
    const bool is_throw = hands->def.act == RLF_SYNTHETIC_ACT_THROW;
    task->rise = RISE;
    task->closed = SYNTH_HANDS_THERE + 1.4;
    task->lifted = task->closed + 0.2 + RISE / hands->speed + 0.15;
    task->carried = is_throw ? task->lifted + 0.3 : task->lifted + CARRY / hands->speed + 0.15;
    task->opened = is_throw ? task->carried + THROW_UP_S : task->carried + hands->def.hold;
    task->end = task->opened + 1.0;
    task->release = task->release > 0.0 ? task->closed : 0.0;
}

static void add_throw(const synth_hands *hands, synth_track *track, const hold *h, rlf_pose at)
{
    const rlf_synthetic_task *task = &hands->task;
    const rlf_vec3 v = task->thrown;
    synth_track_add(track, task->carried, &at, &h->closed, 0, SYNTH_EASE_SMOOTH);
    at.p = rlf_mad(at.p, v, 0.5 * THROW_UP_S);
    synth_track_add(track, task->opened, &at, &h->closed, 0, SYNTH_EASE_SPEED_UP);
    at.p = rlf_mad(at.p, v, THROW_OPEN_S);
    synth_track_add(track, task->opened + THROW_OPEN_S, &at, &h->open, 0, SYNTH_EASE_LINEAR);
    at.p = rlf_mad(at.p, v, 0.15);
    synth_track_add(track, task->opened + THROW_OPEN_S + 0.3, &at, &h->open, 0,
                    SYNTH_EASE_SLOW_DOWN);
}

/* Lets go where it is: by its fingers, by parting from the other hand, or by turning over. */
static void add_release(const synth_hands *hands, synth_track *track, const hold *h, rlf_pose at)
{
    const rlf_synthetic_task *task = &hands->task;
    const bool is_two = hands->def.act == RLF_SYNTHETIC_ACT_TWO_HANDS;
    synth_track_add(track, task->opened, &at, &h->closed, 0, SYNTH_EASE_SMOOTH);
    at.q = h->away;
    at.p = is_two ? rlf_mad(at.p, h->approach, -0.06) : at.p;
    synth_track_add(track, task->opened + 0.3, &at, &h->let_go, 0, SYNTH_EASE_SMOOTH);
    synth_track_add(track, task->opened + 0.6, &at, &h->let_go, 0, SYNTH_EASE_SMOOTH);
    at.p = rlf_mad(at.p, h->approach, -BACK_OFF);
    synth_track_add(track, task->end, &at, &h->let_go, 0, SYNTH_EASE_SMOOTH);
}

static void add_keys(const synth_hands *hands, synth_track *track, const rlf_pose *home,
                     const hold *h)
{
    const rlf_synthetic_task *task = &hands->task;
    const synth_grip relaxed = synth_grip_named(SYNTH_GRIP_RELAXED);
    const bool is_two = hands->def.act == RLF_SYNTHETIC_ACT_TWO_HANDS;
    rlf_pose at = h->at;
    synth_track_add(track, SYNTH_HANDS_THERE, home, &relaxed, 0, SYNTH_EASE_SMOOTH);
    at.p = rlf_mad(at.p, h->approach, -BACK_OFF);
    synth_track_add(track, task->closed - 0.8, &at, &h->open, 0, SYNTH_EASE_SMOOTH);
    at.p = is_two ? rlf_mad(h->at.p, h->approach, -0.03) : h->at.p;
    synth_track_add(track, task->closed - 0.35, &at, &h->open, 0, SYNTH_EASE_SMOOTH);
    synth_track_add(track, task->closed - 0.3, &at, &h->open, 0, SYNTH_EASE_SMOOTH);
    at = h->at;
    synth_track_add(track, task->closed, &at, &h->closed, 0, SYNTH_EASE_SMOOTH);
    synth_track_add(track, task->closed + 0.2, &at, &h->closed, 0, SYNTH_EASE_SMOOTH);
    at.p.y -= RISE;
    synth_track_add(track, task->lifted, &at, &h->closed, 0, SYNTH_EASE_STEADY);
    if (hands->def.act == RLF_SYNTHETIC_ACT_THROW) {
        add_throw(hands, track, h, at);
        return;
    }
    at.p = rlf_mad(at.p, hands->across, CARRY);
    synth_track_add(track, task->carried, &at, &h->closed, 0, SYNTH_EASE_STEADY);
    add_release(hands, track, h, at);
}

void synth_hands_script_grasp(synth_hands *hands, synth_draw *d)
{
    plan p = {.hands = hands, .draw = d};
    hold holds[RLF_SYNTHETIC_HANDS_MAX];
    p.press = synth_draw_range(d, 0.001, 0.005);
    p.clear = synth_draw_range(d, 0.012, 0.022);
    p.yaw = synth_draw_range(d, -30.0, 30.0) * DEGREE;
    draw_body(&p);
    take_all(&p, holds);
    find_times(hands);
    double speed = synth_draw_range(d, 0.8, 2.0), up = synth_draw_range(d, 20.0, 40.0) * DEGREE;
    if (hands->def.act == RLF_SYNTHETIC_ACT_THROW) {
        hands->task.thrown = rlf_scale(hands->across, speed * rlf_cos(up));
        hands->task.thrown.y = -speed * rlf_sin(up);
    }
    for (int32_t i = 0; i < hands->track_count; i++) {
        rlf_pose home = synth_hands_home(hands, i);
        add_keys(hands, &hands->tracks[i], &home, &holds[i]);
    }
    hands->task.T_camera_body[0] = p.body;
}
