/* Coarse to fine alignment of a frame's points with a prediction. */
#include "math/solve_six.h"
#include "track/constraint.h"
#include "track/tracker.h"

/* Tukey's limit for 95 % efficiency, and the deviation of a median of absolute values. */
#define TUKEY 4.685
#define MEDIAN_TO_SIGMA 1.4826
#define LEAST_POINTS 200 /* at the finest level */
/* Shares of the whole information: a direction with less than the first needs all the help that
 * brightness gives; one with more than the second none: blurred by the voxels, it would disturb. */
#define GREY_WHOLE 0.01
#define GREY_NONE 0.02
/* Share of the whole information: a thirtieth of the least that a direction must have, so that it
 * costs the determined ones one thirtieth of a step. */
#define DAMPING 1e-4

/* Every so many points, and so many rounds. */
typedef struct level {
    int32_t stride, rounds;
} level;

static const level levels[] = {{2, 8}, {1, 5}};
#define LEVELS ((int)(sizeof(levels) / sizeof(levels[0])))

typedef struct align_job {
    rlf_tracker *tracker;
    const rlf_track_view *view;
    const rlf_prediction *prediction;
    rlf_pose T;
    track_gate gate;
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

/* How much brightness counts, 0..1: where depth leaves a direction undetermined. */
static double grey_weight(const track_constraint *constraint)
{
    const double *s = constraint->share;
    const double share = rlf_min(rlf_min(s[0], s[1]), s[2]);
    return rlf_clamp((GREY_NONE - share) / (GREY_NONE - GREY_WHOLE), 0.0, 1.0);
}

/* Solves for the small motion, without its part along ways that are not determined. */
static void solve(const track_sums *sums, const track_constraint *constraint, double least,
                  double x[6])
{
    double a[6][6];
    int k = 0;
    for (int r = 0; r < 6; r++) {
        for (int c = 0; c <= r; c++) {
            a[r][c] = a[c][r] = sums->a[k++];
        }
    }
    const double turning = a[0][0] + a[1][1] + a[2][2];
    for (int i = 0; i < 6; i++) { /* Levenberg: a way without information is not gone */
        a[i][i] += DAMPING * (i < 3 ? turning : sums->information);
    }
    math_solve_six(a, sums->b, x);
    rlf_vec3 t = rlf_vec3_make(x[3], x[4], x[5]);
    for (int i = 0; i < 3; i++) {
        if (constraint->share[i] < least) {
            t = rlf_mad(t, constraint->way[i], -rlf_dot(t, constraint->way[i]));
        }
    }
    x[3] = t.x;
    x[4] = t.y;
    x[5] = t.z;
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

/* Rounds of one level; the limit for outliers follows the residuals. */
static bool align_level(align_job *job, const level *l, double least, track_sums *sums)
{
    for (int32_t round = 0; round < l->rounds; round++) {
        *sums =
            track_sums_of(&job->tracker->points, l->stride, job->prediction, &job->T, &job->gate);
        if (sums->matched * l->stride * l->stride < LEAST_POINTS || !(sums->information > 0.0)) {
            return false;
        }
        double x[6];
        const track_constraint constraint = track_constraint_of(sums);
        const double grey = grey_weight(&constraint);
        const bool is_weighed = grey <= job->gate.grey_weight;
        solve(sums, &constraint, least, x);
        if (!move(&job->T, x)) {
            return false;
        }
        job->gate.cut = rlf_max(TUKEY * MEDIAN_TO_SIGMA * median_of(sums), 2.0);
        job->gate.grey = sums->grey_weight > 0.0 ? sums->grey_residual / sums->grey_weight : 0.0;
        job->gate.grey_weight = rlf_max(job->gate.grey_weight, grey);
        const double small = 1e-5; /* radians, metres */
        if (is_weighed && x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < small * small &&
            x[3] * x[3] + x[4] * x[4] + x[5] * x[5] < small * small) {
            break;
        }
    }
    return true;
}

/* What the sums at the end say about the pose. */
static void judge(const rlf_tracker *t, const track_sums *sums, const rlf_prediction *prediction,
                  rlf_track_result *out)
{
    const track_constraint constraint = track_constraint_of(sums);
    int weakest = 0;
    for (int i = 1; i < 3; i++) {
        weakest = constraint.share[i] < constraint.share[weakest] ? i : weakest;
    }
    out->constraint = constraint.share[weakest];
    out->weak_way = rlf_rotate(prediction->T_world_camera.q, constraint.way[weakest]);
    out->overlap = sums->tried > 0 ? (double)sums->matched / sums->tried : 0.0;
    out->rms_sigma = sums->weight > 0.0 ? sqrt(sums->squared / sums->weight) : 0.0;
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
    track_sums sums = {.a = {0}};
    for (int i = 0; i < LEVELS; i++) {
        if (!align_level(&job, &levels[i], tracker->def.least_constraint, &sums)) {
            return RLF_OK;
        }
    }
    judge(tracker, &sums, prediction, out);
    if (out->health != RLF_TRACK_LOST) {
        out->T_world_camera = rlf_pose_mul(&prediction->T_world_camera, &job.T);
        out->T_world_camera.q = rlf_quat_normalize(out->T_world_camera.q);
    }
    return RLF_OK;
}
