/* The one table of goals and bounds. A bound without a goal beside it is the goal itself; where the
 * goal is not reached yet, the bound is what was measured when it was set and a little more, so
 * that nothing gets worse unseen. */
#include "eval/bounds.h"

#include <math.h>
#include <string.h>

const eval_bound eval_bounds[] = {
    {"room", "depth_still_rmse_mm", '<', 1.5, 1.5, "none: raw depth", "bilateral filter 2.65"},
    {"room", "depth_still_flying_percent", '<', 0.002, 0.002, "none: raw depth",
     "bilateral filter 0.70"},
    {"room", "depth_moving_rmse_mm", '<', 2.7, 2.7, "none: raw depth", "bilateral filter 2.65"},
    {"room", "depth_moving_flying_percent", '<', 0.002, 0.002, "", ""},
    {"room", "normals_interior_mean_deg", '<', 1.4, 1.4, "23.2", ""},
    {"room", "normals_interior_over_30_percent", '<', 0.4, 0.4, "14.2",
     "FALS 15.3, SRI 8.5, PCL 5.7, bilateral + SRI 0.39"},
    {"room", "normals_interior_missing_percent", '<', NAN, 1.8, "8.7", ""},
    {"room", "normals_band_mean_deg", '<', 5.5, 5.5, "67.8", ""},
    {"room", "normals_band_over_30_percent", '<', 1.5, 1.65, "75",
     "FALS 48, PCL 27, bilateral + SRI 19 (of 37 % covered)"},
    {"room", "normals_band_seen_mean_deg", '<', NAN, 2.8, "", ""},
    {"room", "normals_band_seen_over_30_percent", '<', NAN, 1.0, "", ""},
    {"room", "centre_bad_percent", '<', 0.5, 0.5, "24.6 counted, 8.67 estimated", ""},
    {"room", "foreground_f", '>', 0.985, 0.985, "0.9545", ""},
    {"room", "foreground_f_valid", '>', 0.993, 0.993, "0.9545", ""},
    {"room", "exit_mean_cm", '<', 2.2, 2.2, "none: 15.5", "constant 20 cm: 9"},
    {"room", "exit_within_5_cm_percent", '>', 90, 90, "", ""},
    {"room", "standing_exit_mean_cm", '<', NAN, 5, "", "a guess of 15 cm: 16"},
    {"room", "standing_within_5_cm_percent", '>', NAN, 62, "", ""},
    {"room", "speed_median_percent", '<', NAN, 12, "none", "nobody measures it"},
    {"room", "velocity_swift_mean_percent", '<', NAN, 29, "none", "nobody measures it"},
    {"room", "still_zero_percent", '>', NAN, 99.85, "", ""},
    {"room", "behind_missing_percent", '<', NAN, 0.1, "", ""},
    {"room", "behind_off_percent", '<', NAN, 0.1, "none", ""},
    {"room", "behind_rmse_mm", '<', NAN, 0.8, "", ""},
    {"room", "behind_normals_mean_deg", '<', NAN, 0.3, "", ""},
    {"room", "bounces_off_mm", '<', NAN, 2.5, "", ""},
    {"room", "bounces_phantom_percent", '<', NAN, 3, "", ""},
    {"room", "bounces_right_percent", '>', 99.5, 92, "9 of 10 at best", ""},
    {"room", "bounces_within_10_percent", '>', NAN, 88, "", ""},
    {"room", "bounces_over_30_percent", '<', NAN, 9, "", ""},
    {"room", "bounces_unexplained_percent", '<', NAN, 5, "", ""},
    {"room", "entries", '<', 0, 1, "", ""},
    {"empty", "depth_still_rmse_mm", '<', 1.5, 1.5, "", "bilateral filter 2.65"},
    {"empty", "depth_still_flying_percent", '<', 0.002, 0.002, "", ""},
    {"empty", "normals_interior_mean_deg", '<', 1.4, 1.4, "", ""},
    {"empty", "normals_interior_over_30_percent", '<', 0.4, 0.4, "", ""},
    {"empty", "normals_band_over_30_percent", '<', 1.5, 1.5, "", ""},
    {"empty", "foreground_false_percent", '<', NAN, 0.01, "", ""},
    {"empty", "still_zero_percent", '>', NAN, 99.99, "", ""},
    {"thesis", "depth_still_rmse_mm", '<', 1.5, 1.5, "", ""},
    {"thesis", "normals_interior_mean_deg", '<', 1.4, 1.4, "23.2", ""},
    {"thesis", "normals_interior_over_30_percent", '<', 0.4, 0.4, "14.2", ""},
    {"thesis", "normals_band_mean_deg", '<', 5.5, 5.5, "67.8", ""},
    {"thesis", "normals_band_over_30_percent", '<', 1.5, 1.9, "75", ""},
    {"thesis", "centre_bad_percent", '<', 0.5, 0.5, "24.6 counted, 8.67 estimated", ""},
    {"thesis", "foreground_f", '>', 0.985, 0.985, "0.9545", ""},
    {"thesis", "foreground_f_valid", '>', 0.993, 0.993, "0.9545", ""},
    {"thesis", "exit_mean_cm", '<', 2.2, 2.2, "none: 15.5", "constant 20 cm: 9"},
    {"thesis", "exit_within_5_cm_percent", '>', 90, 90, "", ""},
    {"thesis", "entries", '<', 0, 1, "", ""},
    {"chair", "foreground_f", '>', 0.985, 0.985, "", ""},
    {"chair", "background_phantoms_soon_percent", '<', 2, 2, "100 for ever", ""},
    {"chair", "background_phantoms_late_percent", '<', 0.5, 0.5, "100 for ever", ""},
    {"chair", "entries", '<', 0, 1, "", ""},
    {"book", "foreground_f", '>', 0.985, 0.985, "", ""},
    {"book", "exit_mean_cm", '<', 2.2, 2.2, "", ""},
    {"book", "book_exit_mean_cm", '<', 1.5, 1.5, "", ""},
    {"book", "entries", '<', 0, 1, "", ""},
    {"hand", "foreground_f", '>', 0.985, 0.985, "", ""},
    {"hand", "exit_mean_cm", '<', 1.5, 1.5, "", ""},
    {"hand", "exit_within_5_cm_percent", '>', 95, 95, "", ""},
    {"hand", "speed_median_percent", '<', NAN, 1.7, "", ""},
    {"hand", "velocity_median_percent", '<', NAN, 6.5, "", ""},
    {"hand", "entries", '<', 0, 1, "", ""},
    {"steps", "depth_still_rmse_mm", '<', NAN, 4.4, "", "raw frame 15"},
    {"steps", "normals_interior_mean_deg", '<', NAN, 2, "", ""},
    {"steps", "normals_interior_over_30_percent", '<', NAN, 1.1, "", ""},
    {"steps", "normals_band_over_30_percent", '<', NAN, 13, "", ""},
    {"steps", "behind_normals_mean_deg", '<', NAN, 2.8, "", ""},
    {"steps", "foreground_f", '>', NAN, 0.972, "", ""},
    {"steps", "still_zero_percent", '>', NAN, 99.9, "", ""},
    {"people", "depth_moving_rmse_mm", '<', 2.7, 2.75, "", ""},
    {"people", "depth_moving_flying_percent", '<', 0.002, 0.002, "", ""},
    {"people", "normals_interior_mean_deg", '<', 1.4, 1.4, "", ""},
    {"people", "normals_interior_over_30_percent", '<', 0.4, 0.4, "", ""},
    {"people", "normals_band_over_30_percent", '<', 1.5, 1.65, "", ""},
    {"people", "foreground_f", '>', 0.985, 0.985, "", ""},
    {"people", "exit_mean_cm", '<', 2.2, 2.5, "", ""},
    {"people", "exit_within_5_cm_percent", '>', 90, 88, "", ""},
    {"people", "speed_median_percent", '<', NAN, 12, "", ""},
    {"people", "velocity_swift_mean_percent", '<', NAN, 34, "", ""},
    {"people", "bounces_right_percent", '>', 99.5, 91, "", ""},
    {"people", "bounces_within_10_percent", '>', NAN, 85, "", ""},
    {"people", "entries", '<', 0, 1, "", ""},
    {"picture", "person_mean_px", '<', 1.0, 1.0, "", "hard test at depth resolution 3 to 9"},
    {"picture", "person_p95_px", '<', 3.0, 3.0, "", ""},
    {"picture", "things_mean_px", '<', 1.0, 1.0, "", "hard test at depth resolution 3 to 9"},
    {"picture", "things_p95_px", '<', 3.0, 3.0, "", ""},
    {"picture", "hidden_iou", '>', 0.985, 0.985, "", ""},
    {"picture", "alpha_error", '<', 0.05, 0.05, "", ""},
    {"picture", "still_flicker", '<', 0.005, 0.005, "", ""},
    {"picture", "order_percent", '<', 0.1, 0.1, "", ""},
    {"picture", "real_shade_right_percent", '>', 97, 97, "none", ""},
    {"picture", "real_shade_iou", '>', NAN, 0.74, "none", ""},
    {"picture", "light_off_deg", '<', 15, 15, "none", ""},
    {"simulator", "table_a_off_percent", '<', 5, 5, "165.5 missing of 3392", ""},
    {"simulator", "table_b_off_percent", '<', 5, 5, "15.5 of 2632", ""},
    {"simulator", "table_c_off_percent", '<', 15, 15, "188.6 of 3392", ""},
    {"simulator", "table_d_off_percent", '<', 5, 5, "57.1 of 2632", ""},
    {"planes", "normals_mean_deg", '<', 0.001, 0.001, "12.9", ""},
    {"planes", "normals_over_30_percent", '<', 0, 0, "6.0", ""},
    {"planes", "normals_missing_percent", '<', NAN, 0.001, "", ""},
    {"planes", "holes_lost_percent", '<', 0, 0, "3.8",
     "PCL 20.6 to 47.5, OpenCV SRI 38.2, Open3D 1.9"},
    {"planes", "holes_spoilt_percent", '<', 0, 0, "0", "OpenCV FALS 7.4 to 36.6"},
    {"planes", "holes_invented_percent", '<', 0, 0, "98.6", "bilateral filter 87 of NaN holes"},
    {"plate", "plate_speed_error_percent", '<', 5, 5, "none", "nobody measures it"},
    {"plate", "wall_moving_percent", '<', 0, 0, "", ""},
    {"physics", "free_fall_mm", '<', 0.01, 0.01, "", "Box3D 20.4"},
    {"physics", "tumble_energy_drift", '<', 1e-6, 1e-6, "", "Box3D 0.8"},
    {"physics", "chain_error_percent", '<', 0.5, 0.5, "", "Box3D 49.5"},
    {"physics", "stack_drift_mm", '<', 0.5, 0.5, "", "Box3D 0.87"},
    {"physics", "stack_penetration_mm", '<', 1, 1, "", "Box3D 5.0"},
    {"physics", "slope_error_deg", '<', 0.05, 0.05, "", "Box3D 0.05"},
    {"physics", "creep_mm", '<', 0.1, 0.1, "", ""},
    {"physics", "lift_count", '>', 12, 12, "none: no velocity", "mesh rebuilt in Bullet: 3"},
    {"physics", "swipe_count", '>', 36, 36, "none: no velocity", "mesh rebuilt in Bullet: 0 to 6"},
    {"physics", "throw_tunnelled", '<', 0, 0, "", ""},
    {"physics", "behind_bounced_percent", '>', 99, 99, "0", ""},
    {"physics", "edge_bounced_percent", '>', 99, 99, "0", ""},
    {"known", "picked_mm", '<', NAN, 18, "", ""},
    {"known", "refined_mm", '<', 2, 2, "", ""},
    {"known", "refined_deg", '<', 0.5, 0.5, "", ""},
    {"known", "refused_count", '<', NAN, 5, "", ""},
    {"known", "edge_px", '<', 1.0, 1.0, "", "no model: 0.44"},
    {"known", "iou", '>', 0.985, 0.985, "", "no model: 0.988"},
    {"known", "order_percent", '<', 0.1, 0.1, "", "no model: 0.15"},
    {"known", "lost_edge_px", '<', 1.0, 1.0, "", "no model: 12.3"},
    {"known", "lost_iou", '>', 0.985, 0.985, "", "no model: 0.05"},
    {"known", "lost_order_percent", '<', 0.1, 0.1, "", "no model: 60.6"},
    {"known", "chair_edge_px", '<', 1.0, 1.0, "", "no model: 0.74"},
    {"known", "chair_iou", '>', 0.985, 0.985, "", "no model: 0.932"},
    {"known", "chair_order_percent", '<', 0.1, 0.1, "", "no model: 0.84"},
    {"known", "back_percent", '>', 100, 98, "", "no model: 0"},
    {"known", "front_percent", '>', 100, 98, "", "no model: 97"},
    {"known", "inside_percent", '<', 0, 0, "", "no model: 16.7"},
    {"known", "lost_back_percent", '>', 100, 98, "", "no model: 0"},
    {"known", "lost_front_percent", '>', 100, 98, "", "no model: 0"},
    {"known", "lost_inside_percent", '<', 0, 0, "", "no model: 100"},
    {"calibration", "map_p95_px", '<', 0.65, 0.65, "", ""},
    {"calibration", "baseline_mm", '<', 0.13, 0.13, "", ""},
    {"calibration", "focal_percent", '<', 0.25, 0.25, "11 by its four corners", ""},
    {"calibration", "undistort_none_px", '<', 1e-6, 1e-6, "", ""},
    {"calibration", "undistort_plumb_bob_px", '<', 1e-6, 1e-6, "", ""},
    {"calibration", "undistort_rational_px", '<', 1e-6, 1e-6, "", ""},
    {"chessboards", "stereo_rms_px", '<', 0.195, 0.195, "", "OpenCV's tutorial 0.445"},
    {"chessboards", "left_leave_one_out_px", '<', 0.185, 0.185, "", "OpenCV's tutorial 0.418"},
    {"chessboards", "epipolar_px", '<', 0.102, 0.102, "", "window 5: 0.132"},
    {"chessboards", "opencv_apart_px", '<', 0.02, 0.02, "", ""},
    {"sensed", "lift_count", '>', 12, 12, "none: no velocity", "mesh rebuilt in Bullet: 3"},
    {"sensed", "lift_error_percent", '<', 10, 10, "", ""},
    {"sensed", "swipe_count", '>', 12, 12, "none: no velocity", "mesh rebuilt in Bullet: 0 to 2"},
    {"sensed", "carry_stayed", '>', 3, 3, "", ""},
    {"sensed", "noise_jitter_mm", '<', 0.5, 0.5, "", ""},
    {"sensed", "noise_awake_mm", '<', 0.5, 0.5, "", ""},
    {"sensed", "noise_asleep_s", '<', 1, 1, "", ""},
    {"sensed", "noise_wakes", '<', 0, 0, "", ""},
    {"sensed", "chair_frames", '<', 4, 4, "never", ""},
    {"sensed", "throw_tunnelled", '<', 0, 0, "", ""},
    {"sensed", "throw_not_finite", '<', 0, 0, "", ""},
    {"sensed", "drop_tunnelled", '<', 0, 0, "", ""},
    {"sensed", "drop_fastest", '<', 15, 15, "", ""},
    {"sensed", "drop_walk_tunnelled", '<', 0, 0, "", ""},
    {"sensed", "drop_walk_swallowed", '<', 0, 0, "", ""},
    {"sensed", "drop_walk_not_finite", '<', 0, 0, "", ""},
    {"sensed", "drop_walk_fastest", '<', 15, 15, "", ""},
    {"sensed", "behind_bounced_percent", '>', 99, 98, "0", ""},
    {"sensed", "behind_passed_percent", '<', 0, 1, "", ""},
    {"sensed", "edge_bounced_percent", '>', 99, 99, "0", ""},
    {"sensed", "edge_passed_percent", '<', 0, 0, "", ""},
    {"sensed", "realism_percent", '>', 99.5, 92, "9 of 10 at best", ""},
    {"sensed", "realism_phantom_percent", '<', NAN, 1, "", ""},
    {"sensed", "realism_missed_percent", '<', NAN, 1, "", ""},
    {"moving empty", "ate_mm", '<', 2, NAN, "", "OpenCV RGBD-ICP: 0.96 mm a frame"},
    {"moving empty", "found_again_percent", '>', 100, NAN, "", ""},
    {"moving person", "ate_mm", '<', 3, NAN, "", ""},
    {"moving person", "found_again_percent", '>', 100, NAN, "", ""},
    {"moving loop", "foreground_f", '>', 0.97, NAN, "", ""},
    {"moving loop", "loop_ms", '<', 33, NAN, "", ""},
    {"moving thrown", "lost", '<', 0, NAN, "", ""},
    {"moving rested", "lost", '<', 0, NAN, "", ""},
    {"moving rested", "flung", '<', 0, NAN, "", ""},
    {"moving rested", "sunk", '<', 0, NAN, "", ""},
    {"hands", "grasps_percent", '>', 95, NAN, "", ""},
    {"hands", "slip_carried_mm", '<', 5, NAN, "", ""},
    {"hands", "slip_still_mm", '<', 3, NAN, "", ""},
    {"hands", "throw_speed_percent", '<', 10, NAN, "", ""},
    {"hands", "throw_direction_deg", '<', 8, NAN, "", ""},
    {"hands", "false_per_minute", '<', 0.5, NAN, "", ""},
    {"gestures", "palm_mm", '<', 8, NAN, "", ""},
    {"gestures", "tip_mm", '<', 10, NAN, "", "a network on HandNet 9.9"},
    {"gestures", "gestures_percent", '>', 95, NAN, "", ""},
    {"gestures", "hands_ms", '<', 1, NAN, "", "MediaPipe 11"},
    {"gestures", "far_open_fist_percent", '>', 95, NAN, "", ""},
    {"gestures", "far_palm_mm", '<', 12, NAN, "", ""},
    {"android", "normals_mean_deg", '<', 0.81, 0.81, "", "D2NT v3 1.240"},
    {"android", "normals_over_30_percent", '<', NAN, 0.2, "", ""},
    {"android", "normals_missing_percent", '<', NAN, 0.01, "", ""},
    {"demo", "normals_mean_deg", '<', 0.495, 0.495, "", "D2NT v3 0.565"},
    {"demo", "normals_over_30_percent", '<', NAN, 0.2, "", ""},
    {"demo", "normals_missing_percent", '<', NAN, 0.01, "", ""},
    {"android", "still_flight_60_deg", '<', 2.7, 2.7, "", "mean of frames + 5x5 plane 4.53"},
    {"android", "still_steps_60_deg", '<', NAN, 5.8, "", "mean of frames + 5x5 plane 18.7"},
    {"demo", "still_flight_60_deg", '<', 4.5, 4.5, "", "mean of frames + 5x5 plane 3.99"},
    {"demo", "still_steps_60_deg", '<', NAN, 8.2, "", "mean of frames + 5x5 plane 16.4"},
};
const int32_t eval_bound_count = (int32_t)(sizeof(eval_bounds) / sizeof(eval_bounds[0]));

const eval_bound *eval_bound_find(const char *scene, const char *key)
{
    for (int32_t i = 0; i < eval_bound_count; i++) {
        const eval_bound *b = &eval_bounds[i];
        if (strcmp(b->scene, scene) == 0 && strcmp(b->key, key) == 0) {
            return b;
        }
    }
    return NULL;
}

bool eval_has_bounds(const char *scene)
{
    bool has = false;
    for (int32_t i = 0; i < eval_bound_count; i++) {
        bool is_bounded = !isnan(eval_bounds[i].bound);
        has = has || (is_bounded && strcmp(eval_bounds[i].scene, scene) == 0);
    }
    return has;
}

static bool holds(char relation, double limit, double value)
{
    return relation == '<' ? value <= limit : value >= limit;
}

eval_verdict eval_bound_judge(const eval_bound *bound, double mean)
{
    if (isnan(mean)) {
        return EVAL_NOT_MEASURED;
    }
    if (!isnan(bound->goal) && holds(bound->relation, bound->goal, mean)) {
        return EVAL_GOAL_MET;
    }
    bool is_within = isnan(bound->bound) || holds(bound->relation, bound->bound, mean);
    return is_within ? EVAL_WITHIN_BOUND : EVAL_OUTSIDE;
}

const char *eval_verdict_name(eval_verdict verdict)
{
    static const char *const names[] = {"goal", "bound", "OUTSIDE", "no sample"};
    return names[verdict];
}
