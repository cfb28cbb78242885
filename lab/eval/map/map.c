/* The map of a room against the true one: its mesh, what is missing, what a person who left leaves
 * behind, and memory. Poses are the true ones: what a tracker adds is not measured here. */
#include "command.h"
#include "eval/map/fuser.h"
#include "eval/map/view.h"
#include "eval/sections.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    FRAMES = 60,        /* of the whole path */
    WITH_PERSON = 20,   /* frames with the person in view, before he is gone */
    AFTER_PERSON = 150, /* frames of the empty room then */
    SPACING = 7,        /* pixels between those that are looked at for what is missing */
    LOOKS = 6,          /* views for that */
    MIN_WEIGHT = 32,    /* as `relief run --mesh` */
    PERSON_POINTS = 4096
};

#define TRUE_M 0.01 /* a surface this near is there */

static const char *const scene = "map";

typedef struct map_run {
    map_camera camera;
    fuser fuser;
} map_run;

static rlf_result open_run(map_run *run, const char *source, double time_s, int64_t seed)
{
    memset(run, 0, sizeof(*run));
    const fuser_options options = {0};
    rlf_result result = map_camera_open(&run->camera, source, time_s, seed);
    return result == RLF_OK ? fuser_open(&run->fuser, &run->camera.rig, &options, NULL) : result;
}

static void close_run(map_run *run)
{
    fuser_close(&run->fuser);
    map_camera_close(&run->camera);
}

static rlf_result fuse_one(map_run *run, map_camera *camera, int32_t i)
{
    rlf_result result = map_camera_look(camera, i);
    if (result != RLF_OK || command_interrupted) {
        return command_interrupted ? RLF_END : result;
    }
    return fuser_add(&run->fuser, &camera->frame, &camera->T_world_camera, NULL);
}

static void add(eval_table *table, const char *key, const char *title, double value)
{
    eval_table_add(table, scene, key, title, RLF_PROFILE_LIVE, value);
}

/* Distance of the mesh's corners from the true room. */
static rlf_result measure_mesh(map_run *run, eval_table *table)
{
    rlf_map_mesh mesh;
    rlf_result result = rlf_map_mesh_create(run->fuser.map, MIN_WEIGHT, &mesh);
    double sum = 0.0, near = 0.0, count = 0.0;
    for (size_t i = 0; result == RLF_OK && i < mesh.vertex_count; i += 11) {
        const float *p = &mesh.position[3 * i];
        double distance;
        rlf_vec3 normal;
        int32_t label;
        result = rlf_synthetic_distance(run->camera.source,
                                        rlf_vec3_make((double)p[0], (double)p[1], (double)p[2]),
                                        &distance, &normal, &label);
        sum += fabs(distance);
        near += fabs(distance) < TRUE_M ? 1.0 : 0.0;
        count += 1.0;
    }
    rlf_map_mesh_destroy(&mesh);
    add(table, "mesh_mean", "fused mesh, distance from the true room, mean, mm",
        1000.0 * sum / count);
    add(table, "mesh_within", "  within 1 cm, %", 100.0 * near / count);
    return result;
}

static bool is_there(const rlf_map *map, rlf_vec3 p)
{
    const rlf_map_point s = rlf_map_sample(map, p);
    return s.state != RLF_MAP_UNKNOWN && fabs(s.distance) < TRUE_M;
}

/* Share of what the camera saw that the map has. */
static rlf_result measure_missing(map_run *run, eval_table *table)
{
    double seen = 0.0, found = 0.0;
    rlf_result result = RLF_OK;
    for (int32_t look = 0; look < LOOKS && result == RLF_OK; look++) {
        result = map_camera_look(&run->camera, 5 + look * (FRAMES - 10) / LOOKS);
        const int32_t n = run->camera.rig.depth.width * run->camera.rig.depth.height;
        for (int32_t i = 0; i < n && result == RLF_OK; i += SPACING) {
            rlf_vec3 p;
            if (map_camera_point(&run->camera, i, &p)) {
                seen += 1.0;
                found += is_there(run->fuser.map, p) ? 1.0 : 0.0;
            }
        }
    }
    add(table, "present", "  of what was seen present within 1 cm, %", 100.0 * found / seen);
    return result;
}

static rlf_result run_room(eval_table *table, int64_t seed)
{
    map_run *run = rlf_alloc(sizeof(*run));
    if (run == NULL) {
        return RLF_ERROR_MEMORY;
    }
    rlf_result result = open_run(run, "synthetic:empty?color=0", 0.0, seed);
    for (int32_t i = 0; i < FRAMES && result == RLF_OK; i++) {
        result = fuse_one(run, &run->camera, i);
    }
    if (result == RLF_OK) {
        result = measure_mesh(run, table);
    }
    if (result == RLF_OK) {
        result = measure_missing(run, table);
    }
    if (result == RLF_OK) {
        const rlf_map_status s = rlf_map_get_status(run->fuser.map);
        add(table, "memory", "  memory of the map, MB", (double)s.bytes * 1e-6);
    }
    close_run(run);
    rlf_free(run);
    return result;
}

/* Points on the person, as the frames with him show him. */
typedef struct person_points {
    rlf_vec3 at[PERSON_POINTS], way[PERSON_POINTS]; /* way: the ray's, unit */
    int32_t count;
} person_points;

static void take_points(const map_camera *camera, person_points *points)
{
    const int32_t n = camera->rig.depth.width * camera->rig.depth.height;
    for (int32_t i = 0; i < n && points->count < PERSON_POINTS; i += 3 * SPACING) {
        rlf_vec3 p;
        if (camera->label[i] == RLF_SYNTHETIC_LABEL_PERSON && map_camera_point(camera, i, &p)) {
            points->way[points->count] = rlf_normalize(camera->ways[i]);
            points->at[points->count++] = p;
        }
    }
}

/* Whether there is matter right behind a point. */
static bool is_solid(const rlf_map *map, const person_points *points, int32_t i)
{
    const rlf_vec3 behind = rlf_mad(points->at[i], points->way[i], TRUE_M);
    return rlf_map_sample(map, behind).state == RLF_MAP_INSIDE;
}

static double share_left(const rlf_map *map, const person_points *points, const map_camera *empty)
{
    double left = 0.0, count = 0.0;
    for (int32_t i = 0; i < points->count; i++) {
        double distance = 1.0;
        rlf_vec3 normal;
        int32_t label;
        (void)rlf_synthetic_distance(empty->source, points->at[i], &distance, &normal, &label);
        if (distance > 2.0 * TRUE_M) { /* his soles stood on what is really there */
            left += is_solid(map, points, i) ? 1.0 : 0.0;
            count += 1.0;
        }
    }
    return 100.0 * left / count;
}

/* The hard case: he stands there from the first frame on, so that nothing can tell him from the
 * room, and then goes. */
static rlf_result run_person(eval_table *table, int64_t seed)
{
    map_run *run = rlf_alloc(sizeof(*run));
    person_points *points = rlf_alloc(sizeof(*points));
    map_camera empty = {0};
    rlf_result result = run != NULL && points != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    if (result == RLF_OK) {
        result = open_run(run, "synthetic:room?color=0", 3.0, seed);
    }
    if (result == RLF_OK) {
        result = map_camera_open(&empty, "synthetic:empty?color=0", 0.0, seed + 1000);
    }
    for (int32_t i = 0; i < WITH_PERSON && result == RLF_OK; i++) {
        result = fuse_one(run, &run->camera, i);
        if (result == RLF_OK) {
            take_points(&run->camera, points);
        }
    }
    if (result == RLF_OK) {
        add(table, "person_before", "person fused, of his surface in the map, %",
            share_left(run->fuser.map, points, &empty));
    }
    for (int32_t i = 0; i < AFTER_PERSON && result == RLF_OK; i++) {
        result = fuse_one(run, &empty, WITH_PERSON + i);
    }
    if (result == RLF_OK) {
        add(table, "person_left", "  left five seconds after he has gone, %",
            share_left(run->fuser.map, points, &empty));
    }
    map_camera_close(&empty);
    if (run != NULL) {
        close_run(run);
    }
    rlf_free(run);
    rlf_free(points);
    return result;
}

rlf_result eval_map_run(eval_table *table, int64_t seed, int profile_mask)
{
    if ((profile_mask & 1 << RLF_PROFILE_LIVE) == 0) {
        return RLF_OK;
    }
    rlf_result result = run_room(table, seed);
    return result == RLF_OK ? run_person(table, seed) : result;
}
