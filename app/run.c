/* `relief run`: frames through the whole pipeline, in a window or headless. */
#include "command.h"
#include "run_window.h"
#include "parts.h"
#include "run.h"
#ifdef RLF_HAVE_GL
#include "relief/gl.h"
#endif

#include <stdio.h>
#include <string.h>

/* The window's start page: RLF_END when it was closed, RLF_ERROR_DEVICE or _UNSUPPORTED where there
 * is no window to be had. */
static rlf_result ask_for_source(run_options *o)
{
#ifdef RLF_HAVE_VIEWER
    static rlf_window_choice choice;
    const rlf_result result = start_page_choose(&choice);
    if (result == RLF_OK) {
        const bool has_scene = o->session.scene_path != NULL || choice.scene[0] == '\0';
        o->session.source = choice.source;
        o->session.scene_path = has_scene ? o->session.scene_path : choice.scene;
    }
    return result;
#else
    (void)o;
    return rlf_fail(RLF_ERROR_UNSUPPORTED, "this build has no window: %s", part_cure(PART_WINDOW));
#endif
}

static bool has_no_window(rlf_result result)
{
    return result == RLF_ERROR_DEVICE || result == RLF_ERROR_UNSUPPORTED;
}

/* -1 to go on, else the exit status. */
static int choose_source(run_options *o)
{
    if (o->session.source != NULL) {
        return -1;
    }
    if (o->is_headless) {
        return command_usage("run", "needs a SOURCE");
    }
    const rlf_result result = ask_for_source(o);
    if (has_no_window(result)) {
        return command_usage("run", "needs a SOURCE: no start page: %s", rlf_error_text());
    }
    return result == RLF_OK ? -1 : result == RLF_END ? EXIT_DONE : command_failed();
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
    rlf_log(RLF_LOG_WARNING,
            "this build has no OpenGL renderer; going on with the soft one: for it %s",
            part_cure(PART_OPENGL));
#endif
    o->use_gl = false;
}

/* The moment as another camera of the list sees it. */
static rlf_result draw_other(session *s, int32_t camera, rlf_pipeline_output *frame)
{
    rlf_pipeline_output other;
    rlf_result result = rlf_pipeline_redraw(s->cameras.pipelines[camera - 1], &other);
    if (result == RLF_OK) {
        frame->render = other.render;
    }
    return result == RLF_NO_FRAME ? RLF_OK : result;
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
        if (result == RLF_OK && o->session.drawn_camera > 1) {
            result = draw_other(s, o->session.drawn_camera, &frame);
        }
        if (result == RLF_OK) {
            result = run_output_add(output, &frame);
            publisher_apply(output->publisher, s->pipeline, output->recorder);
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
    return command_interrupted ? RLF_OK : run_output_end(output);
}

#ifndef RLF_HAVE_VIEWER
rlf_result run_window(const run_options *o, session *s, run_output *output)
{
    (void)o;
    (void)s;
    (void)output;
    return rlf_fail(RLF_ERROR_UNSUPPORTED, "this build has no window: add --headless, or %s",
                    part_cure(PART_WINDOW));
}

void run_window_end(void) {}
#endif

static rlf_result run_frames(run_options *o, session *s, run_output *output)
{
    const int32_t camera = o->session.drawn_camera;
    if (camera > s->cameras.count) {
        return rlf_fail(RLF_ERROR_INVALID, "--view: there is no camera %d: %s has %d", (int)camera,
                        o->session.source, (int)s->cameras.count);
    }
    rlf_pipeline *drawn = camera > 1 ? s->cameras.pipelines[camera - 1] : s->pipeline;
    rlf_pipeline_set_orbit(drawn, &o->orbit);
    rlf_pipeline_set_legend(drawn, o->shows_legend);
    rlf_result result = rlf_pipeline_set_views(drawn, o->views, o->view_count);
    if (result != RLF_OK) {
        return result;
    }
    if (camera > 1 && !o->is_headless) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "--view: the window shows the first camera; add --headless for camera %d",
                        (int)camera);
    }
    if (o->is_headless) {
        choose_headless_renderer(o, s);
        return run_headless(o, s, output);
    }
    return run_window(o, s, output);
}

static void print_summary(const run_options *o, session *s, const run_output *output,
                          const recorder_status *recorded)
{
    FILE *words = run_output_words(&o->output);
    const char *renderer = o->use_gl ? "renderer gl" : "renderer soft";
    const rlf_source_status frames =
        s->source != NULL ? rlf_source_get_status(s->source) : (rlf_source_status){0};
    run_output_print_summary(output, o->is_headless ? renderer : "in a window", &frames);
    run_room_print(&output->room, &o->room, rlf_pipeline_get_map(s->pipeline), words);
    recorder_print_summary(words, &o->session.record, recorded);
    publisher_print_summary(output->publisher, words);
}

static int run_session(run_options *o, session *s, publisher *events)
{
    const rlf_source_info *info = rlf_source_get_info(s->source);
    int64_t total = info->frame_count;
    if (o->frame_count > 0 && (total < 0 || o->frame_count < total)) {
        total = o->frame_count;
    }
    static run_output output; /* large: timing samples */
    /* Before the run: afterwards the room would be lost. */
    rlf_result result = run_room_check(&o->room);
    if (result == RLF_OK) {
        result = run_output_open(&o->output, info, total, &output);
    }
    output.recorder = s->recorder;
    output.publisher = events;
    if (result == RLF_OK) {
        result = run_frames(o, s, &output);
    }
    publisher_end(events);
    const rlf_map *map = rlf_pipeline_get_map(s->pipeline);
    if (result == RLF_OK && s->source != NULL) { /* a kiosk's may be gone */
        result = run_room_write(&output.room, &o->room, map, &rlf_source_get_info(s->source)->rig);
    }
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
        print_summary(o, s, &output, &recorded);
    }
    run_room_close(&output.room);
    return status == EXIT_DONE ? command_done() : status;
}

static bool writes_something(const run_options *o)
{
    const run_output_options *out = &o->output;
    return out->video_path != NULL || out->picture_folder != NULL || out->log_folder != NULL ||
           o->session.record.path != NULL || o->room.mesh_path != NULL ||
           o->room.map_path != NULL || out->print_hash;
}

/* What is written or counted ends with the recording, unless one asks for more. */
static void choose_end(run_options *o)
{
    const bool is_kept = writes_something(o) || o->frame_count >= 0;
    o->session.is_played = !o->is_headless;
    if (!o->window.is_end_set) {
        o->session.end = is_kept ? RLF_PLAYBACK_STOP : RLF_PLAYBACK_LOOP;
    }
}

/* Everything is known but what the options leave to the run. */
static int run_chosen(run_options *o)
{
    if (o->window.is_kiosk && kiosk_log_open(o->window.log_path) != RLF_OK) {
        return command_failed();
    }
    choose_end(o);
    o->session.record.is_switched = !o->is_headless || o->publish.count > 0;
    o->output.scene_path = o->session.scene_path;
    o->output.room = &o->room;
    o->room.source = o->session.source;
    o->room.has_source_poses = o->session.poses == RLF_POSES_SOURCE;
    o->session.enable_render = !o->is_headless || o->room.mesh_path == NULL ||
                               o->output.video_path != NULL || o->output.picture_folder != NULL;
    session s;
    if ((o->window.is_kiosk ? kiosk_session_open : session_open)(&o->session, &s) != RLF_OK) {
        return command_not_opened("run");
    }
    publisher *events = NULL;
    if (publisher_open(&o->publish, rlf_source_get_info(s.source), o->session.scene_path,
                       &events) != RLF_OK) {
        session_close(&s);
        return command_failed();
    }
    if (o->is_headless && !o->output.is_quiet && !writes_something(o) && events == NULL) {
        fprintf(stderr, "relief run: nothing will be kept: add --video FILE, --pictures DIR or "
                        "--log DIR\n");
    }
    o->output.finds_gravity = s.scene.finds_gravity;
    o->output.is_light_given = o->session.is_light_set;
    const int status = run_session(o, &s, events);
    session_close(&s);
    publisher_destroy(&events);
    run_window_end();
    kiosk_log_close();
    return status;
}

int run_main(int argc, char **argv)
{
    run_options options;
    memset(&options, 0, sizeof(options));
    int status = run_parse(argc, argv, &options);
    status = status < 0 ? choose_source(&options) : status;
    return status < 0 ? run_chosen(&options) : status;
}

int run_alone(void)
{
    char name[] = "run";
    char *arguments[] = {name, NULL};
    run_options options;
    memset(&options, 0, sizeof(options));
    const int status = run_parse(1, arguments, &options);
    const rlf_result result = status < 0 ? ask_for_source(&options) : RLF_OK;
    if (has_no_window(result)) {
        return -1;
    }
    if (status >= 0 || result != RLF_OK) {
        return status >= 0 ? status : result == RLF_END ? EXIT_DONE : command_failed();
    }
    return run_chosen(&options);
}
