/* The options of `relief run`, and its help. */
#include "command.h"
#include "options.h"
#include "run.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

static void print_output_help(void)
{
    printf(
        "  --video FILE          .mp4, .y4m, - for Y4M on standard output, or a virtual camera:\n"
        "                        pipewire:NAME, or /dev/videoN of v4l2loopback\n"
        "  --pictures DIR        PNG pictures NNNNNN.png, one every 30 frames; keys:\n"
        "                        DIR?every=10, ?at=60+92+last (these frames alone), ?shrink=2\n"
        "                        (average 2 x 2 pixels into one), with & between\n"
        "  --record FILE.mcap    what the source gives, for playing it again; keys as the\n"
        "                        options of `relief record`: FILE.mcap?codec=png, and ?bodies:\n"
        "                        the bodies' poses, too, as frames of /tf\n"
        "  --log DIR             frames.csv, bodies.csv, contacts.csv, hands.csv, and\n"
        "                        trajectory.txt when the camera moves\n"
        "  --mesh FILE           at the end: the room that a moving camera has seen, .ply, .obj\n"
        "                        or .glb; keys: voxel=MM (2 to 50, default 6), memory=MB\n"
        "                        (default 288; the farthest leaves first), weight=N (leaves out\n"
        "                        what was seen less: a frame from near adds 16, one from far 1;\n"
        "                        default 32, less for fewer than 128 frames)\n"
        "  --save-map FILE.map   at the end: that room for --map; keys voxel, memory\n");
}

static void print_publish_help(void)
{
    printf("  --publish PLACE       contacts, gestures, poses and regions for other programs, and\n"
           "                        their commands; ws:[HOST:]PORT, JSON by WebSocket, or\n"
           "                        osc:[HOST:]PORT; on this machine unless HOST says more; up to\n"
           "                        4 times. Keys: every=N (poses of each N-th frame), of osc\n"
           "                        listen=[HOST:]PORT (for commands), of ws origin=URL (a web\n"
           "                        page that may connect). See docs/events.md\n"
           "                        Or ros2:/NAME: frames, picture, points, foreground, bodies\n"
           "                        and contacts below that name, for ROS 2; keys: profile\n"
           "                        (local or lan), domain=N. See docs/ros2.md\n");
}

static void print_camera_help(void)
{
    printf(
        "  --camera NAME         auto (default): fixed; moving while the view as a whole does,\n"
        "                        until it stands for 2 s; moving: tracked against a map from\n"
        "                        the first frame, the default of --mesh and --save-map;\n"
        "                        source: moving, by the source's own poses (groundtruth.txt);\n"
        "                        fixed: never tracked\n"
        "  --map FILE.map        a known room, as --save-map writes it: the camera is looked for\n"
        "                        in it\n"
        "  --hands NAME          look (for hands.csv), or grab: and real fingers can hold bodies\n"
        "                        (experimental)\n");
}

static void print_view_help(void)
{
    printf(
        "  --view NAME[,NAME...] camera (default), depth, normals, mesh, regions, foreground,\n"
        "                        background, velocity, thickness, reason, points, contacts,\n"
        "                        known, hands, map, bodies;\n"
        "                        up to four of them side by side; key legend: what their\n"
        "                        colours mean, with units, in the picture ('depth?legend');\n"
        "                        key camera: another one of a list ('depth?camera=2')\n"
        "  --orbit YAW,PITCH[,ZOOM]   where points and map are seen from: degrees to the\n"
        "                        right and up, and the distance, 1 being the camera's\n"
        "  --light NAME          auto: bodies as dark and as tinted as the camera's picture, and\n"
        "                        lit from where its shading says (live's default for clips);\n"
        "                        scene: not so; or X,Y,Z: it shines to right, down, forward;\n"
        "                        may be given twice\n"
        "  --shade NAME          of real things on bodies: on (default), cast (their shadows\n"
        "                        alone), near (darker close to them alone) or off\n"
        "  --occlusion NAME      soft (live's), hard, thesis (thesis's) or off\n");
}

static void print_help(void)
{
    printf(
        "usage: relief run [SOURCE] [OPTIONS]\n\n"
        "Runs a source with virtual bodies that collide with what the camera sees.\n"
        "SOURCE: synthetic:room or a folder with a clip (see `relief list sources`), or a list of\n"
        "cameras of one room, FILE.json; without one the window lists cameras and recent\n"
        "recordings.\n\n"
        "  --scene NAME          bodies and gravity: a scene that `relief list scenes` tells, or "
        "a\n"
        "                        file scene.json; default: two thrown cubes\n"
        "  --profile NAME        live (default) or thesis\n"
        "  --renderer NAME       soft or gl; default: gl in a window, soft headless\n"
        "  --headless            no window: as fast as the machine can, every frame\n"
        "  --window LIST         full (the picture alone), full=N (on monitor N), fill (cut, no\n"
        "                        black bars), mirror, text=on, off or full (also in full screen),\n"
        "                        panel=off or light; kiosk or kiosk=LOG (full, and opens the "
        "source\n"
        "                        again when it fails); projector=FILE (bodies alone, from the "
        "lens\n"
        "                        of a calibrated pair's second camera; also headless); after a\n"
        "                        recording end=loop (default), hold (bodies fall on over the last\n"
        "                        frame) or stop (default where frames are written or counted)\n"
        "  --frames N            stop after N frames\n");
    print_output_help();
    print_publish_help();
    print_camera_help();
    print_view_help();
    printf("  --gravity X,Y,Z       m/s^2 to the right, down and forward, in place of the\n"
           "                        scene's; or floor: down is where the first frame's floor,\n"
           "                        tables and walls say; clips' default if the scene says none\n"
           "  --scale N             keep every N-th depth pixel (live 1, thesis 8)\n"
           "  --set NAME=VALUE      a setting of the surface (see `relief list settings`); any "
           "number\n"
           "  --threads N           default: one per processor; results do not depend on it\n"
           "  --plugin FILE         a plug-in that brings a camera or a format; any number\n"
           "  --hash                print the hash of all body states at the end\n"
           "  --quiet               no progress and no summary\n\n"
           "examples:\n"
           "  relief run synthetic:room\n"
           "  relief run synthetic:room --headless --frames 200 --video out.mp4 --log log\n"
           "  relief run path/to/clip --headless --view normals --video - | mpv -\n"
           "  relief run path/to/clip --headless --mesh room.glb --log log\n"
           "  relief run synthetic:room --headless --frames 93 --pictures 'pictures?at=60+92'\n");
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

/* Its colour and where it comes from: two answers, so it may be given twice. */
static bool take_light(const char *text, void *out)
{
    session_options *s = out;
    rlf_vec3 *l = &s->light_direction;
    char rest;
    const bool is_auto = strcmp(text, "auto") == 0, is_scene = strcmp(text, "scene") == 0;
    if (is_auto || is_scene) {
        s->matches_light = is_auto;
        s->keeps_light = is_scene;
        return true;
    }
    bool is_good = sscanf(text, "%lf,%lf,%lf%c", &l->x, &l->y, &l->z, &rest) == 3 &&
                   rlf_vec3_is_finite(*l) && rlf_length(*l) > 1e-6 && rlf_length(*l) < 1e6;
    *l = is_good ? rlf_normalize(*l) : *l;
    s->is_light_set = is_good;
    return is_good;
}

/* Index of a word, -1 for none. */
static int find_word(const char *text, const char *const *words, int count)
{
    for (int i = 0; i < count; i++) {
        if (strcmp(text, words[i]) == 0) {
            return i;
        }
    }
    return -1;
}

static bool take_shade(const char *text, void *out)
{
    static const char *const names[4] = {"on", "cast", "near", "off"};
    session_options *s = out;
    const int found = find_word(text, names, 4);
    s->no_real_ambient = found == 1 || found == 3;
    s->no_real_shade = found == 2 || found == 3;
    return found >= 0;
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
    static const char *const names[4] = {"fixed", "moving", "auto", "source"};
    session_options *s = out;
    const int found = find_word(text, names, 4);
    s->is_camera_set = true;
    s->poses = found == 3 ? RLF_POSES_SOURCE : RLF_POSES_TRACKED;
    s->camera = found == 3 ? RLF_CAMERA_MOVING : (rlf_camera_mode)found;
    return found >= 0;
}

static bool take_hands(const char *text, void *out)
{
    static const char *const names[2] = {"look", "grab"};
    session_options *s = out;
    const int found = find_word(text, names, 2);
    s->enable_hands = true;
    s->enable_grab = found == 1;
    return found >= 0;
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

/* A monitor's number; 0 = the one that the window is on. */
static bool take_full(const char *text, void *out)
{
    run_window_options *o = out;
    char rest;
    o->is_fullscreen = true;
    return sscanf(text, "%d%c", &o->monitor, &rest) == 1 && o->monitor >= 0 && o->monitor <= 16;
}

/* "-": the usual log. */
static bool take_kiosk(const char *text, void *out)
{
    run_window_options *o = out;
    o->is_kiosk = o->is_fullscreen = true;
    o->log_path = strcmp(text, "-") != 0 ? text : NULL;
    return text[0] != '\0';
}

static bool take_overlay(const char *text, void *out)
{
    run_window_options *o = out;
    o->hides_overlay = strcmp(text, "off") == 0;
    o->shows_overlay = strcmp(text, "full") == 0;
    return o->hides_overlay || o->shows_overlay || strcmp(text, "on") == 0;
}

static bool take_panel(const char *text, void *out)
{
    run_window_options *o = out;
    o->hides_panel = strcmp(text, "off") == 0;
    o->has_light_panel = strcmp(text, "light") == 0;
    return o->hides_panel || o->has_light_panel || strcmp(text, "on") == 0;
}

static bool take_occlusion(const char *text, void *out)
{
    static const char *const names[4] = {"hard", "thesis", "off", "soft"};
    session_options *s = out;
    const int found = find_word(text, names, 4);
    s->occlusion = (rlf_occlusion)found;
    s->is_occlusion_set = found >= 0;
    return found >= 0;
}

/* "60+92+last" into the run_output_options. */
static bool take_picture_frames(const char *text, void *out)
{
    run_output_options *o = out;
    char list[256];
    const size_t length = strlen(text), last = strlen("last");
    o->keeps_last = length >= last && strcmp(text + length - last, "last") == 0;
    const size_t kept = o->keeps_last ? length - last : length;
    if (kept >= sizeof list) {
        return false;
    }
    (void)snprintf(list, sizeof list, "%.*s", (int)kept, text);
    if (o->keeps_last && kept > 0 && list[kept - 1] == '+') {
        list[kept - 1] = '\0';
    }
    for (char *plus = strchr(list, '+'); plus != NULL; plus = strchr(plus, '+')) {
        *plus = ',';
    }
    return (o->keeps_last && list[0] == '\0') ||
           command_parse_list(list, 0, INT64_C(1000000000), RUN_PICTURES_MAX, o->picture_at,
                              &o->picture_count);
}

static bool take_mesh(const char *text, void *out)
{
    *(const char **)out = text;
    return rlf_map_mesh_check_name(text) == RLF_OK;
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

/* ---- the table ------------------------------------------------------------------------------ */

/* Of --window. */
#define WINDOW_KEYS(o)                                                                             \
    {                                                                                              \
        {.name = "full",                                                                           \
         .kind = OPTION_CHOICE,                                                                    \
         .out = &(o)->window,                                                                      \
         .take = take_full,                                                                        \
         .choices = "use a monitor's number, 1 to 16",                                             \
         .bare = "0"},                                                                             \
            {.name = "kiosk",                                                                      \
             .kind = OPTION_CHOICE,                                                                \
             .out = &(o)->window,                                                                  \
             .take = take_kiosk,                                                                   \
             .choices = "use the name of a log file",                                              \
             .bare = "-"},                                                                         \
            ROW_FLAG("fill", &(o)->window.fills),                                                  \
            ROW_TEXT("projector", &(o)->session.projector_path),                                   \
            ROW_FLAG("mirror", &(o)->window.is_mirrored),                                          \
            ROW_CHOICE("text", &(o)->window, take_overlay, "use on, off or full"),                 \
            ROW_CHOICE("panel", &(o)->window, take_panel, "use on, light or off"),                 \
            ROW_CHOICE("end", (o), take_end, "use loop, hold or stop"), {0},                       \
    }

/* Of --pictures. */
#define PICTURE_KEYS(o)                                                                            \
    {                                                                                              \
        ROW_INT64("every", &(o)->picture_every, 1, 1000000),                                       \
            ROW_CHOICE("at", (o), take_picture_frames,                                             \
                       "use up to 16 frame numbers with + between, and last"),                     \
            ROW_INT32("shrink", &(o)->picture_shrink, 1, 64), {0},                                 \
    }

/* Of --mesh and --save-map. */
#define MAP_KEYS(o)                                                                                \
    ROW_INT32("voxel", &(o)->session.voxel_mm, 2, 50),                                             \
        ROW_INT32("memory", &(o)->session.map_memory_mb, 8, RLF_MAP_MEMORY_MOST_MB)

/* Rows about what is written. */
#define OUTPUT_OPTIONS(o)                                                                          \
    ROW_CHOICE("video", &(o)->output.video_path, take_video,                                       \
               "end the name in .mp4 or .y4m, or give - for Y4M on standard output, "              \
               "pipewire:NAME or /dev/videoN"),                                                    \
        {.name = "pictures",                                                                       \
         .kind = OPTION_FOLDER,                                                                    \
         .out = &(o)->output.picture_folder,                                                       \
         .keys = picture_keys},                                                                    \
        {.name = "record",                                                                         \
         .kind = OPTION_CHOICE,                                                                    \
         .out = &(o)->session.record,                                                              \
         .take = recorder_take_path,                                                               \
         .choices = RECORDER_PATH,                                                                 \
         .keys = record_keys},                                                                     \
        ROW_FOLDER("log", &(o)->output.log_folder),                                                \
        {.name = "mesh",                                                                           \
         .kind = OPTION_CHOICE,                                                                    \
         .out = &(o)->room.mesh_path,                                                              \
         .take = take_mesh,                                                                        \
         .choices = "end the name in .ply, .obj or .glb",                                          \
         .keys = mesh_keys},                                                                       \
    {                                                                                              \
        .name = "save-map", .kind = OPTION_FILE, .out = &(o)->room.map_path, .choices = ".map",    \
        .keys = map_keys                                                                           \
    }

/* Rows about what bodies meet. */
#define WORLD_OPTIONS(s)                                                                           \
    {.name = "scene", .kind = OPTION_SCENE, .out = &(s)->scene_path},                              \
        {.name = "profile", .kind = OPTION_PROFILE, .out = &(s)->profile},                         \
        ROW_CHOICE("gravity", (s), take_gravity, "use floor, or X,Y,Z of up to 1000 m/s^2"),       \
        ROW_CHOICE("camera", (s), take_camera, "use auto, fixed, moving or source"),               \
        ROW_TEXT("map", &(s)->map_path), ROW_CHOICE("hands", (s), take_hands, "use look or grab"), \
        ROW_INT32("scale", &(s)->scale_factor, 1, 64),                                             \
        {.name = "set", .kind = OPTION_SET, .out = &(s)->settings},                                \
        ROW_INT32("threads", &(s)->thread_count, 1, 64)

/* Rows about the picture. */
#define VIEW_OPTIONS(o)                                                                            \
    ROW_CHOICE("renderer", (o), take_renderer, "use soft or gl"),                                  \
        {.name = "view",                                                                           \
         .kind = OPTION_CHOICE,                                                                    \
         .out = (o),                                                                               \
         .take = take_views,                                                                       \
         .choices = "is not a list of up to four views",                                           \
         .names = view_names(),                                                                    \
         .keys = view_keys},                                                                       \
        ROW_CHOICE("orbit", &(o)->orbit, options_take_orbit, OPTIONS_ORBIT),                       \
        ROW_CHOICE("light", &(o)->session, take_light, "use auto, scene, or X,Y,Z, not all zero"), \
        ROW_CHOICE("shade", &(o)->session, take_shade, "use on, cast, near or off"),               \
        ROW_CHOICE("occlusion", &(o)->session, take_occlusion, "use soft, hard, thesis or off")

static int read_options(int argc, char **argv, run_options *o)
{
    const option_def window_keys[] = WINDOW_KEYS(o);
    const option_def view_keys[] = {
        ROW_FLAG("legend", &o->shows_legend),
        ROW_INT32("camera", &o->session.drawn_camera, 1, RLF_WORLD_CAMERAS_MAX),
        {0},
    };
    const option_def picture_keys[] = PICTURE_KEYS(&o->output);
    const option_def record_keys[] = {
        ROW_FLAG("bodies", &o->session.record.keeps_bodies),
        RECORDER_OPTIONS(&o->session.record),
        {0},
    };
    const option_def publish_keys[] = {
        ROW_CHOICE("every", &o->publish, publish_take_every, "use a number from 1 to 1000"),
        ROW_CHOICE("listen", &o->publish, publish_take_listen, "give [HOST:]PORT, of osc alone"),
        ROW_CHOICE("origin", &o->publish, publish_take_origin,
                   "give http://HOST:PORT of the page, of ws alone"),
        ROW_CHOICE("profile", &o->publish, publish_take_profile,
                   "use local, lan or a file, of ros2 alone"),
        ROW_CHOICE("domain", &o->publish, publish_take_domain,
                   "use a number from 0 to 232, of ros2 alone"),
        {0},
    };
    const option_def map_keys[] = {MAP_KEYS(o), {0}};
    const option_def mesh_keys[] = {
        MAP_KEYS(o),
        ROW_INT32("weight", &o->room.min_weight, 1, 255),
        {0},
    };
    const option_def options[] = {
        WORLD_OPTIONS(&o->session),
        VIEW_OPTIONS(o),
        OUTPUT_OPTIONS(o),
        {.name = "publish",
         .kind = OPTION_CHOICE,
         .out = &o->publish,
         .take = publish_take,
         .choices = PUBLISH_CHOICES,
         .keys = publish_keys},
        ROW_FLAG("headless", &o->is_headless),
        {.name = "window", .kind = OPTION_KEYS, .keys = window_keys},
        ROW_INT64("frames", &o->frame_count, 1, 1000000000),
        ROW_FLAG("hash", &o->output.print_hash),
        ROW_FLAG("quiet", &o->output.is_quiet),
        ROW_PLUGIN,
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
    const bool keeps_room = o->room.mesh_path != NULL || o->room.map_path != NULL;
    if (keeps_room && !o->session.is_camera_set) {
        o->session.camera = RLF_CAMERA_MOVING;
    }
    o->session.makes_map = keeps_room;
    o->session.map_is_whole = keeps_room && o->is_headless;
    o->session.source = argv[optind]; /* NULL when there is none */
    if (o->session.projector_path != NULL) {
        o->views[0] = RLF_VIEW_BODIES;
        o->view_count = 1;
    }
    return -1;
}
