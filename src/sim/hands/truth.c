/* What is true of the hands and their script. */
#include "sim/bones.h"
#include "sim/sensor.h"

#include <stddef.h>

static const synth_hands *hands_of(const rlf_source *source)
{
    const synth_sensor *sensor = synth_sensor_of(source);
    return sensor != NULL ? sensor->scene.hands : NULL;
}

static rlf_result fail_other(const rlf_source *source)
{
    return rlf_fail(RLF_ERROR_INVALID, "%s: not synthetic:hands, so its hands are unknown",
                    rlf_source_get_info(source)->name);
}

static rlf_pose hand_pose(const synth_hands *hands, int32_t track, double t)
{
    rlf_pose at = synth_track_at(&hands->tracks[track], t).hand;
    at.p = rlf_add(at.p, synth_hands_offset(hands, t));
    return rlf_pose_mul(&hands->T_camera_stage, &at);
}

static rlf_vec3 palm_at(const synth_hands *hands, int32_t track, double t, double *out_half)
{
    rlf_pose at = hand_pose(hands, track, t);
    return rlf_transform(&at, synth_hand_palm(&hands->tracks[track].form, out_half));
}

static void find(const synth_hands *hands, int32_t i, double t, rlf_synthetic_hand *out)
{
    const synth_track *track = &hands->tracks[i];
    const synth_key key = synth_track_at(track, t);
    const double h = SYNTH_DIFFERENCE_S;
    synth_hand_shape shape;
    synth_hand_form_shape(&track->form, &key.grip, &shape);
    *out = (rlf_synthetic_hand){.is_left = track->form.is_left,
                                .gesture = (rlf_synthetic_gesture)key.gesture};
    out->length = track->form.length;
    out->T_camera_hand = hand_pose(hands, i, t);
    out->palm = palm_at(hands, i, t, &out->palm_half);
    out->palm_normal = rlf_rotate(out->T_camera_hand.q, rlf_vec3_make(0, 0, -1));
    rlf_vec3 way = rlf_sub(palm_at(hands, i, t + h, &out->palm_half),
                           palm_at(hands, i, t - h, &out->palm_half));
    out->velocity = rlf_scale(way, 0.5 / h);
    for (int f = 0; f < SYNTH_FINGERS; f++) {
        for (int k = 0; k < 4; k++) {
            out->joints[f][k] = rlf_transform(&out->T_camera_hand, shape.joints[f][k]);
        }
        out->tip_radius[f] = shape.tip_radius[f];
    }
    double apart = rlf_length(rlf_sub(out->joints[0][3], out->joints[1][3]));
    out->pinch_width = rlf_max(0.0, apart - out->tip_radius[0] - out->tip_radius[1]);
}

rlf_result rlf_synthetic_get_hands(rlf_source *source, double time_s, rlf_synthetic_hand *out,
                                   int32_t *out_count)
{
    if (!RLF_ASSERT(source != NULL && out != NULL && out_count != NULL && time_s >= 0.0)) {
        return RLF_ERROR_INVALID;
    }
    const synth_hands *hands = hands_of(source);
    if (hands == NULL) {
        return fail_other(source);
    }
    for (int32_t i = 0; i < hands->track_count; i++) {
        find(hands, i, time_s, &out[i]);
    }
    *out_count = hands->track_count;
    return RLF_OK;
}

rlf_result rlf_synthetic_get_task(const rlf_source *source, rlf_synthetic_task *out)
{
    if (!RLF_ASSERT(source != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    const synth_hands *hands = hands_of(source);
    if (hands == NULL) {
        return fail_other(source);
    }
    *out = hands->task;
    out->thrown = rlf_rotate(hands->T_camera_stage.q, hands->task.thrown);
    for (int32_t i = 0; i < out->body_count; i++) {
        out->T_camera_body[i] = rlf_pose_mul(&hands->T_camera_stage, &hands->task.T_camera_body[i]);
    }
    return RLF_OK;
}
