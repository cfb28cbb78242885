/* How fingers meet a body: they close until they touch it. */
#include "sim/hands/hands.h"

#define STEPS 48 /* of a finger's way, before the bisection */
#define HALVINGS 16
#define SAMPLES 5 /* spheres along a bone */

/* A round cone, or the palm's ellipsoid as three spheres, against the body. */
static double solid_distance(const synth_shape *solid, const synth_shape *body)
{
    double least = 1e9;
    for (int k = 0; k < SAMPLES; k++) {
        const double share = k / (SAMPLES - 1.0);
        rlf_vec3 at = {0, share * solid->length, 0}, normal;
        double radius = solid->radius_a + (solid->radius_b - solid->radius_a) * share;
        if (solid->type == SYNTH_ELLIPSOID) {
            at = rlf_vec3_make(0, (share - 0.5) * solid->size.y, 0);
            radius = solid->size.z;
        }
        rlf_vec3 p = rlf_transform(&solid->T_camera_shape, at);
        least = rlf_min(least, synth_shape_distance(body, p, &normal) - radius);
    }
    return least;
}

double synth_hand_distance(const synth_hand_shape *hand, int32_t first, int32_t count,
                           const synth_shape *body)
{
    double least = 1e9;
    for (int32_t i = first; i < first + count; i++) {
        least = rlf_min(least, solid_distance(&hand->solids[i], body));
    }
    return least;
}

/* A way of one finger: share of it to its distance from the body. */
typedef struct finger_way {
    const synth_hand_form *form;
    const synth_grip *a, *b;
    const synth_shape *body;
    int finger;
} finger_way;

static double distance_at(const finger_way *way, double share)
{
    synth_hand_shape hand;
    synth_grip grip = synth_grip_mix(way->a, way->b, share);
    synth_hand_form_shape(way->form, &grip, &hand);
    /* the metacarpal of the thumb is in the palm's flesh: it does not close on anything */
    int32_t skip = way->finger == 0 ? 1 : 0;
    return synth_hand_distance(&hand, SYNTH_HAND_PALM + 3 * way->finger + skip, 3 - skip,
                               way->body);
}

static double close_finger(const finger_way *way, double gap, double most)
{
    double low = 0.0;
    if (distance_at(way, 0.0) <= gap) {
        return 0.0;
    }
    for (int k = 1; k <= STEPS; k++) {
        double high = (double)k / STEPS;
        if (distance_at(way, high) <= gap) {
            for (int i = 0; i < HALVINGS; i++) {
                double middle = 0.5 * (low + high);
                bool is_near = distance_at(way, middle) <= gap;
                low = is_near ? low : middle;
                high = is_near ? middle : high;
            }
            return high;
        }
        low = high;
    }
    return most;
}

void synth_hand_close(const synth_hand_form *form, const synth_grip *a, const synth_grip *b,
                      const synth_shape *body, double gap, double most, double share[SYNTH_FINGERS])
{
    for (int f = 0; f < SYNTH_FINGERS; f++) {
        const finger_way way = {form, a, b, body, f};
        share[f] = close_finger(&way, gap, most);
    }
}

/* Gap of the pads at a share of the way, with their middle and axis. */
static double span_at(const synth_hand_form *form, double share, rlf_vec3 *out_middle,
                      rlf_vec3 *out_axis)
{
    const synth_grip wide = synth_grip_named(SYNTH_GRIP_WIDE);
    const synth_grip closed = synth_grip_named(SYNTH_GRIP_CLOSED);
    synth_grip grip = synth_grip_mix(&wide, &closed, share);
    synth_hand_shape hand;
    synth_hand_form_shape(form, &grip, &hand);
    rlf_vec3 thumb = hand.joints[0][3];
    rlf_vec3 fingers = rlf_scale(rlf_add(hand.joints[1][3], hand.joints[2][3]), 0.5);
    rlf_vec3 way = rlf_sub(fingers, thumb);
    double length = rlf_length(way);
    *out_axis = rlf_normalize(way);
    double near = hand.tip_radius[0], far = length - hand.tip_radius[1];
    *out_middle = rlf_mad(thumb, *out_axis, 0.5 * (near + far));
    return far - near;
}

double synth_hand_span(const synth_hand_form *form, double width, rlf_vec3 *out_middle,
                       rlf_vec3 *out_axis)
{
    double low = 0.0, high = 1.0;
    for (int k = 0; k < 24; k++) {
        double middle = 0.5 * (low + high);
        bool is_wide = span_at(form, middle, out_middle, out_axis) > width;
        low = is_wide ? middle : low;
        high = is_wide ? high : middle;
    }
    (void)span_at(form, high, out_middle, out_axis);
    return high;
}
