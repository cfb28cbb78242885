/* Plates from frame to frame. */
#include "surface/plate/plate.h"

#include "surface/past/past.h"

/* Off constant velocity, per 1/30 s: an edge shows little of a turn, and is taken to turn steadily.
 */
static const double place_m = 0.02, turn_rad = 0.01, turn_seen_rad = 0.08;
static const double extent_m = 0.0003; /* lets extents be learnt for ever */
static const double frame_s = 1.0 / 30.0;
static const double follow_share = 0.8; /* of a change of velocity */
static const double spin_left = 0.9;    /* of a frame's, in the next */
static const double longest_lost_s = 0.6, longest_passed_s = 0.1;
static const double behind_m = 0.04;
static const double least_half_m = 0.038, most_half_m = 0.6, thickest_half_m = 0.04;
static const double young_s = 0.25; /* it is a plate if it is not lost before */
enum { LEAST_FACES = 4, LEAST_SHARE = 4, MOST_PIXELS = 2048 };

static void predict(rlf_plate *plate, double dt)
{
    double frames = dt / frame_s;
    rlf_vec3 normal = rlf_rotate(plate->pose.q, rlf_vec3_make(0, 0, 1));
    double facing = rlf_dot(normal, rlf_normalize(plate->pose.p));
    double turn_sigma = turn_rad + turn_seen_rad * facing * facing;
    plate->pose.p = rlf_mad(plate->pose.p, plate->speed, dt);
    rlf_quat turn = rlf_quat_from_rotation_vector(rlf_scale(plate->spin, dt));
    plate->pose.q = rlf_quat_normalize(rlf_quat_mul(turn, plate->pose.q));
    for (int k = 0; k < 3; k++) {
        plate->doubt[k][k] += frames * place_m * place_m;
        plate->doubt[3 + k][3 + k] += frames * turn_sigma * turn_sigma;
        plate->doubt[6 + k][6 + k] += frames * extent_m * extent_m;
    }
}

/* Rotation vector of a small turn. */
static rlf_vec3 turn_between(rlf_quat from, rlf_quat to)
{
    rlf_quat q = rlf_quat_mul(to, rlf_quat_conjugate(from));
    double sign = q.w < 0.0 ? -2.0 : 2.0;
    return rlf_scale(rlf_vec3_make(q.x, q.y, q.z), sign);
}

/* Speed follows the frames as far as these say more than was expected: along the view a lost edge
 * says nothing. */
static void follow_motion(const rlf_pose *before, const double expected[3], double dt,
                          rlf_plate *plate)
{
    const rlf_vec3 moved = rlf_scale(rlf_sub(plate->pose.p, before->p), 1.0 / dt);
    const rlf_vec3 turned = rlf_scale(turn_between(before->q, plate->pose.q), 1.0 / dt);
    double share[3];
    for (int k = 0; k < 3; k++) {
        share[k] = follow_share * rlf_max(1.0 - plate->doubt[k][k] / expected[k], 0.0);
    }
    plate->speed.x += share[0] * (moved.x - plate->speed.x);
    plate->speed.y += share[1] * (moved.y - plate->speed.y);
    plate->speed.z += share[2] * (moved.z - plate->speed.z);
    plate->spin = rlf_mad(plate->spin, rlf_sub(turned, plate->spin), follow_share);
}

/* Whether the camera sees through most of it. */
static bool is_passed(const rlf_reconstruct *stage, const float *depth, const rlf_plate *plate)
{
    const rlf_grid *grid = &stage->grid;
    const rlf_plate_view view = rlf_plate_look(plate);
    rlf_plate_window w = rlf_plate_window_of(grid, &view, 0);
    int32_t seen = 0, beyond = 0, stride = rlf_plate_stride(&w, MOST_PIXELS);
    for (int32_t y = w.y0; y < w.y1; y += stride) {
        for (int32_t x = w.x0; x < w.x1; x += stride) {
            ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
            rlf_plate_cut cut;
            if (depth[i] > 0.0f && rlf_plate_cut_ray(&view, grid->ray_x[i], grid->ray_y[i], &cut)) {
                seen++;
                beyond += depth[i] > cut.leave + behind_m;
            }
        }
    }
    return w.x1 <= w.x0 || 2 * beyond > seen + 4;
}

static bool is_plate(const rlf_plate *plate)
{
    return rlf_vec3_is_finite(plate->pose.p) && plate->half[2] < thickest_half_m &&
           plate->half[0] > least_half_m && plate->half[0] < most_half_m &&
           plate->half[1] > least_half_m && plate->half[1] < most_half_m &&
           plate->lost_s < (plate->age_s < young_s ? 1e-6 : longest_lost_s) &&
           plate->passed_s < longest_passed_s;
}

/* False when it is to be forgotten. */
static bool follow(const rlf_reconstruct *stage, const float *depth, double dt, rlf_plate *plate)
{
    const rlf_pose before = plate->pose;
    double expected[3];
    predict(plate, dt);
    for (int k = 0; k < 3; k++) {
        expected[k] = plate->doubt[k][k];
    }
    rlf_plate_fit fit = rlf_plate_improve(stage, depth, plate);
    bool is_lost = fit.faces < LEAST_FACES || LEAST_SHARE * fit.outline < fit.places;
    plate->age_s += dt;
    plate->lost_s = is_lost ? plate->lost_s + dt : 0.0;
    plate->passed_s = is_passed(stage, depth, plate) ? plate->passed_s + dt : 0.0;
    if (!is_lost) {
        follow_motion(&before, expected, dt, plate);
        plate->spin = rlf_scale(plate->spin, spin_left);
    }
    return is_plate(plate);
}

void rlf_plates_follow(rlf_reconstruct *stage, const rlf_slot *slot, const float *depth)
{
    rlf_plates *plates = &stage->plates;
    double dt = rlf_past_elapsed(stage, slot);
    int32_t kept = 0;
    for (int32_t i = 0; i < plates->count && dt > 0.0; i++) {
        rlf_plate plate = plates->item[i];
        if (follow(stage, depth, dt, &plate)) {
            plates->item[kept++] = plate;
        }
    }
    plates->count = kept;
}
