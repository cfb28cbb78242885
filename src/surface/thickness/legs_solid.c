/* The solid of a leg: thigh, shin and foot. */
#include "surface/thickness/legs.h"

#include "relief/math.h"

#include <math.h>
#include <string.h>

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

rlf_kernel_legs rlf_legs_of(const rlf_leg_shape shape[2], rlf_vec3 camera)
{
    rlf_kernel_legs out = {.heel = heel_back,
                           .length = heel_back + toes_ahead,
                           .behind = behind_share,
                           .least_aslant = least_aslant};
    put(camera, out.camera);
    for (int k = 0; k < 2 * RLF_LEG_PARTS; k++) {
        const rlf_leg_part *part = &shape[k / RLF_LEG_PARTS].part[k % RLF_LEG_PARTS];
        out.axis[k] = axis_of(part);
        put(rlf_normalize(rlf_sub(part->end, part->begin)), out.unit[k]);
    }
    return out;
}

void rlf_leg_stretch(const rlf_leg_shape *shape, rlf_kernel_touches *out)
{
    memset(out, 0, sizeof *out);
    for (int part = RLF_THIGH; part <= RLF_SHIN; part++) {
        const rlf_leg_part s = shape->part[part];
        rlf_vec3 along = rlf_sub(s.end, s.begin);
        double length = rlf_length(along) + 1e-9;
        const double by[3] = {along.x, along.y, along.z};
        out->distance[part] = (length - usual_length[part]) / length_spread;
        for (int k = 0; k < 3; k++) {
            double slope = by[k] / (length * length_spread);
            out->slope[part == RLF_THIGH ? RLF_LEG_KNEE + k : RLF_LEG_ANKLE + k][part] = slope;
            if (part == RLF_SHIN) {
                out->slope[RLF_LEG_KNEE + k][part] = -slope;
            }
        }
        if (part == RLF_THIGH) {
            out->slope[RLF_LEG_HIP][part] = -by[2] / (length * length_spread);
        }
    }
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
