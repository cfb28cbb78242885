/* The head of a person, as an ellipsoid.
 *
 * From the side a head is its own mirror image, and its front says where its back is. A face says
 * less: heads are widest behind their middle, and mirrored come out 2 cm too deep. But how long a
 * head is shows when it is seen from the side, differs little among people, and is kept. */
#include "surface/thickness/torso.h"

#include <math.h>

enum { BREADTH, LENGTH, MOST_POINTS = 150, LEAST_POINTS = 20 };

/* Metres, of both sexes' means in ANSUR II (Gordon et al. 2014, Natick/TR-15/007), with 5 mm of
 * hair: half a head's breadth and length, ... */
static const double usual_half[2] = {0.0805, 0.1025};
/* ... from its top to the brow, 2 cm above the eyes (sitting height less that of the eyes), and on
 * to the chin (menton to sellion): it is broadest and longest at the brow. */
static const double brow_down = 0.1, chin_down = 0.139;
/* Of both sexes together in that survey, and of hair. */
static const double spread[2] = {0.006, 0.0066};
static const double seen_m2 = 0.004 * 0.004;         /* of half a width that is seen for a second */
static const double face_from = 0.05, face_to = 0.2; /* below the top: between crown and chin */
static const double least_left = 0.3; /* of the square; nearer to its outline it tells little */

static void begin(rlf_skull *skull)
{
    for (int k = 0; k < 2; k++) {
        skull->measure[k] = usual_half[k];
        skull->doubt[k][k] = spread[k] * spread[k];
        skull->doubt[k][1 - k] = 0.0;
    }
}

/* Half the width that is seen of a head, turned from the camera by an angle of that squared sine.
 */
static double width_of(const rlf_skull *skull, double turned)
{
    const double *m = skull->measure;
    double b2 = m[BREADTH] * m[BREADTH], a2 = m[LENGTH] * m[LENGTH];
    return sqrt(b2 + turned * (a2 - b2));
}

/* An extended Kalman filter of the two measures. */
static void learn(rlf_skull *skull, double half_width, double turned, double variance)
{
    double expected = width_of(skull, turned);
    const double slope[2] = {(1.0 - turned) * skull->measure[BREADTH] / expected,
                             turned * skull->measure[LENGTH] / expected};
    double both[2], sum = variance;
    for (int k = 0; k < 2; k++) {
        both[k] = skull->doubt[k][0] * slope[0] + skull->doubt[k][1] * slope[1];
        sum += slope[k] * both[k];
    }
    for (int r = 0; r < 2; r++) {
        skull->measure[r] += both[r] / sum * (half_width - expected);
        for (int c = 0; c < 2; c++) {
            skull->doubt[r][c] -= both[r] * both[c] / sum;
        }
    }
}

/* Share of the half depth that is left beside and above the middle, squared; <= 0 outside. */
static double left_of(const rlf_skull *skull, double aside, double down)
{
    double u = aside / skull->half_width, v = down / (down < 0.0 ? brow_down : chin_down);
    return 1.0 - u * u - v * v;
}

/* Where its middle is by its front. */
static void find_middle(const rlf_chord_job *job, const rlf_torso *torso, rlf_skull *skull)
{
    rlf_vec3 seen[MOST_POINTS];
    rlf_torso_points points = {.p = seen};
    const rlf_torso_window window = {usual_half[LENGTH], face_from, face_to, MOST_POINTS, 0};
    double sum = 0.0, weight = 0.0;
    rlf_torso_find_points(job, torso, &window, &points);
    for (int32_t i = 0; i < points.count; i++) {
        rlf_vec3 p = seen[i];
        double left = left_of(skull, p.x * skull->way_z - p.z * skull->way_x, p.y - skull->down);
        if (left > least_left) {
            double front = p.x * skull->way_x + p.z * skull->way_z;
            sum += left * (front + skull->half_depth * sqrt(left));
            weight += left;
        }
    }
    skull->is_seen = points.count >= LEAST_POINTS && weight > 0.0;
    skull->far = skull->is_seen ? sum / weight : 0.0;
}

void rlf_skull_follow(const rlf_chord_job *job, rlf_torso *torso, double brow, double dt)
{
    rlf_skull *skull = &torso->skull;
    const rlf_vec3 head = torso->head;
    double far = sqrt(head.x * head.x + head.z * head.z);
    skull->way_x = head.x / far;
    skull->way_z = head.z / far;
    double along = torso->side_x * skull->way_x + torso->side_z * skull->way_z;
    double turned = along * along;
    if (!(skull->measure[BREADTH] > 0.0)) {
        begin(skull);
    }
    if (dt > 0.0 && brow > 0.0) {
        double width = brow * head.z * skull->way_z; /* square to the way */
        learn(skull, 0.5 * width, turned, seen_m2 / dt);
    }
    skull->face = 1.0 - turned;
    skull->half_width = width_of(skull, turned);
    skull->half_depth = skull->measure[BREADTH] * skull->measure[LENGTH] / skull->half_width;
    skull->down = head.y + brow_down;
    find_middle(job, torso, skull);
}

rlf_torso_cut rlf_skull_cut_ray(const rlf_skull *skull, double x, double y)
{
    double height = y * skull->far < skull->down ? brow_down : chin_down; /* nearly so */
    double aside = (x * skull->way_z - skull->way_x) / skull->half_width;
    double along = (x * skull->way_x + skull->way_z) / skull->half_depth, down = y / height;
    double middle_far = skull->far / skull->half_depth, middle_down = skull->down / height;
    double a = aside * aside + along * along + down * down;
    double b = along * middle_far + down * middle_down;
    double q = b * b - a * (middle_far * middle_far + middle_down * middle_down - 1.0);
    double root = q > 0.0 ? sqrt(q) : -1.0;
    return (rlf_torso_cut){(b - root) / a, (b + root) / a};
}
