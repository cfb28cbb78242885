/* Whether cameras of one room stand where their list says: the first one's surfaces are fused, and
 * each other camera's are aligned with them, point to plane. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "calibrate/calibrate.h"

#include "command.h"
#include "json_file.h"
#include "relief/io.h"
#include "relief/map.h"
#include "relief/reconstruct.h"
#include "relief/track.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEGREES (180.0 / RLF_PI)
#define FRAMES 20       /* of each camera: noise is averaged, and who walks by does not count */
#define ROUNDS 20       /* of an alignment: a way that little determines is gone slowly */
#define STARTS 5        /* more to each side, */
#define START_M 0.03    /* so far apart */
#define VOXEL_M 0.01    /* of the first one's room */
#define REACH_M 3.0     /* where a turn of the camera counts as much as a shift of it */
#define SHARED_MIN 0.05 /* of a camera's pixels must show what the first one sees, too */
#define MEMORY_MB 512
#define FAR_M 0.3        /* more than the room can correct: what it finds there is another place */
#define OVERLAP_MIN 0.85 /* of what both see lies on each other once the pose is right */
#define OFF_M 0.02       /* surfaces of two cameras that lie further apart are two */

/* How far a camera is from where its list says. */
typedef struct camera_check {
    rlf_pose T_world_camera; /* as found; as listed where nothing is known */
    bool is_enough;          /* of what the first one sees, too */
    bool is_known;           /* and that determines the pose in all ways */
    bool is_far;             /* no pose near the list's fits */
    double overlap;          /* share of those that lie on each other, 0..1 */
    double shared;           /* of its pixels show what the first one sees, 0..1 */
    double shift_m, turn;    /* from the list's pose; radians */
} camera_check;

/* A camera that is looked through. */
typedef struct eye {
    rlf_source *source;
    rlf_reconstruct *stage;
    const rlf_surface *surface;
} eye;

static void close_eye(eye *e)
{
    rlf_reconstruct_destroy(&e->stage);
    rlf_source_destroy(&e->source);
}

static rlf_result open_eye(const char *name, rlf_rig *out_rig, eye *e)
{
    *e = (eye){.source = NULL};
    rlf_result result = rlf_open_source(name, NULL, &e->source);
    if (result == RLF_OK) {
        *out_rig = rlf_source_get_info(e->source)->rig;
        rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, out_rig);
        def.scale_factor = 1;
        result = rlf_reconstruct_create(&def, &e->stage);
    }
    return result;
}

/* The surface of the next frame; RLF_END after the last. */
static rlf_result look(eye *e)
{
    rlf_frame frame;
    rlf_result result = RLF_NO_FRAME;
    while (result == RLF_NO_FRAME && !command_interrupted) {
        result = rlf_source_next(e->source, &frame);
    }
    return result == RLF_OK ? rlf_reconstruct_process(e->stage, &frame, &e->surface) : result;
}

static rlf_result fuse_first(const rlf_placed_camera *first, rlf_rig *out_rig, rlf_map **out)
{
    eye e;
    rlf_map_def def = rlf_map_def_default();
    def.voxel_m = VOXEL_M;
    def.memory_mb = MEMORY_MB;
    def.blocks_per_frame = 0;
    rlf_result result = open_eye(first->source, out_rig, &e);
    if (result == RLF_OK) {
        def.rig = *out_rig;
        result = rlf_map_create(&def, out);
    }
    for (int k = 0; k < FRAMES && result == RLF_OK; k++) {
        result = look(&e);
        if (result == RLF_OK) {
            const rlf_map_view view = {.depth = e.surface->depth,
                                       .normal_x = e.surface->normal_x,
                                       .normal_y = e.surface->normal_y,
                                       .normal_z = e.surface->normal_z};
            result = rlf_map_integrate(*out, &view, &first->T_world_camera, NULL);
        }
    }
    close_eye(&e);
    return result == RLF_END ? RLF_OK : result;
}

/* Marks what both may see: pixels at which the first one's room is predicted, too. Returns their
 * share of the picture. */
static double mark_shared(const rlf_prediction *room, const rlf_surface *surface, uint8_t *shared)
{
    const int32_t factor = surface->width / room->camera.width;
    int64_t count = 0;
    for (int32_t y = 0; y < surface->height; y++) {
        for (int32_t x = 0; x < surface->width; x++) {
            const int32_t u = x / factor, v = y / factor;
            const bool is_in = u < room->camera.width && v < room->camera.height;
            const bool is_known = is_in && room->depth[v * room->camera.width + u] > 0.0F;
            shared[(ptrdiff_t)y * surface->width + x] = is_known;
            count += is_known;
        }
    }
    return (double)count / ((double)surface->width * surface->height);
}

/* A surface that is aligned with the first camera's room. */
typedef struct aligner {
    rlf_map *room;
    rlf_tracker *tracker;
    rlf_camera camera; /* that the room is predicted for */
    const rlf_surface *surface;
    uint8_t *shared; /* of the surface's pixels, see mark_shared */
    double share;
} aligner;

/* Aligns again and again from `start`. */
static rlf_result follow(aligner *a, rlf_pose start, rlf_track_result *found)
{
    rlf_result result = RLF_OK;
    *found = (rlf_track_result){.T_world_camera = start};
    for (int k = 0; k < ROUNDS && result == RLF_OK; k++) {
        rlf_prediction predicted;
        result = rlf_map_predict(a->room, &a->camera, &found->T_world_camera, &predicted);
        if (result == RLF_OK) {
            a->share = mark_shared(&predicted, a->surface, a->shared);
            const rlf_track_view view = {.depth = a->surface->depth, .is_static = a->shared};
            result =
                rlf_tracker_align(a->tracker, &view, &predicted, &found->T_world_camera, found);
        }
    }
    return result;
}

/* A robust fit may take the few points that determine a way, such as a narrow side wall, for
 * outliers: other starts along the way that is determined least tell whether more of them fit. */
static rlf_result align(aligner *a, rlf_pose start, rlf_track_result *best)
{
    rlf_result result = follow(a, start, best);
    const rlf_track_result first = *best;
    for (int k = -STARTS; k < STARTS && result == RLF_OK; k++) {
        rlf_pose other = first.T_world_camera;
        rlf_track_result found;
        other.p = rlf_mad(other.p, first.weak_way, START_M * (k < 0 ? k : k + 1));
        result = follow(a, other, &found);
        if (result == RLF_OK && found.overlap > best->overlap) {
            *best = found;
        }
    }
    return result;
}

/* A room is predicted for pictures no larger than those that it was made of. */
static int32_t shrink_of(const rlf_camera *camera, const rlf_camera *first)
{
    int32_t factor = 2; /* the tracker looks at every fourth pixel */
    while (camera->width / factor > first->width || camera->height / factor > first->height) {
        factor++;
    }
    return factor;
}

static rlf_result find_place(rlf_map *room, const rlf_rig *first_rig, eye *e, const rlf_rig *rig,
                             camera_check *out)
{
    rlf_tracker_def def = rlf_tracker_def_default();
    def.rig = *rig;
    aligner a = {.room = room,
                 .camera =
                     rlf_camera_decimate(&rig->depth, shrink_of(&rig->depth, &first_rig->depth)),
                 .shared = rlf_alloc((size_t)rig->depth.width * (size_t)rig->depth.height)};
    rlf_track_result found = {.T_world_camera = out->T_world_camera};
    rlf_result result = a.shared != NULL ? rlf_tracker_create(&def, &a.tracker) : RLF_ERROR_MEMORY;
    for (int k = 0; k < FRAMES && result == RLF_OK; k++) {
        result = look(e);
    }
    a.surface = e->surface;
    if ((result == RLF_OK || result == RLF_END) && a.surface != NULL) {
        result = align(&a, out->T_world_camera, &found);
    }
    out->shared = a.share;
    out->overlap = found.overlap;
    out->is_enough = found.health != RLF_TRACK_LOST && a.share >= SHARED_MIN;
    out->is_known = out->is_enough && found.health == RLF_TRACK_GOOD;
    if (out->is_known) {
        out->T_world_camera = found.T_world_camera;
    }
    rlf_free(a.shared);
    rlf_tracker_destroy(&a.tracker);
    return result == RLF_END ? RLF_OK : result;
}

/* How far the found pose is from the list's. Of one that is far away nothing is believed. */
static void compare(const rlf_pose *listed, camera_check *c)
{
    const rlf_pose T_listed_world = rlf_pose_invert(listed);
    const rlf_pose moved = rlf_pose_mul(&T_listed_world, &c->T_world_camera);
    const rlf_vec3 axis = {moved.q.x, moved.q.y, moved.q.z};
    c->shift_m = rlf_length(moved.p);
    c->turn = 2.0 * rlf_atan2(rlf_length(axis), fabs(moved.q.w));
    c->is_far = c->is_known && (c->overlap < OVERLAP_MIN || c->shift_m + REACH_M * c->turn > FAR_M);
    if (c->is_far) {
        c->T_world_camera = *listed;
    }
}

static rlf_result check_one(const rlf_placed_camera *camera, rlf_map *room,
                            const rlf_rig *first_rig, camera_check *out)
{
    eye e;
    rlf_rig rig;
    *out = (camera_check){.T_world_camera = camera->T_world_camera};
    rlf_result result = open_eye(camera->source, &rig, &e);
    result = result == RLF_OK ? find_place(room, first_rig, &e, &rig, out) : result;
    close_eye(&e);
    compare(&camera->T_world_camera, out);
    return result;
}

static bool is_off(const camera_check *c)
{
    return c->is_far || (c->is_known && c->shift_m + REACH_M * c->turn > OFF_M);
}

static void print_one(int32_t index, const camera_check *c)
{
    printf("camera %d  ", (int)index);
    if (c->is_far) {
        printf(
            "off: no pose near the listed one lays what both see on each other: find it with the "
            "chessboard\n");
        return;
    }
    if (!c->is_known) {
        printf("cannot be told: %s (%.0f %% of its picture shows what the first one sees)\n",
               c->is_enough ? "what both see leaves a way open, such as along a wall"
                            : "both see too little of the same",
               100.0 * c->shared);
        return;
    }
    printf("%s: by %.1f mm and %.2f degrees (%.0f %% of its picture shows what the first one "
           "sees)\n",
           is_off(c) ? "off" : "holds", 1e3 * c->shift_m, DEGREES * c->turn, 100.0 * c->shared);
}

/* A file's whole path: a list may be written elsewhere. */
static json_t *source_json(const char *source)
{
    char *whole = strchr(source, ':') == NULL ? realpath(source, NULL) : NULL;
    json_t *text = json_string(whole != NULL ? whole : source);
    free(whole);
    return text;
}

static rlf_result write_list(const char *path, const rlf_placed_camera *cameras, int32_t count)
{
    json_t *list = json_array();
    for (int32_t k = 0; k < count; k++) {
        const rlf_pose *T = &cameras[k].T_world_camera;
        json_array_append_new(list,
                              json_pack("{s:o, s:[f,f,f], s:[f,f,f,f]}", "source",
                                        source_json(cameras[k].source), "position", T->p.x, T->p.y,
                                        T->p.z, "orientation", T->q.x, T->q.y, T->q.z, T->q.w));
    }
    return json_file_write(path, json_pack("{s:s, s:o}", "about",
                                           "relief calibrate --check: poses by the room", "cameras",
                                           list));
}

rlf_result calibrate_check_cameras(const char *list, const char *out_path, bool *out_is_off)
{
    static rlf_placed_camera cameras[RLF_WORLD_CAMERAS_MAX];
    int32_t count;
    rlf_map *room = NULL;
    rlf_rig first_rig;
    rlf_result result = rlf_cameras_load(list, cameras, &count);
    *out_is_off = false;
    if (result == RLF_OK && count < 2) {
        result = rlf_fail(RLF_ERROR_INVALID,
                          "%s: lists one camera: there is none to compare it with", list);
    }
    if (result == RLF_OK && out_path != NULL) {
        result = rlf_file_check(out_path);
    }
    if (result == RLF_OK) {
        result = fuse_first(&cameras[0], &first_rig, &room);
    }
    for (int32_t k = 1; k < count && result == RLF_OK && !command_interrupted; k++) {
        camera_check check;
        result = check_one(&cameras[k], room, &first_rig, &check);
        if (result == RLF_OK) {
            print_one(k, &check);
            *out_is_off = *out_is_off || is_off(&check);
            cameras[k].T_world_camera = check.T_world_camera;
        }
    }
    rlf_map_destroy(&room);
    return result == RLF_OK && out_path != NULL && !command_interrupted
               ? write_list(out_path, cameras, count)
               : result;
}
