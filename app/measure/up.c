/* `relief measure SOURCE --up`. */
#include "measure/up.h"

#include "command.h"
#include "timing.h"

#include <stdio.h>
#include <string.h>

#define DEGREES (180.0 / RLF_PI)
#define TRUTH_MAX 100000
#define TRUTH_GAP_NS INT64_C(20000000) /* a frame farther than this from every pose has none */

typedef struct true_pose {
    int64_t time_ns;
    rlf_quat q; /* camera to world, z up */
} true_pose;

typedef struct up_measure {
    timing_series down, roll, error; /* degrees */
    int64_t frames, found, judged;
    true_pose *truth; /* by time; NULL = unknown */
    int32_t truth_count;
} up_measure;

static rlf_result read_pose(const char *line, const char *path, int number, true_pose *out)
{
    double time_s, x, y, z;
    rlf_quat *q = &out->q;
    if (sscanf(line, "%lf %lf %lf %lf %lf %lf %lf %lf", &time_s, &x, &y, &z, &q->x, &q->y, &q->z,
               &q->w) != 8 ||
        !(time_s > 0.0 && time_s < 9e9)) {
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

static void add_frame(up_measure *m, const rlf_surface *surface)
{
    rlf_vec3 up;
    m->frames++;
    if (!rlf_surface_find_up(surface, &up)) {
        return;
    }
    m->found++;
    timing_add(&m->down, DEGREES * rlf_atan2(-up.z, -up.y));
    timing_add(&m->roll, DEGREES * rlf_atan2(up.x, -up.y));
    const true_pose *pose = nearest_pose(m, surface->time_ns);
    if (pose != NULL) {
        rlf_vec3 truth = rlf_rotate(rlf_quat_conjugate(pose->q), rlf_vec3_make(0, 0, 1));
        m->judged++;
        timing_add(&m->error, DEGREES * rlf_acos(rlf_clamp(rlf_dot(up, truth), -1.0, 1.0)));
    }
}

/* Each frame by itself: the camera may move. */
static rlf_result read_frames(rlf_source *source, int64_t frames, up_measure *m)
{
    const rlf_rig *rig = &rlf_source_get_info(source)->rig;
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, rig);
    rlf_reconstruct *stage = NULL;
    rlf_result result = rlf_reconstruct_create(&def, &stage);
    while (result >= RLF_OK && result != RLF_END && (frames < 0 || m->frames < frames) &&
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
    double value = timing_percentile(degrees, 50);
    return value > -0.05 && value < 0.05 ? 0.0 : value;
}

static void print(const char *name, const up_measure *m)
{
    printf("%s: up is found in %lld of %lld frames\n", name, (long long)m->found,
           (long long)m->frames);
    if (m->found > 0) {
        printf("the camera looks down by %.1f degrees and is rolled by %.1f (medians)\n",
               tenths(&m->down), tenths(&m->roll));
    }
    if (m->judged > 0) {
        printf("off groundtruth.txt by %.1f degrees (median; %.1f at the 95th percentile)\n",
               timing_percentile(&m->error, 50), timing_percentile(&m->error, 95));
    }
}

rlf_result measure_up_run(const char *source_name, int64_t frames)
{
    rlf_source *source = NULL;
    rlf_result result = rlf_open_source(source_name, NULL, &source);
    if (result != RLF_OK) {
        return result;
    }
    up_measure *m = rlf_alloc(sizeof(*m));
    if (rlf_source_get_info(source)->frame_count < 0 && frames < 0) {
        result = rlf_fail(RLF_ERROR_INVALID, "%s: has no end; add --frames N", source_name);
    } else {
        result = m == NULL ? RLF_ERROR_MEMORY : read_truth(source_name, m);
    }
    result = result == RLF_OK ? read_frames(source, frames, m) : result;
    if (result == RLF_OK && m->frames == 0 && !command_interrupted) {
        result = rlf_fail(RLF_ERROR_INVALID, "%s: has no frames", source_name);
    }
    if (result == RLF_OK && !command_interrupted) {
        print(source_name, m);
    }
    if (m != NULL) {
        rlf_free(m->truth);
    }
    rlf_free(m);
    rlf_source_destroy(&source);
    return result;
}
