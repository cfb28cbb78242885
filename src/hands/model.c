/* Lengths as shares of the hand's: Buchholz, Armstrong, Goldstein 1992 (Ergonomics 35, a kinematic
 * model of the human hand). Breadths of fingers: Greiner 1991, Hand anthropometry of US Army
 * personnel, half of the joints' breadths. Ranges of joints: Kapandji. */
#include "hands/model.h"

#define DIGIT_CONE(digit) (MODEL_PALM + 3 * (digit))
#define TURN_FINGER 5
#define TURN_WRIST (TURN_FINGER + 16)
#define LAST_JOINT (2.0 / 3.0) /* of the middle one */

/* Of a left hand of MODEL_LENGTH_M, metres; the thumb first. */
static const double roots[5][3] = {{0.020, 0.018, -0.008},
                                   {0.026, 0.085, 0.000},
                                   {0.004, 0.086, 0.002},
                                   {-0.016, 0.079, 0.000},
                                   {-0.034, 0.071, -0.003}};
static const double lengths[5][3] = {{0.0464, 0.0363, 0.0212},
                                     {0.0453, 0.0265, 0.0115},
                                     {0.0492, 0.0315, 0.0130},
                                     {0.0451, 0.0305, 0.0130},
                                     {0.0377, 0.0216, 0.0112}};
static const double radii[5][4] = {{0.0150, 0.0120, 0.0110, 0.0085},
                                   {0.0105, 0.0090, 0.0080, 0.0068},
                                   {0.0108, 0.0092, 0.0082, 0.0070},
                                   {0.0102, 0.0087, 0.0077, 0.0066},
                                   {0.0090, 0.0076, 0.0068, 0.0060}};

/* Cones of the palm: both middles and both radii. */
static const double palm[MODEL_PALM][8] = {
    {0.014, 0.014, 0.000, 0.026, 0.083, -0.001, 0.0145, 0.0120},
    {0.005, 0.012, 0.001, 0.004, 0.084, 0.000, 0.0150, 0.0125},
    {-0.005, 0.012, 0.000, -0.016, 0.077, -0.001, 0.0150, 0.0120},
    {-0.014, 0.014, -0.002, -0.033, 0.069, -0.003, 0.0140, 0.0110},
    {-0.018, 0.018, -0.006, -0.029, 0.052, -0.007, 0.0145, 0.0130},
    {-0.012, 0.006, -0.002, 0.012, 0.006, -0.002, 0.0185, 0.0185}};
static const double palm_middle[3] = {0.0, 0.047, -0.002};

/* From the wrist on, straight; breadth and depth of a forearm differ by a third. */
static const double forearm_at[3] = {0.0, 0.075, 0.160};
static const double forearm_radius[3] = {0.0230, 0.0270, 0.0350};

const double hand_model_mean[MODEL_ANGLES] = {0.65,  0.55, 0.70, 0.30, 0.30,  0.08, 0.40,
                                              0.50,  0.0,  0.40, 0.50, -0.07, 0.40, 0.50,
                                              -0.15, 0.40, 0.50, 0.0,  0.0};
const double hand_model_low[MODEL_ANGLES] = {-0.50, -0.20, 0.0,   -0.30, -0.30, -0.25, -0.35,
                                             0.0,   -0.30, -0.35, 0.0,   -0.40, -0.35, 0.0,
                                             -0.50, -0.35, 0.0,   -1.50, -1.50};
const double hand_model_high[MODEL_ANGLES] = {1.25, 1.20, 1.50, 1.00, 1.30, 0.45, 1.60,
                                              1.90, 0.30, 1.60, 1.90, 0.25, 1.60, 1.90,
                                              0.20, 1.60, 1.90, 1.50, 1.50};

/* From the left hand's frame to the camera's. */
typedef struct placing {
    const hand_model_pose *pose;
    double side;
} placing;

static rlf_vec3 vector(const double v[3])
{
    return rlf_vec3_make(v[0], v[1], v[2]);
}

static rlf_vec3 place(const placing *p, rlf_vec3 v)
{
    return rlf_add(p->pose->at, rlf_rotate(p->pose->q, rlf_vec3_make(p->side * v.x, v.y, v.z)));
}

/* A mirrored turn keeps its sense about x and changes it about y and z. */
static hand_turn turn_of(const placing *p, rlf_vec3 axis, rlf_vec3 centre, int32_t unknown)
{
    const rlf_vec3 turned = {axis.x, p->side * axis.y, p->side * axis.z};
    return (hand_turn){rlf_rotate(p->pose->q, turned), place(p, centre), 1.0, unknown};
}

/* Cones and joints of a digit from its bones' directions. */
static void put_digit(hand_model *m, const placing *p, int32_t digit, const rlf_vec3 direction[3],
                      rlf_vec3 at[4])
{
    at[0] = vector(roots[digit]);
    for (int32_t k = 0; k < 3; k++) {
        const int32_t c = DIGIT_CONE(digit) + k;
        at[k + 1] = rlf_mad(at[k], direction[k], lengths[digit][k]);
        m->a[c] = m->joint[digit][k] = place(p, at[k]);
        m->b[c] = m->joint[digit][k + 1] = place(p, at[k + 1]);
        m->radius_a[c] = radii[digit][k];
        m->radius_b[c] = radii[digit][k + 1];
    }
}

static void put_finger(hand_model *m, const placing *p, int32_t digit)
{
    const int32_t unknown = MODEL_FINGER + 3 * (digit - 1);
    const double *angle = &p->pose->angle[unknown - MODEL_THUMB];
    const double s = rlf_sin(angle[0]), c = rlf_cos(angle[0]);
    const double bends[3] = {angle[1], angle[1] + angle[2],
                             angle[1] + (1.0 + LAST_JOINT) * angle[2]};
    rlf_vec3 direction[3], at[4];
    for (int32_t k = 0; k < 3; k++) {
        const double along = rlf_cos(bends[k]);
        direction[k] = rlf_vec3_make(s * along, c * along, -rlf_sin(bends[k]));
    }
    put_digit(m, p, digit, direction, at);
    hand_turn *t = &m->turn[TURN_FINGER + 4 * (digit - 1)];
    const rlf_vec3 aside = {0, 0, -1}, bend = {-c, s, 0};
    t[0] = turn_of(p, aside, at[0], unknown);
    t[1] = turn_of(p, bend, at[0], unknown + 1);
    t[2] = turn_of(p, bend, at[1], unknown + 2);
    t[3] = turn_of(p, bend, at[2], unknown + 2);
    t[3].share = LAST_JOINT;
}

static void put_thumb(hand_model *m, const placing *p)
{
    const double *angle = p->pose->angle;
    const double sa = rlf_sin(angle[0]), ca = rlf_cos(angle[0]);
    const double sb = rlf_sin(angle[1]), cb = rlf_cos(angle[1]);
    const rlf_vec3 along = {sa * cb, ca * cb, -sb}, aside = {ca, -sa, 0};
    const rlf_vec3 forward = {-sa * sb, -ca * sb, -cb};
    const rlf_vec3 bent = rlf_mad(rlf_scale(aside, -rlf_cos(angle[2])), forward, rlf_sin(angle[2]));
    const double bends[3] = {0.0, angle[3], angle[3] + angle[4]};
    rlf_vec3 direction[3], at[4];
    for (int32_t k = 0; k < 3; k++) {
        direction[k] = rlf_mad(rlf_scale(along, rlf_cos(bends[k])), bent, rlf_sin(bends[k]));
    }
    put_digit(m, p, 0, direction, at);
    const rlf_vec3 hinge = rlf_cross(along, bent);
    m->turn[0] = turn_of(p, rlf_vec3_make(0, 0, -1), at[0], MODEL_THUMB);
    m->turn[1] = turn_of(p, rlf_vec3_make(-ca, sa, 0), at[0], MODEL_THUMB + 1);
    m->turn[2] = turn_of(p, rlf_neg(along), at[0], MODEL_THUMB + 2);
    m->turn[3] = turn_of(p, hinge, at[1], MODEL_THUMB + 3);
    m->turn[4] = turn_of(p, hinge, at[2], MODEL_THUMB + 4);
}

static void put_forearm(hand_model *m, const placing *p)
{
    const double *angle = &p->pose->angle[MODEL_WRIST - MODEL_THUMB];
    const double s = rlf_sin(angle[1]), c = rlf_cos(angle[1]);
    const double along = rlf_cos(angle[0]);
    const rlf_vec3 back = {-s * along, -c * along, -rlf_sin(angle[0])}, wrist = {0, 0, 0};
    for (int32_t k = 0; k < 2; k++) {
        const int32_t i = MODEL_HAND + k;
        m->a[i] = place(p, rlf_scale(back, forearm_at[k]));
        m->b[i] = place(p, rlf_scale(back, forearm_at[k + 1]));
        m->radius_a[i] = forearm_radius[k];
        m->radius_b[i] = forearm_radius[k + 1];
    }
    m->turn[TURN_WRIST] = turn_of(p, rlf_vec3_make(c, -s, 0), wrist, MODEL_WRIST);
    m->turn[TURN_WRIST + 1] = turn_of(p, rlf_vec3_make(0, 0, -1), wrist, MODEL_WRIST + 1);
}

void hand_model_build(hand_model *m, const hand_model_pose *pose)
{
    const placing p = {pose, pose->is_left ? 1.0 : -1.0};
    m->y = rlf_rotate(pose->q, rlf_vec3_make(0, 1, 0));
    m->z = rlf_rotate(pose->q, rlf_vec3_make(0, 0, 1));
    m->palm = place(&p, vector(palm_middle));
    for (int32_t k = 0; k < MODEL_PALM; k++) {
        m->a[k] = place(&p, vector(palm[k]));
        m->b[k] = place(&p, vector(palm[k] + 3));
        m->radius_a[k] = palm[k][6];
        m->radius_b[k] = palm[k][7];
    }
    put_thumb(m, &p);
    for (int32_t digit = 1; digit < 5; digit++) {
        put_finger(m, &p, digit);
    }
    put_forearm(m, &p);
}

int32_t hand_model_chain(int32_t cone, int32_t *first)
{
    const int32_t digit = (cone - MODEL_PALM) / 3, bone = (cone - MODEL_PALM) % 3;
    if (cone < MODEL_PALM) {
        *first = 0;
        return 0;
    }
    if (cone >= MODEL_HAND) {
        *first = TURN_WRIST;
        return 2;
    }
    *first = digit == 0 ? 0 : TURN_FINGER + 4 * (digit - 1);
    return digit == 0 ? 3 + bone : 2 + bone;
}

void hand_model_step(hand_model_pose *pose, const hand_model *m, const double *step)
{
    const rlf_vec3 turn = {step[3], step[4], step[5]}, way = {step[0], step[1], step[2]};
    const rlf_quat q = rlf_quat_from_rotation_vector(turn);
    const rlf_vec3 off = rlf_rotate(q, rlf_sub(pose->at, m->palm));
    pose->at = rlf_add(rlf_add(m->palm, off), way);
    pose->q = rlf_quat_normalize(rlf_quat_mul(q, pose->q));
    for (int32_t k = 0; k < MODEL_ANGLES; k++) {
        pose->angle[k] = rlf_clamp(pose->angle[k] + step[MODEL_THUMB + k], hand_model_low[k],
                                   hand_model_high[k]);
    }
}

double hand_model_stretch(const hand_model *m, int32_t digit)
{
    double length = 0.0;
    for (int32_t k = 0; k < 3; k++) {
        length += rlf_length(rlf_sub(m->joint[digit][k + 1], m->joint[digit][k]));
    }
    const rlf_vec3 way = rlf_sub(m->joint[digit][3], m->joint[digit][0]);
    return (digit == 0 ? rlf_length(way) : rlf_dot(way, m->y)) / length;
}
