/* Timing of reaches: Jeannerod 1984 (the aperture is widest at two thirds of the way and wider than
 * the thing), Furmanek et al. 2019 (it closes while the hand still moves), minimum jerk. */
#include "eval/hands/act.h"

#include <string.h>

#define DEGREE (RLF_PI / 180.0)
#define TABLE_M 0.42 /* half of its breadth */
#define PALM_SKIN 0.0150
#define PRESS_M 0.001

static rlf_vec3 vec(double x, double y, double z)
{
    return rlf_vec3_make(x, y, z);
}

/* The turn that takes the frame of (a, b) to that of (c, d); b and d only as far as they are square
 * to a and c. */
static rlf_quat turn_of(rlf_vec3 a, rlf_vec3 b, rlf_vec3 c, rlf_vec3 d)
{
    const rlf_vec3 from[2] = {rlf_normalize(a), b}, to[2] = {rlf_normalize(c), d};
    rlf_quat q[2];
    for (int k = 0; k < 2; k++) {
        const rlf_vec3 *v = k == 0 ? from : to;
        const rlf_vec3 x = v[0], y = rlf_normalize(rlf_mad(v[1], x, -rlf_dot(v[1], x)));
        const rlf_vec3 z = rlf_cross(x, y);
        const rlf_mat3 m = {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
        q[k] = rlf_quat_from_mat3(&m);
    }
    return rlf_quat_mul(q[1], rlf_quat_conjugate(q[0]));
}

/* All poses are of a left hand; a right one's are mirrored. */
static rlf_pose mirrored(const rlf_pose *p)
{
    return (rlf_pose){{-p->p.x, p->p.y, p->p.z},
                      {.w = p->q.w, .x = p->q.x, .y = -p->q.y, .z = -p->q.z}};
}

static another_grip bent(eval_random *r, double first, double middle, double last)
{
    another_grip g = {.gesture = RLF_GESTURE_NONE};
    for (int digit = 1; digit < 5; digit++) {
        g.bend[digit][0] = first + eval_random_range(r, -0.06, 0.06);
        g.bend[digit][1] = middle + eval_random_range(r, -0.06, 0.06);
        g.bend[digit][2] = last;
        g.aside[digit] = 0.03 * (2.0 - digit);
    }
    return g;
}

static void bend_thumb(another_grip *g, double aside, double forward, double first, double last)
{
    g->aside[0] = aside;
    g->bend[0][0] = forward;
    g->bend[0][1] = first;
    g->bend[0][2] = last;
}

/* Each digit goes from `open` to `shut` until its skin is `clear` from the body. */
static another_grip close_on(const another_hand *h, const another_grip *open,
                             const another_grip *shut, const rlf_shape *body,
                             const rlf_pose *T_hand_body, double clear)
{
    another_grip g = *open;
    for (int digit = 0; digit < 5; digit++) {
        double share = 1.0;
        for (int n = 0; n <= 60 && share == 1.0; n++) {
            const another_grip at = another_grip_mix(open, shut, n / 60.0);
            share =
                another_hand_distance(h, &at, digit, body, T_hand_body) < clear ? n / 60.0 : 1.0;
        }
        const another_grip at = another_grip_mix(open, shut, share);
        memcpy(g.bend[digit], at.bend[digit], sizeof(g.bend[digit]));
        g.aside[digit] = at.aside[digit];
    }
    return g;
}

typedef struct hold {
    rlf_pose at; /* of the hand, stage */
    rlf_vec3 approach;
    another_grip rest, open, shut, let_go;
} hold;

static rlf_vec3 middle_tip(const another_hand *h, const another_grip *g, rlf_vec3 *axis)
{
    const rlf_vec3 thumb = another_hand_tip(h, g, 0);
    const rlf_vec3 finger =
        rlf_scale(rlf_add(another_hand_tip(h, g, 1), another_hand_tip(h, g, 2)), 0.5);
    *axis = rlf_sub(finger, thumb);
    return rlf_scale(rlf_add(thumb, finger), 0.5);
}

/* The pinch whose skin is `width` apart. */
static another_grip pinch_of(const another_hand *h, const another_grip *wide,
                             const another_grip *shut, double width)
{
    another_grip g = *wide;
    for (int n = 0; n <= 100; n++) {
        rlf_vec3 axis;
        g = another_grip_mix(wide, shut, n / 100.0);
        (void)middle_tip(h, &g, &axis);
        if (rlf_length(axis) - 0.016 < width) {
            break;
        }
    }
    return g;
}

static void hold_pinch(another_act *act, eval_random *r, hold *h)
{
    const another_hand *hand = &act->hand[0];
    another_grip wide = bent(r, 0.15, 0.30, 0.20), shut = bent(r, 1.05, 0.75, 0.35);
    bend_thumb(&wide, 1.0, 0.75, 0.05, 0.05);
    bend_thumb(&shut, 0.55, 0.95, 0.35, 0.45);
    const double width =
        act->body.type == RLF_SHAPE_BOX ? act->body.size.x : 2.0 * act->body.radius;
    const another_grip at = pinch_of(hand, &wide, &shut, width);
    rlf_vec3 axis;
    const rlf_vec3 middle = middle_tip(hand, &at, &axis), y = {0, 1, 0};
    const double yaw = eval_random_range(r, -0.3, 0.5), c = rlf_cos(yaw), s = rlf_sin(yaw);
    const bool is_above = act->kind == ACT_PINCH_ABOVE;
    const rlf_vec3 level = vec(-c, 0, -s);
    h->approach = is_above ? vec(0.1, eval_random_range(r, -1.2, -0.7), -0.6)
                           : vec(s, eval_random_range(r, -0.25, 0.0), -c);
    h->at.q = turn_of(axis, y, level, h->approach);
    act->T_stage_body[0].q = rlf_quat_from_axis_angle(y, yaw);
    h->at.p = rlf_sub(act->T_stage_body[0].p, rlf_rotate(h->at.q, middle));
    const rlf_pose inverse = rlf_pose_invert(&h->at);
    act->T_hand_body = rlf_pose_mul(&inverse, &act->T_stage_body[0]);
    h->shut = close_on(hand, &wide, &shut, &act->body, &act->T_hand_body, -PRESS_M);
    h->open = pinch_of(hand, &wide, &shut, 1.3 * width + 0.02);
    h->let_go = pinch_of(hand, &wide, &shut, 1.3 * width + 0.03);
}

static void hold_bar(another_act *act, eval_random *r, hold *h)
{
    const another_hand *hand = &act->hand[0];
    const double s = hand->length / 0.19, tilt = eval_random_range(r, -0.3, 0.3);
    another_grip open = bent(r, 0.30, 0.35, 0.20), shut = bent(r, 1.50, 1.75, 0.95);
    bend_thumb(&open, 1.35, 0.30, 0.05, 0.05);
    bend_thumb(&shut, 0.35, 1.15, 0.70, 0.90);
    h->approach = rlf_normalize(vec(0.5, 0, -0.85));
    h->at.q = turn_of(vec(1, 0, 0), vec(0, 1, 0), vec(0, 1, 0), h->approach);
    h->at.q = rlf_quat_mul(rlf_quat_from_axis_angle(vec(0, 1, 0), tilt), h->at.q);
    h->approach = rlf_rotate(h->at.q, vec(0, 0, -1)); /* the palm first */
    const rlf_vec3 middle = {0, 0.080 * s, -PALM_SKIN * s - act->body.radius};
    h->at.p = rlf_sub(act->T_stage_body[0].p, rlf_rotate(h->at.q, middle));
    const rlf_pose inverse = rlf_pose_invert(&h->at);
    act->T_hand_body = rlf_pose_mul(&inverse, &act->T_stage_body[0]);
    h->open = h->let_go = open;
    h->shut = close_on(hand, &open, &shut, &act->body, &act->T_hand_body, -PRESS_M);
}

static another_grip flat(eval_random *r)
{
    another_grip g = bent(r, 0.10, 0.10, 0.06);
    bend_thumb(&g, 0.75, 0.25, 0.05, 0.05);
    return g;
}

static void hold_between(another_act *act, eval_random *r, hold *h)
{
    const double s = act->hand[0].length / 0.19;
    h->approach = vec(1, 0, 0);
    h->at.q = turn_of(vec(0, 0, 1), vec(0, 1, 0), vec(-1, 0, 0),
                      vec(0, eval_random_range(r, -0.4, 0.0), -1));
    const rlf_vec3 middle = {0, 0.10 * s, -(PALM_SKIN - PRESS_M) * s - 0.5 * act->body.size.x};
    h->at.p =
        rlf_sub(rlf_add(act->T_stage_body[0].p, vec(0, 0.02, 0)), rlf_rotate(h->at.q, middle));
    const rlf_pose inverse = rlf_pose_invert(&h->at);
    act->T_hand_body = rlf_pose_mul(&inverse, &act->T_stage_body[0]);
    h->open = h->shut = h->let_go = flat(r);
}

/* Palm up, beneath a body that hangs there until it is released. */
static void hold_under(another_act *act, eval_random *r, hold *h)
{
    const another_hand *hand = &act->hand[0];
    const bool is_scoop = act->kind == ACT_SCOOP;
    const double s = hand->length / 0.19;
    const double half =
        act->body.type == RLF_SHAPE_SPHERE ? act->body.radius : 0.5 * act->body.size.y;
    h->approach = rlf_normalize(vec(eval_random_range(r, 0.0, 0.5), 0, -1));
    h->at.q = turn_of(vec(0, 0, 1), vec(0, 1, 0), vec(0, -1, 0), h->approach);
    const rlf_vec3 middle = {0, (is_scoop ? 0.075 : 0.090) * s, -PALM_SKIN * s - half};
    h->at.p = rlf_sub(act->T_stage_body[0].p, rlf_rotate(h->at.q, middle));
    const rlf_pose inverse = rlf_pose_invert(&h->at);
    act->T_hand_body = rlf_pose_mul(&inverse, &act->T_stage_body[0]);
    h->open = flat(r);
    another_grip cup = bent(r, 0.75, 0.75, 0.45);
    bend_thumb(&cup, 0.65, 0.65, 0.25, 0.25);
    h->shut =
        is_scoop ? close_on(hand, &h->open, &cup, &act->body, &act->T_hand_body, 0.002) : h->open;
    h->open = h->let_go = h->shut;
}

static act_key *add_key(another_act *act, double time, rlf_pose at, const another_grip *grip)
{
    act_key *key = &act->key[act->key_count < ACT_GRIPS_MAX ? act->key_count++ : ACT_GRIPS_MAX - 1];
    *key = (act_key){.time = time, .at = at, .grip = *grip};
    return key;
}

static rlf_pose moved(const rlf_pose *at, rlf_vec3 by)
{
    return (rlf_pose){rlf_add(at->p, by), at->q};
}

/* Reach, close, wait, lift, carry, wait, let go, leave. */
static void write_grasp(another_act *act, const hold *h, eval_random *r)
{
    const bool is_under = act->kind >= ACT_SCOOP;
    const double reach = eval_random_range(r, 0.8, 1.3), shut = eval_random_range(r, 0.25, 0.45);
    const double aside = eval_random_range(r, 0.18, 0.30) * (eval_random_uniform(r) < 0.5 ? -1 : 1);
    const bool is_two = act->kind == ACT_TWO_HANDS;
    rlf_pose at = h->at;
    if (act->is_aborted) { /* beside it, or before it */
        const bool is_before = eval_random_uniform(r) < 0.5;
        const rlf_vec3 off =
            is_before ? rlf_scale(rlf_normalize(h->approach), -eval_random_range(r, 0.07, 0.1))
                      : vec(eval_random_range(r, 0.09, 0.13), 0.02, 0.05);
        at = moved(&at, off);
    }
    const rlf_vec3 back =
        is_two ? vec(-0.10, 0.0, 0.0)
               : rlf_scale(rlf_normalize(h->approach), act->kind == ACT_BAR ? -0.12 : -0.08);
    const rlf_vec3 start = vec(act->kind == ACT_BAR ? -0.33 : -0.05, 0.12,
                               act->kind == ACT_BAR ? 0.15 : 0.30),
                   up = {0, act->rise, 0}, over = {aside, act->rise, 0};
    act->begin = 1.2;
    const rlf_pose far = moved(&h->at, start), near = moved(&at, back);
    add_key(act, act->begin, far, &h->rest);
    add_key(act, act->begin + 0.65 * reach, near, &h->open);
    act->closed = act->begin + 0.65 * reach + rlf_max(shut, 0.35 * reach);
    if (act->kind == ACT_BAR) { /* fingers close when the palm is there */
        add_key(act, act->closed, at, &h->open);
        act->closed += shut;
    }
    act_key *key = add_key(act, act->closed, at, &h->shut);
    for (int k = 0; k < 5; k++) {
        key->late[k] = eval_random_range(r, -0.04, 0.04);
    }
    double t = act->closed + eval_random_range(r, 0.15, 0.35);
    if (is_under) {
        act->release = act->closed + 0.15;
        t += 0.35;
    }
    add_key(act, t, at, &h->shut);
    if (!act->is_aborted) {
        t = act->lifted = t + eval_random_range(r, 0.6, 1.0);
        const rlf_pose lifted = moved(&at, up);
        add_key(act, t, lifted, &h->shut);
        t = act->carried = t + eval_random_range(r, 0.9, 1.6);
        at = moved(&at, over);
        if (!is_two) {
            const double roll = eval_random_range(r, -0.2, 0.2);
            at.q = rlf_quat_mul(rlf_quat_from_axis_angle(vec(0, 1, 0), roll), at.q);
        }
        add_key(act, t, at, &h->shut);
        t = act->opened = t + eval_random_range(r, 0.3, 0.6);
        add_key(act, t, at, &h->shut);
    } else {
        act->lifted = act->carried = act->opened = t;
    }
    const double opening = eval_random_range(r, 0.2, 0.6);
    t = act->let_go = act->opened + opening;
    rlf_pose away = is_two ? moved(&at, vec(-0.10, 0, 0)) : at;
    if (is_under) { /* turned over */
        const rlf_vec3 y = rlf_rotate(at.q, vec(0, 1, 0));
        away.q = rlf_quat_mul(rlf_quat_from_axis_angle(y, -2.4), at.q);
        t = act->let_go = act->opened + 0.3 + opening;
    }
    add_key(act, t, away, &h->let_go);
    add_key(act, t + 0.3, away, &h->let_go);
    act->end = t + 1.2;
    add_key(act, act->end, moved(&away, start), &h->rest);
}

/* One way among bodies and back: past, against, over, onto or beside one of them. */
static double write_visit(another_act *act, double t, eval_random *r)
{
    const int32_t way = (int32_t)eval_random_range(r, 0.0, 5.0),
                  b = (int32_t)eval_random_range(r, 0.0, 3.0);
    const double speed = eval_random_range(r, 0.1, 1.2) * eval_random_range(r, 0.4, 1.0) + 0.06;
    const rlf_gesture gestures[5] = {RLF_GESTURE_NONE, RLF_GESTURE_OPEN, RLF_GESTURE_FIST,
                                     RLF_GESTURE_POINT, RLF_GESTURE_NONE};
    another_grip grip =
        another_grip_draw_lots(&act->hand[0], gestures[(int)eval_random_range(r, 0.0, 5.0)], r);
    another_grip next = eval_random_uniform(r) < 0.25
                            ? another_grip_draw_lots(
                                  &act->hand[0], gestures[(int)eval_random_range(r, 0.0, 5.0)], r)
                            : grip;
    const rlf_vec3 body = act->T_stage_body[b].p;
    rlf_vec3 from = vec(-0.16, 0.03, 0.02), to = vec(0.16, 0.03, 0.02);
    rlf_quat q = turn_of(vec(0, 1, 0), vec(0, 0, 1),
                         vec(eval_random_range(r, -0.2, 0.5), -0.25, -1), vec(-0.3, 1, 0));
    double stay = 0.0;
    switch (way) {
    case 0: from.y = to.y = eval_random_range(r, 0.02, 0.10); break; /* passes */
    case 1: /* pushes with the ends of its fingers */
        from = vec(eval_random_range(r, -0.03, 0.03), 0.01, 0.16);
        to = vec(from.x, 0.01, -0.02);
        break;
    case 2: from.y = to.y = 0.075; break; /* strokes its top */
    case 3:                               /* rests on it */
        from = vec(0, 0.20, 0.10);
        to = vec(0, 0.055, 0.02);
        stay = eval_random_range(r, 0.5, 1.2);
        break;
    default: /* rests beside it */
        from = vec(-0.10, 0.12, 0.12);
        to = vec(-0.055, 0.0, 0.02);
        stay = eval_random_range(r, 0.5, 1.2);
        break;
    }
    if (way != 1 && way != 3 && eval_random_uniform(r) < 0.5) {
        const rlf_vec3 swap = from;
        from = to;
        to = swap;
    }
    const rlf_vec3 palm =
        rlf_rotate(q, vec(0, way == 1 ? 0.15 : 0.09, 0)); /* what meets the body */
    const rlf_vec3 a = rlf_sub(rlf_add(body, from), palm), b_at = rlf_sub(rlf_add(body, to), palm);
    const double gap = rlf_length(rlf_sub(b_at, a));
    t += eval_random_range(r, 0.3, 0.7);
    add_key(act, t, (rlf_pose){a, q}, &grip);
    t += rlf_max(gap / speed, 0.15);
    add_key(act, t, (rlf_pose){b_at, q}, &next);
    if (stay > 0.0) {
        t += stay;
        add_key(act, t, (rlf_pose){b_at, q}, &grip);
        t += 0.4;
        add_key(act, t, (rlf_pose){a, q}, &grip);
    }
    return t;
}

static void write_among(another_act *act, eval_random *r)
{
    double t = 1.2;
    const rlf_quat q = turn_of(vec(0, 1, 0), vec(0, 0, 1), vec(0, -0.2, -1), vec(0, 1, 0));
    const rlf_pose far = {vec(-0.1, 0.25, 0.30), q};
    const another_grip rest = another_grip_draw_lots(&act->hand[0], RLF_GESTURE_NONE, r);
    act->begin = t;
    add_key(act, t, far, &rest);
    t += 0.6;
    while (act->key_count + 8 < ACT_GRIPS_MAX && t < 30.0) {
        t = write_visit(act, t, r);
    }
    act->end = t + 0.6;
    add_key(act, act->end, far, &rest);
}

/* The camera looks at what is a little above the table. */
static void draw_view(another_act *act, eval_random *r)
{
    const double far = eval_random_range(r, 0.75, 1.2);
    act->view = (int32_t)eval_random_range(r, 0.0, 3.0);
    const double side = eval_random_uniform(r) < 0.5 ? -1.0 : 1.0;
    const double azimuth =
        act->view == 2 ? side * eval_random_range(r, 55, 80) : eval_random_range(r, -15, 15);
    const double elevation = act->view == 1 ? eval_random_range(r, 60, 78)
                                            : (act->view == 2 ? eval_random_range(r, 12, 30)
                                                              : eval_random_range(r, 15, 30));
    const rlf_vec3 aim = {0, 0.12, 0.0};
    const double ca = rlf_cos(azimuth * DEGREE), sa = rlf_sin(azimuth * DEGREE);
    const double ce = rlf_cos(elevation * DEGREE), se = rlf_sin(elevation * DEGREE);
    const rlf_vec3 eye = rlf_mad(aim, vec(sa * ce, se, -ca * ce), far);
    const rlf_vec3 z = rlf_normalize(rlf_sub(aim, eye));
    /* Of the camera in the stage: z ahead, y down. */
    const rlf_quat q = turn_of(vec(0, 0, 1), vec(0, 1, 0), z, vec(0, -1, 0));
    const rlf_pose T_stage_camera = {eye, q};
    act->T_camera_stage = rlf_pose_invert(&T_stage_camera);
}

static void draw_body(another_act *act, eval_random *r)
{
    const int32_t type = (int32_t)eval_random_range(r, 0.0, 3.0);
    const double width = eval_random_range(r, 0.032, 0.058),
                 tall = eval_random_range(r, 0.05, 0.09);
    act->body = (rlf_shape){.type = RLF_SHAPE_BOX, .size = {width, tall, width}};
    if (act->kind == ACT_BAR) {
        act->body = (rlf_shape){.type = RLF_SHAPE_CYLINDER};
        act->body.radius = eval_random_range(r, 0.012, 0.020);
        act->body.height = act->body.size.y = eval_random_range(r, 0.18, 0.24);
    } else if (act->kind == ACT_TWO_HANDS) {
        const double box = eval_random_range(r, 0.12, 0.19);
        act->body.size = vec(box, eval_random_range(r, 0.12, 0.18), 0.8 * box);
    } else if (act->kind == ACT_SCOOP || type == 1) {
        act->body = (rlf_shape){.type = RLF_SHAPE_SPHERE};
        act->body.radius = eval_random_range(r, 0.019, 0.030);
        act->body.size.y = 2.0 * act->body.radius;
    } else if (type == 2) {
        act->body = (rlf_shape){.type = RLF_SHAPE_CYLINDER};
        act->body.radius = 0.5 * width;
        act->body.height = act->body.size.y = tall;
    }
    if (act->kind == ACT_UNDER && act->body.type == RLF_SHAPE_SPHERE) {
        act->body = (rlf_shape){.type = RLF_SHAPE_BOX, .size = {width, 0.04, width}};
    }
}

void another_act_draw(another_act *act, act_kind kind, bool is_aborted, eval_random *r)
{
    memset(act, 0, sizeof(*act));
    act->kind = kind;
    act->is_aborted = is_aborted;
    another_hand_draw_lots(&act->hand[0], r);
    act->hand[1] = act->hand[0];
    act->hand_count = kind == ACT_TWO_HANDS ? 2 : 1;
    const bool is_left = act->hand[0].is_left || kind == ACT_TWO_HANDS;
    act->hand[0].is_left = true; /* lots are drawn for a left hand and mirrored in the end */
    act->rise = eval_random_range(r, 0.12, 0.18);
    draw_view(act, r);
    draw_body(act, r);
    act->body_count = kind == ACT_AMONG ? 3 : 1;
    for (int32_t k = 0; k < act->body_count; k++) {
        const double lift = kind == ACT_SCOOP || kind == ACT_UNDER ? 0.14 : 0.001;
        act->T_stage_body[k] = rlf_pose_identity();
        act->T_stage_body[k].p =
            vec(0.13 * (k - 0.5 * (act->body_count - 1)), 0.5 * act->body.size.y + lift, 0);
    }
    hold h = {.rest = another_grip_draw_lots(&act->hand[0], RLF_GESTURE_NONE, r)};
    switch (kind) {
    case ACT_PINCH_ABOVE:
    case ACT_PINCH_SIDE: hold_pinch(act, r, &h); break;
    case ACT_BAR: hold_bar(act, r, &h); break;
    case ACT_TWO_HANDS: hold_between(act, r, &h); break;
    case ACT_SCOOP:
    case ACT_UNDER: hold_under(act, r, &h); break;
    case ACT_AMONG: break;
    }
    if (kind == ACT_AMONG) {
        write_among(act, r);
    } else {
        write_grasp(act, &h, r);
    }
    act->hand[0].is_left = is_left;
    act->hand[1].is_left = false;
    for (int32_t k = 0; k < act->body_count && !is_left; k++) {
        act->T_stage_body[k] = mirrored(&act->T_stage_body[k]);
        act->T_hand_body = k == 0 ? mirrored(&act->T_hand_body) : act->T_hand_body;
    }
}

void another_act_room(const another_act *act, another_view *view)
{
    another_plane planes[5] = {{vec(0, 1, 0), 0.0, vec(0, 0, 0), TABLE_M},
                               {vec(0, 1, 0), 0.0, vec(0, -0.75, 0), 6.0},
                               {vec(0, 0, -1), 0.0, vec(0, 0, 1.6), 6.0},
                               {vec(1, 0, 0), 0.0, vec(-1.8, 0, 0), 6.0},
                               {vec(-1, 0, 0), 0.0, vec(1.8, 0, 0), 6.0}};
    for (int k = 0; k < 5; k++) {
        planes[k].normal = rlf_rotate(act->T_camera_stage.q, planes[k].normal);
        planes[k].middle = rlf_transform(&act->T_camera_stage, planes[k].middle);
        planes[k].offset = rlf_dot(planes[k].normal, planes[k].middle);
    }
    another_view_room(view, planes, 5, rlf_rotate(act->T_camera_stage.q, vec(0, 1, 0)));
}

static double smooth(double t)
{
    t = rlf_clamp(t, 0.0, 1.0);
    return t * t * t * (10.0 + t * (6.0 * t - 15.0));
}

/* Elbow and shoulder as an arm allows them, stage frame of that hand. */
static void put_arm(another_hand *h, const rlf_pose *at, double side,
                    const rlf_pose *T_camera_stage)
{
    const rlf_vec3 y = rlf_rotate(at->q, vec(0, 1, 0)), shoulder = {-0.2 * side, 0.38, 0.55};
    const rlf_vec3 wish =
        rlf_add(rlf_scale(y, -1.0), rlf_normalize(rlf_sub(vec(-0.28 * side, 0.1, 0.45), at->p)));
    rlf_vec3 elbow = rlf_mad(at->p, rlf_normalize(wish), 0.26);
    elbow.y = rlf_max(elbow.y, 0.045);
    h->elbow = rlf_transform(T_camera_stage, elbow);
    h->shoulder = rlf_transform(T_camera_stage, shoulder);
    h->chest = rlf_transform(T_camera_stage, vec(0, 0.26, 0.58));
}

int32_t another_act_pose(another_act *act, double time)
{
    const act_key *a = &act->key[0], *b = a;
    for (int32_t k = 0; k + 1 < act->key_count && act->key[k].time <= time; k++) {
        a = &act->key[k];
        b = &act->key[k + 1];
    }
    if (time < act->begin || time > act->end) {
        return 0;
    }
    const double span = rlf_max(b->time - a->time, 1e-6), share = smooth((time - a->time) / span);
    another_grip grip = another_grip_mix(&a->grip, &b->grip, 0.999 * share);
    for (int k = 0; k < 5; k++) {
        const another_grip late =
            another_grip_mix(&a->grip, &b->grip, smooth((time - b->late[k] - a->time) / span));
        memcpy(grip.bend[k], late.bend[k], sizeof(grip.bend[k]));
        grip.aside[k] = late.aside[k];
    }
    rlf_quat q = b->at.q;
    q = rlf_quat_mul(rlf_quat_conjugate(a->at.q), q);
    const double sign = q.w < 0.0 ? -1.0 : 1.0;
    const double angle = 2.0 * rlf_acos(rlf_clamp(sign * q.w, -1.0, 1.0));
    const rlf_vec3 axis = vec(sign * q.x, sign * q.y, sign * q.z);
    const rlf_quat turn = angle > 1e-6
                              ? rlf_quat_from_axis_angle(rlf_normalize(axis), share * angle)
                              : rlf_pose_identity().q;
    const rlf_pose at = {rlf_mad(a->at.p, rlf_sub(b->at.p, a->at.p), share),
                         rlf_quat_mul(a->at.q, turn)};
    for (int32_t k = 0; k < act->hand_count; k++) {
        rlf_pose own = act->hand[k].is_left ? at : mirrored(&at);
        if (k == 1) { /* the other side of what moves aside as one: the body's place */
            rlf_vec3 shift = vec(0, 0, 0);
            if (time > act->lifted) {
                const double carried = smooth((time - act->lifted) / (act->carried - act->lifted));
                shift.x = 2.0 * act->key[5].at.p.x - 2.0 * act->key[4].at.p.x;
                shift.x *= rlf_min(carried, 1.0);
            }
            own.p = rlf_add(own.p, shift);
        }
        act->hand[k].grip = grip;
        act->hand[k].T_camera_hand = rlf_pose_mul(&act->T_camera_stage, &own);
        put_arm(&act->hand[k], &own, act->hand[k].is_left ? 1.0 : -1.0, &act->T_camera_stage);
    }
    return act->hand_count;
}
