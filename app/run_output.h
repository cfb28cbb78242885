/* What a run leaves behind: video, pictures, logs, progress lines and a summary. */
#ifndef RELIEF_APP_RUN_OUTPUT_H
#define RELIEF_APP_RUN_OUTPUT_H

#include "recorder.h"
#include "relief/io.h"
#include "timing.h"

#include <stdio.h>

#define RUN_PICTURES_MAX 16

typedef struct run_output_options {
    const char *video_path;               /* NULL = none */
    const char *picture_folder;           /* NULL = none */
    int64_t picture_every;                /* frames between pictures, >= 1 */
    int64_t picture_at[RUN_PICTURES_MAX]; /* instead: the pictures of these frames alone */
    int32_t picture_shrink;               /* pixels averaged into one, each way; >= 1 */
    int picture_count;                    /* of them; 0 = every picture_every-th */
    const char *log_folder;               /* NULL = none */
    bool is_quiet;                        /* no progress, no summary */
    const char *scene_path;               /* of the run; NULL = none */
    bool finds_gravity;                   /* so the summary tells it */
    bool is_light_given;                  /* by the user; else an unknown one is the default */
    bool print_hash;                      /* print the hash of all body states at the end */
} run_output_options;

typedef struct run_output {
    run_output_options options;
    double frames_per_second; /* of the video */
    int64_t frame_total;      /* for progress; -1 = unknown */
    rlf_video *video;
    rlf_csv_log *log;
    recorder *recorder; /* borrowed; NULL = none */
    int64_t frames, pictures;
    int64_t last_index; /* of the frames */
    int64_t start_ns, last_frame_ns, last_progress_ns;
    int64_t moving_frames;               /* in which the camera moved and was not tracked */
    int64_t tracked_frames, lost_frames; /* of a camera that moves */
    rlf_vec3 gravity;                    /* of the last frame */
    double gravity_confidence;
    rlf_vec3 light; /* of the last picture: where it shines to; 0 = no picture */
    bool is_light_estimated;
    timing times;
    timing_series latency_ms; /* of frames whose arrival is known */
    timing_series panel_ms;   /* of pictures of the window with its panel */
} run_output;

/* Makes the folders. Files are opened with the first frame, so that a run that has none leaves
 * those of an earlier one alone. */
rlf_result run_output_open(const run_output_options *options, const rlf_source_info *info,
                           int64_t frame_total, run_output *out);
/* Takes one frame: writes what was asked for and notes the times. */
rlf_result run_output_add(run_output *out, const rlf_pipeline_output *frame);
/* Fails for a picture asked for of a frame that never came; the source may have ended before. */
rlf_result run_output_check(const run_output *out);
/* Saves one picture as relief-NNNNNN.png in the picture folder (or here) and says where. */
rlf_result run_output_save(run_output *out, const rlf_image_rgba8 *image, char *out_message,
                           size_t message_size);
/* Saves the run's scene with the known objects' poses as placed.json in the picture folder (or
 * here) and says where. */
rlf_result run_output_save_scene(const run_output *out, const rlf_known_def *known, int32_t count,
                                 char *out_message, size_t message_size);
/* Finishes all files, also after an error or Ctrl-C. */
rlf_result run_output_close(run_output *out);
/* Where words go: standard output, unless the video is written there. */
FILE *run_output_words(const run_output_options *options);
/* Where things were written, the median times, and what became of the source's frames; `how` says
 * how frames were shown. */
void run_output_print_summary(const run_output *out, const char *how,
                              const rlf_source_status *status);

#endif
