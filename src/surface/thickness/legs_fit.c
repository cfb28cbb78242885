/* The legs that explain a frame's points.
 *
 * Each point is of the leg that it is nearest to, and counts the less the farther it is (Geman and
 * McClure's weight): it may be of a hand, or of a coat. */
#include "surface/thickness/legs.h"

#include "math/inverse.h"
#include "math/observe.h"

#include <math.h>
#include <string.h>

enum { N = RLF_LEG_UNKNOWNS, FIRST_PASSES = 6, PASSES = 2 };

static const double scale_m = 0.02; /* of the weight, in the last pass */
static const double widest_m = 0.1; /* in the first of a leg that is looked for */
/* Patches of 10 cm2 are right to 3 cm together: they share the errors of the solid. */
static const double weight_m4 = 1.0 / (0.03 * 0.03 * 0.001);
/* How unknowns wander, per square root of a second. */
static const double joint_wander = 0.25, toes_wander = 0.5, radius_wander = 0.0007,
                    hip_wander = 0.02;
static const double least_radius_m = 0.03;
static const double rim_worth = 2.0;                  /* points that a place on the rim is worth */
static const double speed_gain = 0.4, speed_s = 0.25; /* it dies down in so many seconds */
static const double most_speed = 5.0;
static const double remind_s = 1.0;        /* a leg is drawn to one that stands, once in so long */
static const double least_explained = 0.6; /* of the points: else legs are looked for anew, */
static const double better_by = 0.1;       /* and taken if they explain so much more */
static const double foot_scale_m = 0.05, foot_top = 0.1; /* above an ankle, metres */
static const double facing_gain = 20.0;                  /* 1/m^2: how much what is seen says */

/* What places say about both legs. */
typedef struct reading {
    rlf_kernel_legs legs;
    rlf_kernel_equations sum[2];
    double area_m2[2];
    double scale;    /* of the weight */
    double weight;   /* of a point that fits */
    double point_m2; /* what one stands for */
} reading;

/* Adds what is off by as much as the touches to the legs that they are of, each so many times. */
static void add_touches(reading *r, const rlf_kernel_touches *touches, const double *axis,
                        const double *weight, int32_t count)
{
    double own[RLF_KERNEL_RAYS];
    for (int leg = 0; leg < 2; leg++) {
        for (int32_t i = 0; i < count; i++) {
            own[i] = (axis[i] >= RLF_LEG_PARTS) == (leg != 0) ? weight[i] : 0.0;
        }
        rlf_kernel_add_touches(touches, own, count, &r->sum[leg]);
    }
}

static double share_at(const reading *r, double distance)
{
    double off = distance / r->scale;
    return 1.0 / (1.0 + off * off);
}

/* On a leg's outline the camera's ray touches it: the place on the ray that is nearest to the axis
 * is on the surface, which tells how thick the leg is. A foot is not seen from beside. */
static void add_rim(reading *r, const rlf_vec3 *p, int32_t count)
{
    rlf_kernel_places places;
    rlf_kernel_nearest nearest;
    rlf_kernel_touches touches;
    double weight[RLF_KERNEL_RAYS];
    rlf_places_read(p, count, &places);
    rlf_kernel_find_nearest(r->legs.axis, 2 * RLF_LEG_PARTS, &places, &nearest);
    rlf_kernel_legs_beside(&r->legs, nearest.axis, &places);
    rlf_kernel_touch_legs(&r->legs, &places, nearest.axis, &touches);
    for (int32_t i = 0; i < count; i++) {
        double share = share_at(r, touches.distance[i]);
        bool is_foot = (int)nearest.axis[i] % RLF_LEG_PARTS == RLF_FOOT;
        weight[i] = is_foot ? 0.0 : rim_worth * r->weight * share * share;
    }
    add_touches(r, &touches, nearest.axis, weight, count);
}

/* Adds each of the points to the leg that it is nearest to. */
static void add_points(reading *r, const rlf_vec3 *p, int32_t count)
{
    rlf_kernel_places places;
    rlf_kernel_nearest nearest;
    rlf_kernel_touches touches;
    double weight[RLF_KERNEL_RAYS];
    rlf_places_read(p, count, &places);
    rlf_kernel_find_nearest(r->legs.axis, 2 * RLF_LEG_PARTS, &places, &nearest);
    rlf_kernel_touch_legs(&r->legs, &places, nearest.axis, &touches);
    for (int32_t i = 0; i < count; i++) {
        double share = share_at(r, touches.distance[i]);
        int leg = nearest.axis[i] >= RLF_LEG_PARTS;
        r->area_m2[leg] += share > 0.5 ? r->point_m2 : 0.0;
        weight[i] = r->weight * share * share;
    }
    add_touches(r, &touches, nearest.axis, weight, count);
}

static rlf_kernel_legs legs_of(const rlf_torso *torso)
{
    const rlf_leg_shape shape[2] = {rlf_leg_shape_of(torso, 0), rlf_leg_shape_of(torso, 1)};
    return rlf_legs_of(shape, rlf_torso_place(torso, rlf_vec3_make(0.0, 0.0, 0.0)));
}

static int32_t batch_at(int32_t first, int32_t count)
{
    return count - first < RLF_KERNEL_RAYS ? count - first : RLF_KERNEL_RAYS;
}

static void read_points(const rlf_torso *torso, const rlf_torso_points *points, double scale,
                        reading *out)
{
    static const double once[2] = {1.0, 1.0};
    *out = (reading){.legs = legs_of(torso),
                     .scale = scale,
                     .weight = weight_m4 * points->area_m2,
                     .point_m2 = points->area_m2};
    for (int32_t i = 0; i < points->count; i += RLF_KERNEL_RAYS) {
        add_points(out, points->p + i, batch_at(i, points->count));
    }
    for (int32_t i = 0; i < points->rim_count; i += RLF_KERNEL_RAYS) {
        add_rim(out, points->rim + i, batch_at(i, points->rim_count));
    }
    for (int leg = 0; leg < 2; leg++) {
        const rlf_leg_shape shape = rlf_leg_shape_of(torso, leg);
        rlf_kernel_touches stretch;
        rlf_leg_stretch(&shape, &stretch);
        rlf_kernel_add_touches(&stretch, once, 2, &out->sum[leg]);
    }
}

static void correct(rlf_leg *leg, const rlf_kernel_equations *sum, double information[N][N],
                    const double expected[N])
{
    double b[N];
    for (int r = 0; r < N; r++) {
        b[r] = sum->b[r];
        for (int c = 0; c < N; c++) {
            leg->doubt[r][c] = information[r][c] + (c <= r ? sum->a[r][c] : sum->a[c][r]);
            b[r] += information[r][c] * (expected[c] - leg->unknown[c]);
        }
    }
    math_invert(&leg->doubt[0][0], N);
    for (int r = 0; r < N; r++) {
        for (int c = 0; c < N; c++) {
            leg->unknown[r] += leg->doubt[r][c] * b[c];
        }
    }
    leg->unknown[RLF_LEG_TOES] = rlf_clamp(leg->unknown[RLF_LEG_TOES], -1.0, 1.0);
    for (int r = RLF_LEG_RADIUS; r < RLF_LEG_HIP; r++) {
        leg->unknown[r] = rlf_max(leg->unknown[r], least_radius_m);
    }
}

/* A person's legs are alike: both are as thick as they are on average, and hang as far ahead, as
 * far as it is known. */
static void make_alike(rlf_torso *torso)
{
    rlf_leg *a = &torso->leg[0], *b = &torso->leg[1];
    for (int k = RLF_LEG_RADIUS; k < N; k++) {
        double share = b->doubt[k][k] / (a->doubt[k][k] + b->doubt[k][k]);
        a->unknown[k] = share * a->unknown[k] + (1.0 - share) * b->unknown[k];
        b->unknown[k] = a->unknown[k];
    }
}

/* In passes, the weight's scale shrinking from `scale`. */
static void improve(rlf_torso *torso, const rlf_torso_points *points, double scale, int32_t passes)
{
    double information[2][N][N], expected[2][N];
    for (int leg = 0; leg < 2; leg++) {
        memcpy(expected[leg], torso->leg[leg].unknown, sizeof expected[leg]);
        memcpy(information[leg], torso->leg[leg].doubt, sizeof information[leg]);
        math_invert(&information[leg][0][0], N);
    }
    for (int32_t pass = 0; pass < passes; pass++) {
        reading read;
        read_points(torso, points, scale, &read);
        for (int leg = 0; leg < 2; leg++) {
            correct(&torso->leg[leg], &read.sum[leg], information[leg], expected[leg]);
            torso->leg[leg].area_m2 = read.area_m2[leg];
        }
        scale = rlf_max(0.6 * scale, scale_m);
    }
    make_alike(torso);
}

static void begin(rlf_torso *torso, const rlf_torso_points *points)
{
    for (int k = 0; k < 2; k++) {
        double variance[N];
        torso->leg[k] = (rlf_leg){.area_m2 = 0.0};
        rlf_leg_usual(torso, k == 0 ? -1.0 : 1.0, torso->leg[k].unknown, variance);
        for (int r = 0; r < N; r++) {
            torso->leg[k].doubt[r][r] = variance[r];
        }
    }
    improve(torso, points, widest_m, FIRST_PASSES);
}

static double wander_of(int unknown)
{
    switch (unknown) {
    case RLF_LEG_TOES: return toes_wander;
    case RLF_LEG_HIP: return hip_wander;
    default: return unknown < RLF_LEG_TOES ? joint_wander : radius_wander;
    }
}

static void expect(const rlf_torso *torso, rlf_leg *leg, double side, double dt)
{
    double usual[N], variance[N];
    rlf_leg_usual(torso, side, usual, variance);
    for (int k = 0; k < N; k++) {
        double wander = wander_of(k);
        leg->unknown[k] += leg->speed[k] * dt;
        leg->doubt[k][k] += wander * wander * dt;
    }
    for (int k = 0; k < N; k++) {
        const math_observation reminder = {k, usual[k], variance[k] * remind_s / dt};
        math_observe(leg->unknown, &leg->doubt[0][0], N, &reminder);
    }
}

static double explained(const rlf_torso *torso, const rlf_torso_points *points)
{
    double seen = points->area_m2 * points->count;
    return seen > 0.0 ? (torso->leg[0].area_m2 + torso->leg[1].area_m2) / seen : 1.0;
}

static void go_on(rlf_torso *torso, const rlf_torso_points *points, double dt)
{
    double before[2][N];
    for (int k = 0; k < 2; k++) {
        memcpy(before[k], torso->leg[k].unknown, sizeof before[k]);
        expect(torso, &torso->leg[k], k == 0 ? -1.0 : 1.0, dt);
    }
    improve(torso, points, 2.0 * scale_m, PASSES);
    for (int k = 0; k < 2; k++) {
        rlf_leg *leg = &torso->leg[k];
        for (int r = 0; r < RLF_LEG_TOES; r++) {
            double moved = (leg->unknown[r] - before[k][r]) / dt;
            leg->speed[r] += speed_gain * (moved - leg->speed[r]);
            leg->speed[r] *= speed_s / (speed_s + dt);
            leg->speed[r] = rlf_clamp(leg->speed[r], -most_speed, most_speed);
        }
    }
}

/* How badly the legs explain what is seen of feet, m^2. */
static double misfit_of_feet(const rlf_torso *torso, const rlf_torso_points *points)
{
    const rlf_kernel_legs legs = legs_of(torso);
    double top = rlf_min(torso->leg[0].unknown[RLF_LEG_ANKLE + 1],
                         torso->leg[1].unknown[RLF_LEG_ANKLE + 1]) -
                 foot_top;
    double sum = 0.0;
    for (int32_t i = 0; i < points->count;) {
        rlf_vec3 feet[RLF_KERNEL_RAYS];
        rlf_kernel_places places;
        rlf_kernel_nearest nearest;
        int32_t count = 0;
        for (; i < points->count && count < RLF_KERNEL_RAYS; i++) {
            if (points->p[i].y > top) {
                feet[count++] = points->p[i];
            }
        }
        rlf_places_read(feet, count, &places);
        rlf_kernel_find_nearest(legs.axis, 2 * RLF_LEG_PARTS, &places, &nearest);
        for (int32_t k = 0; k < count; k++) {
            double off = nearest.distance[k] / foot_scale_m;
            sum += points->area_m2 * off * off / (1.0 + off * off);
        }
    }
    return sum;
}

/* Whether toes are ahead of the ankles or behind. */
static void look_at_feet(rlf_torso *torso, const rlf_torso_points *points)
{
    double sign = torso->facing < 0.0 ? -1.0 : 1.0, belief = torso->facing;
    belief -= sign * facing_gain * misfit_of_feet(torso, points);
    torso->facing = -sign;
    belief += sign * facing_gain * misfit_of_feet(torso, points);
    torso->facing = rlf_clamp(belief, -1.0, 1.0);
}

/* Looks for the legs anew if they explain little now. */
static void look_again(rlf_torso *torso, const rlf_torso_points *points)
{
    double now = explained(torso, points);
    if (now < least_explained) {
        rlf_torso anew = *torso;
        begin(&anew, points);
        if (explained(&anew, points) > now + better_by) {
            *torso = anew;
        }
    }
}

void rlf_legs_follow(rlf_torso *torso, const rlf_torso_points *points, double dt)
{
    if (torso->has_legs) {
        go_on(torso, points, dt);
        look_again(torso, points);
    } else {
        begin(torso, points);
    }
    torso->has_legs = true;
    look_at_feet(torso, points);
}
