/* What the parts of `relief run` share: its options, and its window. */
#ifndef RELIEF_APP_RUN_H
#define RELIEF_APP_RUN_H

#include "publish/publish.h"
#include "recorder.h"
#include "relief/io.h"
#include "session.h"
#include "timing.h"
#include "trajectory.h"

#include <stdio.h>

/* ---- the room of a moving camera ------------------------------------------------------------- */

typedef struct run_room_options {
    const char *mesh_path; /* NULL = none */
    const char *map_path;  /* NULL = not saved */
    int32_t min_weight;    /* of the mesh's voxels; 0 = by the number of frames */
    const char *source;    /* its name, for messages */
    bool has_source_poses; /* the camera is where the source says, and not tracked */
} run_room_options;

/* What its frames were. Zeroed at the start, and after another source was opened. */
typedef struct run_room {
    int64_t seen, placed, with_pose;                            /* frames */
    int64_t near_pixels, far_pixels, lost_pixels, whole_pixels; /* until one has depth */
    trajectory way;
    size_t vertex_count, triangle_count; /* of the mesh */
    int32_t min_weight;
} run_room;

/* Whether the files can be written: told before the run, not after it. */
rlf_result run_room_check(const run_room_options *o);
/* One frame; nothing where no room is kept. */
rlf_result run_room_add(run_room *room, const run_room_options *o,
                        const rlf_pipeline_output *frame);
/* Writes what was asked for, also after Ctrl-C. RLF_ERROR_INVALID with the reason when there is
 * none: then nothing is written. `map` may be NULL. */
rlf_result run_room_write(run_room *room, const run_room_options *o, const rlf_map *map,
                          const rlf_rig *rig);
/* Lines for the user. `map` is not NULL. */
void run_room_print(const run_room *room, const run_room_options *o, const rlf_map *map,
                    FILE *file);
void run_room_close(run_room *room);

/* ---- what a run leaves behind ---------------------------------------------------------------- */

#define RUN_PICTURES_MAX 16

typedef struct run_output_options {
    const char *video_path;               /* NULL = none */
    const char *picture_folder;           /* NULL = none */
    int64_t picture_every;                /* frames between pictures, >= 1 */
    int64_t picture_at[RUN_PICTURES_MAX]; /* instead: the pictures of these frames alone */
    bool keeps_last;                      /* and that of the last one */
    int32_t picture_shrink;               /* pixels averaged into one, each way; >= 1 */
    int picture_count;                    /* of them; 0 = every picture_every-th */
    const char *log_folder;               /* NULL = none */
    bool is_quiet;                        /* no progress, no summary */
    const char *scene_path;               /* of the run; NULL = none */
    bool finds_gravity;                   /* so the summary tells it */
    bool is_light_given;                  /* by the user; else an unknown one is the default */
    const run_room_options *room;         /* borrowed */
    bool print_hash;                      /* print the hash of all body states at the end */
} run_output_options;

typedef struct run_output {
    run_output_options options;
    double frames_per_second; /* of the video */
    int64_t frame_total;      /* for progress; -1 = unknown */
    rlf_video *video;
    rlf_csv_log *log;
    recorder *recorder;   /* borrowed; NULL = none */
    publisher *publisher; /* borrowed; NULL = none */
    run_room room;        /* close it */
    int64_t frames, pictures;
    int64_t last_index;         /* of the frames */
    rlf_image_rgba8 last_image; /* of the pipeline's, while it is not stepped */
    bool has_last;              /* it is written already */
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
/* After the last frame: its picture. Fails for a picture of a frame that never came, as the source
 * may have ended before. */
rlf_result run_output_end(run_output *out);
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

/* ---- the run --------------------------------------------------------------------------------- */

/* Of the window alone. */
typedef struct run_window_options {
    bool is_fullscreen, is_mirrored, is_kiosk, fills;
    const char *log_path; /* of a kiosk; NULL = the usual one */
    bool shows_overlay, hides_overlay, hides_panel, has_light_panel;
    bool is_end_set; /* else by what is written: see run_window */
    int32_t monitor; /* from 1; 0 = the one that the window is on */
} run_window_options;

typedef struct run_options {
    session_options session;
    run_output_options output;
    bool is_headless;
    bool use_gl;
    bool is_renderer_set;
    int64_t frame_count; /* -1 = all */
    rlf_view views[RLF_PIPELINE_VIEWS];
    int32_t view_count;
    bool shows_legend;
    rlf_orbit orbit;
    run_room_options room;
    run_window_options window;
    publish_list publish; /* where events go */
} run_options;

/* Returns -1 to go on, or an exit status. */
int run_parse(int argc, char **argv, run_options *o);
/* Runs the session's frames in a window until it is closed. Another source, scene or settings that
 * its user chooses take the place of what is in *s. */
rlf_result run_window(const run_options *o, session *s, run_output *output);
/* Frees what bodies borrow. After session_close. */
void run_window_end(void);

#endif
