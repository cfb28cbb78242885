/* The window of `relief run`: shows a pipeline's pictures and takes keys and the mouse. */
#ifndef RELIEF_APP_VIEWER_H
#define RELIEF_APP_VIEWER_H

#include "playback.h"
#include "viewer/start.h"
#include "viewer/throw.h"

#include "relief/pipeline.h"

#include <signal.h>

/* Gets every frame after it went through the pipeline; an error ends the run. */
typedef rlf_result (*viewer_frame_fn)(void *context, const rlf_pipeline_output *frame);
/* Saves a picture and writes where to, e.g. "saved out/000001.png", for the screen. */
typedef rlf_result (*viewer_picture_fn)(void *context, const rlf_image_rgba8 *image,
                                        char *out_message, size_t message_size);

/* Saves the scene with the known objects' poses and writes where to, for the screen. */
typedef rlf_result (*viewer_scene_fn)(void *context, const rlf_known_def *known, int32_t count,
                                      char *out_message, size_t message_size);

/* Begins or ends a recording and says so. */
typedef rlf_result (*viewer_record_fn)(void *context, char *out_message, size_t message_size);
/* A line about what goes on beside the loop; false = nothing does. */
typedef bool (*viewer_status_fn)(void *context, char *out, size_t size);

/* What the window shows. All borrowed. */
typedef struct viewer_stage {
    rlf_pipeline *pipeline;
    rlf_source *source;       /* asked for the time without frames; NULL = never */
    playback *playback;       /* of the source; NULL = a camera, or it is just played to its end */
    const char *source_name;  /* shown on screen; required */
    double frames_per_second; /* of playback; 0 = as frames come */
    const char *scene_name;   /* "" = none */
    const rlf_reconstruct_def *reconstruct; /* settings of the surface; NULL = not shown */
} viewer_stage;

/* What to open in place of what is shown. */
typedef enum viewer_open {
    VIEWER_OPEN_SOURCE, /* `text` names it */
    VIEWER_OPEN_SCENE,  /* a scene file; "" = the default one */
    VIEWER_OPEN_SETTING /* "NAME=VALUE" of the surface; "" = all as the profile has them */
} viewer_open;

/* Fills *out with a new stage and closes the old one. On failure the old one goes on. */
typedef rlf_result (*viewer_open_fn)(void *context, viewer_open what, const char *text,
                                     viewer_stage *out);
/* Makes a model file the shape of bodies, `size_m` metres along its longest side. What it gives
 * lives until the run ends. */
typedef rlf_result (*viewer_model_fn)(void *context, const char *path, double size_m,
                                      rlf_shape *out_shape, rlf_look *out_look);

/* Is told what the panel cost in a picture, milliseconds of the loop. */
typedef void (*viewer_cost_fn)(void *context, double ms);

typedef struct viewer_options {
    const char *title;       /* of the window; required */
    viewer_stage stage;      /* to start with; the pipeline is viewer_run's argument */
    int64_t frame_count;     /* stop after so many; -1 = when the user closes the window */
    bool use_gl;             /* draw with OpenGL; the soft renderer otherwise */
    bool avoid_software_gl;  /* not if OpenGL is a program on the CPU, which soft outruns; false */
    bool show_help;          /* list the keys at first; default true */
    bool hides_overlay;      /* no text at first; default false */
    bool overlay_everywhere; /* text also in full screen; default false */
    bool is_fullscreen, is_mirrored;
    bool hides_panel;                   /* default false */
    int32_t monitor;                    /* from 1; 0 = the primary one */
    rlf_view views[RLF_PIPELINE_VIEWS]; /* to start with */
    int32_t view_count;
    rlf_orbit orbit;                          /* likewise */
    rlf_pose T_world_camera;                  /* as the pipeline's */
    viewer_frame_fn on_frame;                 /* NULL = none */
    viewer_picture_fn on_picture;             /* NULL = pictures cannot be saved */
    viewer_scene_fn on_scene;                 /* NULL = scenes cannot be saved */
    viewer_record_fn on_record;               /* NULL = cannot */
    viewer_status_fn on_status;               /* NULL = nothing */
    viewer_open_fn on_open;                   /* NULL = cannot */
    viewer_model_fn on_model;                 /* NULL = cannot */
    viewer_list_fn on_sources, on_scenes;     /* for the panel; NULL = it lists none */
    void *context;                            /* of all of them */
    viewer_cost_fn on_panel_ms;               /* NULL = untold */
    const volatile sig_atomic_t *interrupted; /* not 0 = stop, e.g. by Ctrl-C; NULL = none */
} viewer_options;

viewer_options viewer_options_default(void);

/* Opens a window and runs until it is closed, frame_count is reached or it is interrupted. A
 * failing OpenGL renderer is replaced by the soft one with a warning; afterwards the pipeline has a
 * soft compositor. RLF_ERROR_DEVICE: no window to be had (no display, or no OpenGL to show pictures
 * with). */
rlf_result viewer_run(rlf_pipeline *pipeline, const viewer_options *options);

#endif
