/* `relief run`: frames through the whole pipeline, in a window or headless. */
#include "command.h"
#include "run_output.h"
#include "session.h"
#ifdef RLF_HAVE_GL
#include "relief/gl.h"
#endif
#ifdef RLF_HAVE_VIEWER
#include "viewer/viewer.h"
#endif

#include <getopt.h>
#include <stdio.h>
#include <string.h>

typedef struct run_options {
    session_options session;
    run_output_options output;
    bool is_headless;
    bool use_gl;
    bool is_renderer_set;
    int64_t frame_count; /* -1 = all */
    rlf_view view;
} run_options;

static void print_help(void)
{
    printf("usage: relief run SOURCE [OPTIONS]\n\n"
           "Runs a source with virtual bodies that collide with what the camera sees.\n"
           "SOURCE: synthetic:room or a folder with a clip (see `relief sources`).\n\n"
           "  --scene FILE          bodies and gravity (scene.json); default: two thrown cubes\n"
           "  --profile NAME        live (default) or thesis\n"
           "  --renderer NAME       soft or gl; default: gl in a window, soft headless\n"
           "  --headless            no window: as fast as the machine can, every frame\n"
           "  --frames N            stop after N frames\n"
           "  --video FILE          .mp4, .y4m, or - for Y4M on standard output\n"
           "  --pictures DIR        PNG pictures NNNNNN.png, one every --picture-every frames\n"
           "  --picture-every N     default 30\n"
           "  --log DIR             frames.csv, bodies.csv, contacts.csv\n"
           "  --view NAME           camera (default), depth, normals, mesh, regions, foreground,\n"
           "                        background, velocity, thickness, reason\n"
           "  --scale N             keep every N-th depth pixel (live 1, thesis 8)\n"
           "  --set NAME=VALUE      a setting of the surface (see `relief settings`); any number\n"
           "  --threads N           default: one per processor; results do not depend on it\n"
           "  --hash                print the hash of all body states at the end\n"
           "  --quiet               no progress and no summary\n\n"
           "examples:\n"
           "  relief run synthetic:room\n"
           "  relief run synthetic:room --headless --frames 200 --video out.mp4 --log log\n"
           "  relief run synthetic:thesis --profile thesis --headless --pictures pictures\n"
           "  relief run path/to/clip --headless --view normals --video - | mpv -\n");
}

enum {
    OPTION_SCENE = 256,
    OPTION_PROFILE,
    OPTION_RENDERER,
    OPTION_HEADLESS,
    OPTION_FRAMES,
    OPTION_VIDEO,
    OPTION_PICTURES,
    OPTION_PICTURE_EVERY,
    OPTION_LOG,
    OPTION_VIEW,
    OPTION_SCALE,
    OPTION_SET,
    OPTION_THREADS,
    OPTION_HASH,
    OPTION_QUIET
};

static const struct option long_options[] = {
    {"scene", required_argument, NULL, OPTION_SCENE},
    {"profile", required_argument, NULL, OPTION_PROFILE},
    {"renderer", required_argument, NULL, OPTION_RENDERER},
    {"headless", no_argument, NULL, OPTION_HEADLESS},
    {"frames", required_argument, NULL, OPTION_FRAMES},
    {"video", required_argument, NULL, OPTION_VIDEO},
    {"pictures", required_argument, NULL, OPTION_PICTURES},
    {"picture-every", required_argument, NULL, OPTION_PICTURE_EVERY},
    {"log", required_argument, NULL, OPTION_LOG},
    {"view", required_argument, NULL, OPTION_VIEW},
    {"scale", required_argument, NULL, OPTION_SCALE},
    {"set", required_argument, NULL, OPTION_SET},
    {"threads", required_argument, NULL, OPTION_THREADS},
    {"hash", no_argument, NULL, OPTION_HASH},
    {"quiet", no_argument, NULL, OPTION_QUIET},
    {"help", no_argument, NULL, 'h'},
    {0},
};

/* Takes one option with a number; false after saying what is wrong. */
static bool take_number(const char *name, int64_t high, int64_t *out)
{
    if (command_parse_int(optarg, 1, high, out)) {
        return true;
    }
    command_usage("run", "--%s '%s' is not a number from 1 to %lld", name, optarg, (long long)high);
    return false;
}

static bool take_renderer(run_options *o)
{
    o->use_gl = strcmp(optarg, "gl") == 0;
    o->is_renderer_set = true;
    if (!o->use_gl && strcmp(optarg, "soft") != 0) {
        command_usage("run", "--renderer '%s': use soft or gl", optarg);
        return false;
    }
    return true;
}

static bool take_numeric_option(int option, run_options *o)
{
    int64_t number = 0;
    switch (option) {
    case OPTION_FRAMES: return take_number("frames", 1000000000, &o->frame_count);
    case OPTION_PICTURE_EVERY:
        return take_number("picture-every", 1000000, &o->output.picture_every);
    case OPTION_SCALE:
        if (!take_number("scale", 64, &number)) {
            return false;
        }
        o->session.scale_factor = (int32_t)number;
        return true;
    default:
        if (!take_number("threads", 64, &number)) {
            return false;
        }
        o->session.thread_count = (int32_t)number;
        return true;
    }
}

static bool take_option(int option, run_options *o)
{
    switch (option) {
    case OPTION_SCENE: o->session.scene_path = optarg; return true;
    case OPTION_PROFILE:
        if (!session_parse_profile(optarg, &o->session.profile)) {
            command_usage("run", "--profile '%s': use live or thesis", optarg);
            return false;
        }
        return true;
    case OPTION_SET: return command_set("run", &o->session.settings, optarg) < 0;
    case OPTION_RENDERER: return take_renderer(o);
    case OPTION_HEADLESS: o->is_headless = true; return true;
    case OPTION_VIDEO: o->output.video_path = optarg; return true;
    case OPTION_PICTURES: o->output.picture_folder = optarg; return true;
    case OPTION_LOG: o->output.log_folder = optarg; return true;
    case OPTION_VIEW:
        if (!rlf_view_parse(optarg, &o->view)) {
            command_usage("run", "--view '%s' is not a view", optarg);
            return false;
        }
        return true;
    case OPTION_HASH: o->output.print_hash = true; return true;
    case OPTION_QUIET: o->output.is_quiet = true; return true;
    default: return take_numeric_option(option, o);
    }
}

/* Returns -1 to go on, or an exit status. */
static int parse(int argc, char **argv, run_options *o)
{
    o->session = session_options_default();
    o->session.use_default_scene = true;
    o->output.picture_every = 30;
    o->frame_count = -1;
    int option;
    while ((option = getopt_long(argc, argv, "h", long_options, NULL)) != -1) {
        if (option == 'h') {
            print_help();
            return EXIT_DONE;
        }
        if (option == '?' || !take_option(option, o)) {
            return EXIT_USAGE;
        }
    }
    if (argc - optind != 1) {
        return command_usage("run", argc == optind ? "needs a SOURCE" : "takes one SOURCE only");
    }
    o->session.source = argv[optind];
    return -1;
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
        return rlf_fail(RLF_ERROR_IO, "%s: has no frame with depth; check its depth.txt",
                        o->session.source);
    }
    return RLF_OK;
}

#ifdef RLF_HAVE_VIEWER
static rlf_result on_frame(void *context, const rlf_pipeline_output *frame)
{
    return run_output_add(context, frame);
}

static rlf_result on_picture(void *context, const rlf_image_rgba8 *image, char *out_message,
                             size_t message_size)
{
    return run_output_save(context, image, out_message, message_size);
}

static rlf_result run_window(const run_options *o, session *s, run_output *output)
{
    const rlf_source_info *info = rlf_source_get_info(s->source);
    viewer_options viewer = viewer_options_default();
    viewer.title = "Relief";
    viewer.source_name = info->name;
    viewer.frames_per_second = info->frames_per_second;
    viewer.frame_count = o->frame_count;
    viewer.use_gl = o->use_gl || !o->is_renderer_set;
    viewer.avoid_software_gl = !o->is_renderer_set;
    viewer.view = o->view;
    viewer.show_help = o->output.video_path == NULL;
    viewer.on_frame = on_frame;
    viewer.on_picture = on_picture;
    viewer.context = output;
    viewer.interrupted = &command_interrupted;
    return viewer_run(s->pipeline, &viewer);
}
#else
static rlf_result run_window(const run_options *o, session *s, run_output *output)
{
    (void)o;
    (void)s;
    (void)output;
    return rlf_fail(RLF_ERROR_UNSUPPORTED, "this build has no window; add --headless");
}
#endif

static rlf_result run_frames(run_options *o, session *s, run_output *output)
{
    rlf_pipeline_set_view(s->pipeline, o->view);
    if (o->is_headless) {
        choose_headless_renderer(o, s);
        return run_headless(o, s, output);
    }
    return run_window(o, s, output);
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
    if (result == RLF_OK) {
        result = run_frames(o, s, &output);
    }
    int status = result == RLF_OK ? EXIT_DONE : command_failed();
    if (run_output_close(&output) != RLF_OK && status == EXIT_DONE) {
        status = command_failed();
    }
    if (status == EXIT_DONE && o->output.print_hash) {
        printf("hash %016llx\n",
               (unsigned long long)rlf_world_hash(rlf_pipeline_get_world(s->pipeline)));
    }
    if (status == EXIT_DONE && !o->output.is_quiet) {
        const char *renderer = o->use_gl ? "renderer gl" : "renderer soft";
        run_output_print_summary(&output, o->is_headless ? renderer : "in a window");
    }
    return status;
}

int run_main(int argc, char **argv)
{
    run_options options;
    memset(&options, 0, sizeof(options));
    int status = parse(argc, argv, &options);
    if (status >= 0) {
        return status;
    }
    options.session.enable_overlay = !options.is_headless;
    session s;
    if (session_open(&options.session, &s) != RLF_OK) {
        return command_failed();
    }
    status = run_session(&options, &s);
    session_close(&s);
    return status;
}
