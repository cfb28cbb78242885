/* What a frame of a moving camera costs, and the memory of a room: someone walks round a furnished
 * room of 5 x 5 x 3 m, looking everywhere, and round again. CPU time of one thread. */
#define _POSIX_C_SOURCE 200809L
#include "command.h"
#include "eval/analytic.h"
#include "eval/sections.h"

#include "relief/io.h"
#include "relief/map.h"
#include "relief/track.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

enum {
    LOOP = 100,   /* frames, five a second */
    MINUTE = 300, /* frames */
    MINUTES = 3,
    NOISE = 4093, /* a prime: it does not repeat with the rows */
    BOXES = 7
};

/* The tracker starts from where a camera of 30 Hz was a frame ago. */
#define BETWEEN (1.0 / 6.0)

typedef enum series { ALIGN, INTEGRATE, PREDICT, SUM, SERIES } series;

/* x right, y down, z forward, metres. The first is the room, seen from within. */
static const rlf_aabb boxes[BOXES] = {
    {{-2.5, -1.6, -2.5}, {2.5, 1.4, 2.5}},  {{-2.5, -0.6, 1.2}, {-1.9, 1.4, 2.5}},
    {{0.4, 0.65, 1.4}, {2.0, 0.7, 2.2}},    {{1.2, 0.9, -2.5}, {2.5, 1.4, -0.5}},
    {{-2.5, 0.95, -2.0}, {-1.7, 1.4, 0.2}}, {{-1.0, -1.0, 2.35}, {0.2, 1.4, 2.5}},
    {{-0.9, 0.3, -2.3}, {-0.4, 1.4, -1.8}},
};

typedef struct walk {
    rlf_source *source; /* of the rig only */
    rlf_rig rig;
    rlf_camera small; /* that is predicted for */
    rlf_map *map;
    rlf_tracker *tracker;
    float *depth, *normal[3];
    uint8_t *grey, *rgba;
    float noise[NOISE];
    uint32_t noise_at;
    double *ms[SERIES];
    int32_t count, lost;
} walk;

static double cpu_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

/* Round the middle of the room, up and down, once round each loop and twice about oneself. */
static rlf_pose pose_at(double frame)
{
    const double t = 2.0 * RLF_PI * frame / LOOP;
    const rlf_quat yaw = rlf_quat_from_rotation_vector(rlf_vec3_make(0, 2.0 * t, 0));
    const rlf_quat pitch =
        rlf_quat_from_rotation_vector(rlf_vec3_make(0.6 * rlf_sin(5.0 * t), 0, 0));
    return (rlf_pose){.p = {rlf_sin(t), 0.2 * rlf_sin(3.0 * t), -rlf_cos(t)},
                      .q = rlf_quat_mul(yaw, pitch)};
}

/* Where a line enters a box, or leaves the room; the axis of that face. */
static double meet(const rlf_aabb *box, const double p[3], const double inverse[3], bool is_room,
                   int32_t *axis)
{
    const double low[3] = {box->min.x, box->min.y, box->min.z};
    const double high[3] = {box->max.x, box->max.y, box->max.z};
    double in = 0.0, out = 1e9;
    int32_t in_axis = 0, out_axis = 0;
    for (int32_t k = 0; k < 3; k++) {
        const double a = (low[k] - p[k]) * inverse[k], b = (high[k] - p[k]) * inverse[k];
        const double first = rlf_min(a, b), last = rlf_max(a, b);
        in_axis = first > in ? k : in_axis;
        in = rlf_max(in, first);
        out_axis = last < out ? k : out_axis;
        out = rlf_min(out, last);
    }
    *axis = is_room ? out_axis : in_axis;
    return is_room ? out : (in < out && in > 0.0 ? in : 1e9);
}

static void see_pixel(walk *w, const rlf_mat3 *R, rlf_vec3 eye, int32_t i)
{
    const rlf_camera *c = &w->rig.depth;
    rlf_vec3 ray;
    (void)rlf_camera_unproject(c, i % c->width, i / c->width, &ray);
    const rlf_vec3 v = rlf_mat3_mul_vec(R, ray);
    const double p[3] = {eye.x, eye.y, eye.z}, way[3] = {v.x, v.y, v.z};
    double z = 1e9, inverse[3];
    for (int32_t k = 0; k < 3; k++) {
        inverse[k] = 1.0 / (way[k] * way[k] > 1e-18 ? way[k] : 1e-9);
    }
    int32_t axis = 0;
    for (int32_t k = 0; k < BOXES; k++) {
        int32_t its_axis;
        const double its = meet(&boxes[k], p, inverse, k == 0, &its_axis);
        axis = its < z ? its_axis : axis;
        z = rlf_min(its, z);
    }
    const double sign = way[axis] > 0.0 ? -1.0 : 1.0;
    for (int32_t k = 0; k < 3; k++) { /* a row of R: the axis in the camera's frame */
        w->normal[k][i] = (float)(sign * R->m[axis][k]);
    }
    w->noise_at = w->noise_at * 1664525u + 1013904223u;
    const double sigma = rlf_depth_noise_sigma(&w->rig.noise, z);
    const bool is_seen = z > w->rig.depth_min_m && z < w->rig.depth_max_m;
    w->depth[i] = is_seen ? (float)(z + sigma * (double)w->noise[(w->noise_at >> 8) % NOISE]) : 0;
    /* Tiles of a fifth of a metre. */
    int32_t tile = 0;
    for (int32_t k = 0; k < 3; k++) {
        tile += (int32_t)(5.0 * (p[k] + z * way[k]) + 100.01);
    }
    const uint8_t grey = (tile & 1) != 0 ? 90 : 160;
    w->grey[i] = grey;
    memset(&w->rgba[4 * (size_t)i], grey, 3);
    w->rgba[4 * (size_t)i + 3] = 255;
}

static rlf_result step(walk *w, int32_t i)
{
    const rlf_pose T = pose_at(i % LOOP), start = pose_at(i % LOOP - BETWEEN);
    const rlf_mat3 R = rlf_quat_to_mat3(T.q);
    const int32_t n = w->rig.depth.width * w->rig.depth.height;
    for (int32_t k = 0; k < n; k++) {
        see_pixel(w, &R, T.p, k);
    }
    const rlf_track_view seen = {.depth = w->depth, .grey = w->grey};
    const rlf_map_view view = {.depth = w->depth,
                               .normal_x = w->normal[0],
                               .normal_y = w->normal[1],
                               .normal_z = w->normal[2],
                               .rgba = w->rgba};
    rlf_prediction prediction;
    rlf_track_result found;
    const double t0 = cpu_ms();
    rlf_result result = rlf_map_predict(w->map, &w->small, &start, &prediction);
    const double t1 = cpu_ms();
    if (result == RLF_OK) {
        result = rlf_tracker_align(w->tracker, &seen, &prediction, &start, &found);
    }
    const double t2 = cpu_ms();
    if (result == RLF_OK) {
        result = rlf_map_integrate(w->map, &view, &T, NULL);
    }
    const double t3 = cpu_ms();
    w->ms[PREDICT][w->count] = t1 - t0;
    w->ms[ALIGN][w->count] = t2 - t1;
    w->ms[INTEGRATE][w->count] = t3 - t2;
    w->ms[SUM][w->count++] = t3 - t0;
    w->lost += i > 0 && result == RLF_OK && found.health == RLF_TRACK_LOST;
    return result;
}

static rlf_result open_walk(walk *w, int64_t seed)
{
    rlf_result result = rlf_open_source("synthetic:empty?color=0", NULL, &w->source);
    if (result != RLF_OK) {
        return result;
    }
    w->rig = rlf_source_get_info(w->source)->rig;
    w->small = rlf_camera_decimate(&w->rig.depth, 4);
    rlf_map_def map = rlf_map_def_default();
    rlf_tracker_def tracker = rlf_tracker_def_default();
    map.rig = tracker.rig = w->rig;
    result = rlf_map_create(&map, &w->map);
    if (result == RLF_OK) {
        result = rlf_tracker_create(&tracker, &w->tracker);
    }
    const size_t n = (size_t)w->rig.depth.width * (size_t)w->rig.depth.height;
    w->depth = rlf_alloc_array(n, sizeof(float));
    w->grey = rlf_alloc_array(n, 1);
    w->rgba = rlf_alloc_array(n, 4);
    bool is_whole = w->depth != NULL && w->grey != NULL && w->rgba != NULL;
    for (int32_t k = 0; k < 3; k++) {
        w->normal[k] = rlf_alloc_array(n, sizeof(float));
        is_whole = is_whole && w->normal[k] != NULL;
    }
    for (int32_t k = 0; k < SERIES; k++) {
        w->ms[k] = rlf_alloc_array((size_t)MINUTE * MINUTES, sizeof(double));
        is_whole = is_whole && w->ms[k] != NULL;
    }
    eval_random random = eval_random_start((uint64_t)seed);
    for (int32_t k = 0; k < NOISE; k++) {
        w->noise[k] = (float)eval_random_normal(&random);
    }
    return result == RLF_OK && !is_whole ? RLF_ERROR_MEMORY : result;
}

static void close_walk(walk *w)
{
    rlf_map_destroy(&w->map);
    rlf_tracker_destroy(&w->tracker);
    rlf_source_destroy(&w->source);
    for (int32_t k = 0; k < 3; k++) {
        rlf_free(w->normal[k]);
    }
    for (int32_t k = 0; k < SERIES; k++) {
        rlf_free(w->ms[k]);
    }
    rlf_free(w->depth);
    rlf_free(w->grey);
    rlf_free(w->rgba);
    rlf_free(w);
}

static int by_value(const void *a, const void *b)
{
    const double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

static void add(eval_table *table, const char *key, const char *title, double value)
{
    eval_table_add(table, "map_cost", key, title, RLF_PROFILE_LIVE, value);
}

static void add_times(walk *w, eval_table *table)
{
    static const char *const keys[SERIES] = {"align", "integrate", "predict", "frame"};
    static const char *const titles[SERIES] = {
        "align a frame, one core, CPU, median, ms", "  integrate, CPU, median, ms",
        "  predict at a quarter, CPU, median, ms", "  all three, CPU, median, ms"};
    for (int32_t k = 0; k < SERIES && w->count > 0; k++) {
        qsort(w->ms[k], (size_t)w->count, sizeof(double), by_value);
        add(table, keys[k], titles[k], w->ms[k][w->count / 2]);
    }
    add(table, "lost", "  frames lost, %", 100.0 * w->lost / (w->count > 0 ? w->count : 1));
}

rlf_result eval_map_cost_run(eval_table *table, int64_t seed, int profile_mask)
{
    walk *w = rlf_alloc(sizeof(*w));
    if (w == NULL) {
        return RLF_ERROR_MEMORY;
    }
    (void)profile_mask; /* a map does not depend on it */
    rlf_result result = open_walk(w, seed);
    for (int32_t i = 0; i < MINUTE * MINUTES && result == RLF_OK; i++) {
        result = command_interrupted ? RLF_END : step(w, i);
        const rlf_map_status s = rlf_map_get_status(w->map);
        if (i + 1 == MINUTE) {
            add(table, "blocks_first", "  blocks after one minute", s.block_count);
        }
        if (i + 1 == MINUTE * MINUTES) {
            add(table, "blocks_last", "  blocks after three", s.block_count);
            add(table, "memory_walk", "  memory of the map then, MB", 1e-6 * (double)s.bytes);
        }
    }
    if (result == RLF_OK) {
        add_times(w, table);
    }
    close_walk(w);
    return result;
}
