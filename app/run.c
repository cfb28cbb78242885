/* `relief run`: frames through the whole pipeline, in a window or headless. */
#include "command.h"
#include "commands.h"
#include "options.h"
#include "run.h"
#ifdef RLF_HAVE_GL
#include "relief/gl.h"
#endif
#ifdef RLF_HAVE_VIEWER
#include "start_page.h"
#endif

#include <getopt.h>
#include <stdio.h>
#include <string.h>

static void print_camera_help(void)
{
    printf("  --camera NAME         auto (default): fixed until the view as a whole moves, then\n"
           "                        moving; moving: tracked against a map from the first frame;\n"
           "                        fixed: never tracked\n"
           "  --poses NAME          of a moving camera: tracked (default), or source: its own\n"
           "  --map FILE.map        a known room, as relief fuse --save writes it: the camera is\n"
           "                        looked for in it\n"
           "  --save-map FILE.map   at the end: the room that a moving camera has seen, for --map\n"
           "  --log DIR             frames.csv, bodies.csv, contacts.csv, hands.csv, and\n"
           "                        trajectory.txt when the camera moves\n"
           "  --hands               look for hands, for hands.csv\n"
           "  --grab                real fingers can hold bodies (experimental)\n");
}

static void print_help(void)
{
    printf(
        "usage: relief run [SOURCE] [OPTIONS]\n\n"
        "Runs a source with virtual bodies that collide with what the camera sees.\n"
        "SOURCE: synthetic:room or a folder with a clip (see `relief sources`); without one the\n"
        "window lists cameras and recent recordings.\n\n"
        "  --scene NAME          bodies and gravity: a scene that `relief scenes` lists, or a "
        "file\n"
        "                        scene.json; default: two thrown cubes\n"
        "  --profile NAME        live (default) or thesis\n"
        "  --renderer NAME       soft or gl; default: gl in a window, soft headless\n"
        "  --headless            no window: as fast as the machine can, every frame\n"
        "  --end WHAT            in the window, after a recording: loop (default), hold (bodies\n"
        "                        fall on over the last frame) or stop (default where frames are\n"
        "                        written or counted)\n"
        "  --fullscreen          the picture alone, without text\n"
        "  --monitor N           the window and its full screen on the N-th monitor, from 1\n"
        "  --mirror              as in a mirror: the window, not what is written\n"
        "  --overlay NAME        text over the window's picture: on, off, or full: also in full\n"
        "                        screen; never in what is written\n"
        "  --no-panel            the window without its panel\n"
        "  --frames N            stop after N frames\n"
        "  --video FILE          .mp4, .y4m, - for Y4M on standard output, or a virtual camera:\n"
        "                        pipewire:NAME, or /dev/videoN of v4l2loopback\n"
        "  --pictures DIR        PNG pictures NNNNNN.png, one every --picture-every frames\n"
        "  --picture-every N     default 30\n"
        "  --picture-at LIST     instead: these frames alone, e.g. 60,92\n"
        "  --picture-shrink N    average N x N pixels of a picture into one\n"
        "  --record FILE.mcap    what the source gives, for playing it again (see `relief\n"
        "                        record`, whose --codec, --jpeg-quality, --lossless and\n"
        "                        --compression work here, too)\n"
        "  --record-bodies       the bodies' poses, too, as frames of /tf\n");
    print_camera_help();
    printf(
        "  --view NAME[,NAME...] camera (default), depth, normals, mesh, regions, foreground,\n"
        "                        background, velocity, thickness, reason, points, contacts,\n"
        "                        known, hands, map;\n"
        "                        up to four of them side by side\n"
        "  --legend              what the colours of every view mean, with units, in the picture\n"
        "  --orbit YAW,PITCH[,ZOOM]   where points and map are seen from: degrees to the\n"
        "                        right and up, and the distance, 1 being the camera's\n"
        "  --gravity X,Y,Z       m/s^2 to the right, down and forward, in place of the\n"
        "                        scene's; or floor: down is where the first frame's floor,\n"
        "                        tables and walls say; clips' default if the scene says none\n"
        "  --light X,Y,Z         where the light shines to: right, down, forward\n"
        "  --match-light         bodies as dark and as tinted as the camera's picture, and\n"
        "                        lit from where its shading says; live's default for clips\n"
        "  --no-match-light      not so\n"
        "  --no-real-shade       real things keep no light from bodies\n"
        "  --no-real-ambient     bodies are not darker where they are close to real surfaces\n"
        "  --occlusion NAME      soft (live's), hard, thesis (thesis's) or off\n"
        "  --scale N             keep every N-th depth pixel (live 1, thesis 8)\n"
        "  --set NAME=VALUE      a setting of the surface (see `relief settings`); any number\n"
        "  --threads N           default: one per processor; results do not depend on it\n"
        "  --plugin FILE         a plug-in that brings a camera or a format; any number\n"
        "  --hash                print the hash of all body states at the end\n"
        "  --quiet               no progress and no summary\n\n"
        "examples:\n"
        "  relief run synthetic:room\n"
        "  relief run synthetic:room --headless --frames 200 --video out.mp4 --log log\n"
        "  relief run synthetic:thesis --profile thesis --headless --pictures pictures\n"
        "  relief run path/to/clip --headless --view normals --video - | mpv -\n"
        "  relief run synthetic:room?path=orbit --headless --log log --pictures pictures\n");
}

static bool take_renderer(const char *text, void *out)
{
    run_options *o = out;
    o->use_gl = strcmp(text, "gl") == 0;
    o->is_renderer_set = true;
    return o->use_gl || strcmp(text, "soft") == 0;
}

/* Names with commas between. */
static bool take_views(const char *text, void *out)
{
    run_options *o = out;
    o->view_count = 0;
    while (o->view_count < RLF_PIPELINE_VIEWS) {
        char name[32];
        size_t length = strcspn(text, ",");
        if (length >= sizeof(name)) {
            return false;
        }
        memcpy(name, text, length);
        name[length] = '\0';
        if (!rlf_view_parse(name, &o->views[o->view_count++])) {
            return false;
        }
        if (text[length] == '\0') {
            return true;
        }
        text += length + 1;
    }
    return false;
}

static bool take_light(const char *text, void *out)
{
    session_options *s = out;
    rlf_vec3 *l = &s->light_direction;
    char rest;
    bool is_good = sscanf(text, "%lf,%lf,%lf%c", &l->x, &l->y, &l->z, &rest) == 3 &&
                   rlf_vec3_is_finite(*l) && rlf_length(*l) > 1e-6 && rlf_length(*l) < 1e6;
    *l = is_good ? rlf_normalize(*l) : *l;
    s->is_light_set = is_good;
    return is_good;
}

static bool take_gravity(const char *text, void *out)
{
    session_options *s = out;
    rlf_vec3 *g = &s->gravity;
    char rest;
    s->is_gravity_set = true;
    s->finds_gravity = strcmp(text, "floor") == 0;
    *g = rlf_world_def_default().gravity;
    return s->finds_gravity || (sscanf(text, "%lf,%lf,%lf%c", &g->x, &g->y, &g->z, &rest) == 3 &&
                                rlf_vec3_is_finite(*g) && rlf_length(*g) <= 1000.0);
}

static bool take_camera(const char *text, void *out)
{
    static const char *const names[3] = {"fixed", "moving", "auto"};
    rlf_camera_mode *mode = out;
    for (int i = 0; i < 3; i++) {
        if (strcmp(text, names[i]) == 0) {
            *mode = (rlf_camera_mode)i;
            return true;
        }
    }
    return false;
}

static bool take_poses(const char *text, void *out)
{
    rlf_pose_origin *poses = out;
    *poses = strcmp(text, "source") == 0 ? RLF_POSES_SOURCE : RLF_POSES_TRACKED;
    return *poses == RLF_POSES_SOURCE || strcmp(text, "tracked") == 0;
}

static bool take_end(const char *text, void *out)
{
    run_options *o = out;
    o->window.is_end_set = true;
    return playback_parse(text, &o->session.end);
}

static bool take_overlay(const char *text, void *out)
{
    run_window_options *o = out;
    o->hides_overlay = strcmp(text, "off") == 0;
    o->shows_overlay = strcmp(text, "full") == 0;
    return o->hides_overlay || o->shows_overlay || strcmp(text, "on") == 0;
}

static bool take_occlusion(const char *text, void *out)
{
    static const char *const names[4] = {"hard", "thesis", "off", "soft"};
    session_options *s = out;
    for (int i = 0; i < 4; i++) {
        if (strcmp(text, names[i]) == 0) {
            s->occlusion = (rlf_occlusion)i;
            s->is_occlusion_set = true;
            return true;
        }
    }
    return false;
}

/* "60,92" into the run_output_options. */
static bool take_picture_frames(const char *text, void *out)
{
    run_output_options *o = out;
    return command_parse_list(text, 0, INT64_C(1000000000), RUN_PICTURES_MAX, o->picture_at,
                              &o->picture_count);
}

/* Of all views, ended with NULL. */
static const char *const *view_names(void)
{
    static const char *names[RLF_VIEW_COUNT + 1];
    for (int i = 0; i < RLF_VIEW_COUNT; i++) {
        names[i] = rlf_view_name((rlf_view)i);
    }
    return names;
}
/* Rows of the table that are for the window alone. */
#define WINDOW_OPTIONS(o)                                                                          \
    {.name = "end",                                                                                \
     .kind = OPTION_CHOICE,                                                                        \
     .out = (o),                                                                                   \
     .take = take_end,                                                                             \
     .choices = "use loop, hold or stop"},                                                         \
        {.name = "fullscreen", .kind = OPTION_FLAG, .out = &(o)->window.is_fullscreen},            \
        {.name = "monitor",                                                                        \
         .kind = OPTION_INT32,                                                                     \
         .out = &(o)->window.monitor,                                                              \
         .low = 1,                                                                                 \
         .high = 16},                                                                              \
        {.name = "mirror", .kind = OPTION_FLAG, .out = &(o)->window.is_mirrored},                  \
        {.name = "overlay",                                                                        \
         .kind = OPTION_CHOICE,                                                                    \
         .out = &(o)->window,                                                                      \
         .take = take_overlay,                                                                     \
         .choices = "use on, off or full"},                                                        \
    {                                                                                              \
        .name = "no-panel", .kind = OPTION_FLAG, .out = &(o)->window.hides_panel                   \
    }

/* Rows of the table that say which pictures are kept. */
#define PICTURE_OPTIONS(out)                                                                       \
    {.name = "pictures", .kind = OPTION_TEXT, .out = &(out)->picture_folder},                      \
        {.name = "picture-every",                                                                  \
         .kind = OPTION_INT64,                                                                     \
         .out = &(out)->picture_every,                                                             \
         .low = 1,                                                                                 \
         .high = 1000000},                                                                         \
        {.name = "picture-at",                                                                     \
         .kind = OPTION_CHOICE,                                                                    \
         .out = (out),                                                                             \
         .take = take_picture_frames,                                                              \
         .choices = "use up to 16 frame numbers"},                                                 \
    {                                                                                              \
        .name = "picture-shrink", .kind = OPTION_INT32, .out = &(out)->picture_shrink, .low = 1,   \
        .high = 64                                                                                 \
    }

/* Rows of the table that say where the camera is. */
#define CAMERA_OPTIONS(s)                                                                          \
    {.name = "camera",                                                                             \
     .kind = OPTION_CHOICE,                                                                        \
     .out = &(s)->camera,                                                                          \
     .take = take_camera,                                                                          \
     .choices = "use fixed, moving or auto"},                                                      \
        {.name = "poses",                                                                          \
         .kind = OPTION_CHOICE,                                                                    \
         .out = &(s)->poses,                                                                       \
         .take = take_poses,                                                                       \
         .choices = "use tracked or source"},                                                      \
    {                                                                                              \
        .name = "map", .kind = OPTION_TEXT, .out = &(s)->map_path                                  \
    }

static int read_options(int argc, char **argv, run_options *o)
{
    session_options *s = &o->session;
    run_output_options *out = &o->output;
    const option_def options[] = {
        {.name = "scene", .kind = OPTION_SCENE, .out = &s->scene_path},
        {.name = "profile", .kind = OPTION_PROFILE, .out = &s->profile},
        {.name = "renderer",
         .kind = OPTION_CHOICE,
         .out = o,
         .take = take_renderer,
         .choices = "use soft or gl"},
        {.name = "headless", .kind = OPTION_FLAG, .out = &o->is_headless},
        WINDOW_OPTIONS(o),
        {.name = "frames",
         .kind = OPTION_INT64,
         .out = &o->frame_count,
         .low = 1,
         .high = 1000000000},
        {.name = "video", .kind = OPTION_TEXT, .out = &out->video_path},
        PICTURE_OPTIONS(out),
        {.name = "hands", .kind = OPTION_FLAG, .out = &s->enable_hands},
        {.name = "grab", .kind = OPTION_FLAG, .out = &s->enable_grab},
        CAMERA_OPTIONS(s),
        {.name = "save-map", .kind = OPTION_TEXT, .out = &o->save_map_path},
        {.name = "log", .kind = OPTION_TEXT, .out = &out->log_folder},
        {.name = "record", .kind = OPTION_TEXT, .out = &s->record.path},
        {.name = "record-bodies", .kind = OPTION_FLAG, .out = &s->record.keeps_bodies},
        RECORDER_OPTIONS(&s->record),
        {.name = "view",
         .kind = OPTION_CHOICE,
         .out = o,
         .take = take_views,
         .choices = "is not a list of up to four views",
         .names = view_names()},
        {.name = "legend", .kind = OPTION_FLAG, .out = &o->shows_legend},
        {.name = "orbit",
         .kind = OPTION_CHOICE,
         .out = &o->orbit,
         .take = options_take_orbit,
         .choices = OPTIONS_ORBIT},
        {.name = "gravity",
         .kind = OPTION_CHOICE,
         .out = s,
         .take = take_gravity,
         .choices = "use floor, or X,Y,Z of up to 1000 m/s^2"},
        {.name = "light",
         .kind = OPTION_CHOICE,
         .out = s,
         .take = take_light,
         .choices = "use X,Y,Z, not all zero"},
        {.name = "match-light", .kind = OPTION_FLAG, .out = &s->matches_light},
        {.name = "no-match-light", .kind = OPTION_FLAG, .out = &s->keeps_light},
        {.name = "no-real-shade", .kind = OPTION_FLAG, .out = &s->no_real_shade},
        {.name = "no-real-ambient", .kind = OPTION_FLAG, .out = &s->no_real_ambient},
        {.name = "occlusion",
         .kind = OPTION_CHOICE,
         .out = s,
         .take = take_occlusion,
         .choices = "use soft, hard, thesis or off"},
        {.name = "scale", .kind = OPTION_INT32, .out = &s->scale_factor, .low = 1, .high = 64},
        {.name = "threads", .kind = OPTION_INT32, .out = &s->thread_count, .low = 1, .high = 64},
        {.name = "hash", .kind = OPTION_FLAG, .out = &out->print_hash},
        {.name = "quiet", .kind = OPTION_FLAG, .out = &out->is_quiet},
        {.name = "set", .kind = OPTION_SET, .out = &s->settings},
        {.name = "plugin", .kind = OPTION_PLUGIN},
        {0},
    };
    return options_parse("run", argc, argv, options, print_help);
}

/* Returns -1 to go on, or an exit status. */
static int parse(int argc, char **argv, run_options *o)
{
    o->session = session_options_default();
    o->session.use_default_scene = true;
    o->session.camera = RLF_CAMERA_AUTO;
    o->session.record.is_beside_loop = true;
    o->output.picture_every = 30;
    o->output.picture_shrink = 1;
    o->frame_count = -1;
    o->view_count = 1;
    int status = read_options(argc, argv, o);
    if (status >= 0) {
        return status;
    }
    if (argc - optind > 1) {
        return command_usage("run", "takes one SOURCE only");
    }
    if (o->output.picture_count > 0 && o->output.picture_folder == NULL) {
        return command_usage("run", "--picture-at needs --pictures DIR");
    }
    o->session.source = argv[optind]; /* NULL when there is none */
    return -1;
}

/* Without a SOURCE the window's start page asks for one. */
static int choose_source(run_options *o)
{
    if (o->session.source != NULL) {
        return -1;
    }
#ifdef RLF_HAVE_VIEWER
    static char source[START_PAGE_SOURCE];
    if (!o->is_headless) {
        o->session.source = source;
        return start_page_choose(source);
    }
#endif
    return command_usage("run", "needs a SOURCE");
}

/* Falls back to the soft renderer, and says so, when GL is not to be had. */
static void choose_headless_renderer(run_options *o, session *s)
{
    if (!o->use_gl) {
        return;
    }
#ifdef RLF_HAVE_GL
    rlf_compositor_def def = rlf_pipeline_get_compositor_def(s->pipeline);
    rlf_compositor *compositor = NULL;
    if (rlf_gl_compositor_create(&def, false, &compositor) == RLF_OK &&
        rlf_pipeline_set_compositor(s->pipeline, compositor) == RLF_OK) {
        return;
    }
    rlf_compositor_destroy(&compositor);
    rlf_log(RLF_LOG_WARNING, "%s; going on with the soft renderer", rlf_error_text());
#else
    (void)s;
    rlf_log(RLF_LOG_WARNING, "this build has no OpenGL renderer; going on with the soft one");
#endif
    o->use_gl = false;
}

static rlf_result run_headless(const run_options *o, session *s, run_output *output)
{
    while (!command_interrupted && (o->frame_count < 0 || output->frames < o->frame_count)) {
        rlf_pipeline_output frame;
        rlf_result result = rlf_pipeline_step(s->pipeline, &frame);
        if (result == RLF_END) {
            break;
        }
        if (result == RLF_NO_FRAME) {
            continue;
        }
        if (result == RLF_OK) {
            result = run_output_add(output, &frame);
        }
        if (result != RLF_OK) {
            return result;
        }
    }
    if (output->frames == 0 && !command_interrupted) {
        return rlf_fail(RLF_ERROR_IO,
                        "%s: has no frame with depth: check what `relief info` says of it",
                        o->session.source);
    }
    return command_interrupted ? RLF_OK : run_output_check(output);
}

#ifndef RLF_HAVE_VIEWER
rlf_result run_window(const run_options *o, session *s, run_output *output)
{
    (void)o;
    (void)s;
    (void)output;
    return rlf_fail(RLF_ERROR_UNSUPPORTED, "this build has no window; add --headless");
}

void run_window_end(void) {}
#endif

static rlf_result run_frames(run_options *o, session *s, run_output *output)
{
    rlf_pipeline_set_orbit(s->pipeline, &o->orbit);
    rlf_pipeline_set_legend(s->pipeline, o->shows_legend);
    rlf_result result = rlf_pipeline_set_views(s->pipeline, o->views, o->view_count);
    if (result != RLF_OK) {
        return result;
    }
    if (o->is_headless) {
        choose_headless_renderer(o, s);
        return run_headless(o, s, output);
    }
    return run_window(o, s, output);
}

/* Also after Ctrl-C. */
static rlf_result save_map(const run_options *o, session *s)
{
    if (o->save_map_path == NULL) {
        return RLF_OK;
    }
    const rlf_map *map = rlf_pipeline_get_map(s->pipeline);
    return map != NULL ? rlf_map_write_file(map, o->save_map_path)
                       : rlf_fail(RLF_ERROR_INVALID,
                                  "--save-map: the camera has not moved, so there is no map; add "
                                  "--camera moving");
}

static int run_session(run_options *o, session *s)
{
    const rlf_source_info *info = rlf_source_get_info(s->source);
    int64_t total = info->frame_count;
    if (o->frame_count > 0 && (total < 0 || o->frame_count < total)) {
        total = o->frame_count;
    }
    static run_output output; /* large: timing samples */
    rlf_result result = run_output_open(&o->output, info, total, &output);
    output.recorder = s->recorder;
    if (result == RLF_OK) {
        result = run_frames(o, s, &output);
    }
    result = result == RLF_OK ? save_map(o, s) : result;
    int status = result == RLF_OK ? EXIT_DONE : command_failed();
    if (status == EXIT_DONE && command_interrupted && output.frames == 0) {
        status = command_stopped("run");
    }
    recorder_status recorded = {0};
    if (recorder_destroy(&s->recorder, &recorded) != RLF_OK && status == EXIT_DONE) {
        status = recorded.is_told ? EXIT_FAILED : command_failed();
    }
    if (run_output_close(&output) != RLF_OK && status == EXIT_DONE) {
        status = command_failed();
    }
    if (status == EXIT_DONE && o->output.print_hash) {
        fprintf(run_output_words(&o->output), "hash %016llx\n",
                (unsigned long long)rlf_world_hash(rlf_pipeline_get_world(s->pipeline)));
    }
    if (status == EXIT_DONE && !o->output.is_quiet) {
        const char *renderer = o->use_gl ? "renderer gl" : "renderer soft";
        const rlf_source_status frames = rlf_source_get_status(s->source);
        run_output_print_summary(&output, o->is_headless ? renderer : "in a window", &frames);
        recorder_print_summary(run_output_words(&o->output), &o->session.record, &recorded);
    }
    return status == EXIT_DONE ? command_done() : status;
}

static bool writes_something(const run_options *o)
{
    const run_output_options *out = &o->output;
    return out->video_path != NULL || out->picture_folder != NULL || out->log_folder != NULL ||
           o->session.record.path != NULL || o->save_map_path != NULL || out->print_hash;
}

/* What is written or counted ends with the recording, unless one asks for more. */
static void choose_end(run_options *o)
{
    const bool is_kept = writes_something(o) || o->frame_count >= 0;
    o->session.is_played = !o->is_headless;
    if (!o->window.is_end_set) {
        o->session.end = is_kept ? PLAYBACK_STOP : PLAYBACK_LOOP;
    }
}

int run_main(int argc, char **argv)
{
    run_options options;
    memset(&options, 0, sizeof(options));
    int status = parse(argc, argv, &options);
    status = status < 0 ? choose_source(&options) : status;
    if (status >= 0) {
        return status;
    }
    choose_end(&options);
    options.session.record.is_switched = !options.is_headless;
    options.output.scene_path = options.session.scene_path;
    session s;
    if (session_open(&options.session, &s) != RLF_OK) {
        return command_not_opened("run");
    }
    if (options.is_headless && !options.output.is_quiet && !writes_something(&options)) {
        fprintf(stderr, "relief run: nothing will be kept: add --video FILE, --pictures DIR or "
                        "--log DIR\n");
    }
    options.output.finds_gravity = s.scene.finds_gravity;
    options.output.is_light_given = options.session.is_light_set;
    status = run_session(&options, &s);
    session_close(&s);
    run_window_end();
    return status;
}
