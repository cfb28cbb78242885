/* A GLFW window with an OpenGL context, and what the user did in it. */
#ifndef RLF_VIEWER_WINDOW_H
#define RLF_VIEWER_WINDOW_H

#include "relief/base.h"

typedef struct GLFWwindow GLFWwindow;
typedef struct GLFWmonitor GLFWmonitor;

#define VIEWER_PATH_SIZE 1024
#define VIEWER_TAPS_MAX 8

/* Wishes since the last look, to be cleared by who fulfils them. */
typedef struct viewer_commands {
    bool toggle_pause, step, restart, toggle_help, next_view, save_picture, throw_body,
        toggle_record;
    bool refresh;            /* the window must be drawn again */
    bool press;              /* the left button went down */
    double press_x, press_y; /* where, window position */
    bool delete_body;        /* the one under the mouse */
    bool open_files;         /* the list to choose one from */
    bool bring_back;         /* those that were deleted last */
    bool toggle_fill, toggle_corners;
    bool toggle_overlay, toggle_mirror, toggle_panel, next_end, next_shape;
    bool leave;          /* what is over the window's usual state; else the program */
    bool is_screen_lost; /* the monitor of the full screen was unplugged */
    bool has_drop;
    char drop[VIEWER_PATH_SIZE]; /* a file or folder dropped on the window */
    int32_t view;                /* -1 = none */
    double throw_x, throw_y;     /* window position */
    double throw_drag_fraction;  /* of the window's height */
    double turn_x, turn_y;       /* dragged with the right button, of the window's height */
    double zoom;                 /* steps of the wheel, > 0: nearer */
    bool toggle_beside;          /* the camera's picture beside the view */
    bool toggle_place;           /* placing models; the rest is for that */
    bool next_object, skip_point, undo_points, solve_points, save_scene;
    int32_t nudge_x, nudge_y, nudge_z, nudge_turn; /* steps; y down, z away */
    bool is_fine;                                  /* with shift: small steps */
} viewer_commands;

typedef struct viewer_window {
    GLFWwindow *handle;
    viewer_commands commands;
    bool is_dragging;
    bool is_held; /* the left button is down on something: no throw */
    double press_x, press_y;
    bool is_turning;
    double turned_x, turned_y; /* the mouse's last position while turning */
    int32_t windowed[4];       /* x, y, width, height before full screen */
    int32_t screen_number;     /* of the monitor for full screen, from 1; 0 = where it is */
    bool is_kiosk;             /* full screen comes back with a monitor, and has no pointer */
    bool is_full_due;          /* a monitor came or went */
    bool needs_pointer;        /* for what is done in full screen */
    GLFWmonitor *screen;       /* that the full screen is on; NULL = none */
    int32_t panel_width; /* at the right, in the unit of mouse positions; 0 = it is not shown */
    bool is_list_open;   /* in the panel: the mouse is its alone, wherever it is */
    bool is_key_taken;   /* a control of the panel has the focus */
    int taps[VIEWER_TAPS_MAX]; /* keys that went down since the panel was drawn */
    int32_t tap_count;
    int64_t moved_ns; /* when the mouse moved last */
    bool is_pointer_hidden;
    bool follows_mouse; /* what is shown changes with the mouse: the panel is open */
} viewer_window;

/* At 100 % scale. */
typedef struct viewer_window_size {
    int32_t width, height;             /* of the picture */
    int32_t panel_width, panel_height; /* beside it; 0 = none */
} viewer_window_size;

/* Opens a window and makes its context current: OpenGL 3.3, else ES 3.0. `out` must stay where it
 * is until closed. One window per program. RLF_ERROR_DEVICE says why there is none. */
rlf_result viewer_window_open(const char *title, const viewer_window_size *size,
                              viewer_window *out);
void viewer_window_close(viewer_window *window);

/* True when the context is drawn by a program on the CPU (Mesa's llvmpipe or softpipe). */
bool viewer_window_is_software_gl(const viewer_window *window);
/* True when the user wants to end. */
bool viewer_window_should_close(const viewer_window *window);
/* Leaves full screen; in a window it asks to end. */
void viewer_window_leave(viewer_window *window);
/* Takes events, waiting for one at most this long; 0 does not wait. */
void viewer_window_poll(viewer_window *window, double timeout_s);
/* Pixels of the default framebuffer; 0 while minimised. */
void viewer_window_get_framebuffer_size(const viewer_window *window, int32_t *out_width,
                                        int32_t *out_height);
/* Size in the unit of mouse positions. */
void viewer_window_get_size(const viewer_window *window, int32_t *out_width, int32_t *out_height);
/* Drag of the button that is down now as a part of the window's height; < 0 when none is. */
double viewer_window_get_drag(const viewer_window *window);
/* Where the mouse is. */
void viewer_window_get_cursor(const viewer_window *window, double *out_x, double *out_y);
void viewer_window_swap(viewer_window *window);

/* input.c: keys, mouse and dropped files become commands. */
void viewer_window_take_input(viewer_window *window);

/* screen.c: chooses the monitor for full screen, from 1 in the order of `relief run --window
 * full=N`; 0 = the one that the window is on. A window goes there, too. RLF_ERROR_INVALID lists
 * them when there is none. */
rlf_result viewer_screen_choose(viewer_window *window, int32_t number);
void viewer_screen_toggle(viewer_window *window);
bool viewer_screen_is_full(const viewer_window *window);
/* Hides the pointer of a full screen while the mouse rests, a kiosk's always, and shows it
 * otherwise. Takes a kiosk back to full screen after its monitor came or went. */
void viewer_screen_settle(viewer_window *window, int64_t now_ns);
/* Watches monitors: when the one of the full screen is unplugged, the window is as it was before.
 */
void viewer_screen_watch(viewer_window *window);
/* Leaves no trace of the window in GLFW's callback. */
void viewer_screen_forget(void);

#endif
