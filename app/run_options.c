/* The options of `relief run`, and its help. */
#include "command.h"
#include "options.h"
#include "output_name.h"
#include "run.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

static void print_camera_help(void)
{
    printf("  --camera NAME         auto (default): fixed; moving while the view as a whole does,\n"
           "                        until it stands for 2 s; moving: tracked against a map from "
           "the first frame;\n"
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

static bool take_video(const char *text, void *out)
{
    *(const char **)out = text;
    return strcmp(text, "-") == 0 || strncmp(text, "pipewire:", strlen("pipewire:")) == 0 ||
           strncmp(text, "/dev/video", strlen("/dev/video")) == 0 ||
           output_name_has(text, ".mp4 .y4m");
}

static bool take_end(const char *text, void *out)
{
    run_options *o = out;
    o->window.is_end_set = true;
    return rlf_playback_parse(text, &o->session.end);
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
    {.name = "pictures", .kind = OPTION_FOLDER, .out = &(out)->picture_folder},                    \
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
        {.name = "video",
         .kind = OPTION_CHOICE,
         .out = &out->video_path,
         .take = take_video,
         .choices = "end the name in .mp4 or .y4m, or give - for Y4M on standard output, "
                    "pipewire:NAME or /dev/videoN"},
        PICTURE_OPTIONS(out),
        {.name = "hands", .kind = OPTION_FLAG, .out = &s->enable_hands},
        {.name = "grab", .kind = OPTION_FLAG, .out = &s->enable_grab},
        CAMERA_OPTIONS(s),
        {.name = "save-map", .kind = OPTION_FILE, .out = &o->save_map_path, .choices = ".map"},
        {.name = "log", .kind = OPTION_FOLDER, .out = &out->log_folder},
        {.name = "record",
         .kind = OPTION_CHOICE,
         .out = &s->record,
         .take = recorder_take_path,
         .choices = RECORDER_PATH},
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

int run_parse(int argc, char **argv, run_options *o)
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
