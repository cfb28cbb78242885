/* Relief: the window. Shows a pipeline's pictures, takes keys and the mouse, and has a panel beside
 * the picture where the build has Dear ImGui. Part of librelief_window, which needs OpenGL.
 * docs/window.md lists the keys.
 *
 * One window at a time, on the main thread: GLFW asks for that on some systems.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_WINDOW_H
#define RELIEF_WINDOW_H

#include "relief/pipeline.h"
#include "relief/playback.h"

#include <signal.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- the start page
 * ------------------------------------------------------------------------------------- */

/* Entries of a list at most. */
#define RLF_WINDOW_CHOICES_MAX 64
/* Room for the name of a source or file, with its ending zero. */
#define RLF_WINDOW_SOURCE_SIZE 1024

/* A line of the start page, and of the panel's lists. */
typedef struct rlf_window_choice {
    char source[RLF_WINDOW_SOURCE_SIZE]; /* as rlf_source_open takes it */
    char scene[RLF_WINDOW_SOURCE_SIZE];  /* file to play it with; "" = the default one */
    char text[160];                      /* what the window shows of it */
    char
        picture[RLF_WINDOW_SOURCE_SIZE]; /* file of a small picture of it, PNG or JPEG; "" = none */
} rlf_window_choice;

/* Lists what there is to choose: fills at most RLF_WINDOW_CHOICES_MAX, returns how many. */
typedef int32_t (*rlf_window_list_fn)(void *context, rlf_window_choice *out);

/* Opens a window with the list over a picture of the simulated room, until the user chooses by
 * arrows and Enter, number, wheel or click. RLF_OK: *out is the choice; RLF_END: the window was
 * closed, or *interrupted (NULL = none) was set. RLF_ERROR_DEVICE: no window can be opened. */
RLF_API rlf_result rlf_window_choose(rlf_window_list_fn list, void *context,
                                     const volatile sig_atomic_t *interrupted,
                                     rlf_window_choice *out);

/* ---- what the program does for the window
 * --------------------------------------------------------------- */

/* Gives the next frame of a camera of one's own, whose planes are good until the next call.
 * RLF_NO_FRAME: none yet; RLF_END: there will be none. */
typedef rlf_result (*rlf_window_next_fn)(void *context, rlf_frame *out);
/* Gets every frame after it went through the pipeline; an error ends the run. */
typedef rlf_result (*rlf_window_frame_fn)(void *context, const rlf_pipeline_output *frame);
/* Saves a picture and writes for the screen where to, e.g. "saved out/000001.png". */
typedef rlf_result (*rlf_window_picture_fn)(void *context, const rlf_image_rgba8 *image,
                                            char *out_message, size_t message_size);
/* Saves the scene with the known objects' poses and writes where to, for the screen. */
typedef rlf_result (*rlf_window_scene_fn)(void *context, const rlf_known_def *known, int32_t count,
                                          char *out_message, size_t message_size);
/* Begins or ends a recording and says so. */
typedef rlf_result (*rlf_window_record_fn)(void *context, char *out_message, size_t message_size);
/* A line about a recording that goes on, for the screen; false when none does. */
typedef bool (*rlf_window_status_fn)(void *context, char *out, size_t size);

/* What the window shows. All borrowed. */
typedef struct rlf_window_stage {
    rlf_pipeline *pipeline;   /* required */
    rlf_source *source;       /* asked for the time without frames; NULL = never */
    rlf_playback *playback;   /* of the source; NULL = a camera, or played once to its end */
    const char *source_name;  /* shown on screen; "" = none */
    double frames_per_second; /* of a recording; 0 = as frames come */
    const char *scene_name;   /* "" = none */
    const rlf_reconstruct_def *reconstruct; /* settings of the surface; NULL = not shown */
} rlf_window_stage;

/* What to open in place of what is shown. */
typedef enum rlf_window_opening {
    RLF_WINDOW_OPEN_SOURCE,  /* `text` names it */
    RLF_WINDOW_OPEN_SCENE,   /* a scene file; "" = the default one */
    RLF_WINDOW_OPEN_SETTING, /* "NAME=VALUE" of the surface; "" = all as the profile has them */
    RLF_WINDOW_OPEN_AGAIN    /* the source as before, of a kiosk: it has ended or failed */
} rlf_window_opening;

/* Fills *out with a new stage and closes the old one. On failure the old one goes on; but for
 * RLF_WINDOW_OPEN_AGAIN the old source is closed first, and the pipeline alone goes on. */
typedef rlf_result (*rlf_window_open_fn)(void *context, rlf_window_opening what, const char *text,
                                         rlf_window_stage *out);
/* Makes a model file the shape of bodies, `size_m` metres along its longest side. What it gives
 * lives until the pipeline is destroyed. */
typedef rlf_result (*rlf_window_model_fn)(void *context, const char *path, double size_m,
                                          rlf_shape *out_shape, rlf_look *out_look);

/* A setting of the surface for people: its name, what it means, what it may be and what it is. */
typedef struct rlf_window_setting {
    const char *name;         /* as `--set` takes it */
    const char *meaning;      /* one line */
    const char *const *words; /* ends with NULL; a switch has "off" and "on". NULL = a number */
    bool is_switch;           /* its words are "off" and "on" */
    char value[32];           /* now */
    const char *need;         /* what is missing for it to have an effect; NULL = nothing */
} rlf_window_setting;

/* Describes setting `index`, from 0, as it is in *def; false when there are no more. */
typedef bool (*rlf_window_setting_fn)(void *context, int32_t index, const rlf_reconstruct_def *def,
                                      rlf_window_setting *out);
/* Is told what the panel cost in a picture, milliseconds of the loop. */
typedef void (*rlf_window_cost_fn)(void *context, double ms);

/* ---- the window
 * ----------------------------------------------------------------------------------------- */

/* How the window begins, and what the program does for it. Get it from rlf_window_def_default, so
 * that fields which later versions add have a value. Callbacks run on the thread of
 * rlf_window_run, between two pictures, and hold the picture up as long as they take. */
typedef struct rlf_window_def {
    const char *title;       /* of the window; required */
    rlf_window_stage stage;  /* to start with; its pipeline is rlf_window_run's argument */
    int64_t frame_count;     /* stop after so many; -1 = when the user closes the window */
    bool use_gl;             /* draw with OpenGL; the soft renderer otherwise. Default true */
    bool avoid_software_gl;  /* the soft renderer where OpenGL itself runs on the CPU; false */
    bool show_help;          /* tell at first how to begin, in three lines; default true */
    bool hides_overlay;      /* no text at first; default false */
    bool overlay_everywhere; /* text also in full screen; default false */
    bool is_fullscreen;      /* default false */
    bool is_mirrored;        /* as a mirror shows it; default false */
    bool hides_panel;        /* default false */
    bool has_light_panel;    /* dark letters on a light panel; default false */
    bool fills;              /* the picture is as large as the window and cut; else black bars.
                                Default false */
    bool is_kiosk;   /* nobody attends it: full screen without a pointer, that comes back with
                        a monitor; a source that ends, fails or gives nothing for 10 s is
                        opened again by on_open; errors go to rlf_log alone. Default false */
    bool keeps_size; /* of the picture, which the soft renderer halves where the machine cannot keep
                        the source's rate; for what is written. Default false */
    bool keeps_view; /* keys and panel do not change it, as of a projector; default false */
    const char *corners_path; /* file to keep the picture's corners in; NULL = they are not kept */
    int32_t monitor;          /* from 1; 0 = the one that the window is on */
    rlf_view views[RLF_PIPELINE_VIEWS];       /* to start with */
    int32_t view_count;                       /* 1, or 2 side by side; default 1 */
    rlf_orbit orbit;                          /* likewise */
    rlf_pose T_world_camera;                  /* as the pipeline's */
    rlf_window_next_fn next;                  /* NULL = frames come from the pipeline's source */
    rlf_window_frame_fn on_frame;             /* NULL = none */
    rlf_window_picture_fn on_picture;         /* NULL = PNG in the working folder */
    rlf_window_scene_fn on_scene;             /* NULL = scenes cannot be saved */
    rlf_window_record_fn on_record;           /* NULL = an MCAP file in the working folder */
    rlf_window_status_fn on_status;           /* of on_record; NULL = nothing */
    rlf_window_open_fn on_open;               /* NULL = nothing else can be opened */
    rlf_window_model_fn on_model;             /* NULL = models cannot be opened */
    rlf_window_setting_fn on_setting;         /* NULL = the panel shows no settings */
    rlf_window_list_fn on_sources, on_scenes; /* for the panel; NULL = it lists none */
    void *context;                            /* of all of them */
    rlf_window_cost_fn on_panel_ms;           /* NULL = untold */
    const volatile sig_atomic_t *interrupted; /* not 0 = stop, e.g. by Ctrl-C; NULL = none */
} rlf_window_def;

/* All fields at the defaults that they name: a window of its own size that ends when its user
 * closes it, OpenGL where it works, no callbacks. */
RLF_API rlf_window_def rlf_window_def_default(void);

/* Opens a window and runs the pipeline until the user closes the window, frame_count is reached or
 * it is interrupted. The soft renderer replaces an OpenGL renderer that fails, with a warning;
 * afterwards the pipeline has a soft compositor. RLF_ERROR_DEVICE: no window can be opened (no
 * display, or no OpenGL to show pictures with). Thread-safety: the main thread, one at a time. */
RLF_API rlf_result rlf_window_run(rlf_pipeline *pipeline, const rlf_window_def *def);

#ifdef __cplusplus
}
#endif
#endif
