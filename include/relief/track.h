/* Relief: the pose of a moving depth camera, frame by frame, against a prediction of the room.
 *
 * Each frame's points are moved until they lie on the predicted surfaces: point to plane,
 * projective association, coarse to fine (Chen and Medioni 1991; Newcombe et al. 2011,
 * KinectFusion, section 3.5), weighted by the sensor's noise, and robust (Beaton and Tukey 1974).
 * What moves is kept out before it can pull: by a mask, and where a point is nearer than the room
 * by more than noise.
 *
 * One frame:
 *
 *   pose = rlf_tracker_guess(tracker, frame.time_ns);
 *   rlf_map_predict(map, &camera, &pose, &prediction);
 *   rlf_tracker_align(tracker, &view, &prediction, &pose, &result);
 *   rlf_tracker_accept(tracker, &view, frame.time_ns, &result);
 *   if (result.health == RLF_TRACK_LOST) ... rlf_tracker_recall() gives poses to try.
 *
 * World = the frame that the predictions' poses refer to; metres. Thread-safety: one call at a time
 * per tracker. The bits do not depend on the number of threads.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_TRACK_H
#define RELIEF_TRACK_H

#include "relief/frame.h"
#include "relief/prediction.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How far a pose can be trusted. */
typedef enum rlf_track_health {
    RLF_TRACK_LOST = 0, /* too little of the frame lies on the prediction: the pose is the guess */
    RLF_TRACK_WEAK = 1, /* a direction is not determined: there the pose is the prediction's */
    RLF_TRACK_GOOD = 2
} rlf_track_health;

/* "lost", "weak" or "good". */
RLF_API const char *rlf_track_health_name(rlf_track_health health);

/* Settings of a tracker. */
typedef struct rlf_tracker_def {
    uint32_t cookie; /* from rlf_tracker_def_default */
    rlf_rig rig;     /* of the frames to come; must be set */
    rlf_pool *pool;  /* borrowed; NULL = one thread */
} rlf_tracker_def;

/* Memory for one camera. Made by rlf_tracker_create, gone by rlf_tracker_destroy. */
typedef struct rlf_tracker rlf_tracker;

/* Defaults as the fields say; rig is empty and must be set. */
RLF_API rlf_tracker_def rlf_tracker_def_default(void);
/* RLF_ERROR_INVALID names the field that cannot be used; RLF_ERROR_MEMORY. Nothing is allocated
 * after it. */
RLF_API rlf_result rlf_tracker_create(const rlf_tracker_def *def, rlf_tracker **out);
/* Frees it and nulls the pointer. NULL and a NULL tracker are allowed. */
RLF_API void rlf_tracker_destroy(rlf_tracker **tracker);
/* Starts anew at a pose, at rest, without keyframes. */
RLF_API void rlf_tracker_reset(rlf_tracker *tracker, const rlf_pose *T_world_camera);

/* One frame. Planes have the rig's depth camera's size, row-major without padding, and are only
 * read during the call. */
typedef struct rlf_track_view {
    const float *depth;       /* metres along z; <= 0 or not finite = missing */
    const uint8_t *is_static; /* 1 = may be static room, 0 = moves; NULL = all may be */
    const uint8_t *grey;      /* luma 0..255 of each depth pixel, 0 = none; NULL = no colour */
} rlf_track_view;

/* What was found. */
typedef struct rlf_track_result {
    rlf_pose T_world_camera; /* always finite */
    rlf_track_health health; /* whether the pose can be used */
    double overlap;          /* share of the frame's points that lie on the prediction, 0..1 */
    double rms_sigma;        /* of those: root mean square residual over its expected deviation */
    double constraint;       /* least share of information of a direction, 0..1/3 */
    rlf_vec3 weak_way;       /* unit, world: the direction of motion that is determined least */
    int32_t point_count;     /* points of the frame that were tried at the finest level */
} rlf_track_result;

/* Where the camera will be at time_ns if it goes on as it did: where to predict for. */
RLF_API rlf_pose rlf_tracker_guess(const rlf_tracker *tracker, int64_t time_ns);

/* Aligns a view with a prediction, beginning at the pose `start`. Changes no state of the tracker
 * but its work memory, so that several starts can be tried. */
RLF_API rlf_result rlf_tracker_align(rlf_tracker *tracker, const rlf_track_view *view,
                                     const rlf_prediction *prediction, const rlf_pose *start,
                                     rlf_track_result *out);

/* Takes a result as the camera's pose at time_ns: later guesses begin there. Keeps the view as a
 * keyframe when its pose is good and no keyframe looks alike; view NULL: keeps none. */
RLF_API void rlf_tracker_accept(rlf_tracker *tracker, const rlf_track_view *view, int64_t time_ns,
                                const rlf_track_result *result);

/* Keeps what is predicted at a pose as a keyframe: a camera that comes into a known room is found
 * where a keyframe looks like its view. Nothing is kept when one looks alike, or there is no room.
 */
RLF_API void rlf_tracker_remember(rlf_tracker *tracker, const rlf_prediction *prediction);

/* Poses of the keyframes that look most like the view, the likeliest first; at most `max`. Returns
 * how many. Each is a start for rlf_map_predict and rlf_tracker_align. A keyframe is turned, by up
 * to a quarter of the picture, to where it looks most like the view. Source: small thumbnails
 * compared as a whole, Klein and Murray 2008. */
RLF_API int32_t rlf_tracker_recall(rlf_tracker *tracker, const rlf_track_view *view,
                                   rlf_pose *out_poses, int32_t max);

#ifdef __cplusplus
}
#endif
#endif
