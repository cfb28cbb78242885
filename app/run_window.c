/* The window of `relief run`: what its user may open, save and record. */
#include "run.h"

#include "run_window.h"
#include "command.h"
#include "state_folder.h"
#include "relief/window.h"

#include <stdio.h>
#include <string.h>

/* What the window's callbacks work with. */
typedef struct run_stage {
    run_options options; /* as changed since */
    session *session;
    run_output *output;
    body_models models;
    char source[RLF_WINDOW_SOURCE_SIZE], scene[RLF_WINDOW_SOURCE_SIZE];
    char settings[SETTINGS_MAX][64]; /* of the panel */
    int32_t first_setting;           /* those before are the command line's */
} run_stage;

/* One second is enough for cameras to settle, and for bodies to be seen. */
#define PICTURE_FRAME 30

static rlf_result on_frame(void *context, const rlf_pipeline_output *frame)
{
    const run_stage *stage = context;
    if (frame->frame_index == PICTURE_FRAME && frame->frame.color.data != NULL) {
        recent_keep_picture(stage->options.session.source, &frame->frame.color);
    }
    const rlf_result result = run_output_add(stage->output, frame);
    publisher_apply(stage->output->publisher, stage->session->pipeline, stage->output->recorder);
    return result;
}

static rlf_result on_picture(void *context, const rlf_image_rgba8 *image, char *out_message,
                             size_t message_size)
{
    return run_output_save(((run_stage *)context)->output, image, out_message, message_size);
}

/* Beside the pictures, so that the scene itself stays as it was written. */
static rlf_result on_scene(void *context, const rlf_known_def *known, int32_t count,
                           char *out_message, size_t message_size)
{
    const run_output *output = ((run_stage *)context)->output;
    if (output->options.scene_path == NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "no scene file to save: open one, or use --scene");
    }
    return run_output_save_scene(output, known, count, out_message, message_size);
}

static rlf_result on_record(void *context, char *out_message, size_t message_size)
{
    run_stage *stage = context;
    recorder *r = stage->output->recorder;
    return r != NULL ? recorder_toggle(r, out_message, message_size)
                     : rlf_fail(RLF_ERROR_UNSUPPORTED, "no source to record now");
}

static bool on_status(void *context, char *out, size_t size)
{
    return recorder_describe(((run_stage *)context)->output->recorder, out, size);
}

static rlf_result on_model(void *context, const char *path, double size_m, rlf_shape *out_shape,
                           rlf_look *out_look)
{
    return body_models_load(&((run_stage *)context)->models, path, size_m, out_shape, out_look);
}

static void on_panel_ms(void *context, double ms)
{
    timing_add(&((run_stage *)context)->output->panel_ms, ms);
}

static int32_t on_scenes(void *context, rlf_window_choice *out)
{
    return scene_list(((run_stage *)context)->options.session.scene_path, out);
}

static int32_t on_sources(void *context, rlf_window_choice *out)
{
    (void)context;
    return start_page_list(out);
}

static bool on_setting(void *context, int32_t index, const rlf_reconstruct_def *def,
                       rlf_window_setting *out)
{
    (void)context;
    if (index >= settings_count()) {
        return false;
    }
    setting_view s;
    settings_look(index, def, &s);
    *out = (rlf_window_setting){s.name, s.meaning, s.words, s.is_switch, .need = s.need};
    (void)snprintf(out->value, sizeof out->value, "%s", s.value);
    return true;
}

/* ---- opening something else ----------------------------------------------------------------- */

static void fill_stage(const session *s, const run_options *o, rlf_window_stage *out)
{
    const rlf_source_info *info = rlf_source_get_info(s->source);
    *out = (rlf_window_stage){.pipeline = s->pipeline,
                              .source = s->source,
                              .playback = s->playback,
                              .reconstruct = &s->reconstruct,
                              .source_name = info->name,
                              .frames_per_second = info->is_live ? 0.0 : info->frames_per_second,
                              .scene_name =
                                  o->session.scene_path != NULL ? o->session.scene_path : ""};
}

/* Files have the size and the order of the source that they were begun with. */
static rlf_result check_files(const run_stage *stage)
{
    const run_output_options *o = &stage->output->options;
    const bool is_writing = o->video_path != NULL || o->picture_folder != NULL ||
                            o->log_folder != NULL || stage->options.session.record.path != NULL;
    return is_writing
               ? rlf_fail(RLF_ERROR_UNSUPPORTED, "no other source while --video, --pictures, "
                                                 "--log or --record write this one")
               : RLF_OK;
}

static rlf_result open_source(run_stage *stage, const char *text)
{
    session_options wanted = stage->options.session;
    wanted.source = text;
    rlf_result result = check_files(stage);
    if (result == RLF_OK) {
        result = session_replace(stage->session, &wanted);
    }
    if (result != RLF_OK) {
        return result;
    }
    (void)snprintf(stage->source, sizeof stage->source, "%s", text);
    stage->options.session.source = stage->source;
    stage->output->recorder = stage->session->recorder;
    run_room_close(&stage->output->room);
    recent_note(stage->source);
    return RLF_OK;
}

/* A kiosk's source, which is gone. What --record was writing is whole and stays. */
static rlf_result open_again(run_stage *stage)
{
    stage->output->recorder = NULL;
    stage->options.session.record.path = NULL;
    const rlf_result result = session_again(stage->session, &stage->options.session);
    stage->output->recorder = stage->session->recorder;
    return result;
}

static rlf_result open_scene(run_stage *stage, const char *text)
{
    session_options wanted = stage->options.session;
    wanted.scene_path = text[0] != '\0' ? text : NULL;
    const rlf_result result = session_renew(stage->session, &wanted);
    if (result == RLF_OK) {
        (void)snprintf(stage->scene, sizeof stage->scene, "%s", text);
        wanted.scene_path = text[0] != '\0' ? stage->scene : NULL;
        stage->options.session.scene_path = wanted.scene_path;
        stage->output->options.scene_path = wanted.scene_path;
    }
    return result;
}

static bool is_same_setting(const char *a, const char *b)
{
    const size_t length = strcspn(a, "=");
    return length == strcspn(b, "=") && strncmp(a, b, length) == 0;
}

/* One of the panel's settings takes the place of an earlier one of that name. */
static rlf_result keep_setting(run_stage *stage, setting_list *list, const char *text)
{
    for (int32_t i = stage->first_setting; i < list->count; i++) {
        if (is_same_setting(list->texts[i], text)) {
            list->texts[i] = list->texts[list->count - 1];
            list->count--;
            break;
        }
    }
    return settings_add(list, text);
}

/* Settings keep their texts in slots of their own, none of which is in use twice. */
static void own_last_setting(run_stage *stage, setting_list *list)
{
    for (int32_t slot = 0; slot < SETTINGS_MAX; slot++) {
        bool is_free = true;
        for (int32_t i = 0; i < list->count - 1; i++) {
            is_free = is_free && list->texts[i] != stage->settings[slot];
        }
        if (is_free) {
            (void)snprintf(stage->settings[slot], sizeof stage->settings[slot], "%s",
                           list->texts[list->count - 1]);
            list->texts[list->count - 1] = stage->settings[slot];
            return;
        }
    }
}

static rlf_result open_setting(run_stage *stage, const char *text)
{
    session_options wanted = stage->options.session;
    rlf_result result = RLF_OK;
    if (text[0] == '\0') {
        wanted.settings.count = stage->first_setting;
    } else {
        result = keep_setting(stage, &wanted.settings, text);
    }
    if (result == RLF_OK) {
        result = session_renew(stage->session, &wanted);
    }
    if (result == RLF_OK) {
        if (text[0] != '\0') {
            own_last_setting(stage, &wanted.settings);
        }
        stage->options.session.settings = wanted.settings;
    }
    return result;
}

static rlf_result on_open(void *context, rlf_window_opening what, const char *text,
                          rlf_window_stage *out)
{
    run_stage *stage = context;
    rlf_result result = RLF_OK;
    switch (what) {
    case RLF_WINDOW_OPEN_SOURCE: result = open_source(stage, text); break;
    case RLF_WINDOW_OPEN_SCENE: result = open_scene(stage, text); break;
    case RLF_WINDOW_OPEN_SETTING: result = open_setting(stage, text); break;
    case RLF_WINDOW_OPEN_AGAIN: result = open_again(stage); break;
    }
    if (result == RLF_OK) {
        fill_stage(stage->session, &stage->options, out);
    }
    return result;
}

/* ---- the window ----------------------------------------------------------------------------- */

static void set_callbacks(rlf_window_def *viewer, run_stage *stage)
{
    viewer->on_frame = on_frame;
    viewer->on_picture = on_picture;
    viewer->on_scene = on_scene;
    viewer->on_record = on_record;
    viewer->on_status = on_status;
    viewer->on_open = on_open;
    viewer->on_model = on_model;
    viewer->on_setting = on_setting;
    viewer->on_sources = on_sources;
    viewer->on_scenes = on_scenes;
    viewer->on_panel_ms = on_panel_ms;
    viewer->context = stage;
    viewer->interrupted = &command_interrupted;
}

/* Large, and its models live until the session is closed. */
static run_stage stage;
static char corners_path[STATE_PATH_SIZE];

/* Each monitor may be a projector of its own. */
static const char *name_corners(int32_t monitor)
{
    char name[32];
    (void)snprintf(name, sizeof(name), "corners-%d", (int)monitor);
    return state_make_folder() && state_path(name, corners_path) ? corners_path : NULL;
}

void run_window_end(void)
{
    body_models_destroy(&stage.models);
}

rlf_result run_window(const run_options *o, session *s, run_output *output)
{
    memset(&stage, 0, sizeof stage);
    stage.options = *o;
    stage.session = s;
    stage.output = output;
    stage.first_setting = o->session.settings.count;
    recent_note(o->session.source);
    rlf_window_def viewer = rlf_window_def_default();
    fill_stage(s, o, &viewer.stage);
    viewer.title = "Relief";
    viewer.frame_count = o->frame_count;
    viewer.use_gl = o->use_gl || !o->is_renderer_set;
    viewer.avoid_software_gl = !o->is_renderer_set;
    memcpy(viewer.views, o->views, sizeof(viewer.views));
    viewer.view_count = o->view_count;
    viewer.orbit = o->orbit;
    viewer.is_fullscreen = o->window.is_fullscreen;
    viewer.is_mirrored = o->window.is_mirrored;
    viewer.hides_overlay = o->window.hides_overlay;
    viewer.overlay_everywhere = o->window.shows_overlay;
    viewer.hides_panel = o->window.hides_panel;
    viewer.has_light_panel = o->window.has_light_panel;
    viewer.monitor = o->window.monitor;
    viewer.fills = o->window.fills;
    viewer.is_kiosk = o->window.is_kiosk;
    viewer.keeps_size = o->output.video_path != NULL || o->output.picture_folder != NULL;
    viewer.keeps_view = o->session.projector_path != NULL;
    viewer.corners_path = name_corners(o->window.monitor);
    set_callbacks(&viewer, &stage);
    return rlf_window_run(s->pipeline, &viewer);
}
