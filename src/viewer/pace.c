/* Keeps the source's rate: a picture that takes too long is drawn at half its size. */
#include "viewer/state.h"

#include <stdio.h>
#include <string.h>

#define SLOW_FRAMES 45    /* a second and a half: no hiccup of the desktop lasts as long */
#define WIDTH_MIN 640     /* half of less shows no more of the room */
#define PICTURE_SHARE 0.3 /* of the period: with less for the picture, half of it saves nothing */
#define USUAL_FPS 30.0    /* of cameras that do not say */
#define LATE 1.1          /* of the period: clocks differ */

static bool may_halve(const viewer *v, const rlf_image_rgba8 *image)
{
    return !v->is_half && !v->options->keeps_size && !v->place.is_on && !v->is_beside &&
           strcmp(v->renderer, "soft") == 0 && image->width >= 2 * WIDTH_MIN;
}

void viewer_keep_pace(viewer *v)
{
    const rlf_stage_times *t = &v->times;
    const rlf_image_rgba8 *image = &v->frame.render.image;
    const double fps = v->stage.frames_per_second > 0.0 ? v->stage.frames_per_second : USUAL_FPS;
    const double period_ms = 1000.0 / fps;
    const double picture_ms = t->render_ms + v->present_ms;
    const double work_ms = t->capture_ms * (v->stage.frames_per_second > 0.0) + t->surface_ms +
                           t->physics_ms + picture_ms;
    const bool is_slow = work_ms > LATE * period_ms && picture_ms > PICTURE_SHARE * period_ms;
    v->slow_frames = is_slow && may_halve(v, image) ? v->slow_frames + 1 : 0;
    if (v->slow_frames < SLOW_FRAMES) {
        return;
    }
    char text[VIEWER_LINE_SIZE];
    const int32_t width = image->width, height = image->height;
    v->is_half = true;
    v->slow_frames = 0;
    if (rlf_pipeline_set_picture_size(v->stage.pipeline, width / 2, height / 2) == RLF_OK) {
        (void)snprintf(text, sizeof text, "drawn at %d x %d: %d x %d takes longer than a frame",
                       (int)width / 2, (int)height / 2, (int)width, (int)height);
        viewer_show_message(v, text);
        rlf_log(RLF_LOG_INFO, "window: %s", text);
        memset(&v->frame.render, 0, sizeof v->frame.render); /* was the old renderer's */
        v->is_redraw_due = true;
    }
}

void viewer_draw_whole(viewer *v)
{
    if (!v->is_half) {
        return;
    }
    v->is_half = false;
    v->slow_frames = 0;
    if (rlf_pipeline_set_picture_size(v->stage.pipeline, 0, 0) != RLF_OK) {
        viewer_show_error(v, rlf_error_text());
        return;
    }
    memset(&v->frame.render, 0, sizeof v->frame.render);
    v->is_redraw_due = true;
}
