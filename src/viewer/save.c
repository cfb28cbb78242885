/* Pictures and recordings where the program leaves them to the window: in the working folder. */
#include "viewer/state.h"

#include "relief/io.h"

#include <stdio.h>
#include <time.h>

void viewer_save_picture(viewer *v)
{
    char text[VIEWER_MESSAGE_SIZE] = "";
    const rlf_window_def *o = v->options;
    const rlf_image_rgba8 *image = &v->frame.render.image;
    if (!v->has_frame) {
        viewer_show_error(v, "no picture yet");
        return;
    }
    if (o->on_picture != NULL) {
        viewer_show_result(v, o->on_picture(o->context, image, text, sizeof text), text);
        return;
    }
    char path[64];
    (void)snprintf(path, sizeof path, "relief-%06lld.png", (long long)v->frames_done);
    (void)snprintf(text, sizeof text, "saved %s", path);
    viewer_show_result(v, rlf_png_write_premultiplied(path, image), text);
}

/* ---- recording ------------------------------------------------------------------------------ */

static rlf_result begin(viewer *v)
{
    rlf_source_info info = {.frame_count = -1, .is_live = true};
    if (v->stage.source != NULL) {
        info = *rlf_source_get_info(v->stage.source);
    } else {
        info.rig = rlf_pipeline_get_compositor_def(v->stage.pipeline).rig;
    }
    const time_t now = time(NULL);
    const struct tm *t = localtime(&now);
    if (t == NULL || strftime(v->recording_path, sizeof v->recording_path,
                              "relief-%Y%m%d-%H%M%S.mcap", t) == 0) {
        return rlf_fail(RLF_ERROR_DEVICE, "this machine's clock gives no time to name a file by");
    }
    const rlf_recording_def def = rlf_recording_def_default();
    v->recording_ns = rlf_clock_ns();
    return rlf_recording_open(v->recording_path, &info, &def, &v->recording);
}

void viewer_end_recording(viewer *v)
{
    char text[VIEWER_LINE_SIZE];
    rlf_recording_status status = {0};
    if (v->recording == NULL) {
        return;
    }
    const rlf_result result = rlf_recording_close(&v->recording, &status);
    (void)snprintf(text, sizeof text, "recorded %s: %llu frames", v->recording_path,
                   (unsigned long long)status.frames);
    viewer_show_result(v, result, text);
}

void viewer_toggle_record(viewer *v)
{
    char text[VIEWER_LINE_SIZE];
    const rlf_window_def *o = v->options;
    if (o->on_record != NULL) {
        viewer_show_result(v, o->on_record(o->context, text, sizeof text), text);
    } else if (v->recording != NULL) {
        viewer_end_recording(v);
    } else {
        const rlf_result result = begin(v);
        (void)snprintf(text, sizeof text, "recording %s", v->recording_path);
        viewer_show_result(v, result, text);
    }
}

void viewer_record_frame(viewer *v)
{
    if (v->recording != NULL && rlf_recording_add(v->recording, &v->frame.frame) != RLF_OK) {
        viewer_show_error(v, rlf_error_text());
        (void)rlf_recording_close(&v->recording, NULL);
    }
}

bool viewer_describe_recording(const viewer *v, char *out, size_t size)
{
    const rlf_window_def *o = v->options;
    if (v->recording != NULL) {
        const rlf_recording_status status = rlf_recording_get_status(v->recording);
        const int64_t seconds = (rlf_clock_ns() - v->recording_ns) / (int64_t)VIEWER_NS_PER_S;
        (void)snprintf(out, size, "%d:%02d  recording %s: %llu frames", (int)(seconds / 60),
                       (int)(seconds % 60), v->recording_path, (unsigned long long)status.frames);
        return true;
    }
    return o->on_status != NULL && o->on_status(o->context, out, size);
}
