/* Video, pictures and logs of a run. */
#define _XOPEN_SOURCE 700
#include "run.h"

#include "command.h"
#include "picture_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define PROGRESS_INTERVAL_NS INT64_C(500000000)
#define PATH_SIZE 4096

rlf_result run_output_open(const run_output_options *options, const rlf_source_info *info,
                           int64_t frame_total, run_output *out)
{
    memset(out, 0, sizeof(*out));
    out->options = *options;
    out->frames_per_second = info->frames_per_second > 0.0 ? info->frames_per_second : 30.0;
    out->frame_total = frame_total;
    out->start_ns = out->last_frame_ns = rlf_clock_ns();
    if (options->picture_folder != NULL) {
        rlf_result result = rlf_make_folder(options->picture_folder);
        if (result != RLF_OK) {
            return result;
        }
    }
    return options->log_folder != NULL ? rlf_make_folder(options->log_folder) : RLF_OK;
}

static rlf_result write_log(run_output *out, const rlf_pipeline_output *frame)
{
    rlf_result result = RLF_OK;
    if (out->log == NULL) {
        result = rlf_csv_log_open(out->options.log_folder, &out->log);
    }
    return result == RLF_OK ? rlf_csv_log_write(out->log, frame) : result;
}

static rlf_result write_video(run_output *out, const rlf_image_rgba8 *image)
{
    if (out->video == NULL) {
        rlf_result result = rlf_video_open(out->options.video_path, image->width, image->height,
                                           out->frames_per_second, &out->video);
        if (result != RLF_OK) {
            return result;
        }
    }
    return rlf_video_write(out->video, image);
}

static rlf_result write_picture(run_output *out)
{
    char path[PATH_SIZE];
    int length = snprintf(path, sizeof(path), "%s/%06lld.png", out->options.picture_folder,
                          (long long)out->last_index);
    if (length < 0 || length >= PATH_SIZE) {
        return rlf_fail(RLF_ERROR_IO, "%s: the path is too long", out->options.picture_folder);
    }
    out->pictures++;
    out->has_last = true;
    return picture_file_write(path, &out->last_image, out->options.picture_shrink);
}

rlf_result run_output_save(run_output *out, const rlf_image_rgba8 *image, char *out_message,
                           size_t message_size)
{
    const char *folder = out->options.picture_folder != NULL ? out->options.picture_folder : ".";
    char path[PATH_SIZE];
    int length =
        snprintf(path, sizeof(path), "%s/relief-%06lld.png", folder, (long long)out->frames);
    if (length < 0 || length >= PATH_SIZE) {
        return rlf_fail(RLF_ERROR_IO, "%s: the path is too long", folder);
    }
    const rlf_result result = rlf_png_write_premultiplied(path, image);
    char *whole = result == RLF_OK ? realpath(path, NULL) : NULL;
    snprintf(out_message, message_size, "saved %s", whole != NULL ? whole : path);
    free(whole);
    return result;
}

rlf_result run_output_save_scene(const run_output *out, const rlf_known_def *known, int32_t count,
                                 char *out_message, size_t message_size)
{
    const char *folder = out->options.picture_folder != NULL ? out->options.picture_folder : ".";
    char path[PATH_SIZE];
    int length = snprintf(path, sizeof(path), "%s/placed.json", folder);
    if (length < 0 || length >= PATH_SIZE) {
        return rlf_fail(RLF_ERROR_IO, "%s: the path is too long", folder);
    }
    snprintf(out_message, message_size, "saved %s", path);
    return rlf_scene_save_known(out->options.scene_path, known, count, path);
}

static void print_progress(run_output *out)
{
    int64_t now = rlf_clock_ns();
    if (out->options.is_quiet || now - out->last_progress_ns < PROGRESS_INTERVAL_NS ||
        !isatty(STDERR_FILENO)) {
        return;
    }
    out->last_progress_ns = now;
    double fps = (double)out->frames / ((double)(now - out->start_ns) * 1e-9);
    if (out->frame_total > 0) {
        fprintf(stderr, "\rframe %lld of %lld, %.1f per second ", (long long)out->frames,
                (long long)out->frame_total, fps);
    } else {
        fprintf(stderr, "\rframe %lld, %.1f per second ", (long long)out->frames, fps);
    }
}

static bool is_wanted(const run_output_options *o, int64_t frame)
{
    bool is_listed = false;
    for (int i = 0; i < o->picture_count; i++) {
        is_listed = is_listed || o->picture_at[i] == frame;
    }
    const bool has_list = o->picture_count > 0 || o->keeps_last;
    return has_list ? is_listed : frame % o->picture_every == 0;
}

rlf_result run_output_add(run_output *out, const rlf_pipeline_output *frame)
{
    const rlf_stage_times *t = &frame->times;
    timing_add_frame(&out->times, t, t->capture_ms + t->surface_ms + t->physics_ms + t->render_ms);
    if (frame->latency_ms > 0.0) {
        timing_add(&out->latency_ms, frame->latency_ms);
    }
    out->frames++;
    out->last_index = frame->frame_index;
    out->last_image = frame->render.image;
    out->has_last = false;
    out->moving_frames += frame->surface->camera_moves;
    out->tracked_frames += frame->track != NULL;
    out->lost_frames += frame->track != NULL && frame->track->health == RLF_TRACK_LOST;
    out->gravity = frame->snapshot->gravity;
    out->gravity_confidence = frame->gravity_confidence;
    out->light = frame->render.light_direction;
    out->is_light_estimated = frame->render.is_light_estimated;
    print_progress(out);
    publisher_frame(out->publisher, frame);
    recorder_add_bodies(out->recorder, frame->frame.time_ns, frame->snapshot);
    rlf_result result = run_room_add(&out->room, out->options.room, frame);
    if (result == RLF_OK && out->options.log_folder != NULL) {
        result = write_log(out, frame);
    }
    if (result == RLF_OK && out->options.video_path != NULL) {
        result = write_video(out, &frame->render.image);
    }
    if (result == RLF_OK && out->options.picture_folder != NULL &&
        is_wanted(&out->options, frame->frame_index)) {
        result = write_picture(out);
    }
    return result;
}

rlf_result run_output_end(run_output *out)
{
    const run_output_options *o = &out->options;
    if (o->picture_folder == NULL) {
        return RLF_OK;
    }
    for (int i = 0; i < o->picture_count; i++) {
        if (o->picture_at[i] > out->last_index) {
            return rlf_fail(RLF_ERROR_IO,
                            "no picture of frame %lld: the last one was %lld (the first is 0)",
                            (long long)o->picture_at[i], (long long)out->last_index);
        }
    }
    const bool is_due = o->keeps_last && !out->has_last && out->frames > 0;
    return is_due ? write_picture(out) : RLF_OK;
}

rlf_result run_output_close(run_output *out)
{
    if (!out->options.is_quiet && isatty(STDERR_FILENO)) {
        fprintf(stderr, "\r%60s\r", "");
    }
    rlf_result video_result = rlf_video_close(&out->video);
    char video_error[1024];
    snprintf(video_error, sizeof(video_error), "%s", rlf_error_text());
    rlf_result log_result = rlf_csv_log_close(&out->log);
    if (video_result != RLF_OK) {
        return rlf_fail(video_result, "%s", video_error);
    }
    return log_result;
}

static void print_stage(FILE *file, const char *name, const timing_series *series)
{
    fprintf(file, "  %-8s %7.2f %7.2f\n", name, timing_percentile(series, 50),
            timing_percentile(series, 95));
}

/* Nothing where all is as it should be. */
static void print_status(FILE *file, const rlf_source_status *s)
{
    const struct {
        uint64_t count;
        const char *name;
    } parts[] = {{s->lost, "lost"},
                 {s->late, "overtaken by newer ones"},
                 {s->doubled, "came twice"},
                 {s->unpaired, "without colour"},
                 {s->damaged, "damaged"}};
    const char *before = "source:   ";
    for (size_t i = 0; i < sizeof(parts) / sizeof(parts[0]); i++) {
        if (parts[i].count > 0) {
            fprintf(file, "%s%llu %s", before, (unsigned long long)parts[i].count, parts[i].name);
            before = ", ";
        }
    }
    if (before[0] == ',') {
        fputc('\n', file);
    }
}

FILE *run_output_words(const run_output_options *o)
{
    return o->video_path != NULL && strcmp(o->video_path, "-") == 0 ? stderr : stdout;
}

void run_output_print_summary(const run_output *out, const char *how,
                              const rlf_source_status *status)
{
    const run_output_options *o = &out->options;
    FILE *file = run_output_words(o);
    const timing *t = &out->times;
    double median = timing_percentile(&t->frame, 50);
    fprintf(file, "%lld %s, %s\n", (long long)out->frames, command_frames(out->frames), how);
    fprintf(file, "  ms        median     p95\n");
    print_stage(file, "capture", &t->capture);
    print_stage(file, "surface", &t->surface);
    print_stage(file, "physics", &t->physics);
    print_stage(file, "render", &t->render);
    print_stage(file, "loop", &t->frame);
    if (out->latency_ms.count > 0) { /* from a frame's arrival to the finished picture */
        print_stage(file, "latency", &out->latency_ms);
    }
    if (out->panel_ms.count > 0) {
        print_stage(file, "panel", &out->panel_ms);
    }
    fprintf(file, "  %.1f frames per second (median of the loop, without writing files)\n",
            median > 0.0 ? 1000.0 / median : 0.0);
    print_status(file, status);
    if (o->finds_gravity) {
        bool is_sure = out->gravity_confidence >= RLF_UP_SURE;
        fprintf(file,
                "gravity:  %.2f, %.2f, %.2f m/s^2 (right, down, forward), confidence %.2f%s\n",
                command_tidy(out->gravity.x, 2), command_tidy(out->gravity.y, 2),
                command_tidy(out->gravity.z, 2), out->gravity_confidence,
                is_sure ? "" : ": not sure; if it is wrong, pass --gravity X,Y,Z");
    }
    if (out->tracked_frames > 0) {
        fprintf(file, "camera:   tracked in %lld %s, lost in %lld\n",
                (long long)out->tracked_frames, command_frames(out->tracked_frames),
                (long long)out->lost_frames);
    } else if (out->moving_frames > 0) {
        fprintf(file, "camera:   moved in %lld %s; put it still (it is not tracked)\n",
                (long long)out->moving_frames, command_frames(out->moving_frames));
    }
    if (rlf_length(out->light) > 0.0) {
        fprintf(file, "light:    to %.2f, %.2f, %.2f (right, down, forward), %s\n",
                command_tidy(out->light.x, 2), command_tidy(out->light.y, 2),
                command_tidy(out->light.z, 2),
                out->is_light_estimated ? "found in the picture"
                : o->is_light_given     ? "given"
                                        : "the default");
    }
    if (o->video_path != NULL && file == stdout) {
        fprintf(file, "video:    %s\n", o->video_path);
    }
    if (o->picture_folder != NULL) {
        fprintf(file, "pictures: %s (%lld)\n", o->picture_folder, (long long)out->pictures);
    }
    if (o->log_folder != NULL) {
        fprintf(file, "logs:     %s/frames.csv, bodies.csv, contacts.csv, hands.csv%s\n",
                o->log_folder, out->tracked_frames > 0 ? ", trajectory.txt" : "");
    }
}
