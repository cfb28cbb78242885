/* `relief info SOURCE --up`. */
#include "info/info.h"

#include "command.h"
#include "timing.h"

#include <stdio.h>
#include <string.h>

#define DEGREES (180.0 / RLF_PI)
#define TRUTH_MAX 100000
#define WRONG_DEG 10.0                 /* bodies roll off a table that is taken to lean so much */
#define TRUTH_GAP_NS INT64_C(20000000) /* a frame farther than this from every pose has none */

typedef struct true_pose {
    int64_t time_ns;
    rlf_quat q; /* camera to world, z up */
} true_pose;

typedef struct up_tally {
    timing_series confidence, down, roll; /* degrees */
    timing_series error;                  /* degrees off the truth */
    int64_t frames, sure, judged;
    int64_t wrong, wrong_sure; /* by the truth */
} up_tally;

typedef struct up_measure {
    true_pose *truth; /* by time; NULL = unknown */
    int32_t truth_count;
    rlf_vec3 down; /* of a synthetic source */
    bool is_synthetic;
    rlf_vec3 world_up; /* in the truth's world */
    bool knows_world;
    up_tally tally;
} up_measure;

static rlf_result read_pose(const char *line, const char *path, int number, true_pose *out)
{
    double time_s, x, y, z;
    rlf_quat *q = &out->q;
    if (sscanf(line, "%lf %lf %lf %lf %lf %lf %lf %lf", &time_s, &x, &y, &z, &q->x, &q->y, &q->z,
               &q->w) != 8 ||
        !(time_s >= 0.0 && time_s < 9e9)) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s:%d: needs eight numbers: time, position, quaternion",
                        path, number);
    }
    out->q = rlf_quat_normalize(*q);
    out->time_ns = (int64_t)(time_s * 1e9);
    return RLF_OK;
}

/* No file is no error. */
static rlf_result read_truth(const char *folder, up_measure *m)
{
    char path[4096], line[512];
    int length = snprintf(path, sizeof(path), "%s/groundtruth.txt", folder);
    FILE *file = length > 0 && length < (int)sizeof(path) ? fopen(path, "r") : NULL;
    if (file == NULL) {
        return RLF_OK;
    }
    m->truth = rlf_alloc_array(TRUTH_MAX, sizeof(*m->truth));
    rlf_result result = m->truth == NULL ? RLF_ERROR_MEMORY : RLF_OK;
    for (int number = 1; result == RLF_OK && fgets(line, sizeof(line), file) != NULL; number++) {
        if (line[0] == '#' || line[strspn(line, " \t\r\n")] == '\0') {
            continue;
        }
        if (m->truth_count == TRUTH_MAX) {
            result = rlf_fail(RLF_ERROR_FORMAT, "%s: has more than %d poses", path, TRUTH_MAX);
        } else {
            result = read_pose(line, path, number, &m->truth[m->truth_count++]);
        }
    }
    fclose(file);
    return result;
}

static const true_pose *nearest_pose(const up_measure *m, int64_t time_ns)
{
    const true_pose *best = NULL;
    int64_t best_gap = TRUTH_GAP_NS;
    for (int32_t i = 0; i < m->truth_count; i++) {
        int64_t gap = m->truth[i].time_ns - time_ns;
        gap = gap < 0 ? -gap : gap;
        if (gap < best_gap) {
            best = &m->truth[i];
            best_gap = gap;
        }
    }
    return best;
}

/* What the simulator knows, or groundtruth.txt says of a frame; its world's up is z, or what the
 * first frame says. */
static bool true_up(up_measure *m, int64_t time_ns, rlf_vec3 found, rlf_vec3 *out)
{
    if (m->is_synthetic) {
        *out = rlf_neg(m->down);
        return true;
    }
    const double near_z = 0.94; /* cos 20 degrees */
    const true_pose *pose = nearest_pose(m, time_ns);
    if (pose == NULL) {
        return false;
    }
    if (!m->knows_world) {
        rlf_vec3 up = rlf_rotate(pose->q, found);
        m->world_up = up.z > near_z ? rlf_vec3_make(0, 0, 1) : up;
        m->knows_world = true;
    }
    *out = rlf_rotate(rlf_quat_conjugate(pose->q), m->world_up);
    return true;
}

static double degrees_between(rlf_vec3 a, rlf_vec3 b)
{
    return DEGREES * rlf_acos(rlf_clamp(rlf_dot(a, b), -1.0, 1.0));
}

static void add_frame(up_measure *m, const rlf_surface *surface)
{
    up_tally *tally = &m->tally;
    rlf_vec3 up, truth;
    double confidence = rlf_surface_find_up(surface, &up);
    bool is_sure = confidence >= RLF_UP_SURE;
    timing_add(&tally->confidence, confidence);
    tally->sure += is_sure;
    timing_add(&tally->down, DEGREES * rlf_atan2(-up.z, -up.y));
    timing_add(&tally->roll, DEGREES * rlf_atan2(up.x, -up.y));
    bool is_known = true_up(m, surface->time_ns, up, &truth);
    if (is_known) {
        double error = degrees_between(up, truth);
        timing_add(&tally->error, error);
        tally->judged++;
        tally->wrong += error > WRONG_DEG;
        tally->wrong_sure += error > WRONG_DEG && is_sure;
    }
    tally->frames++;
}

/* Each frame by itself: the camera may move. */
static rlf_result read_frames(rlf_source *source, int64_t frames, up_measure *m)
{
    const rlf_rig *rig = &rlf_source_get_info(source)->rig;
    const rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, rig);
    rlf_reconstruct *stage = NULL;
    rlf_result result = rlf_reconstruct_create(&def, &stage);
    while (result >= RLF_OK && result != RLF_END && m->tally.frames < frames &&
           !command_interrupted) {
        rlf_frame frame;
        const rlf_surface *surface;
        result = rlf_source_next(source, &frame);
        if (result != RLF_OK) {
            continue;
        }
        rlf_reconstruct_reset(stage);
        result = rlf_reconstruct_process(stage, &frame, &surface);
        if (result == RLF_OK) {
            add_frame(m, surface);
        }
    }
    rlf_reconstruct_destroy(&stage);
    return result < RLF_OK ? result : RLF_OK;
}

/* Without a minus before a zero. */
static double tenths(const timing_series *degrees)
{
    return command_tidy(timing_percentile(degrees, 50), 1);
}

static void print(const char *name, const up_tally *t)
{
    printf("%s: sure of up in %lld of %lld %s (confidence %.2f, median)\n", name,
           (long long)t->sure, (long long)t->frames, command_frames(t->frames),
           timing_percentile(&t->confidence, 50));
    printf("the camera looks down by %.1f degrees and is rolled by %.1f (medians)\n",
           tenths(&t->down), tenths(&t->roll));
    if (t->judged > 0) {
        printf("off the truth by %.1f degrees (median; %.1f at the 95th percentile); "
               "by more than 10: %lld, of them sure %lld\n",
               timing_percentile(&t->error, 50), timing_percentile(&t->error, 95),
               (long long)t->wrong, (long long)t->wrong_sure);
    }
}

rlf_result info_up(rlf_source *source, const char *name, int64_t frames)
{
    up_measure *m = rlf_alloc(sizeof(*m));
    if (m == NULL) {
        return RLF_ERROR_MEMORY;
    }
    rlf_result result = read_truth(name, m);
    if (result == RLF_OK && strncmp(name, "synthetic:", strlen("synthetic:")) == 0) {
        m->is_synthetic = rlf_synthetic_get_down(source, &m->down) == RLF_OK;
    }
    result = result == RLF_OK ? read_frames(source, frames, m) : result;
    if (result == RLF_OK && m->tally.frames == 0) {
        result = command_interrupted ? RLF_NO_FRAME
                                     : rlf_fail(RLF_ERROR_INVALID, "%s: has no frames", name);
    }
    if (result == RLF_OK) {
        print(name, &m->tally);
    }
    rlf_free(m->truth);
    rlf_free(m);
    return result;
}
