/* How fingers are bent: named grips. */
#include "sim/hands/hands.h"

#define DEGREE (RLF_PI / 180.0)
#define NEAR_SKIN 0.001 /* metres by which the ring's tips press */

/* Degrees; the thumb is that of a left hand. */
typedef struct grip_row {
    rlf_vec3 thumb[3];
    double bend[4][2];
    double spread;
} grip_row;

static const grip_row rows[SYNTH_GRIP_COUNT] = {
    [SYNTH_GRIP_OPEN] = {{{0.72, 0.66, -0.20}, {0.62, 0.78, -0.12}, {0.52, 0.85, -0.08}},
                         {{4, 8}, {3, 8}, {4, 8}, {5, 9}},
                         7.5},
    [SYNTH_GRIP_FLAT] = {{{0.50, 0.84, -0.20}, {0.24, 0.96, -0.12}, {0.12, 0.99, -0.06}},
                         {{3, 5}, {2, 5}, {3, 5}, {5, 6}},
                         0.5},
    [SYNTH_GRIP_RELAXED] = {{{0.55, 0.75, -0.37}, {0.32, 0.90, -0.30}, {0.16, 0.95, -0.25}},
                            {{22, 28}, {26, 30}, {30, 32}, {32, 34}},
                            2.0},
    [SYNTH_GRIP_FIST] = {{{0.45, 0.66, -0.60}, {-0.15, 0.76, -0.63}, {-0.88, 0.42, -0.20}},
                         {{78, 98}, {80, 100}, {82, 100}, {84, 98}},
                         0.0},
    [SYNTH_GRIP_POINT] = {{{0.45, 0.66, -0.60}, {-0.15, 0.76, -0.63}, {-0.88, 0.42, -0.20}},
                          {{3, 5}, {80, 100}, {82, 100}, {84, 98}},
                          0.0},
    [SYNTH_GRIP_CUP] = {{{0.60, 0.62, -0.50}, {0.40, 0.74, -0.54}, {0.20, 0.80, -0.56}},
                        {{30, 32}, {28, 34}, {30, 34}, {36, 34}},
                        0.0},
    [SYNTH_GRIP_WIDE] = {{{0.42, 0.30, -0.86}, {0.25, 0.36, -0.90}, {0.10, 0.46, -0.88}},
                         {{-6, 8}, {-6, 8}, {-4, 9}, {0, 10}},
                         3.0},
    [SYNTH_GRIP_CLOSED] = {{{0.30, 0.62, -0.72}, {0.06, 0.96, -0.28}, {-0.06, 0.99, 0.08}},
                           {{66, 44}, {66, 44}, {68, 46}, {70, 46}},
                           0.0},
    [SYNTH_GRIP_ROUND] = {{{0.30, 0.62, -0.72}, {-0.35, 0.70, -0.62}, {-0.80, 0.50, 0.33}},
                          {{86, 100}, {86, 102}, {88, 102}, {90, 100}},
                          0.0},
};

synth_grip synth_grip_named(synth_grip_name name)
{
    const grip_row *row = &rows[name];
    synth_grip grip = {.spread = row->spread * DEGREE};
    for (int k = 0; k < 3; k++) {
        grip.thumb[k] = rlf_normalize(row->thumb[k]);
    }
    for (int i = 0; i < 8; i++) {
        grip.bend[i / 2][i % 2] = row->bend[i / 2][i % 2] * DEGREE;
    }
    return grip;
}

synth_grip synth_grip_mix_each(const synth_grip *a, const synth_grip *b,
                               const double share[SYNTH_FINGERS])
{
    synth_grip grip;
    double mean = 0.25 * (share[1] + share[2] + share[3] + share[4]);
    grip.spread = a->spread + (b->spread - a->spread) * mean;
    for (int k = 0; k < 3; k++) {
        rlf_vec3 way = rlf_sub(b->thumb[k], a->thumb[k]);
        grip.thumb[k] = rlf_normalize(rlf_mad(a->thumb[k], way, share[0]));
    }
    for (int i = 0; i < 8; i++) {
        double from = a->bend[i / 2][i % 2], to = b->bend[i / 2][i % 2];
        grip.bend[i / 2][i % 2] = from + (to - from) * share[1 + i / 2];
    }
    return grip;
}

synth_grip synth_grip_mix(const synth_grip *a, const synth_grip *b, double share)
{
    const double all[SYNTH_FINGERS] = {share, share, share, share, share};
    return synth_grip_mix_each(a, b, all);
}

synth_grip synth_grip_ring(const synth_hand_form *form)
{
    const synth_grip wide = synth_grip_named(SYNTH_GRIP_WIDE);
    const synth_grip closed = synth_grip_named(SYNTH_GRIP_CLOSED);
    double low = 0.0, high = 1.0;
    synth_grip grip = closed;
    for (int k = 0; k < 24; k++) {
        const double middle = 0.5 * (low + high);
        const double share[SYNTH_FINGERS] = {middle, middle, 0.25, 0.22, 0.2};
        synth_hand_shape hand;
        grip = synth_grip_mix_each(&wide, &closed, share);
        synth_hand_form_shape(form, &grip, &hand);
        double gap = rlf_length(rlf_sub(hand.joints[1][3], hand.joints[0][3])) -
                     hand.tip_radius[0] - hand.tip_radius[1];
        low = gap > -NEAR_SKIN ? middle : low;
        high = gap > -NEAR_SKIN ? high : middle;
    }
    return grip;
}
