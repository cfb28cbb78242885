/* `relief export`: arrays of every frame as NPY, meshes as PLY, true poses as CSV. */
#include "command.h"
#include "export_arrays.h"
#include "options.h"
#include "session.h"

#include <errno.h>
#include <getopt.h>
#include <stdio.h>
#include <string.h>

#define PATH_SIZE 4096
#define MESH_JUMP 0.05 /* relative depth step that cuts the mesh */

/* begin <= i < end */
typedef struct frame_range {
    int64_t begin, end;
} frame_range;

typedef struct export_options {
    session_options session;
    const char *out_folder;
    const char *what;
    frame_range frames;
} export_options;

typedef struct exporter {
    const export_options *options;
    const export_kind *kinds[EXPORT_KINDS_MAX];
    int kind_count;
    bool write_mesh, write_regions, write_poses;
    uint32_t *indices; /* for meshes */
    FILE *poses;
    export_frame frame;
} exporter;

static void print_help(void)
{
    printf(
        "usage: relief export SOURCE --out DIR --what LIST [OPTIONS]\n\n"
        "Writes DIR/NAME/NNNNNN.npy for every frame and every NAME in the comma-separated LIST:\n");
    for (int i = 0; i < export_kind_count; i++) {
        printf("  %-20s %s%s\n", export_kinds[i].name, export_kinds[i].description,
               export_kinds[i].need == EXPORT_NEEDS_RENDER ? " (needs --scene)" : "");
    }
    printf(
        "  %-20s PLY: points, normals and triangles\n"
        "  %-20s NNNNNN_LABEL.ply: the same, one file per region\n"
        "  %-20s true_poses.csv: poses of the moving objects\n"
        "true_* need a synthetic source and have the depth camera's full resolution.\n\n"
        "  --frames A:B      frames A <= i < B (earlier ones are processed, not written)\n"
        "  --scene NAME      put bodies in: a scene of `relief list scenes`, or a file scene.json\n"
        "  --profile NAME    live (default) or thesis\n"
        "  --scale N         keep every N-th depth pixel (live 1, thesis 8)\n"
        "  --set NAME=VALUE  a setting of the surface (see `relief list settings`); any number\n"
        "  --threads N       default: one per processor\n" COMMAND_PLUGIN_HELP "\n"
        "examples:\n"
        "  relief export synthetic:room --out out --what depth,normals,true_normals "
        "--frames 0:50\n"
        "  relief export path/to/clip --out out --what points,labels,mesh --profile thesis\n",
        "mesh", "regions", "true_poses");
}

static bool take_range(const char *text, void *out)
{
    frame_range *range = out;
    return command_parse_range(text, &range->begin, &range->end);
}

/* Of all that can be written, ended with NULL. */
static const char *const *kind_names(void)
{
    static const char *names[EXPORT_KINDS_MAX + 4] = {"mesh", "regions", "true_poses"};
    for (int i = 0; i < export_kind_count; i++) {
        names[3 + i] = export_kinds[i].name;
    }
    return names;
}

static int parse(int argc, char **argv, export_options *o)
{
    o->session = session_options_default();
    o->frames.end = INT64_MAX;
    session_options *s = &o->session;
    const option_def options[] = {
        ROW_FOLDER("out", &o->out_folder),
        {.name = "what", .kind = OPTION_TEXT, .out = &o->what, .names = kind_names()},
        ROW_CHOICE("frames", &o->frames, take_range, "use A:B with A < B"),
        {.name = "scene", .kind = OPTION_SCENE, .out = &s->scene_path},
        {.name = "profile", .kind = OPTION_PROFILE, .out = &s->profile},
        ROW_INT32("scale", &s->scale_factor, 1, 64),
        ROW_INT32("threads", &s->thread_count, 1, 64),
        {.name = "set", .kind = OPTION_SET, .out = &s->settings},
        ROW_PLUGIN,
        {0},
    };
    int status = options_parse("export", argc, argv, options, print_help);
    if (status >= 0) {
        return status;
    }
    if (argc - optind != 1) {
        return command_usage("export", "needs one SOURCE");
    }
    if (o->out_folder == NULL || o->what == NULL) {
        return command_usage("export", "needs --out DIR and --what LIST");
    }
    o->session.source = argv[optind];
    return -1;
}

static int refuse_kind(const char *name)
{
    char nearest[SUGGEST_TEXT];
    return command_usage("export", "--what '%s' is not an array: %s", name,
                         suggest_text(name, kind_names(), false, nearest));
}

/* Adds one name of the list; an exit status when it cannot be written. */
static int add_kind(exporter *e, const char *name)
{
    if (strcmp(name, "mesh") == 0) {
        e->write_mesh = true;
        return -1;
    }
    if (strcmp(name, "regions") == 0) {
        e->write_regions = true;
        return -1;
    }
    if (strcmp(name, "true_poses") == 0) {
        e->write_poses = true;
        return -1;
    }
    const export_kind *kind = export_kind_find(name);
    if (kind == NULL) {
        return refuse_kind(name);
    }
    if (kind->need == EXPORT_NEEDS_RENDER && e->options->session.scene_path == NULL) {
        return command_usage("export", "--what %s needs --scene FILE", name);
    }
    for (int i = 0; i < e->kind_count; i++) {
        if (e->kinds[i] == kind) {
            return -1;
        }
    }
    e->kinds[e->kind_count++] = kind; /* no duplicates, so never more than there are kinds */
    return -1;
}

static int parse_what(exporter *e)
{
    const char *rest = e->options->what;
    for (;;) {
        size_t length = strcspn(rest, ",");
        char name[64];
        if (length == 0 || length >= sizeof(name)) {
            return command_usage("export", "--what '%s': a comma-separated list of names",
                                 e->options->what);
        }
        memcpy(name, rest, length);
        name[length] = '\0';
        int status = add_kind(e, name);
        if (status >= 0) {
            return status;
        }
        if (rest[length] == '\0') {
            return -1;
        }
        rest += length + 1;
    }
}

static rlf_result make_path(const exporter *e, const char *name, int64_t index, char *path)
{
    const char *folder = e->options->out_folder;
    const char *extension = strcmp(name, "mesh") == 0 ? "ply" : "npy";
    int length = index < 0 ? snprintf(path, PATH_SIZE, "%s/%s", folder, name)
                           : snprintf(path, PATH_SIZE, "%s/%s/%06lld.%s", folder, name,
                                      (long long)index, extension);
    if (length < 0 || length >= PATH_SIZE) {
        return rlf_fail(RLF_ERROR_IO, "%s: the path is too long", folder);
    }
    return RLF_OK;
}

static rlf_result make_folders(exporter *e)
{
    char path[PATH_SIZE];
    rlf_result result = rlf_make_folder(e->options->out_folder);
    for (int i = 0; result == RLF_OK && i < e->kind_count; i++) {
        result = make_path(e, e->kinds[i]->name, -1, path);
        if (result == RLF_OK) {
            result = rlf_make_folder(path);
        }
    }
    const bool wanted[2] = {e->write_mesh, e->write_regions};
    const char *const names[2] = {"mesh", "regions"};
    for (int i = 0; result == RLF_OK && i < 2; i++) {
        result = wanted[i] ? make_path(e, names[i], -1, path) : RLF_OK;
        if (result == RLF_OK && wanted[i]) {
            result = rlf_make_folder(path);
        }
    }
    return result;
}

static rlf_result open_poses(exporter *e)
{
    char path[PATH_SIZE];
    rlf_result result = make_path(e, "true_poses.csv", -1, path);
    if (result != RLF_OK) {
        return result;
    }
    e->poses = fopen(path, "w");
    if (e->poses == NULL) {
        return rlf_fail(RLF_ERROR_IO, "%s: cannot be written: %s: choose another --out", path,
                        strerror(errno));
    }
    fprintf(e->poses, "frame,time_s,name,label,px,py,pz,qx,qy,qz,qw\n");
    return RLF_OK;
}

static rlf_result make_scratch(exporter *e, const rlf_rig *rig)
{
    size_t depth_pixels = (size_t)rig->depth.width * (size_t)rig->depth.height;
    size_t color_pixels =
        rig->has_color ? (size_t)rig->color.width * (size_t)rig->color.height : depth_pixels;
    size_t picture_pixels = color_pixels > depth_pixels ? color_pixels : depth_pixels;
    e->frame.scratch = rlf_alloc_array(depth_pixels, 3 * sizeof(float));
    e->frame.scratch_u8 = rlf_alloc_array(picture_pixels, 3);
    e->indices = rlf_alloc_array(rlf_mesh_index_count(rig->depth.width, rig->depth.height),
                                 sizeof(uint32_t));
    bool is_ready = e->frame.scratch != NULL && e->frame.scratch_u8 != NULL && e->indices != NULL;
    return is_ready ? RLF_OK : RLF_ERROR_MEMORY;
}

static rlf_result write_poses(exporter *e, const rlf_pipeline_output *output)
{
    rlf_result result = e->poses == NULL ? open_poses(e) : RLF_OK;
    if (result != RLF_OK) {
        return result;
    }
    const rlf_truth *truth = e->frame.truth;
    for (int32_t i = 0; i < truth->pose_count; i++) {
        const rlf_truth_pose *pose = &truth->poses[i];
        const rlf_pose *T = &pose->T_camera_object;
        fprintf(e->poses, "%lld,%.9g,%s,%d,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n",
                (long long)output->frame_index, output->time_s, pose->name, (int)pose->label,
                T->p.x, T->p.y, T->p.z, T->q.x, T->q.y, T->q.z, T->q.w);
    }
    return ferror(e->poses) ? rlf_fail(RLF_ERROR_IO,
                                       "%s/true_poses.csv: write failed; is the "
                                       "disk full?",
                                       e->options->out_folder)
                            : RLF_OK;
}

static rlf_result write_mesh(exporter *e, const rlf_pipeline_output *output)
{
    char path[PATH_SIZE];
    rlf_result result = make_path(e, "mesh", output->frame_index, path);
    if (result != RLF_OK) {
        return result;
    }
    size_t count = rlf_mesh_indices_valid(output->surface, MESH_JUMP, e->indices);
    return rlf_ply_write(path, output->surface, e->indices, count);
}

static rlf_result write_regions(exporter *e, const rlf_pipeline_output *output)
{
    const rlf_surface *s = output->surface;
    rlf_result result = RLF_OK;
    for (int32_t r = 0; r < s->region_count && result == RLF_OK; r++) {
        const rlf_region *region = &s->regions[r];
        char path[PATH_SIZE];
        int length = snprintf(path, PATH_SIZE, "%s/regions/%06lld_%d.ply", e->options->out_folder,
                              (long long)output->frame_index, (int)region->label);
        if (length < 0 || length >= PATH_SIZE) {
            return rlf_fail(RLF_ERROR_IO, "%s: the path is too long", e->options->out_folder);
        }
        size_t count = rlf_mesh_indices_region(s, region, MESH_JUMP, e->indices);
        result = rlf_ply_write_region(path, s, region, e->indices, count);
    }
    return result;
}

static rlf_result write_frame(exporter *e, session *s, const rlf_pipeline_output *output)
{
    e->frame.output = output;
    e->frame.truth = rlf_source_get_truth(s->source);
    for (int i = 0; i < e->kind_count; i++) {
        const export_kind *kind = e->kinds[i];
        if (kind->need == EXPORT_NEEDS_TRUTH && e->frame.truth == NULL) {
            return rlf_fail(RLF_ERROR_UNSUPPORTED,
                            "%s: knows no truth; %s needs a synthetic source",
                            e->options->session.source, kind->name);
        }
        char path[PATH_SIZE];
        rlf_result result = make_path(e, kind->name, output->frame_index, path);
        if (result == RLF_OK) {
            result = kind->write(&e->frame, path);
        }
        if (result != RLF_OK) {
            return result;
        }
    }
    if (e->write_poses && e->frame.truth == NULL) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED, "%s: true_poses needs a synthetic source",
                        e->options->session.source);
    }
    rlf_result result = e->write_poses ? write_poses(e, output) : RLF_OK;
    if (result == RLF_OK && e->write_regions) {
        result = write_regions(e, output);
    }
    return result == RLF_OK && e->write_mesh ? write_mesh(e, output) : result;
}

static rlf_result export_frames(exporter *e, session *s, int64_t *out_written)
{
    rlf_result result = make_scratch(e, &rlf_source_get_info(s->source)->rig);
    if (result == RLF_OK) {
        result = make_folders(e);
    }
    while (result == RLF_OK && !command_interrupted) {
        rlf_pipeline_output output;
        result = rlf_pipeline_step(s->pipeline, &output);
        if (result == RLF_NO_FRAME) {
            result = RLF_OK;
            continue;
        }
        if (result == RLF_OK && output.frame_index >= e->options->frames.begin) {
            result = write_frame(e, s, &output);
            ++*out_written;
        }
        if (result == RLF_OK && output.frame_index + 1 >= e->options->frames.end) {
            return RLF_OK;
        }
    }
    return result == RLF_END ? RLF_OK : result;
}

int export_main(int argc, char **argv)
{
    export_options options;
    memset(&options, 0, sizeof(options));
    int status = parse(argc, argv, &options);
    if (status >= 0) {
        return status;
    }
    exporter e;
    memset(&e, 0, sizeof(e));
    e.options = &options;
    status = parse_what(&e);
    if (status >= 0) {
        return status;
    }
    options.session.enable_render = options.session.scene_path != NULL;
    session s;
    if (session_open(&options.session, &s) != RLF_OK) {
        return command_not_opened("export");
    }
    int64_t written = 0;
    rlf_result result = export_frames(&e, &s, &written);
    if (result == RLF_OK && written == 0 && !command_interrupted) {
        result = rlf_fail(RLF_ERROR_INVALID, "%s: has no frame %lld or later; use --frames A:B",
                          options.session.source, (long long)options.frames.begin);
    }
    status = result == RLF_OK ? EXIT_DONE : command_failed();
    if (e.poses != NULL && fclose(e.poses) != 0 && status == EXIT_DONE) {
        rlf_fail(RLF_ERROR_IO, "%s/true_poses.csv: write failed; is the disk full?",
                 options.out_folder);
        status = command_failed();
    }
    if (status == EXIT_DONE && written == 0) {
        status = command_stopped("export");
    } else if (status == EXIT_DONE) {
        printf("%lld %s in %s\n", (long long)written, command_frames(written), options.out_folder);
    }
    rlf_free(e.frame.scratch);
    rlf_free(e.frame.scratch_u8);
    rlf_free(e.indices);
    session_close(&s);
    return status == EXIT_DONE ? command_done() : status;
}
