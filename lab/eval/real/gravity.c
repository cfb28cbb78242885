/* Gravity from the first frame alone, on every clip, with the camera rolled and mirrored. */
#include "command.h"
#include "eval/measures/depth.h"
#include "eval/measures/percent.h"
#include "eval/real/clip.h"
#include "eval/real/fit.h"
#include "eval/real/parts.h"
#include "eval/real/real.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define DEGREES (180.0 / RLF_PI)
#define RIGHT_DEG 10.0 /* off by no more: bodies lie where they are put */
#define TURNS 8        /* by 0, 90, 180 and 270 degrees, and mirrored before that */

typedef struct gravity_clip {
    const char *name, *part;
    int32_t frame;
    rlf_vec3 up; /* all 0: groundtruth.txt has it */
} gravity_clip;

/* Normals of planes found by RANSAC, each looked at in a picture of its inliers. */
static const gravity_clip clips[] = {
    {"hands_toys", "gravity: hands_toys", 0, {-0.0185, -0.8660, -0.5000}}, /* the table */
    {"hands_toys", "gravity: hands_toys 80", 80, {-0.0185, -0.8660, -0.5000}},
    {"room_still", "gravity: room_still", 0, {-0.1177, -0.9730, 0.1988}},       /* the ceiling */
    {"kinect2_frame", "gravity: kinect2_frame", 0, {-0.0184, -0.9990, 0.0400}}, /* the desk */
    {"azure_frame", "gravity: azure_frame", 0, {0.0104, -0.9870, 0.1604}},      /* the table */
    {"table_hands", "gravity: table_hands", 0, {-0.1632, 0.8060, -0.5690}},     /* the table */
    {"redkitchen", "gravity: redkitchen", 0, {0.1145, -0.8750, -0.4705}},       /* table, floor */
    {"labelled/five_people", "gravity: five_people", 0, {0.0061, -0.9965, -0.0836}}, /* floor */
    {"tum_fr1_rpy", "gravity: tum_fr1_rpy 0", 0, {0, 0, 0}},
    {"tum_fr1_rpy", "gravity: tum_fr1_rpy 40", 40, {0, 0, 0}},
    {"tum_fr1_rpy", "gravity: tum_fr1_rpy 80", 80, {0, 0, 0}},
};

typedef struct gravity_try {
    rlf_vec3 up[2]; /* found: Relief, baseline */
    bool is_sure;   /* Relief says so */
} gravity_try;

typedef struct gravity_sums {
    int32_t tries, right[2], wrong_unsaid[2], unsure;
} gravity_sums;

/* Baseline: the normal of the plane with most points. */
static rlf_result take_surface(void *context, const rlf_frame *frame, const rlf_surface *s,
                               int32_t index)
{
    (void)index;
    gravity_try *t = context;
    int32_t pixels = s->width * s->height;
    float *depth = rlf_alloc_array((size_t)pixels, sizeof(float));
    if (depth == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (int32_t i = 0; i < pixels; i++) {
        depth[i] = eval_raw_depth(frame, i % s->width, i / s->width);
    }
    const real_points raw = {s->width, s->height, s->ray_x, s->ray_y, depth};
    real_plane plane;
    bool has_plane = real_plane_find(&raw, NULL, &frame->rig->noise, &plane);
    t->up[1] = has_plane ? plane.n : rlf_vec3_make(0, -1, 0);
    t->is_sure = rlf_surface_find_up(s, &t->up[0]);
    rlf_free(depth);
    return RLF_OK;
}

/* z is up in groundtruth.txt of the TUM RGB-D benchmark: the pose nearest in time. */
static bool read_true_up(const char *folder, int64_t time_ns, rlf_vec3 *out)
{
    char path[REAL_PATH_SIZE], line[512];
    FILE *file = real_join(path, folder, "groundtruth.txt") ? fopen(path, "r") : NULL;
    double best = INFINITY;
    while (file != NULL && fgets(line, sizeof(line), file) != NULL) {
        double t, p[3];
        rlf_quat q;
        if (sscanf(line, "%lf %lf %lf %lf %lf %lf %lf %lf", &t, &p[0], &p[1], &p[2], &q.x, &q.y,
                   &q.z, &q.w) == 8 &&
            fabs(t - (double)time_ns * 1e-9) < best) {
            best = fabs(t - (double)time_ns * 1e-9);
            *out = rlf_rotate(rlf_quat_conjugate(rlf_quat_normalize(q)), rlf_vec3_make(0, 0, 1));
        }
    }
    if (file != NULL) {
        (void)fclose(file);
    }
    return best < 0.05;
}

static double angle_deg(rlf_vec3 a, rlf_vec3 b)
{
    return DEGREES * rlf_acos(rlf_clamp(rlf_dot(rlf_normalize(a), rlf_normalize(b)), -1.0, 1.0));
}

static rlf_result try_turned(const real_clip *clip, rlf_vec3 up, int turn, gravity_sums *sums,
                             double out_off[2])
{
    real_clip turned;
    gravity_try t = {0};
    rlf_result result = real_clip_turn(clip, turn % 4, turn >= 4, &turned);
    if (result != RLF_OK) {
        return result;
    }
    result = real_clip_surfaces(&turned, 1, take_surface, &t);
    real_clip_free(&turned);
    if (result != RLF_OK || command_interrupted) {
        return result;
    }
    sums->tries++;
    sums->unsure += !t.is_sure;
    for (int k = 0; k < 2; k++) {
        out_off[k] = angle_deg(t.up[k], real_turn_vector(up, turn % 4, turn >= 4));
        bool is_right = out_off[k] <= RIGHT_DEG;
        sums->right[k] += is_right;
        sums->wrong_unsaid[k] += !is_right && (k == 1 || t.is_sure);
    }
    return result;
}

static void add_row(real_table *table, const char *part, const char *key, const char *title,
                    char relation, double goal, const double value[2])
{
    const real_row row = {.key = key,
                          .title = title,
                          .relation = relation,
                          .goal = goal,
                          .relief = value[0],
                          .baseline = value[1],
                          .baseline_name = "normal of the largest plane"};
    real_add(table, part, &row);
}

static rlf_result run_clip(real_table *table, const gravity_clip *c, const char *folder,
                           gravity_sums *sums)
{
    real_clip clip;
    rlf_vec3 up = c->up;
    bool is_single = strncmp(c->name, "labelled/", 9) == 0;
    rlf_result result = is_single ? real_clip_load_single(folder, &clip)
                                  : real_clip_load(folder, c->frame, 1, &clip);
    if (result != RLF_OK) {
        return result;
    }
    if (!(rlf_length(up) > 0.0) && !read_true_up(folder, clip.time_ns[0], &up)) {
        fprintf(stderr, "SKIPPED: %s tells no pose of frame %d\n", folder, (int)c->frame);
        real_clip_free(&clip);
        return RLF_OK;
    }
    double upright[2] = {NAN, NAN}, worst[2] = {0, 0};
    for (int turn = 0; turn < TURNS && result == RLF_OK && !command_interrupted; turn++) {
        double off[2] = {0, 0};
        result = try_turned(&clip, up, turn, sums, off);
        for (int k = 0; k < 2; k++) {
            upright[k] = turn == 0 ? off[k] : upright[k];
            worst[k] = rlf_max(worst[k], off[k]);
        }
    }
    real_clip_free(&clip);
    add_row(table, c->part, "up_off_deg", "up as recorded: off by, deg", '<', RIGHT_DEG, upright);
    add_row(table, c->part, "up_turned_worst_deg", "  worst of 4 turns, mirrored or not, deg", '<',
            RIGHT_DEG, worst);
    return result;
}

static void add_sums(real_table *table, const gravity_sums *s)
{
    double right[2], wrong[2], unsure[2] = {eval_percent(s->unsure, s->tries), 0.0};
    for (int k = 0; k < 2; k++) {
        right[k] = eval_percent(s->right[k], s->tries);
        wrong[k] = eval_percent(s->wrong_unsaid[k], s->tries);
    }
    add_row(table, "gravity", "up_right_percent", "up, all clips and turns: within 10 deg, %", '>',
            100.0, right);
    add_row(table, "gravity", "up_wrong_unsaid_percent", "  wrong without a warning, %", '<', 0.0,
            wrong);
    add_row(table, "gravity", "up_unsure_percent", "  not sure, and says so, %", '<', NAN, unsure);
}

rlf_result real_gravity_run(real_table *table, const real_options *options)
{
    gravity_sums sums = {0};
    rlf_result result = RLF_OK;
    for (size_t i = 0; i < sizeof(clips) / sizeof(clips[0]) && result == RLF_OK; i++) {
        char folder[REAL_PATH_SIZE];
        if (!command_interrupted && real_join(folder, options->folder, clips[i].name) &&
            real_is_there(folder)) {
            fprintf(stderr, "  %s\n", clips[i].part);
            result = run_clip(table, &clips[i], folder, &sums);
        }
    }
    if (result == RLF_OK && sums.tries > 0) {
        add_sums(table, &sums);
    }
    return result;
}
