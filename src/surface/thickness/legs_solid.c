/* The solid of a leg: thigh, shin and foot. */
#include "surface/thickness/legs.h"

#include "relief/math.h"

#include <math.h>

/* Metres, of both sexes' means in ANSUR II (Gordon et al. 2014, Natick/TR-15/007) at their mean
 * stature, 1.69 m: trochanter below the shoulders' middle (the hips' joints are 17 cm apart), ...
 */
static const double hip_down = 0.463, hip_aside = 0.085;
/* ... from there to the knee's epicondyle and on to the malleolus, ... */
static const double usual_length[2] = {0.394, 0.411};
/* ... radii by the girths below the buttocks (0.099), above the knee (0.065), of calf (0.061) and
 * ankle (0.035), with 5 mm of clothes, made to taper evenly, */
static const double usual_radius[3] = {0.1, 0.07, 0.048};
/* and a foot 26 cm long and its shoe; from the ankle back to the middle of the heel's round end,
 * ahead to that of the toes', and down. */
static const double heel_back = 0.03, toes_ahead = 0.16, foot_down = 0.045, foot_radius = 0.04;

static const double length_spread = 0.05, girth_spread = 0.1, hip_spread = 0.03, toes_spread = 0.25;
static const double stand_spread[3] = {0.06, 0.06, 0.2}; /* x, y, z of a knee; of an ankle twice */

static const double least_aslant = 0.1; /* squared sine between an axis and a ray beside it */
static const double behind_share = 0.2; /* cosine beyond which a side is turned from the camera */

static rlf_vec3 hip_of(const rlf_torso *torso, double side)
{
    return rlf_vec3_make(side * hip_aside, hip_down,
                         torso->unknown[RLF_TORSO_AHEAD] +
                             torso->unknown[RLF_TORSO_LEAN] * hip_down);
}

static rlf_vec3 joint_of(const rlf_leg *leg, int first)
{
    return rlf_vec3_make(leg->unknown[first], leg->unknown[first + 1], leg->unknown[first + 2]);
}

void rlf_leg_usual(const rlf_torso *torso, double side, double unknown[RLF_LEG_UNKNOWNS],
                   double variance[RLF_LEG_UNKNOWNS])
{
    rlf_vec3 hip = hip_of(torso, side);
    double down = hip.y;
    for (int joint = 0; joint < 2; joint++) {
        down += usual_length[joint];
        const double place[3] = {hip.x, down, hip.z};
        for (int k = 0; k < 3; k++) {
            double spread = (1.0 + joint) * stand_spread[k];
            unknown[3 * joint + k] = place[k];
            variance[3 * joint + k] = spread * spread;
        }
    }
    unknown[RLF_LEG_TOES] = 0.0;
    variance[RLF_LEG_TOES] = toes_spread * toes_spread;
    unknown[RLF_LEG_HIP] = 0.0;
    variance[RLF_LEG_HIP] = hip_spread * hip_spread;
    for (int joint = 0; joint < 3; joint++) {
        double spread = girth_spread * usual_radius[joint];
        unknown[RLF_LEG_RADIUS + joint] = usual_radius[joint];
        variance[RLF_LEG_RADIUS + joint] = spread * spread;
    }
}

static rlf_leg_part part_of(const rlf_torso *torso, int leg, int part)
{
    const rlf_leg *l = &torso->leg[leg];
    const double *radius = &l->unknown[RLF_LEG_RADIUS];
    rlf_vec3 knee = joint_of(l, RLF_LEG_KNEE), ankle = joint_of(l, RLF_LEG_ANKLE);
    if (part == RLF_THIGH) {
        rlf_vec3 hip = hip_of(torso, leg == 0 ? -1.0 : 1.0);
        hip.z += l->unknown[RLF_LEG_HIP];
        return (rlf_leg_part){hip, knee, {radius[0], radius[1]}};
    }
    if (part == RLF_SHIN) {
        return (rlf_leg_part){knee, ankle, {radius[1], radius[2]}};
    }
    double facing = torso->facing < 0.0 ? -1.0 : 1.0, turn = l->unknown[RLF_LEG_TOES];
    rlf_vec3 ahead = rlf_vec3_make(facing * rlf_sin(turn), 0.0, facing * rlf_cos(turn));
    rlf_vec3 sole = rlf_vec3_make(ankle.x, ankle.y + foot_down, ankle.z);
    return (rlf_leg_part){rlf_mad(sole, ahead, -heel_back),
                          rlf_mad(sole, ahead, toes_ahead),
                          {foot_radius, foot_radius}};
}

rlf_leg_shape rlf_leg_shape_of(const rlf_torso *torso, int leg)
{
    rlf_leg_shape out;
    for (int part = 0; part < RLF_LEG_PARTS; part++) {
        out.part[part] = part_of(torso, leg, part);
    }
    return out;
}

/* The place of a part's axis that is nearest to a point. */
typedef struct foot_point {
    rlf_vec3 off;     /* from there to the point */
    double t, radius; /* share of the axis, 0..1; of the part */
} foot_point;

static foot_point foot_of(const rlf_leg_part *s, rlf_vec3 p)
{
    rlf_vec3 along = rlf_sub(s->end, s->begin), off = rlf_sub(p, s->begin);
    double t = rlf_clamp(rlf_dot(off, along) / (rlf_dot(along, along) + 1e-9), 0.0, 1.0);
    return (foot_point){rlf_mad(off, along, -t), t,
                        s->radius[0] + t * (s->radius[1] - s->radius[0])};
}

static void put(rlf_vec3 v, double out[3])
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

static rlf_kernel_axis axis_of(const rlf_leg_part *part)
{
    rlf_kernel_axis out = {.radius = {part->radius[0], part->radius[1]}};
    rlf_vec3 along = rlf_sub(part->end, part->begin);
    put(part->begin, out.begin);
    put(along, out.along);
    out.square = rlf_dot(along, along) + 1e-9;
    return out;
}

void rlf_legs_nearest(const rlf_leg_shape shape[2], const rlf_vec3 *p, int32_t count,
                      rlf_kernel_nearest *out)
{
    rlf_kernel_axis axes[2 * RLF_LEG_PARTS];
    rlf_kernel_places places = {.count = 0};
    for (int k = 0; k < 2 * RLF_LEG_PARTS; k++) {
        axes[k] = axis_of(&shape[k / RLF_LEG_PARTS].part[k % RLF_LEG_PARTS]);
    }
    while (places.count < count || places.count % RLF_KERNEL_RAY_LANES != 0) {
        int32_t i = places.count++;
        const rlf_vec3 *at = &p[i < count ? i : count - 1];
        places.side[i] = at->x;
        places.down[i] = at->y;
        places.ahead[i] = at->z;
    }
    rlf_kernel_find_nearest(axes, 2 * RLF_LEG_PARTS, &places, out);
}

rlf_leg_touch rlf_leg_touch_at(const rlf_leg_shape *shape, int part, rlf_vec3 p, rlf_vec3 camera)
{
    const rlf_leg_part s = shape->part[part];
    const foot_point foot = foot_of(&s, p);
    double length = rlf_length(foot.off) + 1e-9, t = foot.t;
    rlf_vec3 n = rlf_scale(foot.off, 1.0 / length);
    if (rlf_dot(n, rlf_sub(p, camera)) > behind_share * rlf_length(rlf_sub(p, camera))) {
        n = rlf_scale(n, -1.0);
        length = -length;
    }
    rlf_leg_touch out = {.distance = length - foot.radius};
    double of_knee = part == RLF_THIGH ? t : part == RLF_SHIN ? 1.0 - t : 0.0;
    double of_ankle = part == RLF_THIGH ? 0.0 : part == RLF_SHIN ? t : 1.0;
    const double by[3] = {n.x, n.y, n.z};
    for (int k = 0; k < 3; k++) {
        out.slope[RLF_LEG_KNEE + k] = -of_knee * by[k];
        out.slope[RLF_LEG_ANKLE + k] = -of_ankle * by[k];
    }
    out.slope[RLF_LEG_HIP] = part == RLF_THIGH ? (t - 1.0) * n.z : 0.0;
    if (part == RLF_FOOT) { /* turned, the axis moves square to itself */
        double ahead = t * (heel_back + toes_ahead) - heel_back;
        double share = ahead / (heel_back + toes_ahead);
        rlf_vec3 along = rlf_sub(s.end, s.begin);
        out.slope[RLF_LEG_TOES] = -share * (n.x * along.z - n.z * along.x);
    } else {
        out.slope[RLF_LEG_RADIUS + part] = t - 1.0;
        out.slope[RLF_LEG_RADIUS + part + 1] = -t;
    }
    return out;
}

rlf_vec3 rlf_leg_beside(const rlf_leg_part *s, rlf_vec3 p, rlf_vec3 camera)
{
    rlf_vec3 along = rlf_normalize(rlf_sub(s->end, s->begin)),
             way = rlf_normalize(rlf_sub(p, camera));
    rlf_vec3 off = rlf_sub(s->begin, p);
    double cosine = rlf_dot(along, way), square = 1.0 - cosine * cosine;
    if (square < least_aslant) {
        return p;
    }
    return rlf_mad(p, way, (rlf_dot(off, way) - cosine * rlf_dot(off, along)) / square);
}

rlf_leg_touch rlf_leg_stretch(const rlf_leg_shape *shape, int part)
{
    const rlf_leg_part s = shape->part[part];
    rlf_vec3 along = rlf_sub(s.end, s.begin);
    double length = rlf_length(along) + 1e-9;
    rlf_leg_touch out = {.distance = (length - usual_length[part]) / length_spread};
    const double by[3] = {along.x, along.y, along.z};
    for (int k = 0; k < 3; k++) {
        double slope = by[k] / (length * length_spread);
        out.slope[part == RLF_THIGH ? RLF_LEG_KNEE + k : RLF_LEG_ANKLE + k] = slope;
        if (part == RLF_SHIN) {
            out.slope[RLF_LEG_KNEE + k] = -slope;
        }
    }
    if (part == RLF_THIGH) {
        out.slope[RLF_LEG_HIP] = -by[2] / (length * length_spread);
    }
    return out;
}

rlf_kernel_limb rlf_leg_limb(const rlf_leg_part *part, rlf_vec3 camera)
{
    rlf_kernel_limb out = {.radius = {part->radius[0], part->radius[1]}};
    rlf_vec3 along = rlf_sub(part->end, part->begin);
    out.length = rlf_length(along) + 1e-9;
    put(rlf_scale(along, 1.0 / out.length), out.along);
    put(rlf_sub(part->begin, camera), out.off[0]);
    put(rlf_sub(part->end, camera), out.off[1]);
    return out;
}
