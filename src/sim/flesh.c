/* The rounded solids on the bones: sizes of an adult of 1.75 m, clothes and skin. */
#include "sim/bones.h"

#define ELLIPSOID(name, bone, material, x, y, z, a, b, c)                                          \
    {                                                                                              \
        name, bone, material, SYNTH_ELLIPSOID, {x, y, z}, 'y', {a, b, c}, 0.0, 0.0, 0.0            \
    }
#define CONE(name, bone, material, x, y, z, length, radius_a, radius_b)                            \
    {                                                                                              \
        name, bone, material, SYNTH_CONE, {x, y, z}, 'y', {0, 0, 0}, length, radius_a, radius_b    \
    }
#define CROSS(name, bone, material, x, y, z, length, radius_a, radius_b)                           \
    {                                                                                              \
        name, bone, material, SYNTH_CONE, {x, y, z}, 'x', {0, 0, 0}, length, radius_a, radius_b    \
    }
#define FORWARD(name, bone, material, x, y, z, length, radius_a, radius_b)                         \
    {                                                                                              \
        name, bone, material, SYNTH_CONE, {x, y, z}, 'z', {0, 0, 0}, length, radius_a, radius_b    \
    }

/* In a bone frame y points down the limb; the trunk's frames are upright with y down. */
const synth_flesh synth_person_flesh[SYNTH_PERSON_FLESH] = {
    ELLIPSOID("pelvis", SYNTH_PELVIS, SYNTH_TROUSERS, 0, -0.02, -0.005, 0.162, 0.125, 0.118),
    ELLIPSOID("belly", SYNTH_CHEST, SYNTH_SHIRT, 0, -0.17, 0.0, 0.150, 0.185, 0.112),
    ELLIPSOID("chest", SYNTH_CHEST, SYNTH_SHIRT, 0, -0.36, 0.0, 0.172, 0.205, 0.122),
    CROSS("shoulders", SYNTH_CHEST, SYNTH_SHIRT, -0.155, -0.495, -0.005, 0.31, 0.062, 0.062),
    CONE("neck", SYNTH_HEAD, SYNTH_SKIN, 0, -0.09, 0.015, 0.10, 0.050, 0.056),
    ELLIPSOID("head", SYNTH_HEAD, SYNTH_FACE, 0, -0.135, 0.025, 0.076, 0.112, 0.094),
    ELLIPSOID("hair", SYNTH_HEAD, SYNTH_HAIR, 0, -0.172, 0.004, 0.083, 0.088, 0.094),
    ELLIPSOID("nose", SYNTH_HEAD, SYNTH_SKIN, 0, -0.118, 0.118, 0.013, 0.022, 0.015),
    CONE("thigh l", SYNTH_THIGH, SYNTH_TROUSERS, 0, 0, 0, 0.43, 0.086, 0.060),
    CONE("thigh r", SYNTH_THIGH + 1, SYNTH_TROUSERS, 0, 0, 0, 0.43, 0.086, 0.060),
    CONE("shin l", SYNTH_SHIN, SYNTH_TROUSERS, 0, 0, 0, 0.39, 0.060, 0.047),
    CONE("shin r", SYNTH_SHIN + 1, SYNTH_TROUSERS, 0, 0, 0, 0.39, 0.060, 0.047),
    FORWARD("foot l", SYNTH_FOOT, SYNTH_SHOE, 0, 0.047, -0.03, 0.19, 0.038, 0.038),
    FORWARD("foot r", SYNTH_FOOT + 1, SYNTH_SHOE, 0, 0.047, -0.03, 0.19, 0.038, 0.038),
    CONE("upper arm l", SYNTH_UPPER_ARM, SYNTH_SHIRT, 0, 0, 0, 0.29, 0.057, 0.045),
    CONE("upper arm r", SYNTH_UPPER_ARM + 1, SYNTH_SHIRT, 0, 0, 0, 0.29, 0.057, 0.045),
    CONE("forearm l", SYNTH_FOREARM, SYNTH_SKIN, 0, 0, 0, 0.25, 0.043, 0.029),
    CONE("forearm r", SYNTH_FOREARM + 1, SYNTH_SKIN, 0, 0, 0, 0.25, 0.043, 0.029),
    ELLIPSOID("palm l", SYNTH_PALM, SYNTH_SKIN, 0, 0.05, 0, 0.040, 0.055, 0.021),
    ELLIPSOID("palm r", SYNTH_PALM + 1, SYNTH_SKIN, 0, 0.05, 0, 0.040, 0.055, 0.021),
    ELLIPSOID("fingers l", SYNTH_PALM, SYNTH_SKIN, 0, 0.120, -0.010, 0.034, 0.055, 0.016),
    ELLIPSOID("fingers r", SYNTH_PALM + 1, SYNTH_SKIN, 0, 0.120, -0.010, 0.034, 0.055, 0.016),
    CONE("thumb l", SYNTH_PALM, SYNTH_SKIN, 0.036, 0.035, -0.016, 0.055, 0.015, 0.011),
    CONE("thumb r", SYNTH_PALM + 1, SYNTH_SKIN, -0.036, 0.035, -0.016, 0.055, 0.015, 0.011),
};

/* A book of 17 x 24 x 2.5 cm that stands on the grip: its frame's y points down. */
const synth_flesh synth_book_flesh = {
    "book", SYNTH_BOOK_BONE,       SYNTH_BOOK, SYNTH_BOX, {0, -0.10, 0},
    'y',    {0.085, 0.12, 0.0125}, 0.0,        0.0,       0.0};

#define FINGER(index, name, length, radius)                                                        \
    CONE(name, SYNTH_FINGER + (index), SYNTH_SKIN, 0, 0, 0, length, radius, (radius)*0.92)
#define TIP(index, name, length, radius)                                                           \
    CONE(name, SYNTH_FINGER_TIP + (index), SYNTH_SKIN, 0, 0, 0, length, (radius)*0.92, (radius)*0.8)

const synth_flesh synth_hand_flesh[] = {
    CONE("upper arm", SYNTH_UPPER_ARM, SYNTH_SHIRT, 0, 0, 0, 0.6, 0.075, 0.050),
    CONE("forearm", SYNTH_FOREARM, SYNTH_SKIN, 0, 0, 0, 0.25, 0.046, 0.030),
    ELLIPSOID("palm", SYNTH_PALM, SYNTH_SKIN, 0, 0.055, 0, 0.043, 0.060, 0.020),
    FINGER(0, "index", 0.045, 0.0105),
    FINGER(1, "middle", 0.050, 0.0108),
    FINGER(2, "ring", 0.046, 0.0102),
    FINGER(3, "little", 0.036, 0.0092),
    TIP(0, "index tip", 0.040, 0.0105),
    TIP(1, "middle tip", 0.044, 0.0108),
    TIP(2, "ring tip", 0.041, 0.0102),
    TIP(3, "little tip", 0.032, 0.0092),
    CONE("thumb", SYNTH_THUMB, SYNTH_SKIN, 0, 0, 0, 0.075, 0.0160, 0.0110),
};
const int32_t synth_hand_flesh_count =
    (int32_t)(sizeof(synth_hand_flesh) / sizeof(synth_hand_flesh[0]));
