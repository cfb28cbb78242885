/* What the parts of the window share: its state, its text and what its user commands. */
#ifndef RLF_VIEWER_STATE_H
#define RLF_VIEWER_STATE_H

#include "viewer/corners.h"
#include "viewer/mouse.h"
#include "viewer/panel.h"
#include "relief/window.h"
#include "viewer/window.h"

#include "relief/gl.h"
#include "relief/io.h"

#define VIEWER_NS_PER_S 1000000000.0
#define VIEWER_LINES_MAX 32 /* of text over the picture */
#define VIEWER_LINE_SIZE 128
#define VIEWER_MESSAGE_SIZE 512
#define VIEWER_MESSAGES_MAX 8  /* that the panel lists */
#define VIEWER_MESSAGE_LINES 8 /* room of messages over the picture */
#define VIEWER_PLOT_FRAMES 120
#define VIEWER_PLOT_STAGES 4

typedef enum viewer_mark { VIEWER_MARK_NONE, VIEWER_MARK_RECORDING, VIEWER_MARK_ERROR } viewer_mark;

typedef struct viewer_message {
    char text[VIEWER_MESSAGE_SIZE];
    int64_t end_ns; /* of its time over the picture; 0 = that is over */
    bool is_error;
} viewer_message;

#define VIEWER_UNDO_MAX 256

/* A deleted body; those of one group went together. */
typedef struct viewer_removed {
    rlf_body_def def;
    int32_t group;
} viewer_removed;

typedef struct viewer_undo {
    viewer_removed removed[VIEWER_UNDO_MAX]; /* a ring: the oldest is forgotten */
    int32_t next, count, group;
} viewer_undo;

/* What a kiosk waits for. */
typedef struct kiosk {
    bool is_lost;                       /* there is no source now */
    int64_t lost_ns, again_ns, wait_ns; /* since when, next attempt, pause before it */
    int32_t silent_limit_s;             /* seconds without a frame, after which it is lost */
    char why[VIEWER_MESSAGE_SIZE];      /* last reason that was told */
} kiosk;

typedef struct viewer {
    rlf_window_stage stage;
    const rlf_window_def *options;
    rlf_gl_presenter *presenter;
    viewer_window window;
    const char *renderer; /* name on screen */
    rlf_pipeline_output frame;
    bool has_frame, is_paused, is_at_end, shows_help;
    bool is_step_due, is_redraw_due, is_present_due;
    bool shows_overlay, shows_overlay_in_full; /* in a window; in full screen */
    bool is_mirrored, is_seeking;
    bool is_light;       /* the panel, not the picture */
    int64_t hint_end_ns; /* of the lines that tell how to begin */
    rlf_view view;
    bool is_beside; /* the camera's picture is beside the view */
    rlf_orbit orbit;
    int64_t frames_done;
    viewer_throw_def thrown;
    int32_t thrown_count;
    viewer_grab grab;
    viewer_place place;
    viewer_corners corners;
    viewer_undo undo;
    kiosk kiosk;
    bool fills;           /* the window, cut; else with bars */
    int64_t due_ns;       /* of the next frame */
    int64_t last_step_ns; /* when the last one was done; 0 = none */
    double gap_s;         /* between the last two frames, by their own times */
    double fps;
    rlf_stage_times times;                              /* smoothed */
    float plot[VIEWER_PLOT_FRAMES][VIEWER_PLOT_STAGES]; /* ms, the oldest first */
    int32_t plot_count;
    double latency_ms;   /* smoothed */
    int32_t silent_s;    /* whole seconds without a frame; 0 = they come */
    viewer_panel *panel; /* NULL = none */
    bool shows_panel;
    int32_t extra_presents; /* the panel shows what it was told one picture later */
    double present_ms;      /* cost of putting the picture into the window, smoothed */
    int32_t slow_frames;    /* in a row that took longer than the source's period */
    bool is_half;           /* the picture is drawn at half its size */
    double panel_ms;        /* cost of the last picture's */
    viewer_message messages[VIEWER_MESSAGES_MAX]; /* the newest first */
    int32_t message_count;
    rlf_recording *recording; /* of the window's own; NULL = none */
    char recording_path[64];
    int64_t recording_ns; /* when it began */
    char lines[VIEWER_LINES_MAX][VIEWER_LINE_SIZE];
    viewer_mark line_marks[VIEWER_LINES_MAX]; /* before their text */
    int32_t line_count;
    rlf_image_rgba8 text, marks; /* over the picture; grow with the window */
    size_t text_size, marks_size;
} viewer;

/* Where the camera is: as in the last frame, or before the first as the options say. */
static inline rlf_pose viewer_camera(const viewer *v)
{
    return v->has_frame ? v->frame.T_world_camera : v->options->T_world_camera;
}

/* message.c: puts a message over the picture for as long as it takes to read, and in the panel. */
void viewer_show_message(viewer *v, const char *text);
/* Of something that failed: in full screen, too. */
void viewer_show_error(viewer *v, const char *text);
/* `text`, or the library's error line. */
void viewer_show_result(viewer *v, rlf_result result, const char *text);
/* Ends those over the picture whose time is over. */
void viewer_end_old_messages(viewer *v, int64_t now_ns);

/* area.c: the window's part for the picture, in the unit of mouse positions. */
void viewer_get_area(const viewer *v, int32_t *out_width, int32_t *out_height);
bool viewer_is_overlay_shown(const viewer *v);
/* Makes an overlay image of that size, clear; false without memory. */
bool viewer_clear_image(rlf_image_rgba8 *image, size_t *room, int32_t width, int32_t height);

/* marks.c: plot of the stages' times, seek bar and legend. */
void viewer_note_plot(viewer *v);
void viewer_draw_marks(viewer *v, int32_t width, int32_t height, int32_t scale);
/* Place on the seek bar, 0 to 1, of a window position; false beside it. `is_held`: the mouse began
 * there, and may be anywhere now. */
bool viewer_seek_pick(const viewer *v, double x, double y, bool is_held, double *out);

/* lines.c: what stays, then what is new; messages last, at most VIEWER_MESSAGE_LINES of so many
 * letters. */
void viewer_make_lines(viewer *v);
void viewer_add_messages(viewer *v, int32_t columns);

/* overlay.c: lines of text and marks, at the window's resolution, over what was drawn. */
void viewer_draw_overlay(viewer *v, int32_t width, int32_t height);

/* actions.c: what keys, mouse and panel may all ask for. */
void viewer_choose_renderer(viewer *v); /* of a new pipeline */
void viewer_set_view(viewer *v, rlf_view view);
void viewer_set_end(viewer *v, rlf_playback_end end);
void viewer_restart(viewer *v);
void viewer_toggle_pause(viewer *v);
void viewer_seek_to(viewer *v, double share);

/* save.c: pictures, without the lines of text, and recordings. */
void viewer_save_picture(viewer *v);
void viewer_toggle_record(viewer *v);
void viewer_record_frame(viewer *v); /* the last one, if a recording of the window's own goes on */
void viewer_end_recording(viewer *v);
bool viewer_describe_recording(const viewer *v, char *out, size_t size); /* false: none goes on */

/* open.c: what was dropped, or chosen in the panel. */
void viewer_open_path(viewer *v, const char *path);
bool viewer_open_stage(viewer *v, rlf_window_opening what, const char *text);

/* mouse.c: throws, picks up, deletes. */
void viewer_press(viewer *v, viewer_commands *commands);
void viewer_follow_mouse(viewer *v);
void viewer_click(viewer *v, const viewer_commands *commands);
void viewer_delete(viewer *v);

/* undo.c: deletes bodies so that they can come back. */
void viewer_remove_body(viewer *v, rlf_body_id id);
void viewer_remove_all(viewer *v);
void viewer_bring_back(viewer *v);

/* kiosk.c: whether the source is opened again by itself; that it is gone, and why; what to do while
 * no frame comes; and an attempt, when one is due. */
bool viewer_kiosk_is_on(const viewer *v);
void viewer_kiosk_lose(viewer *v, const char *why);
void viewer_kiosk_note_silence(viewer *v);
void viewer_kiosk_try(viewer *v, int64_t now_ns);

/* pace.c: after each frame: draws the picture at half its size where the machine cannot keep the
 * source's rate; and at its own again. */
void viewer_keep_pace(viewer *v);
void viewer_draw_whole(viewer *v);

/* output.c: how the picture fills the window, and the marks of corners that are moved. */
void viewer_toggle_fill(viewer *v);
void viewer_toggle_corners(viewer *v);
void viewer_run_corners(viewer *v, const viewer_commands *commands);
bool viewer_press_corner(viewer *v, const viewer_commands *commands);
void viewer_drag_corner(viewer *v);
void viewer_draw_corners(viewer *v, int32_t width, int32_t height);

/* commands.c: does what keys and mouse asked for since the last call. */
void viewer_run_commands(viewer *v);

#endif
