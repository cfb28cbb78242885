/* Tracker and map over one clip, and what its poses are worth. */
#include "eval/moving/moving.h"

#include "command.h"
#include "fuse/fuser.h"
#include "fuse/trajectory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define FRAMES_MAX 4096
#define COVER_FIRST 40  /* frames of tracking before the lens is covered ... */
#define COVER_FRAMES 30 /* ... for a second ... */
#define COVER_EVERY 60  /* ... and again */
#define FOUND_WITHIN 10 /* frames */
#define FOUND_M 0.02
#define WRONG_M 0.05
#define DEGREES (180.0 / RLF_PI)

typedef enum series { DRIFT_M, DRIFT_RAD, TRACK_MS, PREDICT_MS, INTEGRATE_MS, SERIES } series;

typedef struct run {
    const moving_options *options;
    fuser fuser;
    uint16_t *dark; /* a depth picture without depth */
    trajectory path;
    rlf_pose first, last_true, last_found; /* the first true camera in its own world */
    bool has_last;
    bool is_waiting; /* covered a moment ago, not found again yet */
    int64_t seen, good, lost, wrong, covers, found_again;
    double values[SERIES][FRAMES_MAX];
    int32_t count[SERIES];
} run;

static void add(run *r, series s, double value)
{
    if (r->count[s] < FRAMES_MAX) {
        r->values[s][r->count[s]++] = value;
    }
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

static double median(run *r, series s)
{
    if (r->count[s] == 0) {
        return NAN;
    }
    qsort(r->values[s], (size_t)r->count[s], sizeof(double), compare);
    return r->values[s][r->count[s] / 2];
}

/* Frames of the cover's period since it began; negative before the first. */
static int64_t since_cover(const run *r)
{
    const int64_t after = r->seen - COVER_FIRST;
    return !r->options->is_covered || after < 0 ? -1 : after % COVER_EVERY;
}

/* Turn between two attitudes, radians. */
static double turn_of(rlf_quat q)
{
    const rlf_vec3 v = {q.x, q.y, q.z};
    return 2.0 * rlf_atan2(rlf_length(v), fabs(q.w));
}

/* The motion since the last frame, found against true. */
static void add_drift(run *r, const rlf_pose *found, const rlf_pose *truth)
{
    const rlf_pose found_back = rlf_pose_invert(&r->last_found);
    const rlf_pose true_back = rlf_pose_invert(&r->last_true);
    const rlf_pose moved = rlf_pose_mul(&found_back, found);
    const rlf_pose went = rlf_pose_mul(&true_back, truth);
    const rlf_pose went_back = rlf_pose_invert(&went);
    const rlf_pose off = rlf_pose_mul(&went_back, &moved);
    add(r, DRIFT_M, rlf_length(off.p));
    add(r, DRIFT_RAD, turn_of(off.q));
}

static void judge_cover(run *r, bool is_right)
{
    const int64_t since = since_cover(r);
    if (since == 0) {
        r->covers++;
        r->is_waiting = true;
    }
    if (r->is_waiting && since >= COVER_FRAMES && since < COVER_FRAMES + FOUND_WITHIN && is_right) {
        r->found_again++;
        r->is_waiting = false;
    }
}

/* `truth` is in the world of the first camera. */
static rlf_result judge(run *r, int64_t time_ns, const rlf_pose *truth)
{
    const rlf_track_result *found = &r->fuser.pose.last;
    const double off = rlf_length(rlf_sub(found->T_world_camera.p, truth->p));
    const bool is_lost = found->health == RLF_TRACK_LOST;
    const bool is_good = found->health == RLF_TRACK_GOOD;
    judge_cover(r, is_good && off < FOUND_M);
    r->lost += is_lost;
    r->good += is_good;
    r->wrong += is_good && off > WRONG_M;
    if (r->has_last && !is_lost) {
        add_drift(r, &found->T_world_camera, truth);
    }
    r->has_last = !is_lost;
    r->last_found = found->T_world_camera;
    r->last_true = *truth;
    return is_lost ? RLF_OK : trajectory_add(&r->path, time_ns, &found->T_world_camera, truth);
}

static rlf_result add_frame(run *r, rlf_frame *frame)
{
    const int64_t since = since_cover(r);
    if (since >= 0 && since < COVER_FRAMES) {
        frame->depth_u16 = r->dark;
        frame->depth_f32 = NULL;
        frame->depth_stride = frame->rig->depth.width * (ptrdiff_t)sizeof(uint16_t);
        frame->color.data = NULL;
    }
    if (r->seen == 0) {
        r->first = rlf_pose_invert(&frame->T_world_camera);
    }
    const rlf_pose truth = rlf_pose_mul(&r->first, &frame->T_world_camera);
    rlf_result result = fuser_add(&r->fuser, frame, NULL, NULL);
    if (result == RLF_OK) {
        result = judge(r, frame->time_ns, &truth);
        add(r, TRACK_MS, r->fuser.pose.align_ms);
        add(r, PREDICT_MS, r->fuser.pose.predict_ms);
        add(r, INTEGRATE_MS, r->fuser.integrate_ms);
        r->seen++;
    }
    return result;
}

static void summarise(run *r, moving_figures *out)
{
    const double all = (double)r->seen;
    const double error = trajectory_error(&r->path);
    out->ate_mm = error >= 0.0 ? 1000.0 * error : NAN;
    out->drift_mm = 1000.0 * median(r, DRIFT_M);
    out->drift_deg = DEGREES * median(r, DRIFT_RAD);
    out->lost_share = 100.0 * (double)r->lost / all;
    out->wrong_good = r->good > 0 ? 100.0 * (double)r->wrong / (double)r->good : NAN;
    out->track_ms = median(r, TRACK_MS);
    out->predict_ms = median(r, PREDICT_MS);
    out->integrate_ms = median(r, INTEGRATE_MS);
    out->covers = r->covers;
    out->found_again = r->found_again;
}

static rlf_result run_frames(run *r, rlf_source *source)
{
    while (!command_interrupted && (r->options->frames == 0 || r->seen < r->options->frames)) {
        rlf_frame frame;
        rlf_result result = rlf_source_next(source, &frame);
        if (result == RLF_OK && frame.has_pose) { /* a frame without the truth tells nothing */
            result = add_frame(r, &frame);
        }
        if (result != RLF_OK && result != RLF_NO_FRAME) {
            return result == RLF_END ? RLF_OK : result;
        }
    }
    return RLF_OK;
}

rlf_result moving_measure(rlf_source *source, const moving_options *options, moving_figures *out)
{
    const rlf_rig *rig = &rlf_source_get_info(source)->rig;
    const fuser_options fusing = {.is_tracked = true};
    run *r = rlf_alloc(sizeof(*r));
    rlf_pool *pool = NULL;
    if (r == NULL) {
        return RLF_ERROR_MEMORY;
    }
    r->options = options;
    r->dark =
        rlf_alloc_array((size_t)rig->depth.width * (size_t)rig->depth.height, sizeof(*r->dark));
    rlf_result result = r->dark != NULL ? rlf_pool_create(1, &pool) : RLF_ERROR_MEMORY;
    if (result == RLF_OK) {
        result = fuser_open(&r->fuser, rig, &fusing, pool);
    }
    if (result == RLF_OK) {
        result = run_frames(r, source);
        summarise(r, out);
    }
    fuser_close(&r->fuser);
    trajectory_free(&r->path);
    rlf_pool_destroy(&pool);
    rlf_free(r->dark);
    rlf_free(r);
    return result;
}
