/* Coarse to fine alignment of a frame's points with a prediction. */
#include "math/eigen.h"
#include "math/rigid.h"
#include "track/tracker.h"

#include <string.h>

/* Tukey's limit for 95 % efficiency, and the deviation of a median of absolute values. */
#define TUKEY 4.685
#define MEDIAN_TO_SIGMA 1.4826
#define LEAST_SIGMA 0.1  /* of the noise: no map is better, also of a sensor without noise */
#define LEAST_POINTS 200 /* at the finest level */
/* Share of the whole information: a thirtieth of the least that a direction must have, so that it
 * costs the determined ones one thirtieth of a step. */
#define DAMPING 3e-5

#define GATE_M 0.1        /* farther points do not count: it bounds the motion between frames */
#define LEAST_OVERLAP 0.3 /* share of the points that must lie on the prediction */
#define LEAST_CONSTRAINT 0.001 /* of all information, for a way; with less it is weak */
#define SHARED 8.0 /* 64 points in a square share an error: a mean is so many times worse */
/* Where depth is that good (a quarter of a voxel) brightness says nothing; where it is twice as
 * bad, all that it can. */
#define NEEDED_M 0.0015

/* Four pixels lie on one surface when their depths are within so many sigma, or within the slope of
 * a surface at a low angle, 80 degrees: so many times a pixel's width there. */
#define SAME_SIGMAS 4.0
#define SAME_SLOPE 5.67

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

/* ---- ways ---- */

/* The six ways in which a camera can move, and how much is known about each: motions (rotation
 * vector, then translation) that are one metre long when a turn counts by how far it moves what is
 * `reach` away, at right angles to each other. What was measured says something of each by itself:
 * whoever errs about one of them need not err about another. */
typedef struct track_ways {
    double reach;          /* metres */
    double way[6][6];      /* of each: a motion */
    double information[6]; /* about each, m^-2; in no order */
    double pull[6];        /* the right side along each: pull / information is how far to go */
    double sigma;          /* of what was measured, in expected deviations */
    bool asks_grey;        /* depth leaves a way open to brightness */
} track_ways;

enum { EVERY = 4 }; /* point along rows and columns tells where they lie */

/* How far the points are away, RMS, metres; > 0. */
static double reach_of(const track_points *points)
{
    double count = 0.0, sum = 0.0;
    for (int32_t y = 0; y < points->height; y += EVERY) {
        for (int32_t x = 0; x < points->width; x += EVERY) {
            const size_t i = (size_t)y * (size_t)points->width + (size_t)x;
            const rlf_vec3 p = {(double)points->x[i], (double)points->y[i], (double)points->z[i]};
            sum += p.z > 0.0 ? rlf_dot(p, p) : 0.0;
            count += p.z > 0.0;
        }
    }
    return count > 0.0 ? sqrt(sum / count) : 1.0;
}

/* The component of a motion along a way, metres. */
static double along(const track_ways *ways, int k, const double motion[6])
{
    const double square = ways->reach * ways->reach;
    double sum = 0.0;
    for (int i = 0; i < 6; i++) {
        sum += (i < 3 ? square : 1.0) * ways->way[k][i] * motion[i];
    }
    return sum;
}

/* Expected error along a way, metres. */
static double error_of(const track_ways *ways, int k)
{
    return SHARED * ways->sigma / sqrt(rlf_max(ways->information[k], 1e-12));
}

/* The information about two motions, and what is said of one. */
static double between(const double a[21], const double p[6], const double q[6])
{
    double sum = 0.0;
    for (int i = 0; i < 36; i++) {
        sum += p[i / 6] * track_entry(a, i / 6, i % 6) * q[i % 6];
    }
    return sum;
}

static double pull_along(const double way[6], const double b[6])
{
    double sum = 0.0;
    for (int i = 0; i < 6; i++) {
        sum += way[i] * b[i];
    }
    return sum;
}

/* Turns the ways so that no two of them have to do with each other in `a`, which is destroyed. */
static void part(track_ways *w, double a[6][6])
{
    double vectors[6][6], old[6][6], pull[6];
    memcpy(old, w->way, sizeof(old));
    memcpy(pull, w->pull, sizeof(pull));
    math_eigen(a, 6, w->information, vectors);
    for (int k = 0; k < 6; k++) {
        w->pull[k] = 0.0;
        memset(w->way[k], 0, sizeof(w->way[k]));
        for (int i = 0; i < 6; i++) {
            w->pull[k] += vectors[i][k] * pull[i];
            for (int r = 0; r < 6; r++) {
                w->way[k][r] += vectors[i][k] * old[i][r];
            }
        }
    }
}

/* sigma: of what depth measured, in expected deviations. */
static track_ways depth_ways(const track_sums *sums, double reach, double sigma)
{
    track_ways w = {.reach = reach, .sigma = sigma};
    double a[6][6];
    for (int k = 0; k < 6; k++) {
        w.way[k][k] = k < 3 ? 1.0 / reach : 1.0;
        w.pull[k] = w.way[k][k] * sums->depth.b[k];
    }
    for (int i = 0; i < 36; i++) {
        a[i / 6][i % 6] = between(sums->depth.a, w.way[i / 6], w.way[i % 6]);
    }
    part(&w, a);
    return w;
}

/* Depth's own, then those of depth and brightness together: brightness says something only of ways
 * that depth leaves open. */
static track_ways find_ways(const track_sums *sums, double reach, double sigma)
{
    track_ways w = depth_ways(sums, reach, sigma);
    double open[6], a[6][6] = {{0}};
    for (int k = 0; k < 6; k++) {
        open[k] = rlf_clamp(error_of(&w, k) / NEEDED_M - 1.0, 0.0, 1.0);
        w.asks_grey = w.asks_grey || open[k] > 0.0;
        w.pull[k] += open[k] * pull_along(w.way[k], sums->grey.b);
        a[k][k] = w.information[k];
    }
    if (!w.asks_grey || !(sums->grey_weight > 0.0)) {
        return w;
    }
    for (int i = 0; i < 36; i++) {
        const double both = open[i / 6] * open[i % 6];
        if (both > 0.0) {
            a[i / 6][i % 6] += both * between(sums->grey.a, w.way[i / 6], w.way[i % 6]);
        }
    }
    part(&w, a);
    return w;
}

/* ---- rounds ---- */

/* Of each 4 x 4 depth pixels the 2 x 2 in the middle, to a point. */
static void fill_row(const rlf_tracker *t, const rlf_track_view *view, int32_t row)
{
    const track_points *points = &t->points;
    const rlf_rig *rig = &t->def.rig;
    const size_t width = (size_t)rig->depth.width;
    const double slope = SAME_SLOPE / rlf_min(rig->depth.fx, rig->depth.fy);
    for (int32_t column = 0; column < points->width; column++) {
        const size_t to = (size_t)row * (size_t)points->width + (size_t)column;
        const size_t first = (4 * (size_t)row + 1) * width + 4 * (size_t)column + 1;
        const size_t at[4] = {first, first + 1, first + width, first + width + 1};
        double x = 0.0, y = 0.0, z = 0.0, grey = 0.0, least = 1e9, most = 0.0;
        bool is_whole = true, is_lit = view->grey != NULL;
        for (int k = 0; k < 4; k++) {
            const double depth = (double)view->depth[at[k]];
            const bool is_room = view->is_static == NULL || view->is_static[at[k]] != 0;
            is_whole =
                is_whole && is_room && depth >= rig->depth_min_m && depth <= rig->depth_max_m;
            x += 0.25 * (double)t->ray_x[at[k]] * depth;
            y += 0.25 * (double)t->ray_y[at[k]] * depth;
            z += 0.25 * depth;
            least = rlf_min(least, depth);
            most = rlf_max(most, depth);
            is_lit = is_lit && view->grey[at[k]] != 0;
            grey += is_lit ? 0.25 * view->grey[at[k]] : 0.0;
        }
        const double sigma = rlf_depth_noise_sigma(&rig->noise, z);
        const bool is_one = is_whole && most - least <= SAME_SIGMAS * sigma + slope * z;
        points->x[to] = is_one ? (float)x : 0.0f;
        points->y[to] = is_one ? (float)y : 0.0f;
        points->z[to] = is_one ? (float)z : 0.0f;
        points->sigma[to] = is_one ? (float)(0.5 * sigma) : 0.0f;
        points->grey[to] = is_one && is_lit ? (uint8_t)(grey + 0.5) : 0;
    }
}

static void fill_points(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const align_job *job = context;
    (void)worker;
    for (int32_t row = begin; row < end; row++) {
        fill_row(job->tracker, job->view, row);
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
static void solve(const track_sums *sums, const track_ways *ways, const rlf_pose *T, double x[6])
{
    double moved[6];
    motion_of(T, moved);
    memset(x, 0, 6 * sizeof(double));
    for (int k = 0; k < 6; k++) {
        const double known = ways->information[k];
        const double step = known < LEAST_CONSTRAINT * sums->information
                                ? -along(ways, k, moved)
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
        const double way = along(ways, k, moved), error = error_of(ways, k);
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

/* By the best fit of depth so far: brightness that pulls depth off must not open it further. */
static track_ways ways_of(align_job *job, const track_sums *sums)
{
    job->sigma = rlf_min(job->sigma, sqrt(sums->squared / rlf_max(sums->weight, 1e-12)));
    return find_ways(sums, job->reach, rlf_max(job->sigma, LEAST_SIGMA));
}

/* Rounds of one level. */
static bool align_level(align_job *job, const level *l, track_sums *sums)
{
    for (int32_t round = 0; round < l->rounds; round++) {
        *sums = track_sums_of(&job->tracker->points, l->stride, job->prediction,
                              job->tracker->plane_error, &job->T, &job->gate);
        if (sums->matched * l->stride * l->stride < LEAST_POINTS || !(sums->information > 0.0)) {
            return false;
        }
        double x[6];
        const track_ways ways = ways_of(job, sums);
        solve(sums, &ways, &job->T, x);
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
static void judge(const track_sums *sums, const track_ways *ways, const rlf_prediction *prediction,
                  rlf_track_result *out)
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
    out->health = out->overlap < LEAST_OVERLAP || sums->matched < LEAST_POINTS ? RLF_TRACK_LOST
                  : out->constraint < LEAST_CONSTRAINT                         ? RLF_TRACK_WEAK
                                                                               : RLF_TRACK_GOOD;
}

rlf_result rlf_tracker_align(rlf_tracker *tracker, const rlf_track_view *view,
                             const rlf_prediction *prediction, const rlf_pose *start,
                             rlf_track_result *out)
{
    if (!RLF_ASSERT(tracker != NULL && view != NULL && view->depth != NULL && prediction != NULL &&
                    start != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    if (!math_pose_is_sound(start) || !math_pose_is_sound(&prediction->T_world_camera)) {
        return rlf_fail(RLF_ERROR_INVALID, "track: the pose to start from is not a pose");
    }
    align_job job = {.tracker = tracker, .view = view, .prediction = prediction};
    rlf_parallel_for(tracker->def.pool, tracker->points.height, 4, fill_points, &job);
    track_find_plane_error(prediction, tracker->plane_error);
    const rlf_pose T_camera_world = rlf_pose_invert(&prediction->T_world_camera);
    job.T = rlf_pose_mul(&T_camera_world, start);
    job.gate = (track_gate){.metres = GATE_M, .cut = 1e9};
    *out = (rlf_track_result){.T_world_camera = *start, .weak_way = {0, 0, 1}};
    job.sigma = 1e9;
    job.reach = reach_of(&tracker->points);
    /* One that is far off pulls in no round. */
    track_sums sums = track_sums_of(&tracker->points, levels[0].stride, prediction,
                                    tracker->plane_error, &job.T, &job.gate);
    limit(&job.gate, &sums);
    for (int i = 0; i < LEVELS; i++) {
        if (!align_level(&job, &levels[i], &sums)) {
            return RLF_OK;
        }
    }
    const track_ways ways = ways_of(&job, &sums);
    judge(&sums, &ways, prediction, out);
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
