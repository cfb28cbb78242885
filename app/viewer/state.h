/* What the parts of the window share: its state, its text and what its user wishes. */
#ifndef RELIEF_APP_VIEWER_STATE_H
#define RELIEF_APP_VIEWER_STATE_H

#include "viewer/place.h"
#include "viewer/viewer.h"
#include "viewer/window.h"

#include "relief/gl.h"

#define VIEWER_NS_PER_S 1000000000.0
#define VIEWER_LINES_MAX 20 /* of text over the picture */
#define VIEWER_LINE_SIZE 128

typedef struct viewer {
    rlf_pipeline *pipeline;
    const viewer_options *options;
    rlf_gl_presenter *presenter;
    viewer_window window;
    const char *renderer; /* name on screen */
    rlf_pipeline_output frame;
    bool has_frame, is_paused, is_at_end, shows_help;
    bool is_step_due, is_redraw_due, is_present_due;
    rlf_view view;
    bool is_beside; /* the camera's picture is beside the view */
    rlf_orbit orbit;
    int64_t frames_done;
    int32_t thrown_count;
    viewer_place place;
    int64_t due_ns;       /* of the next frame */
    int64_t last_step_ns; /* when the last one was done; 0 = none */
    double fps;
    rlf_stage_times times; /* smoothed */
    double latency_ms;     /* likewise */
    int32_t silent_s;      /* whole seconds without a frame; 0 = they come */
    char message[VIEWER_LINE_SIZE];
    int64_t message_end_ns;
    char lines[VIEWER_LINES_MAX][VIEWER_LINE_SIZE];
} viewer;

/* Puts a line over the picture for three seconds. */
void viewer_show_message(viewer *v, const char *text);

/* Takes the line away when its time is over. */
void viewer_forget_old_message(viewer *v, int64_t now_ns);

/* Hands the lines over the picture to the pipeline, for the next picture that it draws. */
void viewer_update_overlay(viewer *v);

/* Does what keys and mouse asked for since the last call. */
void viewer_fulfil_wishes(viewer *v);

#endif
