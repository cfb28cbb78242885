/* `relief fuse`: a source with poses becomes a mesh of the room, and a map. */
#define _POSIX_C_SOURCE 200809L
#include "command.h"
#include "commands.h"
#include "fuse/fuser.h"
#include "options.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define PROGRESS_INTERVAL_NS 500000000

typedef struct fuse_options {
    const char *source, *out_path, *map_path;
    int64_t frame_limit;
    int32_t voxel_mm, memory_mb, thread_count, min_weight;
    bool is_quiet;
} fuse_options;

typedef struct fuse_run {
    const fuse_options *options;
    rlf_pool *pool;
    rlf_source *source;
    fuser fuser;
    bool has_first;
    rlf_pose T_first_source; /* the first camera's frame is the world */
    int64_t fused, without_pose;
    double integrate_ms;
    int64_t last_progress_ns;
} fuse_run;

static void print_help(void)
{
    printf("usage: relief fuse SOURCE --out ROOM.ply|.obj|.glb [OPTIONS]\n\n"
           "Fuses the frames of a moving camera into one mesh of the room, with normals and\n"
           "colours. The world is the first camera's frame: x right, y down, z forward.\n\n"
           "  --out FILE        the mesh: .ply, .obj or .glb\n"
           "  --save FILE       the map itself, to start in a known room\n"
           "  --poses NAME      source (default): the source's own, as groundtruth.txt\n"
           "  --frames N        at most so many frames\n"
           "  --voxel MM        edge of a voxel, 2..50 mm, default 6\n"
           "  --memory MB       most memory of the map, default 288; the farthest leaves first\n"
           "  --min-weight N    leaves out what was seen less; a near frame adds 16, default 32\n"
           "  --quiet           no progress, no summary\n"
           "  --threads N       default: one per processor\n" COMMAND_PLUGIN_HELP "\n"
           "examples:\n"
           "  relief fuse path/to/clip --out room.ply\n"
           "  relief fuse path/to/clip --out room.glb --save room.map --voxel 8\n");
}

static bool take_poses(const char *text, void *out)
{
    (void)out;
    return strcmp(text, "source") == 0;
}

static int parse(int argc, char **argv, fuse_options *o)
{
    *o = (fuse_options){.frame_limit = INT64_MAX, .min_weight = 32};
    const option_def options[] = {
        {.name = "out", .kind = OPTION_TEXT, .out = &o->out_path},
        {.name = "save", .kind = OPTION_TEXT, .out = &o->map_path},
        {.name = "poses",
         .kind = OPTION_CHOICE,
         .out = o,
         .take = take_poses,
         .choices = "use source"},
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
    if (o->out_path == NULL && o->map_path == NULL) {
        return command_usage("fuse", "needs --out FILE or --save FILE");
    }
    if (o->out_path != NULL && rlf_map_mesh_check_name(o->out_path) != RLF_OK) {
        return command_usage("fuse", "--out '%s': a mesh's name ends with .ply, .obj or .glb",
                             o->out_path);
    }
    o->source = argv[optind];
    return -1;
}

/* Both files can be written: told before the work, not after it. */
static rlf_result check_files(const fuse_options *o)
{
    rlf_result result = o->out_path != NULL ? rlf_file_check(o->out_path) : RLF_OK;
    return result == RLF_OK && o->map_path != NULL ? rlf_file_check(o->map_path) : result;
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
        const fuser_options options = {.voxel_m = o->voxel_mm * 0.001, .memory_mb = o->memory_mb};
        result =
            fuser_open(&run->fuser, &rlf_source_get_info(run->source)->rig, &options, run->pool);
    }
    return result;
}

static void print_progress(fuse_run *run)
{
    const int64_t now = rlf_clock_ns();
    if (run->options->is_quiet || now - run->last_progress_ns < PROGRESS_INTERVAL_NS ||
        !isatty(STDERR_FILENO)) {
        return;
    }
    run->last_progress_ns = now;
    const rlf_map_status s = rlf_map_get_status(run->fuser.map);
    const long long count = rlf_source_get_info(run->source)->frame_count;
    fprintf(stderr, "\rframe %lld of %lld, %d blocks, %.0f MB, %.1f ms ", (long long)run->fused,
            count, (int)s.block_count, (double)s.bytes * 1e-6, run->fuser.integrate_ms);
}

/* A pose that is none is left out, and so is a frame without one. */
static rlf_result add_frame(fuse_run *run, const rlf_frame *frame)
{
    if (!frame->has_pose) {
        run->without_pose++;
        return RLF_OK;
    }
    if (!run->has_first) {
        run->T_first_source = rlf_pose_invert(&frame->T_world_camera);
        run->has_first = true;
    }
    const rlf_pose T = rlf_pose_mul(&run->T_first_source, &frame->T_world_camera);
    rlf_result result = fuser_add(&run->fuser, frame, &T, NULL);
    if (result == RLF_ERROR_INVALID) {
        run->without_pose++;
        return RLF_OK;
    }
    run->fused++;
    run->integrate_ms += run->fuser.integrate_ms;
    return result;
}

static rlf_result fuse_frames(fuse_run *run)
{
    while (!command_interrupted && run->fused < run->options->frame_limit) {
        rlf_frame frame;
        rlf_result result = rlf_source_next(run->source, &frame);
        if (result == RLF_NO_FRAME) {
            continue;
        }
        if (result == RLF_OK) {
            result = add_frame(run, &frame);
        }
        if (result != RLF_OK) {
            return result == RLF_END ? RLF_OK : result;
        }
        print_progress(run);
    }
    return RLF_OK;
}

static rlf_result write_files(fuse_run *run)
{
    const fuse_options *o = run->options;
    const rlf_map_status s = rlf_map_get_status(run->fuser.map);
    rlf_map_mesh mesh = {0};
    rlf_result result = RLF_OK;
    if (o->out_path != NULL) {
        result = rlf_map_mesh_create(run->fuser.map, o->min_weight, &mesh);
        if (result == RLF_OK) {
            result = rlf_map_mesh_write(o->out_path, &mesh);
        }
    }
    if (result == RLF_OK && o->map_path != NULL) {
        result = rlf_map_write_file(run->fuser.map, o->map_path);
    }
    if (result == RLF_OK && !o->is_quiet) {
        printf("%lld frames fused, %lld without a pose; %d blocks, %.0f MB, %.1f ms a frame\n",
               (long long)run->fused, (long long)run->without_pose, (int)s.block_count,
               (double)s.bytes * 1e-6, run->integrate_ms / (double)run->fused);
        if (o->out_path != NULL) {
            printf("%zu vertices, %zu triangles in %s\n", mesh.vertex_count, mesh.triangle_count,
                   o->out_path);
        }
    }
    rlf_map_mesh_destroy(&mesh);
    return result;
}

static void close_all(fuse_run *run)
{
    fuser_close(&run->fuser);
    rlf_source_destroy(&run->source);
    rlf_pool_destroy(&run->pool);
}

static int finish(fuse_run *run, rlf_result result)
{
    if (!run->options->is_quiet && run->last_progress_ns != 0) {
        fprintf(stderr, "\n");
    }
    if (result == RLF_OK && run->fused == 0 && command_interrupted) {
        return command_stopped("fuse");
    }
    if (result == RLF_OK && run->fused == 0) {
        result = rlf_fail(RLF_ERROR_INVALID,
                          "%s: has no poses (%lld frames); a clip needs groundtruth.txt",
                          run->options->source, (long long)run->without_pose);
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
    fuse_run run = {.options = &options};
    if (open_all(&run) != RLF_OK) {
        status = command_not_opened("fuse");
    } else {
        status = finish(&run, fuse_frames(&run));
    }
    close_all(&run);
    return status;
}
