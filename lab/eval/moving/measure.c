/* Tracker and map over one clip, and what its poses are worth. */
#include "eval/moving/moving.h"

#include "command.h"
#include "eval/map/fuser.h"
#include "trajectory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define FRAMES_MAX 4096
#define DARK_FRAMES 3          /* of a lens that is covered, ... */
#define DARK_STEP_NS 333333333 /* ... for a second */
#define STEP_NS 33333333
#define FOUND_WITHIN 10 /* frames */
#define WRONG_M 0.05
#define DEGREES (180.0 / RLF_PI)

typedef enum series { DRIFT_M, DRIFT_RAD, TRACK_MS, PREDICT_MS, INTEGRATE_MS, SERIES } series;

typedef struct run {
    const moving_options *options;
    fuser fuser;
    uint16_t *dark; /* a depth picture without depth */
    trajectory path;
    rlf_pose first, last_true, last_found; /* the first true camera in its own world */
    bool has_last, is_covered; /* is_covered: now and again, since the path was measured */
    int64_t time_ns;           /* of the last frame */
    int64_t seen, good, lost, wrong;
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

static double off_by(const run *r, const rlf_pose *from)
{
    return rlf_length(rlf_sub(r->fuser.pose.last.T_world_camera.p, from->p));
}

/* `truth` is in the world of the first camera. */
static rlf_result judge(run *r, const rlf_pose *truth)
{
    const rlf_track_result *found = &r->fuser.pose.last;
    const bool is_lost = found->health == RLF_TRACK_LOST;
    const bool is_good = found->health == RLF_TRACK_GOOD;
    r->lost += is_lost;
    r->good += is_good;
    r->wrong += is_good && off_by(r, truth) > WRONG_M;
    if (r->has_last && !is_lost) {
        add_drift(r, &found->T_world_camera, truth);
    }
    r->has_last = !is_lost;
    r->last_found = found->T_world_camera;
    r->last_true = *truth;
    return trajectory_add(&r->path, r->time_ns, &found->T_world_camera, truth);
}

/* The next frame with a true pose into tracker and map: a frame without the truth tells nothing. */
static rlf_result next_frame(run *r, rlf_source *source, rlf_pose *out_truth)
{
    rlf_frame frame;
    rlf_result result = RLF_NO_FRAME;
    while (result == RLF_NO_FRAME || (result == RLF_OK && !frame.has_pose)) {
        result = command_interrupted ? RLF_END : rlf_source_next(source, &frame);
    }
    if (result != RLF_OK) {
        return result;
    }
    r->time_ns = r->is_covered ? r->time_ns + STEP_NS : frame.time_ns;
    frame.time_ns = r->time_ns;
    if (r->seen == 0) {
        r->first = rlf_pose_invert(&frame.T_world_camera);
    }
    *out_truth = rlf_pose_mul(&r->first, &frame.T_world_camera);
    r->seen++;
    return fuser_add(&r->fuser, &frame, NULL, NULL);
}

static rlf_result run_frames(run *r, rlf_source *source)
{
    rlf_result result = RLF_OK;
    while (result == RLF_OK && (r->options->frames == 0 || r->seen < r->options->frames)) {
        rlf_pose truth;
        result = next_frame(r, source, &truth);
        if (result == RLF_OK) {
            result = judge(r, &truth);
            add(r, TRACK_MS, r->fuser.pose.align_ms);
            add(r, PREDICT_MS, r->fuser.pose.predict_ms);
            add(r, INTEGRATE_MS, r->fuser.integrate_ms);
        }
    }
    return result == RLF_END ? RLF_OK : result;
}

static rlf_result cover_lens(run *r, const rlf_rig *rig)
{
    rlf_result result = RLF_OK;
    for (int i = 0; i < DARK_FRAMES && result == RLF_OK; i++) {
        r->time_ns += DARK_STEP_NS;
        const rlf_frame dark = {.rig = rig,
                                .sequence = (uint64_t)r->seen++,
                                .time_ns = r->time_ns,
                                .depth_u16 = r->dark,
                                .depth_stride = rig->depth.width * (ptrdiff_t)sizeof(uint16_t),
                                .depth_units_per_metre = 1000.0};
        result = fuser_add(&r->fuser, &dark, NULL, NULL);
    }
    return result;
}

/* Another camera, which knows the map and nothing of where it is. */
static rlf_result enter(run *r, const rlf_rig *rig)
{
    camera_pose_close(&r->fuser.pose);
    rlf_result result = camera_pose_open(&r->fuser.pose, rig, NULL);
    return result == RLF_OK ? camera_pose_know(&r->fuser.pose, r->fuser.map) : result;
}

/* What happens before the camera sees again, elsewhere on its way. */
typedef rlf_result (*interruption)(run *r, const rlf_rig *rig);

/* Percent of the interruptions after which the camera is found: it is where it was found at first.
 * What the whole way is off is told by itself. */
static rlf_result run_covers(run *r, rlf_source *source, interruption interrupt, double *out)
{
    const rlf_source_info *info = rlf_source_get_info(source);
    const int64_t count = r->options->covers;
    const int64_t frames = r->path.count - FOUND_WITHIN;
    rlf_result result = RLF_OK;
    int64_t found = 0;
    r->is_covered = true;
    for (int64_t i = 0; i < count && result == RLF_OK && frames > 0; i++) {
        result = interrupt(r, &info->rig);
        /* 7 has no factor in common with 20: far and near in turn. */
        const int64_t first = i * 7 % count * frames / count;
        if (result == RLF_OK) {
            result = rlf_source_seek(source, first);
        }
        bool is_found = false;
        for (int k = 0; k < FOUND_WITHIN && result == RLF_OK && !is_found; k++) {
            rlf_pose truth;
            result = next_frame(r, source, &truth);
            is_found = result == RLF_OK && r->fuser.pose.last.health == RLF_TRACK_GOOD &&
                       off_by(r, &r->path.found[first + k]) < WRONG_M;
        }
        found += is_found;
    }
    *out = 100.0 * (double)found / (double)count;
    return result;
}

/* What a camera that is taken to stand still would be off, RMS. */
static double spread(const trajectory *t)
{
    rlf_vec3 sum = {0, 0, 0};
    double squares = 0.0;
    for (int32_t i = 0; i < t->count; i++) {
        sum = rlf_add(sum, t->truth[i]);
        squares += rlf_dot(t->truth[i], t->truth[i]);
    }
    const double n = t->count;
    return n > 0 ? sqrt(rlf_max(0.0, squares / n - rlf_dot(sum, sum) / (n * n))) : NAN;
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
    out->still_mm = 1000.0 * spread(&r->path);
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
    if (result == RLF_OK) {
        result = run_covers(r, source, cover_lens, &out->found_again);
    }
    if (result == RLF_OK) {
        result = run_covers(r, source, enter, &out->found_known);
    }
    result = result == RLF_END ? RLF_OK : result;
    fuser_close(&r->fuser);
    trajectory_free(&r->path);
    rlf_pool_destroy(&pool);
    rlf_free(r->dark);
    rlf_free(r);
    return result;
}
