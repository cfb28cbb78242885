/* Throws into a sensed scene, followed frame by frame beside the true one. */
#include "eval/sensed/throw.h"

#include "eval/analytic.h"
#include "eval/ball.h"
#include "eval/sensed/make.h"
#include "eval/sensed/room.h"

#include <string.h>

#define CAPACITY 512
#define FIRST_FRAME 12 /* the background is known by then */
#define LIFE_S 1.0     /* s in the room */
#define FLIGHT_S 0.1   /* without a touch before it counts as flying again */
#define RIGHT_DEG 10.0
#define TWINS 7  /* the throw itself, and by a pixel or two sigma beside it */
#define NUDGES 6 /* throws by NUDGE_M beside it, both ways along each axis */
#define NUDGE_M 0.002
#define EDGE_PX 8
#define PIERCED 0.5 /* share of its inner radius by which a body that went through came nearer */
#define FRAMES_MAX 4000
#define STEPS 8      /* places looked at on the way from a frame to the next that the sensor took */
#define SHOWN_S 0.05 /* before it a new frame's surface is not known; physics lets it stand */

typedef struct track {
    bool is_alive, is_pending;
    bool has_touched, has_tunnelled, has_left, has_passed;
    rlf_vec3 way;   /* of an aimed throw: its direction at birth */
    double nearest; /* the same: least distance of its target to its centre so far, m */
    rlf_body_id id;
    double born_s, last_touch_s;
    rlf_body_state before;
    double restitution, friction, gravity_scale;
    rlf_vec3 gravity;         /* m/s^2 */
    eval_ball twins[TWINS];   /* while a bounce is pending */
    eval_ball nudged[NUDGES]; /* the same */
    bool has_sensed;
    rlf_vec3 sensed_point; /* of the sensed bounce */
} track;

typedef struct throwing {
    const eval_throw_def *def;
    eval_room stage;
    eval_random random;
    eval_throws *out;
    track tracks[CAPACITY];
    int32_t alive;
} throwing;

static rlf_vec3 gravity_of(const track *t)
{
    return rlf_scale(t->gravity, t->gravity_scale);
}

static bool is_in_view(const throwing *run, rlf_vec3 p)
{
    const rlf_rig *rig = &rlf_source_get_info(run->stage.truth)->rig;
    const rlf_camera *camera = &rig->depth;
    double u, v;
    return p.z > rig->depth_min_m && p.z < rig->depth_max_m &&
           rlf_camera_project(camera, p, &u, &v) && u >= EDGE_PX && v >= EDGE_PX &&
           u <= camera->width - 1 - EDGE_PX && v <= camera->height - 1 - EDGE_PX;
}

static rlf_synthetic_hit nearest(const throwing *run, double t, rlf_vec3 p)
{
    rlf_synthetic_hit hit = {.distance = 1e9};
    (void)rlf_synthetic_nearest(run->stage.truth, t, p, &hit);
    return hit;
}

static bool is_mover(int32_t label)
{
    return label >= RLF_SYNTHETIC_LABEL_PERSON && label < RLF_SYNTHETIC_LABEL_THING;
}

static bool is_target(eval_aim aim, int32_t label)
{
    return ((aim == EVAL_AIM_BACK || aim == EVAL_AIM_SIDE) && is_mover(label)) ||
           (aim == EVAL_AIM_BEHIND && label == RLF_SYNTHETIC_LABEL_PERSON) ||
           (aim == EVAL_AIM_EDGE && label == RLF_SYNTHETIC_LABEL_BOOK);
}

static bool is_aimed(const throwing *run)
{
    return eval_is_aimed(run->def->aim);
}

static eval_ball ball_of(const track *t)
{
    eval_ball ball = {.x = t->before.T_world_body.p,
                      .v = t->before.velocity,
                      .w = t->before.angular_velocity,
                      .radius = t->before.shape.radius,
                      .restitution = t->restitution,
                      .friction = t->friction};
    return ball;
}

/* Whether the body's inner ball must meet the target, and not just graze it. */
static bool flies_at_target(const throwing *run, const track *t, double now)
{
    eval_ball ball = ball_of(t);
    ball.radius = 0.9 * eval_inner_radius(&t->before.shape);
    eval_ball_fly(run->stage.truth, &ball, gravity_of(t), now, now + LIFE_S - 0.1);
    return ball.bounces > 0 && is_target(run->def->aim, ball.first.label) &&
           ball.first_approach > 0.7 * rlf_length(t->before.velocity);
}

static void add_throws(throwing *run, int32_t count)
{
    double now = run->stage.frame.time_s;
    for (int32_t i = 0; i < CAPACITY && count > 0; i++) {
        track *t = &run->tracks[i];
        rlf_body_def body;
        if (t->is_alive || !eval_sensed_make(run->def, &run->stage, &run->random, &body)) {
            count -= !t->is_alive;
            continue;
        }
        count--;
        memset(t, 0, sizeof(*t));
        t->born_s = now;
        t->last_touch_s = now - FLIGHT_S;
        t->restitution = body.restitution;
        t->friction = body.friction;
        t->gravity_scale = body.gravity_scale;
        t->gravity = rlf_world_get_snapshot(run->stage.world)->gravity;
        t->before.shape = body.shape;
        t->before.T_world_body.p = body.position;
        t->before.velocity = body.velocity;
        t->before.angular_velocity = body.angular_velocity;
        t->way = rlf_normalize(body.velocity);
        t->nearest = rlf_length(body.velocity) * LIFE_S;
        if (is_aimed(run) && !flies_at_target(run, t, now)) {
            continue;
        }
        if (rlf_world_add_body(run->stage.world, &body, &t->id) == RLF_OK) {
            t->is_alive = true;
            run->alive++;
            run->out->thrown++;
        }
    }
}

static void end_throw(throwing *run, track *t)
{
    rlf_world_remove_body(run->stage.world, t->id);
    t->is_alive = false;
    run->alive--;
    if (is_aimed(run)) {
        run->out->bounced += t->has_touched && !t->has_passed;
        run->out->passed += t->has_passed;
    }
}

/* Whether nothing of the true scene hides that place from the camera. */
static bool is_in_sight(const throwing *run, rlf_vec3 p)
{
    const rlf_truth *truth = rlf_source_get_truth(run->stage.truth);
    const rlf_camera *camera = &rlf_source_get_info(run->stage.truth)->rig.depth;
    double u, v, deepest = 0.0;
    if (!rlf_camera_project(camera, p, &u, &v)) {
        return false;
    }
    for (int32_t i = 0; i < 9; i++) {
        int32_t x = (int32_t)(u + 0.5) + i % 3 - 1, y = (int32_t)(v + 0.5) + i / 3 - 1;
        if (x >= 0 && y >= 0 && x < camera->width && y < camera->height) {
            deepest = rlf_max(deepest, truth->depth[y * camera->width + x]);
        }
    }
    return p.z < deepest + 0.02;
}

/* Whether the camera sees that place of the true scene, whose normal is n. */
static bool is_seen(const throwing *run, rlf_vec3 p, rlf_vec3 n)
{
    return rlf_dot(n, p) <= 0.0 && is_in_sight(run, p);
}

/* Where a body without a touch was at that share of the time between two frames. */
static rlf_vec3 place_between(const track *t, const rlf_body_state *body, double dt, double share)
{
    rlf_vec3 way = rlf_sub(body->T_world_body.p, t->before.T_world_body.p);
    rlf_vec3 p = rlf_mad(t->before.T_world_body.p, way, share);
    return rlf_mad(p, gravity_of(t), -0.5 * dt * dt * share * (1.0 - share));
}

/* The centre got into something true that the camera sees, or is a part of the room's shell: at the
 * end of a frame or, where nothing was touched, on the way. What moves is then where the new frame
 * shows it: frames that are lost tell nothing of its way. */
static void look_for_tunnel(throwing *run, track *t, const rlf_body_state *body, bool has_contact,
                            double begin, double end)
{
    const double DEEP = -0.02;
    double dt = end - begin;
    int32_t steps = has_contact ? 1 : STEPS * (run->def->lost + 1);
    for (int32_t i = 1; i <= steps && !t->has_tunnelled; i++) {
        double share = (double)i / steps;
        rlf_vec3 p = place_between(t, body, dt, share);
        rlf_synthetic_hit hit = nearest(run, rlf_max(begin + dt * share, end - SHOWN_S), p);
        if (hit.distance < DEEP && is_in_view(run, p)) {
            rlf_vec3 surface = rlf_mad(p, hit.normal, -hit.distance);
            t->has_tunnelled =
                hit.label <= RLF_SYNTHETIC_LABEL_CEILING || is_seen(run, surface, hit.normal);
            if (t->has_tunnelled && is_mover(hit.label)) {
                run->out->swallowed++;
            } else if (t->has_tunnelled) {
                run->out->tunnelled++;
            }
        }
    }
}

/* How near to its target the body came on its way through the frame. */
static void note_nearest(const throwing *run, track *t, const rlf_body_state *body, double begin,
                         double end)
{
    rlf_vec3 way = rlf_sub(body->T_world_body.p, t->before.T_world_body.p);
    for (int32_t i = 1; i <= STEPS; i++) {
        double share = (double)i / STEPS;
        rlf_vec3 p = rlf_mad(t->before.T_world_body.p, way, share);
        rlf_synthetic_hit hit = nearest(run, begin + (end - begin) * share, p);
        if (is_target(run->def->aim, hit.label)) {
            t->nearest = rlf_min(t->nearest, hit.distance);
        }
    }
}

/* On which side of the target an aimed body is when it leaves it: the far one means it went
 * through, if it also went into it. (A limb that turns it aside has it on its far side, too.)
 * Where the sensed back is deeper than the true one a body turns back within the true solid: then
 * it has not left it yet, and one that never does has not come back.
 */
static void look_for_pass(const throwing *run, track *t, const rlf_body_state *body,
                          bool has_contact, double begin, double end)
{
    if (!is_aimed(run) || t->has_left) {
        return;
    }
    note_nearest(run, t, body, begin, end);
    if (!t->has_touched || has_contact) {
        return;
    }
    rlf_synthetic_hit hit = nearest(run, end, body->T_world_body.p);
    bool is_at_target = is_target(run->def->aim, hit.label);
    bool is_inside = is_at_target && hit.distance < 0.0;
    bool is_pierced = t->nearest < PIERCED * eval_inner_radius(&t->before.shape);
    t->has_left = !is_inside;
    t->has_passed = is_inside || (is_at_target && is_pierced && rlf_dot(hit.normal, t->way) > 0.3);
}

/* The throw itself, and displaced by a pixel across the view and two sigma along it. */
static void start_twins(const throwing *run, track *t)
{
    const rlf_rig *rig = &rlf_source_get_info(run->stage.truth)->rig;
    double z = rlf_max(0.5, t->before.T_world_body.p.z);
    double pixel = z / rig->depth.fx;
    double sigma = rlf_depth_noise_sigma(&rig->noise, z);
    const rlf_vec3 shifts[TWINS] = {{0, 0, 0},           {pixel, 0, 0},  {-pixel, 0, 0},
                                    {0, pixel, 0},       {0, -pixel, 0}, {0, 0, 2.0 * sigma},
                                    {0, 0, -2.0 * sigma}};
    for (int32_t i = 0; i < TWINS; i++) {
        t->twins[i] = ball_of(t);
        t->twins[i].x = rlf_add(t->twins[i].x, shifts[i]);
    }
    for (int32_t i = 0; i < NUDGES; i++) {
        double nudge = i % 2 == 0 ? NUDGE_M : -NUDGE_M;
        t->nudged[i] = ball_of(t);
        t->nudged[i].x = rlf_add(t->nudged[i].x,
                                 rlf_vec3_make(i / 2 == 0 ? nudge : 0.0, i / 2 == 1 ? nudge : 0.0,
                                               i / 2 == 2 ? nudge : 0.0));
    }
}

static void fly_twins(const throwing *run, track *t, double begin, double end)
{
    for (int32_t i = 0; i < TWINS; i++) {
        eval_ball_fly(run->stage.truth, &t->twins[i], gravity_of(t), begin, end);
    }
    for (int32_t i = 0; i < NUDGES; i++) {
        eval_ball_fly(run->stage.truth, &t->nudged[i], gravity_of(t), begin, end);
    }
}

/* Whether the true bounce's direction hangs on a few millimetres: no sensor tells it. */
static bool is_ill_conditioned(const track *t)
{
    bool is_ill = false;
    for (int32_t i = 0; i < NUDGES; i++) {
        is_ill = is_ill || eval_angle_between(t->nudged[i].v, t->twins[0].v) > RIGHT_DEG;
    }
    return is_ill;
}

static bool has_bounced(const eval_ball *ball)
{
    return ball->bounces > 0 && ball->first_approach > EVAL_HARD_SPEED;
}

/* Whether the camera could not know: the true bounce is at a place that it does not see, or there
 * is none and the sensed one is behind what it sees. */
static bool is_hidden(const throwing *run, const track *t, int32_t true_bounces)
{
    const eval_ball *twin = &t->twins[0];
    if (has_bounced(twin)) {
        return !is_seen(run, twin->first_point, twin->first.normal);
    }
    return true_bounces == 0 && t->has_sensed && !is_in_sight(run, t->sensed_point);
}

/* Ours against truth's, once both had time to bounce. */
static void judge(throwing *run, track *t, const rlf_body_state *body)
{
    eval_throws *out = run->out;
    if (t->twins[0].hard_bounces > 1) {
        return; /* the second hides what the first one did */
    }
    double best = 180.0, exact = eval_angle_between(body->velocity, t->twins[0].v);
    int32_t bounced = 0;
    for (int32_t i = 0; i < TWINS; i++) {
        best = rlf_min(best, eval_angle_between(body->velocity, t->twins[i].v));
        bounced += has_bounced(&t->twins[i]);
    }
    if (is_hidden(run, t, bounced)) {
        out->hidden++;
        out->hidden_right += best <= RIGHT_DEG;
        return;
    }
    out->bounces++;
    out->right += exact <= RIGHT_DEG;
    out->right_nearby += best <= RIGHT_DEG;
    if (!is_ill_conditioned(t)) {
        out->conditioned++;
        out->conditioned_right += best <= RIGHT_DEG;
    }
    out->phantom += t->has_sensed && bounced == 0;
    out->missed += !t->has_sensed && bounced == TWINS;
}

/* A ball's bounce, as sensed in this frame and as truth has it; the later one may be in the next.
 */
static void look_for_bounce(throwing *run, track *t, const rlf_body_state *body,
                            const rlf_contact *contact, double begin, double end)
{
    bool is_sensed = contact != NULL && contact->approach_speed > EVAL_HARD_SPEED;
    t->sensed_point = is_sensed ? contact->point : t->sensed_point;
    if (t->is_pending) {
        t->is_pending = false;
        t->has_sensed = t->has_sensed || is_sensed;
        fly_twins(run, t, begin, end);
        judge(run, t, body);
        t->last_touch_s = end;
        return;
    }
    if (begin - t->last_touch_s < FLIGHT_S - 1e-6) {
        return;
    }
    eval_ball twin = ball_of(t);
    if (nearest(run, begin, twin.x).distance < twin.radius) {
        return;
    }
    eval_ball_fly(run->stage.truth, &twin, gravity_of(t), begin, end);
    bool is_true = has_bounced(&twin);
    rlf_vec3 where =
        is_true ? rlf_mad(twin.x, twin.first.normal, -twin.radius) : body->T_world_body.p;
    if ((!is_sensed && !is_true) || !is_in_view(run, where)) {
        return;
    }
    t->has_sensed = is_sensed;
    start_twins(run, t);
    fly_twins(run, t, begin, end);
    t->is_pending = !is_sensed || !is_true;
    if (!t->is_pending) {
        judge(run, t, body);
    }
    t->last_touch_s = end;
}

/* The body's hardest touch of the real surface in the last advance, or NULL. */
static const rlf_contact *touch_of(const rlf_snapshot *s, rlf_body_id id)
{
    const rlf_contact *best = NULL;
    for (int32_t i = 0; i < s->contact_count; i++) {
        const rlf_contact *c = &s->contacts[i];
        if (c->body.index1 == id.index1 && c->other != RLF_CONTACT_BODY && c->impulse > 0.0 &&
            (best == NULL || c->approach_speed > best->approach_speed)) {
            best = c;
        }
    }
    return best;
}

static void follow(throwing *run, track *t, const rlf_body_state *body, double begin, double end)
{
    const rlf_contact *contact = touch_of(run->stage.frame.snapshot, t->id);
    if (!rlf_vec3_is_finite(body->T_world_body.p) || !rlf_vec3_is_finite(body->velocity) ||
        !rlf_vec3_is_finite(body->angular_velocity)) {
        run->out->not_finite++;
        end_throw(run, t);
        return;
    }
    look_for_tunnel(run, t, body, contact != NULL, begin, end);
    run->out->fastest = rlf_max(run->out->fastest, rlf_length(body->velocity));
    if (run->def->balls_only) {
        look_for_bounce(run, t, body, contact, begin, end);
    }
    t->has_touched =
        t->has_touched || (contact != NULL && contact->other == RLF_CONTACT_FOREGROUND);
    look_for_pass(run, t, body, contact != NULL, begin, end);
    if (contact != NULL && !t->is_pending) {
        t->last_touch_s = end;
    }
    t->before = *body;
    if (end - t->born_s > LIFE_S) {
        end_throw(run, t);
    }
}

static void follow_all(throwing *run, double begin, double end)
{
    const rlf_snapshot *s = run->stage.frame.snapshot;
    for (int32_t i = 0; i < CAPACITY; i++) {
        track *t = &run->tracks[i];
        if (!t->is_alive) {
            continue;
        }
        const rlf_body_state *found = NULL;
        for (int32_t k = 0; k < s->body_count && found == NULL; k++) {
            found = s->bodies[k].id.index1 == t->id.index1 ? &s->bodies[k] : NULL;
        }
        if (found != NULL) {
            rlf_body_state body = *found;
            follow(run, t, &body, begin, end);
        } else {
            end_throw(run, t); /* it left the room */
        }
    }
}

/* Frame by frame, until all are thrown and none flies any more. */
static rlf_result play(throwing *run)
{
    const eval_throw_def *def = run->def;
    const int32_t per_frame = def->per_frame > 0 ? def->per_frame : 8;
    rlf_result result = RLF_OK;
    double before = 0.0;
    bool is_over = false; /* nothing more is thrown */
    for (int32_t i = 0; i < FRAMES_MAX && (!is_over || run->alive > 0); i++) {
        result = eval_room_step(&run->stage);
        if (result != RLF_OK) {
            break;
        }
        double now = run->stage.frame.time_s;
        follow_all(run, before, now);
        is_over = run->out->thrown >= def->throws || (def->end_s > 0.0 && now >= def->end_s);
        int64_t left = is_over ? 0 : def->throws - run->out->thrown;
        bool has_begun = run->stage.frame.frame_index >= FIRST_FRAME && now >= def->begin_s;
        if (has_begun && left > 0) {
            add_throws(run, left < per_frame ? (int32_t)left : per_frame);
        }
        run->stage.lost = has_begun ? def->lost : 0; /* the background first */
        before = now;
    }
    return result;
}

rlf_result eval_sensed_throw(const eval_throw_def *def, eval_throws *out)
{
    memset(out, 0, sizeof(*out));
    throwing *run = rlf_alloc(sizeof(*run));
    if (run == NULL) {
        return RLF_ERROR_MEMORY;
    }
    run->def = def;
    run->out = out;
    run->random = eval_random_start(def->seed);
    rlf_result result =
        eval_room_open(def->source, def->lost, def->profile, def->oracle, &run->stage);
    run->stage.lost = 0;
    result = result == RLF_OK ? play(run) : result;
    eval_room_close(&run->stage);
    rlf_free(run);
    return result == RLF_END ? RLF_OK : result;
}
