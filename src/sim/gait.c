/* The person's way through the room, as a list of acts: walk along x, turn on the spot. Feet that
 * carry do not slide: footfalls are planned per walk, and a foot moves only during its swing. */
#include "sim/gait.h"

#define RAMP 0.2         /* share of a walk's time in which it speeds up, and slows down */
#define STEP_HEIGHT 0.05 /* metres that a swinging foot is lifted */

#define WEST SYNTH_WEST
#define EAST SYNTH_EAST
#define CAMERA (-RLF_PI)

static const synth_act room_acts[] = {
    {true, 0.3, 3.5, 3.35, -0.2},
    {false, 3.5, 4.1, WEST, CAMERA},
    {false, 6.5, 7.1, CAMERA, WEST},
    {true, 7.1, 9.9, -0.2, -3.3},
};
static const synth_act thesis_acts[] = {
    {true, 0.6, 3.6, 2.6, -0.85},  {false, 3.6, 4.3, WEST, EAST}, {true, 4.3, 6.1, -0.85, 0.95},
    {false, 6.1, 6.8, EAST, WEST}, {true, 6.8, 9.8, 0.95, -2.6},
};
static const synth_act book_acts[] = {
    {true, 0.3, 3.5, 3.35, -0.2},
    {false, 3.5, 4.1, WEST, CAMERA},
    {false, 9.2, 9.8, CAMERA, WEST},
    {true, 9.8, 12.6, -0.2, -3.3},
};

static const synth_act crossing_acts[] = {{true, 0.3, 5.3, 2.3, -2.3}};
static const synth_act second_acts[] = {{true, 0.3, 5.3, -2.7, 2.7}};

static const synth_script room_script = {10.0, 2.95, WEST, 3.9, 6.6, room_acts, 4, 0.0, 0.0, 0.0};
static const synth_script thesis_script = {10.0,        2.3, WEST, 0.0, 0.0,
                                           thesis_acts, 5,   0.0,  0.0, 0.0};
static const synth_script book_script = {13.0, 2.95, WEST, 0.0, 0.0, book_acts, 4, 0.0, 0.0, 0.0};
static const synth_script crossing_script = {6.0,           2.2, WEST, 0.0, 0.0,
                                             crossing_acts, 1,   0.0,  0.0, 0.0};
static const synth_script second_script = {6.0, 3.0, EAST, 0.0, 0.0, second_acts, 1, 0.0, 0.0, 0.0};

static const synth_script *script_of(rlf_synthetic_scene kind)
{
    switch (kind) {
    case RLF_SYNTHETIC_THESIS: return &thesis_script;
    case RLF_SYNTHETIC_BOOK: return &book_script;
    case RLF_SYNTHETIC_CROSSING: return &crossing_script;
    default: return &room_script;
    }
}

double synth_gait_period(rlf_synthetic_scene kind)
{
    return script_of(kind)->period;
}

/* Share of the way (0..1) after share x of the time: the speed rises as a smooth step over RAMP,
 * stays, and falls alike. */
static double way(double x)
{
    double c = rlf_clamp(x, 0.0, 1.0);
    double w = rlf_min(c, 1.0 - c) / RAMP;
    double s = w < 1.0 ? RAMP * w * w * w * (1.0 - 0.5 * w) : RAMP * (w - 0.5);
    double part = s / (1.0 - RAMP);
    return c < 0.5 ? part : 1.0 - part;
}

/* Speed relative to full stride. */
static double pace(double x)
{
    return synth_smooth(rlf_min(x, 1.0 - x) / RAMP);
}

/* A foot's place in steps after the body has made `u` of `steps` steps, and its lift. Footfall k is
 * at k; feet alternate, the left one takes the odd ones, and the last joins the other at `steps`.
 * The swing to footfall k lasts while the body goes from k - 1.35 to k - 0.45. */
static double foot_place(int side, double u, int steps, double *lift)
{
    double place = 0.0;
    *lift = 0.0;
    for (int k = side == 0 ? 1 : 2; k <= steps + 1; k += 2) {
        double begin = rlf_max(0.0, k - 1.35);
        double end = rlf_min(steps, k - 0.45);
        double w = rlf_clamp((u - begin) / (end - begin), 0.0, 1.0);
        double target = k < steps ? k : steps;
        place += (target - place) * synth_smooth(w);
        *lift += STEP_HEIGHT * 16.0 * w * w * (1.0 - w) * (1.0 - w);
        if (w < 1.0) {
            break;
        }
    }
    return place;
}

static double absolute(double x)
{
    return x < 0.0 ? -x : x;
}

static rlf_vec3 beside(const synth_gait *gait, rlf_vec3 p, double heading, int side)
{
    double offset = side == 0 ? -gait->foot_offset : gait->foot_offset;
    return rlf_add(p, rlf_vec3_make(offset * rlf_cos(heading), 0, -offset * rlf_sin(heading)));
}

/* The hips go back over the seat, the feet stay. */
static void sit(synth_gait *gait, const synth_script *s, double leg, double now)
{
    const double back = 0.36 * leg;
    gait->sitting =
        synth_smooth((now - s->sit_begin) / 1.0) * synth_smooth((s->sit_end - now) / 1.0);
    gait->seat = s->seat;
    const double away = back * gait->sitting;
    const rlf_vec3 ahead = {rlf_sin(gait->heading), 0, rlf_cos(gait->heading)};
    gait->position = rlf_mad(gait->position, ahead, -away);
}

static void walk(synth_gait *gait, const synth_act *a, double step, double t)
{
    double x = (t - a->begin) / (a->end - a->begin);
    double distance = a->to - a->from;
    int steps = (int)(absolute(distance) / step + 0.5);
    double place[2];
    gait->stride = way(x) * steps;
    gait->walking = pace(x);
    gait->position.x = a->from + distance * way(x);
    for (int side = 0; side < 2; side++) {
        double lift;
        place[side] = foot_place(side, gait->stride, steps, &lift);
        rlf_vec3 p = gait->position;
        p.x = a->from + distance * place[side] / steps;
        p = beside(gait, p, gait->heading, side);
        p.y = lift;
        gait->foot[side].position = p;
    }
    gait->swing = place[0] - place[1];
}

/* The left foot turns during the first 60 % of the time, the right one during the last. */
static void turn(synth_gait *gait, const synth_act *a, double t)
{
    double x = (t - a->begin) / (a->end - a->begin);
    gait->heading = a->from + (a->to - a->from) * synth_smooth(x);
    for (int side = 0; side < 2; side++) {
        double w = rlf_clamp((x - 0.4 * side) / 0.6, 0.0, 1.0);
        double heading = a->from + (a->to - a->from) * synth_smooth(w);
        rlf_vec3 p = beside(gait, gait->position, heading, side);
        p.y = STEP_HEIGHT * 0.7 * 16.0 * w * w * (1.0 - w) * (1.0 - w);
        gait->foot[side].position = p;
        gait->foot[side].heading = heading;
    }
}

static void stand(synth_gait *gait)
{
    for (int side = 0; side < 2; side++) {
        gait->foot[side].position = beside(gait, gait->position, gait->heading, side);
        gait->foot[side].heading = gait->heading;
    }
}

/* Act i at the figure's own pace: who walks slower comes from less far, and goes less far away. */
static synth_act act_of(const synth_script *s, const synth_figure *figure, int i)
{
    synth_act a = s->acts[i];
    if (i == 0) {
        a.from = a.to + (a.from - a.to) * figure->pace;
    } else if (i == s->act_count - 1) {
        a.to = a.from + (a.to - a.from) * figure->pace;
    }
    return a;
}

synth_gait synth_gait_follow(const synth_script *s, const synth_figure *figure, double t)
{
    double now = t - s->period * (double)(int64_t)(t / s->period);
    synth_gait gait = {.position = {act_of(s, figure, 0).from, 0.0, s->z},
                       .heading = s->heading,
                       .foot_offset = figure->hip};
    stand(&gait);
    for (int i = 0; i < s->act_count && now >= s->acts[i].begin; i++) {
        synth_act a = act_of(s, figure, i);
        bool is_over = now >= a.end;
        if (!is_over && a.is_walk) {
            walk(&gait, &a, figure->step, now);
        } else if (!is_over) {
            turn(&gait, &a, now);
        } else {
            gait.position.x = a.is_walk ? a.to : gait.position.x;
            gait.heading = a.is_walk ? gait.heading : a.to;
            stand(&gait);
        }
    }
    if (s->sit_end > 0.0) {
        sit(&gait, s, figure->leg, now);
    }
    if (s->reach_end > 0.0) {
        gait.gesture_time = now - s->reach_begin;
        gait.reach =
            synth_smooth((now - s->reach_begin) / 0.8) * synth_smooth((s->reach_end - now) / 0.7);
    }
    return gait;
}

synth_gait synth_gait_at(rlf_synthetic_scene kind, const synth_figure *figure, double t)
{
    return synth_gait_follow(script_of(kind), figure, t);
}

synth_gait synth_second_gait_at(const synth_figure *figure, double t)
{
    return synth_gait_follow(&second_script, figure, t);
}
