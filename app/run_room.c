/* Counts, files, and the words for what went wrong. */
#include "run.h"

#include "command.h"

/* Voxels with less weight are noise: 32 is two near frames, or as many far ones. A short clip
 * cannot have so much of what is far away: there a quarter of its frames must have seen it. */
#define MIN_WEIGHT_MOST 32
#define MIN_WEIGHT_SHARE 4

static bool is_kept(const run_room_options *o)
{
    return o->mesh_path != NULL || o->map_path != NULL;
}

rlf_result run_room_check(const run_room_options *o)
{
    rlf_result result = o->mesh_path != NULL ? rlf_file_check(o->mesh_path) : RLF_OK;
    return result == RLF_OK && o->map_path != NULL ? rlf_file_check(o->map_path) : result;
}

static void count_pixels(run_room *room, const rlf_surface *s)
{
    for (int32_t i = 0; i < s->width * s->height; i++) {
        const bool is_near = s->reason[i] == RLF_REASON_TOO_NEAR;
        const bool is_far = s->reason[i] == RLF_REASON_TOO_FAR;
        room->near_pixels += is_near;
        room->far_pixels += is_far;
        room->lost_pixels += !is_near && !is_far;
    }
    room->whole_pixels += s->valid_count;
}

rlf_result run_room_add(run_room *room, const run_room_options *o, const rlf_pipeline_output *frame)
{
    if (!is_kept(o)) {
        return RLF_OK;
    }
    room->seen++;
    room->with_pose += frame->frame.has_pose;
    if (room->whole_pixels == 0) {
        count_pixels(room, frame->surface);
    }
    if (frame->track == NULL || frame->track->health == RLF_TRACK_LOST) {
        return RLF_OK;
    }
    room->placed++;
    return trajectory_add(&room->way, frame->frame.time_ns, &frame->T_world_camera,
                          frame->frame.has_pose ? &frame->frame.T_world_camera : NULL);
}

/* ---- why there is none ---------------------------------------------------------------------- */

static double percent(int64_t part, int64_t whole)
{
    return whole > 0 ? 100.0 * (double)part / (double)whole : 0.0;
}

/* No pixel of any frame had depth. */
static rlf_result fail_depth(const run_room *room, const run_room_options *o, const rlf_rig *rig)
{
    const int64_t all = room->near_pixels + room->far_pixels + room->lost_pixels;
    return rlf_fail(RLF_ERROR_INVALID,
                    "%s: no depth from %g to %g m in %lld frames: %.0f %% of the pixels are "
                    "nearer, %.0f %% farther, %.0f %% have none; are units_per_metre, depth_min_m "
                    "and depth_max_m of the camera right?",
                    o->source, rig->depth_min_m, rig->depth_max_m, (long long)room->seen,
                    percent(room->near_pixels, all), percent(room->far_pixels, all),
                    percent(room->lost_pixels, all));
}

static rlf_result check_room(const run_room *room, const run_room_options *o, const rlf_map *map,
                             const rlf_rig *rig)
{
    const long long seen = (long long)room->seen;
    if (room->placed == 0 && o->has_source_poses) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: none of %lld frames has a pose that can be used: --camera source "
                        "needs a groundtruth.txt, --camera moving does not",
                        o->source, seen);
    }
    if (room->whole_pixels == 0) {
        return fail_depth(room, o, rig);
    }
    if (map == NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "--save-map and --mesh: the camera has not moved, so "
                                           "there is no map; add --camera moving");
    }
    if (room->placed == 0) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: the camera's place was found in none of %lld frames: too few pixels "
                        "have depth, or it has not moved (--camera moving)",
                        o->source, seen);
    }
    return rlf_map_get_status(map).block_count > 0
               ? RLF_OK
               : rlf_fail(RLF_ERROR_INVALID,
                          "%s: no surface in %lld frames: the depth is too sparse, or seen too "
                          "aslant",
                          o->source, (long long)room->placed);
}

/* ---- the mesh ------------------------------------------------------------------------------- */

/* The greatest weight that leaves a triangle; 0 = none does. */
static int32_t most_weight(const rlf_map *map, int32_t below)
{
    int32_t low = 0, high = below;
    while (high - low > 1) {
        const int32_t middle = (low + high) / 2;
        rlf_map_mesh mesh;
        const bool is_made = rlf_map_mesh_create(map, middle, &mesh) == RLF_OK;
        const bool has_some = is_made && mesh.triangle_count > 0;
        low = has_some ? middle : low;
        high = has_some ? high : middle;
        if (is_made) {
            rlf_map_mesh_destroy(&mesh);
        }
    }
    return low;
}

static rlf_result fail_mesh(const run_room *room, const run_room_options *o, const rlf_map *map)
{
    const int32_t most = most_weight(map, room->min_weight);
    return most > 0 ? rlf_fail(RLF_ERROR_INVALID,
                               "%s: nothing in %lld frames was seen often enough for weight=%d: "
                               "with %d or less there is a mesh",
                               o->source, (long long)room->placed, (int)room->min_weight, (int)most)
                    : rlf_fail(RLF_ERROR_INVALID,
                               "%s: no mesh in %lld frames: what has depth is smaller than the "
                               "voxels of %g mm (voxel=MM)",
                               o->source, (long long)room->placed,
                               1000.0 * rlf_map_get_status(map).voxel_m);
}

static int32_t usual_weight(int64_t frames)
{
    const int64_t share = frames / MIN_WEIGHT_SHARE;
    return share > MIN_WEIGHT_MOST ? MIN_WEIGHT_MOST : (share > 1 ? (int32_t)share : 1);
}

static rlf_result write_mesh(run_room *room, const run_room_options *o, const rlf_map *map)
{
    room->min_weight = o->min_weight > 0 ? o->min_weight : usual_weight(room->placed);
    rlf_map_mesh mesh;
    rlf_result result = rlf_map_mesh_create(map, room->min_weight, &mesh);
    if (result != RLF_OK) {
        return result;
    }
    room->vertex_count = mesh.vertex_count;
    room->triangle_count = mesh.triangle_count;
    result =
        mesh.triangle_count > 0 ? rlf_map_mesh_write(o->mesh_path, &mesh) : fail_mesh(room, o, map);
    rlf_map_mesh_destroy(&mesh);
    return result;
}

rlf_result run_room_write(run_room *room, const run_room_options *o, const rlf_map *map,
                          const rlf_rig *rig)
{
    if (!is_kept(o) || (command_interrupted && room->placed == 0)) {
        return RLF_OK;
    }
    rlf_result result = check_room(room, o, map, rig);
    if (result == RLF_OK && o->mesh_path != NULL) {
        result = write_mesh(room, o, map);
    }
    return result == RLF_OK && o->map_path != NULL ? rlf_map_write_file(map, o->map_path) : result;
}

void run_room_print(const run_room *room, const run_room_options *o, const rlf_map *map, FILE *file)
{
    if (!is_kept(o) || room->placed == 0) {
        return;
    }
    const rlf_map_status s = rlf_map_get_status(map);
    const bool has_truth = !o->has_source_poses && room->with_pose == room->seen;
    const double error = has_truth ? trajectory_error(&room->way) : -1.0;
    fprintf(file, "room:     %lld of %lld %s, %d blocks of %g mm voxels, %.0f MB%s\n",
            (long long)room->placed, (long long)room->seen, command_frames(room->seen),
            (int)s.block_count, 1000.0 * s.voxel_m, (double)s.bytes * 1e-6,
            s.is_full ? "; it is full, and what is far was forgotten: use a larger memory=MB or "
                        "voxel=MM"
                      : "");
    if (error >= 0.0) {
        fprintf(file, "way:      %.1f mm RMS from the source's own\n", 1000.0 * error);
    }
    if (o->map_path != NULL) {
        fprintf(file, "map:      %s\n", o->map_path);
    }
    if (o->mesh_path != NULL) {
        fprintf(file, "mesh:     %s, %zu vertices, %zu triangles (weight=%d)\n", o->mesh_path,
                room->vertex_count, room->triangle_count, (int)room->min_weight);
    }
}

void run_room_close(run_room *room)
{
    trajectory_free(&room->way);
    *room = (run_room){.seen = 0};
}
