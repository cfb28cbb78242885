/* Coarse to fine alignment of a frame's points with a prediction. */
#include "math/rigid.h"
#include "track/tracker.h"
#include "track/ways.h"

#include <string.h>

/* Tukey's limit for 95 % efficiency, and the deviation of a median of absolute values. */
#define TUKEY 4.685
#define MEDIAN_TO_SIGMA 1.4826
#define LEAST_SIGMA 0.1  /* of the noise: no map is better, also of a sensor without noise */
#define LEAST_POINTS 200 /* at the finest level */
/* Share of the whole information: a thirtieth of the least that a direction must have, so that it
 * costs the determined ones one thirtieth of a step. */
#define DAMPING 3e-5

/* Every so many points, and so many rounds. */
typedef struct level {
    int32_t stride, rounds;
    bool asks_grey; /* at first depth comes as near as it can: that tells what it leaves open */
} level;

static const level levels[] = {{2, 3, false}, {2, 6, true}, {1, 5, true}};
#define LEVELS ((int)(sizeof(levels) / sizeof(levels[0])))

typedef struct align_job {
    rlf_tracker *tracker;
    const rlf_track_view *view;
    const rlf_prediction *prediction;
    rlf_pose T;
    track_gate gate;
    double reach; /* metres */
    double sigma; /* of depth, in expected deviations: the least so far */
} align_job;

static void fill_points(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const align_job *job = context;
    const rlf_tracker *t = job->tracker;
    (void)worker;
    for (int32_t row = begin; row < end; row++) {
        track_points_row(&t->points, &t->def.rig, t->ray_x, t->ray_y, job->view, row);
    }
}

/* The median of the residuals over their deviation, from the bins. */
static double median_of(const track_sums *sums)
{
    int32_t seen = 0;
    for (int32_t i = 0; i < TRACK_BINS; i++) {
        seen += sums->bins[i];
        if (2 * seen >= sums->matched) {
            return (i + 0.5) / TRACK_BINS_PER_SIGMA;
        }
    }
    return (double)TRACK_BINS / TRACK_BINS_PER_SIGMA;
}

/* Rotation vector and translation of a pose. */
static void motion_of(const rlf_pose *T, double x[6])
{
    const rlf_vec3 turn = math_rotation_vector(T->q);
    const double all[6] = {turn.x, turn.y, turn.z, T->p.x, T->p.y, T->p.z};
    memcpy(x, all, sizeof(all));
}

/* The next small motion: along a way that is not determined back to where the prediction was. */
static void solve(const track_sums *sums, const track_ways *ways, double least, const rlf_pose *T,
                  double x[6])
{
    double moved[6];
    motion_of(T, moved);
    memset(x, 0, 6 * sizeof(double));
    for (int k = 0; k < 6; k++) {
        const double known = ways->information[k];
        const double step = known < least * sums->information
                                ? -track_along(ways, k, moved)
                                : ways->pull[k] / (known + DAMPING * sums->information);
        for (int r = 0; r < 6; r++) {
            x[r] += step * ways->way[k][r];
        }
    }
}

/* Whether a motion is within what the pose may be off: then the camera has not moved. */
static bool rests(const track_ways *ways, const rlf_pose *T)
{
    double moved[6];
    motion_of(T, moved);
    for (int k = 0; k < 6; k++) {
        const double way = track_along(ways, k, moved), error = track_error(ways, k);
        if (way > error || way < -error) {
            return false;
        }
    }
    return true;
}

static bool move(rlf_pose *T, const double x[6])
{
    const rlf_vec3 turn = rlf_vec3_make(x[0], x[1], x[2]), shift = rlf_vec3_make(x[3], x[4], x[5]);
    if (!rlf_vec3_is_finite(turn) || !rlf_vec3_is_finite(shift) || rlf_length(turn) > 0.5 ||
        rlf_length(shift) > 0.5) {
        return false;
    }
    const rlf_pose step = {shift, rlf_quat_from_rotation_vector(turn)};
    *T = rlf_pose_mul(&step, T);
    T->q = rlf_quat_normalize(T->q);
    return true;
}

/* The limit for outliers follows the residuals. */
static void limit(track_gate *gate, const track_sums *sums)
{
    gate->cut = rlf_max(TUKEY * MEDIAN_TO_SIGMA * median_of(sums), 2.0);
    gate->grey = sums->grey_weight > 0.0 ? sums->grey_residual / sums->grey_weight : 0.0;
}

static track_sums sums_of(const align_job *job, const level *l)
{
    return track_sums_of(&job->tracker->points, l->stride, job->prediction, &job->T, &job->gate);
}

/* By the best fit of depth so far: brightness that pulls depth off must not open it further. */
static track_ways ways_of(align_job *job, const track_sums *sums)
{
    job->sigma = rlf_min(job->sigma, sqrt(sums->squared / rlf_max(sums->weight, 1e-12)));
    return track_ways_of(sums, job->reach, rlf_max(job->sigma, LEAST_SIGMA));
}

/* Rounds of one level. */
static bool align_level(align_job *job, const level *l, double least, track_sums *sums)
{
    for (int32_t round = 0; round < l->rounds; round++) {
        *sums = sums_of(job, l);
        if (sums->matched * l->stride * l->stride < LEAST_POINTS || !(sums->information > 0.0)) {
            return false;
        }
        double x[6];
        const track_ways ways = ways_of(job, sums);
        solve(sums, &ways, least, &job->T, x);
        if (!move(&job->T, x)) {
            return false;
        }
        const bool asks_grey = l->asks_grey && ways.asks_grey;
        const bool is_weighed = job->gate.asks_grey || !asks_grey;
        limit(&job->gate, sums);
        job->gate.asks_grey = job->gate.asks_grey || asks_grey;
        const double small = 1e-5; /* radians, metres */
        if (is_weighed && x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < small * small &&
            x[3] * x[3] + x[4] * x[4] + x[5] * x[5] < small * small) {
            break;
        }
    }
    return true;
}

/* What the sums at the end say about the pose. */
static void judge(const rlf_tracker *t, const track_sums *sums, const track_ways *ways,
                  const rlf_prediction *prediction, rlf_track_result *out)
{
    int weakest = 0;
    for (int k = 1; k < 6; k++) {
        weakest = ways->information[k] < ways->information[weakest] ? k : weakest;
    }
    const double *w = ways->way[weakest];
    const rlf_vec3 way = rlf_normalize(rlf_vec3_make(w[3], w[4], w[5]));
    out->constraint = rlf_max(0.0, ways->information[weakest] / sums->information);
    out->weak_way = rlf_rotate(prediction->T_world_camera.q, way);
    out->overlap = sums->tried > 0 ? (double)sums->matched / sums->tried : 0.0;
    out->rms_sigma = sqrt(sums->squared / rlf_max(sums->weight, 1e-12));
    out->point_count = sums->tried;
    out->health = out->overlap < t->def.least_overlap || sums->matched < LEAST_POINTS
                      ? RLF_TRACK_LOST
                  : out->constraint < t->def.least_constraint ? RLF_TRACK_WEAK
                                                              : RLF_TRACK_GOOD;
}

static bool is_pose(const rlf_pose *T)
{
    const rlf_quat q = T->q;
    const double length = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    return rlf_vec3_is_finite(T->p) && length > 0.98 && length < 1.02;
}

rlf_result rlf_tracker_align(rlf_tracker *tracker, const rlf_track_view *view,
                             const rlf_prediction *prediction, const rlf_pose *start,
                             rlf_track_result *out)
{
    if (!RLF_ASSERT(tracker != NULL && view != NULL && view->depth != NULL && prediction != NULL &&
                    start != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    if (!is_pose(start) || !is_pose(&prediction->T_world_camera)) {
        return rlf_fail(RLF_ERROR_INVALID, "track: the pose to start from is not a pose");
    }
    align_job job = {.tracker = tracker, .view = view, .prediction = prediction};
    rlf_parallel_for(tracker->def.pool, tracker->points.height, 4, fill_points, &job);
    const rlf_pose T_camera_world = rlf_pose_invert(&prediction->T_world_camera);
    job.T = rlf_pose_mul(&T_camera_world, start);
    job.gate = (track_gate){.metres = tracker->def.gate_m, .cut = 1e9};
    *out = (rlf_track_result){.T_world_camera = *start, .weak_way = {0, 0, 1}};
    track_sums sums = {.tried = 0};
    job.sigma = 1e9;
    job.reach = track_reach_of(&tracker->points);
    sums = sums_of(&job, &levels[0]); /* one that is far off pulls in no round */
    limit(&job.gate, &sums);
    for (int i = 0; i < LEVELS; i++) {
        if (!align_level(&job, &levels[i], tracker->def.least_constraint, &sums)) {
            return RLF_OK;
        }
    }
    const track_ways ways = ways_of(&job, &sums);
    judge(tracker, &sums, &ways, prediction, out);
    if (out->health == RLF_TRACK_LOST) {
        return RLF_OK;
    }
    out->T_world_camera = rlf_pose_mul(&prediction->T_world_camera, &job.T);
    out->T_world_camera.q = rlf_quat_normalize(out->T_world_camera.q);
    if (rests(&ways, &job.T)) {
        out->T_world_camera = prediction->T_world_camera;
    }
    return RLF_OK;
}
