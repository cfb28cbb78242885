/* A hand's bones and flesh. Lengths are shares of those of a hand of 0.18 m: Buryanov and Kotiuk
 * 2010 (Int. J. Morphol. 28, Proportions of hand segments), breadths as in ANSUR II. */
#include "sim/bones.h"
#include "sim/hands/hands.h"

#define STANDARD 0.180  /* metres */
#define PALM_SHARE 0.55 /* of the way from the wrist to the middle finger's root */

/* Of a left hand, whose thumb is on the side of +x. */
static const rlf_vec3 roots[SYNTH_FINGERS] = {{0.020, 0.020, -0.010},
                                              {0.0275, 0.090, 0.0},
                                              {0.0075, 0.0925, 0.002},
                                              {-0.0125, 0.0875, 0.001},
                                              {-0.0305, 0.0795, -0.003}};
/* Metres to the next joint; of the last bone to the middle of its round end. */
static const double lengths[SYNTH_FINGERS][3] = {{0.0462, 0.0316, 0.0185},
                                                 {0.0398, 0.0224, 0.0125},
                                                 {0.0446, 0.0263, 0.0141},
                                                 {0.0414, 0.0257, 0.0140},
                                                 {0.0327, 0.0181, 0.0125}};
static const double radii[SYNTH_FINGERS][4] = {{0.0150, 0.0115, 0.0110, 0.0088},
                                               {0.0108, 0.0095, 0.0082, 0.0070},
                                               {0.0110, 0.0097, 0.0084, 0.0072},
                                               {0.0104, 0.0090, 0.0078, 0.0067},
                                               {0.0093, 0.0078, 0.0068, 0.0060}};

/* Round cone from a to b. */
static synth_shape cone(rlf_vec3 a, rlf_vec3 b, double radius_a, double radius_b)
{
    rlf_vec3 way = rlf_sub(b, a);
    synth_shape shape = {.type = SYNTH_CONE, .radius_a = radius_a, .radius_b = radius_b};
    shape.length = rlf_length(way);
    shape.T_camera_shape = synth_bone_pose(a, way, rlf_perpendicular(rlf_normalize(way)));
    return shape;
}

/* Mirrored where it is a right hand, and in its size. */
static rlf_vec3 sized(const synth_hand_form *form, rlf_vec3 v)
{
    double s = form->length / STANDARD;
    return rlf_vec3_make(form->is_left ? s * v.x : -s * v.x, s * v.y, s * v.z);
}

/* Four metacarpals, what lies between them, and the ball of the little finger. */
static void set_palm(const synth_hand_form *form, synth_hand_shape *out)
{
    const double s = form->length / STANDARD;
    for (int i = 0; i < 4; i++) {
        rlf_vec3 root = roots[i + 1];
        rlf_vec3 base = {0.58 * root.x, 0.010, root.z - 0.001};
        out->solids[i] = cone(sized(form, base), sized(form, root), 0.0145 * s, 0.0112 * s);
    }
    synth_shape *middle = &out->solids[4];
    *middle = (synth_shape){.type = SYNTH_ELLIPSOID, .T_camera_shape = rlf_pose_identity()};
    middle->T_camera_shape.p = sized(form, rlf_vec3_make(0.001, 0.050, -0.002));
    middle->size = rlf_vec3_make(0.036 * s, 0.048 * s, 0.0145 * s);
    out->solids[5] =
        cone(sized(form, rlf_vec3_make(-0.021, 0.016, -0.006)),
             sized(form, rlf_vec3_make(-0.029, 0.062, -0.006)), 0.0145 * s, 0.0125 * s);
}

/* Unit directions of a finger's three bones, left hand. */
static void find_directions(const synth_grip *grip, int finger, rlf_vec3 out[3])
{
    if (finger == 0) {
        for (int k = 0; k < 3; k++) {
            out[k] = rlf_normalize(grip->thumb[k]);
        }
        return;
    }
    const double *bend = grip->bend[finger - 1];
    const double angles[3] = {bend[0], bend[0] + bend[1], bend[0] + bend[1] * (5.0 / 3.0)};
    const double aside =
        grip->spread * (2.2 - finger); /* the middle finger stays nearly straight */
    for (int k = 0; k < 3; k++) {
        double along = rlf_cos(angles[k]);
        out[k] = rlf_vec3_make(rlf_sin(aside) * along, rlf_cos(aside) * along, -rlf_sin(angles[k]));
    }
}

void synth_hand_form_shape(const synth_hand_form *form, const synth_grip *grip,
                           synth_hand_shape *out)
{
    const double s = form->length / STANDARD;
    set_palm(form, out);
    for (int f = 0; f < SYNTH_FINGERS; f++) {
        rlf_vec3 at = roots[f], directions[3];
        find_directions(grip, f, directions);
        out->joints[f][0] = sized(form, at);
        for (int k = 0; k < 3; k++) {
            at = rlf_mad(at, directions[k], lengths[f][k]);
            out->joints[f][k + 1] = sized(form, at);
            out->solids[SYNTH_HAND_PALM + 3 * f + k] = cone(
                out->joints[f][k], out->joints[f][k + 1], radii[f][k] * s, radii[f][k + 1] * s);
        }
        out->tip_radius[f] = radii[f][3] * s;
    }
}

rlf_vec3 synth_hand_palm(const synth_hand_form *form, double *out_half)
{
    const double s = form->length / STANDARD;
    *out_half = 0.0145 * s;
    return sized(form, rlf_vec3_make(0.001, PALM_SHARE * roots[2].y, -0.002));
}
