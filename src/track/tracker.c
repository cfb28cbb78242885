/* A tracker's life, and its guess of the next pose. */
#include "track/tracker.h"

#include "base/cookie.h"
#include "base/time_range.h"
#include "camera/checks.h"
#include "math/rigid.h"

#define GUESS_GAP_NS 200000000 /* after a longer gap nobody knows how the camera goes on */

const char *rlf_track_health_name(rlf_track_health health)
{
    return health == RLF_TRACK_GOOD ? "good" : health == RLF_TRACK_WEAK ? "weak" : "lost";
}

rlf_tracker_def rlf_tracker_def_default(void)
{
    rlf_tracker_def def = {
        .cookie = RLF_DEF_COOKIE,
        .gate_m = 0.1,
        .least_overlap = 0.3,
        .least_constraint = 0.001,
        .keyframe_max = 256,
    };
    return def;
}

static rlf_result check(const rlf_tracker_def *def)
{
    rlf_result result = rig_check(&def->rig, "rlf_tracker_create");
    if (result != RLF_OK) {
        return result;
    }
    if (!(def->gate_m > 0.0 && def->gate_m <= 10.0)) {
        return rlf_fail(RLF_ERROR_INVALID, "rlf_tracker_create: gate_m is %g, not above 0 to 10",
                        def->gate_m);
    }
    if (!(def->least_overlap >= 0.0 && def->least_overlap <= 1.0 && def->least_constraint >= 0.0 &&
          def->least_constraint <= 1.0)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "rlf_tracker_create: least_overlap and least_constraint are 0 to 1");
    }
    if (def->keyframe_max < 1 || def->keyframe_max > 100000) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "rlf_tracker_create: keyframe_max is %d, not 1 to 100000",
                        (int)def->keyframe_max);
    }
    return RLF_OK;
}

static rlf_result allocate(rlf_tracker *t)
{
    const rlf_camera *camera = &t->def.rig.depth;
    const size_t pixels = (size_t)camera->width * (size_t)camera->height;
    t->points.width = (camera->width + 1) / 4;
    t->points.height = (camera->height + 1) / 4;
    const size_t points = (size_t)t->points.width * (size_t)t->points.height;
    t->ray_x = rlf_alloc_array(pixels, sizeof(float));
    t->ray_y = rlf_alloc_array(pixels, sizeof(float));
    t->points.x = rlf_alloc_array(points + 1, sizeof(float));
    t->points.y = rlf_alloc_array(points + 1, sizeof(float));
    t->points.z = rlf_alloc_array(points + 1, sizeof(float));
    t->points.sigma = rlf_alloc_array(points + 1, sizeof(float));
    t->points.grey = rlf_alloc(points + 1);
    t->keyframes = rlf_alloc_array((size_t)t->def.keyframe_max, sizeof(*t->keyframes));
    return t->ray_x != NULL && t->ray_y != NULL && t->points.x != NULL && t->points.y != NULL &&
                   t->points.z != NULL && t->points.sigma != NULL && t->points.grey != NULL &&
                   t->keyframes != NULL
               ? RLF_OK
               : RLF_ERROR_MEMORY;
}

rlf_result rlf_tracker_create(const rlf_tracker_def *def, rlf_tracker **out)
{
    if (!RLF_ASSERT(def != NULL && def->cookie == RLF_DEF_COOKIE && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    rlf_result result = check(def);
    if (result != RLF_OK) {
        return result;
    }
    rlf_tracker *t = rlf_alloc(sizeof(*t));
    if (t == NULL) {
        return RLF_ERROR_MEMORY;
    }
    *t = (rlf_tracker){.def = *def};
    result = allocate(t);
    if (result != RLF_OK) {
        rlf_tracker_destroy(&t);
        return result;
    }
    const rlf_camera *camera = &def->rig.depth;
    for (int32_t y = 0; y < camera->height; y++) {
        for (int32_t x = 0; x < camera->width; x++) {
            const size_t i = (size_t)y * (size_t)camera->width + (size_t)x;
            rlf_vec3 ray;
            (void)rlf_camera_unproject(camera, x, y, &ray);
            t->ray_x[i] = (float)ray.x;
            t->ray_y[i] = (float)ray.y;
        }
    }
    const rlf_pose identity = {{0, 0, 0}, rlf_quat_identity()};
    rlf_tracker_reset(t, &identity);
    *out = t;
    return RLF_OK;
}

void rlf_tracker_destroy(rlf_tracker **tracker)
{
    if (tracker == NULL || *tracker == NULL) {
        return;
    }
    rlf_tracker *t = *tracker;
    rlf_free(t->ray_x);
    rlf_free(t->ray_y);
    rlf_free(t->points.x);
    rlf_free(t->points.y);
    rlf_free(t->points.z);
    rlf_free(t->points.sigma);
    rlf_free(t->points.grey);
    rlf_free(t->keyframes);
    rlf_free(t);
    *tracker = NULL;
}

void rlf_tracker_reset(rlf_tracker *tracker, const rlf_pose *T_world_camera)
{
    if (!RLF_ASSERT(tracker != NULL && T_world_camera != NULL)) {
        return;
    }
    tracker->pose = tracker->before = *T_world_camera;
    tracker->pose_count = 0;
    tracker->keyframe_count = 0;
}

/* Constant velocity: the motion between the last two poses, for as long again. */
rlf_pose rlf_tracker_guess(const rlf_tracker *tracker, int64_t time_ns)
{
    const rlf_pose identity = {{0, 0, 0}, rlf_quat_identity()};
    if (!RLF_ASSERT(tracker != NULL)) {
        return identity;
    }
    if (!time_is_usable(time_ns)) {
        return tracker->pose;
    }
    const int64_t last = tracker->time_ns - tracker->before_ns;
    const int64_t next = time_ns - tracker->time_ns;
    if (tracker->pose_count < 2 || last <= 0 || next <= 0 || last > GUESS_GAP_NS ||
        next > GUESS_GAP_NS) {
        return tracker->pose;
    }
    const double share = (double)next / (double)last;
    const rlf_pose back = rlf_pose_invert(&tracker->before);
    const rlf_pose step = rlf_pose_mul(&back, &tracker->pose);
    const rlf_vec3 turn = rlf_scale(math_rotation_vector(step.q), share);
    const rlf_pose go = {rlf_scale(step.p, share), rlf_quat_from_rotation_vector(turn)};
    rlf_pose pose = rlf_pose_mul(&tracker->pose, &go);
    pose.q = rlf_quat_normalize(pose.q);
    return pose;
}
