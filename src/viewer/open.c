/* Other sources, scenes and models while the window is open. */
#include "viewer/state.h"

#include <stdio.h>
#include <string.h>

static bool ends_with(const char *text, const char *end)
{
    const size_t length = strlen(text);
    const size_t tail = strlen(end);
    return length >= tail && strcmp(text + length - tail, end) == 0;
}

/* Looks at what was opened from its first frame on. */
static void begin_stage(viewer *v, const rlf_window_stage *stage)
{
    if (v->stage.playback != NULL && stage->playback != NULL) {
        rlf_playback_set_end(stage->playback, rlf_playback_get_end(v->stage.playback));
    }
    v->stage = *stage;
    memset(&v->frame, 0, sizeof v->frame);
    v->has_frame = false;
    v->is_at_end = false;
    v->is_step_due = true;
    v->silent_s = 0;
    v->grab.is_on = false;
    v->place.is_on = false;
    v->undo.count = 0; /* what they borrow is gone */
    v->kiosk.is_lost = v->is_half = false;
    v->slow_frames = 0;
    v->due_ns = rlf_clock_ns();
    v->last_step_ns = 0;
    viewer_choose_renderer(v);
    rlf_pipeline_set_orbit(stage->pipeline, &v->orbit);
    viewer_set_view(v, v->view);
}

bool viewer_open_stage(viewer *v, rlf_window_opening what, const char *text)
{
    rlf_window_stage stage = v->stage;
    if (v->options->on_open == NULL) {
        viewer_show_error(v, "nothing else can be opened here");
        return false;
    }
    if (v->options->on_open(v->options->context, what, text, &stage) != RLF_OK) {
        if (what != RLF_WINDOW_OPEN_AGAIN) { /* which the kiosk tells */
            viewer_show_error(v, rlf_error_text());
        }
        return false;
    }
    begin_stage(v, &stage);
    return true;
}

static void open_model(viewer *v, const char *path)
{
    char text[VIEWER_LINE_SIZE];
    viewer_throw_def thrown = v->thrown;
    const char *name = strrchr(path, '/');
    if (v->options->on_model == NULL ||
        v->options->on_model(v->options->context, path, thrown.size_m, &thrown.shape,
                             &thrown.look) != RLF_OK) {
        viewer_show_error(v, v->options->on_model != NULL ? rlf_error_text()
                                                          : "models cannot be opened here");
        return;
    }
    (void)snprintf(thrown.model, sizeof thrown.model, "%s", path);
    thrown.kind = VIEWER_THROW_MODEL;
    v->thrown = thrown;
    (void)snprintf(text, sizeof text, "click throws %.80s", name != NULL ? name + 1 : path);
    viewer_show_message(v, text);
}

void viewer_open_path(viewer *v, const char *path)
{
    if (ends_with(path, ".gltf") || ends_with(path, ".glb") || ends_with(path, ".obj")) {
        open_model(v, path);
    } else {
        const bool is_scene = ends_with(path, ".json");
        (void)viewer_open_stage(v, is_scene ? RLF_WINDOW_OPEN_SCENE : RLF_WINDOW_OPEN_SOURCE, path);
    }
}
