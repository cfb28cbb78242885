/* A tracker's life, and its guess of the next pose. */
#include "track/tracker.h"

#include "base/checks.h"
#include "camera/checks.h"
#include "camera/pixels.h"
#include "math/rigid.h"

#define GUESS_GAP_NS 200000000 /* after a longer gap nobody knows how the camera goes on */

const char *rlf_track_health_name(rlf_track_health health)
{
    return health == RLF_TRACK_GOOD ? "good" : health == RLF_TRACK_WEAK ? "weak" : "lost";
}

rlf_tracker_def rlf_tracker_def_default(void)
{
    return (rlf_tracker_def){.cookie = RLF_DEF_COOKIE};
}

static void take_all(void *context)
{
    rlf_tracker *t = context;
    const rlf_camera *camera = &t->def.rig.depth;
    const size_t pixels = (size_t)camera->width * (size_t)camera->height;
    t->points.width = (camera->width + 1) / 4;
    t->points.height = (camera->height + 1) / 4;
    const size_t points = (size_t)t->points.width * (size_t)t->points.height;
    t->ray_x = arena_take(&t->arena, pixels, sizeof(float));
    t->ray_y = arena_take(&t->arena, pixels, sizeof(float));
    t->points.x = arena_take(&t->arena, points + 1, sizeof(float));
    t->points.y = arena_take(&t->arena, points + 1, sizeof(float));
    t->points.z = arena_take(&t->arena, points + 1, sizeof(float));
    t->points.sigma = arena_take(&t->arena, points + 1, sizeof(float));
    t->points.grey = arena_take(&t->arena, points + 1, 1);
    t->plane_error = arena_take(&t->arena, pixels, sizeof(float));
    t->keyframes = arena_take(&t->arena, TRACK_KEYFRAMES, sizeof(*t->keyframes));
}

rlf_result rlf_tracker_create(const rlf_tracker_def *def, rlf_tracker **out)
{
    if (!RLF_ASSERT(def != NULL && def->cookie == RLF_DEF_COOKIE && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    const rlf_result result = rig_check(&def->rig, "rlf_tracker_create");
    if (result != RLF_OK) {
        return result;
    }
    rlf_tracker *t = rlf_alloc(sizeof(*t));
    if (t == NULL) {
        return RLF_ERROR_MEMORY;
    }
    *t = (rlf_tracker){.def = *def};
    if (!arena_create(&t->arena, take_all, t)) {
        rlf_free(t);
        return RLF_ERROR_MEMORY;
    }
    camera_fill_rays(&def->rig.depth, t->ray_x, t->ray_y);
    const rlf_pose identity = rlf_pose_identity();
    rlf_tracker_reset(t, &identity);
    *out = t;
    return RLF_OK;
}

void rlf_tracker_destroy(rlf_tracker **tracker)
{
    if (tracker == NULL || *tracker == NULL) {
        return;
    }
    arena_destroy(&(*tracker)->arena);
    rlf_free(*tracker);
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
    if (!RLF_ASSERT(tracker != NULL)) {
        return rlf_pose_identity();
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
