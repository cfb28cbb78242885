/* `relief fuse`: a source with poses becomes a mesh of the room, and a map. */
#define _POSIX_C_SOURCE 200809L
#include "command.h"
#include "commands.h"
#include "fuse/picture.h"
#include "fuse/report.h"
#include "fuse/tally.h"
#include "fuse/trajectory.h"
#include "options.h"
#include "pipeline/moving/source_pose.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

typedef struct fuse_options {
    const char *source, *out_path, *map_path, *trajectory_path, *picture_path;
    rlf_orbit orbit;
    int64_t frame_limit;
    int32_t voxel_mm, memory_mb, thread_count, min_weight;
    bool is_quiet, use_source_poses;
} fuse_options;

typedef struct fuse_run {
    const fuse_options *options;
    rlf_pool *pool;
    rlf_source *source;
    fuser fuser;
    source_poses poses; /* the first camera's frame is the world */
    bool has_left;      /* they are not all the same */
    fuse_tally tally;
    fuse_progress progress;
    trajectory trajectory;
    room_view room;
} fuse_run;

static void print_help(void)
{
    printf(
        "usage: relief fuse SOURCE --out ROOM.ply|.obj|.glb [OPTIONS]\n\n"
        "Fuses the frames of a moving camera into one mesh of the room, with normals and\n"
        "colours. The world is the first camera's frame: x right, y down, z forward.\n\n"
        "  --out FILE        the mesh: .ply, .obj or .glb\n"
        "  --save FILE       the map itself, to start in a known room\n"
        "  --trajectory FILE the camera's way: time tx ty tz qx qy qz qw, as TUM's tools read it\n"
        "  --picture FILE    the room and the camera's way in it, as a .png\n"
        "  --orbit YAW,PITCH[,ZOOM]   where the picture is seen from: degrees, and distance\n"
        "  --poses NAME      tracked (default), or source: the source's own, as groundtruth.txt\n"
        "  --frames N        at most so many frames\n"
        "  --voxel MM        edge of a voxel, 2..50 mm, default 6\n"
        "  --memory MB       most memory of the map, default 288; the farthest leaves first\n"
        "  --min-weight N    leaves out of the mesh what was seen less: a frame from near adds "
        "16,\n"
        "                    one from far 1; default 32, less for fewer than 128 frames\n"
        "  --quiet           no progress, no summary\n"
        "  --threads N       default: one per processor\n" COMMAND_PLUGIN_HELP "\n"
        "examples:\n"
        "  relief fuse path/to/clip --out room.ply --trajectory way.txt\n"
        "  relief fuse path/to/clip --out room.glb --save room.map --voxel 8\n");
}

static bool take_poses(const char *text, void *out)
{
    fuse_options *o = out;
    o->use_source_poses = strcmp(text, "source") == 0;
    return o->use_source_poses || strcmp(text, "tracked") == 0;
}

static int parse(int argc, char **argv, fuse_options *o)
{
    *o = (fuse_options){.frame_limit = INT64_MAX};
    const option_def options[] = {
        {.name = "out", .kind = OPTION_TEXT, .out = &o->out_path},
        {.name = "save", .kind = OPTION_FILE, .out = &o->map_path, .choices = ".map"},
        {.name = "trajectory", .kind = OPTION_FILE, .out = &o->trajectory_path, .choices = ".txt"},
        {.name = "picture", .kind = OPTION_FILE, .out = &o->picture_path, .choices = ".png"},
        {.name = "orbit",
         .kind = OPTION_CHOICE,
         .out = &o->orbit,
         .take = options_take_orbit,
         .choices = OPTIONS_ORBIT},
        {.name = "poses",
         .kind = OPTION_CHOICE,
         .out = o,
         .take = take_poses,
         .choices = "use tracked or source"},
        {.name = "frames",
         .kind = OPTION_INT64,
         .out = &o->frame_limit,
         .low = 1,
         .high = INT64_MAX},
        {.name = "voxel", .kind = OPTION_INT32, .out = &o->voxel_mm, .low = 2, .high = 50},
        {.name = "memory", .kind = OPTION_INT32, .out = &o->memory_mb, .low = 8, .high = 16384},
        {.name = "min-weight", .kind = OPTION_INT32, .out = &o->min_weight, .low = 1, .high = 255},
        {.name = "threads", .kind = OPTION_INT32, .out = &o->thread_count, .low = 1, .high = 64},
        {.name = "quiet", .kind = OPTION_FLAG, .out = &o->is_quiet},
        {.name = "plugin", .kind = OPTION_PLUGIN},
        {0},
    };
    int status = options_parse("fuse", argc, argv, options, print_help);
    if (status >= 0) {
        return status;
    }
    if (argc - optind != 1) {
        return command_usage("fuse", "needs one SOURCE");
    }
    if (o->out_path == NULL && o->map_path == NULL && o->trajectory_path == NULL &&
        o->picture_path == NULL) {
        return command_usage("fuse",
                             "needs --out, --save, --trajectory or --picture, each with a FILE");
    }
    if (o->out_path != NULL && rlf_map_mesh_check_name(o->out_path) != RLF_OK) {
        return command_usage("fuse", "--out '%s': a mesh's name ends with .ply, .obj or .glb",
                             o->out_path);
    }
    o->source = argv[optind];
    return -1;
}

/* All files can be written: told before the work, not after it. */
static rlf_result check_files(const fuse_options *o)
{
    const char *const paths[4] = {o->out_path, o->map_path, o->trajectory_path, o->picture_path};
    rlf_result result = RLF_OK;
    for (int i = 0; result == RLF_OK && i < 4; i++) {
        result = paths[i] != NULL ? rlf_file_check(paths[i]) : RLF_OK;
    }
    return result;
}

static rlf_result open_all(fuse_run *run)
{
    const fuse_options *o = run->options;
    rlf_result result = check_files(o);
    if (result == RLF_OK) {
        result = rlf_pool_create(o->thread_count, &run->pool);
    }
    if (result == RLF_OK) {
        result = rlf_open_source(o->source, run->pool, &run->source);
    }
    if (result == RLF_OK) {
        result = check_files(o); /* none is what is read */
    }
    if (result == RLF_OK) {
        const fuser_options options = {.voxel_m = o->voxel_mm * 0.001,
                                       .memory_mb = o->memory_mb,
                                       .has_time = true,
                                       .is_tracked = !o->use_source_poses};
        result =
            fuser_open(&run->fuser, &rlf_source_get_info(run->source)->rig, &options, run->pool);
    }
    if (result == RLF_OK) {
        const rlf_pose first = rlf_pose_identity();
        run->poses = source_poses_begin(&first, rlf_map_get_status(run->fuser.map).voxel_m);
        run->poses.has_told = !o->use_source_poses; /* else they are only compared with */
    }
    return result;
}

#define SAME_M 1e-4   /* poses of a camera that stands differ by less, */
#define SAME_RAD 1e-4 /* and less than that */

/* The poses are all the same so far: the camera stands, and need not be tracked. */
static bool stands(fuse_run *run, bool has_pose, const rlf_pose *T)
{
    const rlf_vec3 turn = {2.0 * T->q.x, 2.0 * T->q.y, 2.0 * T->q.z};
    run->has_left =
        run->has_left || !has_pose || rlf_length(T->p) > SAME_M || rlf_length(turn) > SAME_RAD;
    return !run->has_left;
}

/* A frame without a pose that can be used is left out, and so is one that cannot be placed. */
static rlf_result add_frame(fuse_run *run, const rlf_frame *frame)
{
    fuse_tally *t = &run->tally;
    rlf_pose T = rlf_pose_identity();
    const bool has_pose = source_poses_take(&run->poses, frame, &T);
    t->seen++;
    t->without_pose += !has_pose;
    if (!t->is_tracked && !has_pose) {
        return RLF_OK;
    }
    const bool is_tracked = t->is_tracked && !stands(run, has_pose, &T);
    const rlf_result result = fuser_add(&run->fuser, frame, is_tracked ? NULL : &T, NULL);
    if (result != RLF_OK) {
        return result;
    }
    fuse_tally_add(t, &run->fuser);
    if (is_tracked && run->fuser.pose.last.health == RLF_TRACK_LOST) {
        return RLF_OK;
    }
    t->fused++;
    const rlf_pose *found = is_tracked ? &run->fuser.pose.last.T_world_camera : &T;
    room_view_pass(&run->room, found, run->fuser.surface);
    return trajectory_add(&run->trajectory, frame->time_ns, found, has_pose ? &T : NULL);
}

static int64_t frame_count(const fuse_run *run)
{
    const int64_t all = rlf_source_get_info(run->source)->frame_count;
    const int64_t limit = run->options->frame_limit;
    return all < 0 ? (limit < INT64_MAX ? limit : -1) : (all < limit ? all : limit);
}

static rlf_result fuse_frames(fuse_run *run)
{
    while (!command_interrupted && run->tally.seen < run->options->frame_limit) {
        rlf_frame frame;
        const int64_t start = rlf_clock_ns();
        rlf_result result = rlf_source_next(run->source, &frame);
        run->tally.source_ms += (double)(rlf_clock_ns() - start) * 1e-6;
        if (result == RLF_NO_FRAME) {
            continue;
        }
        if (result == RLF_OK) {
            result = add_frame(run, &frame);
        }
        if (result != RLF_OK) {
            return result == RLF_END ? RLF_OK : result;
        }
        if (!run->options->is_quiet) {
            fuse_progress_show(&run->progress, &run->tally, &run->fuser, frame_count(run));
        }
    }
    return RLF_OK;
}

static rlf_result write_mesh(const fuse_run *run)
{
    const fuse_options *o = run->options;
    const int32_t least = o->min_weight > 0 ? o->min_weight : fuse_tally_min_weight(&run->tally);
    rlf_map_mesh mesh;
    rlf_result result = rlf_map_mesh_create(run->fuser.map, least, &mesh);
    if (result != RLF_OK) {
        return result;
    }
    result = fuse_tally_check_mesh(&run->tally, &run->fuser, least, &mesh);
    if (result == RLF_OK) {
        result = rlf_map_mesh_write(o->out_path, &mesh);
    }
    if (result == RLF_OK && !o->is_quiet) {
        fuse_report_mesh(&mesh, least, o->out_path);
    }
    rlf_map_mesh_destroy(&mesh);
    return result;
}

static rlf_result write_files(fuse_run *run)
{
    const fuse_options *o = run->options;
    rlf_result result = fuse_tally_check(&run->tally, &run->fuser);
    if (result == RLF_OK && !o->is_quiet) {
        fuse_report_print(&run->tally, &run->fuser, &run->trajectory);
    }
    if (result == RLF_OK && o->out_path != NULL) {
        result = write_mesh(run);
    }
    if (result == RLF_OK && o->map_path != NULL) {
        result = rlf_map_write_file(run->fuser.map, o->map_path);
    }
    if (result == RLF_OK && o->trajectory_path != NULL) {
        result = trajectory_write(&run->trajectory, o->trajectory_path);
    }
    if (result == RLF_OK && o->picture_path != NULL) {
        result = fuse_picture_write(o->picture_path, &run->fuser, &run->room, &o->orbit, run->pool);
    }
    return result;
}

static void close_all(fuse_run *run)
{
    trajectory_free(&run->trajectory);
    fuser_close(&run->fuser);
    rlf_source_destroy(&run->source);
    rlf_pool_destroy(&run->pool);
}

static int finish(fuse_run *run, rlf_result result)
{
    fuse_progress_end(&run->progress);
    if (result == RLF_OK && run->tally.fused == 0 && command_interrupted) {
        return command_stopped("fuse");
    }
    if (result == RLF_OK) {
        result = write_files(run);
    }
    return result == RLF_OK ? EXIT_DONE : command_failed();
}

int fuse_main(int argc, char **argv)
{
    fuse_options options;
    int status = parse(argc, argv, &options);
    if (status >= 0) {
        return status;
    }
    fuse_run run = {.options = &options,
                    .tally = {.source = options.source, .is_tracked = !options.use_source_poses}};
    if (open_all(&run) != RLF_OK) {
        status = command_not_opened("fuse");
    } else {
        status = finish(&run, fuse_frames(&run));
    }
    close_all(&run);
    return status;
}
