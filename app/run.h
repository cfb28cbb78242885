/* What the parts of `relief run` share: its options, and its window. */
#ifndef RELIEF_APP_RUN_H
#define RELIEF_APP_RUN_H

#include "run_output.h"
#include "session.h"

/* Of the window alone. */
typedef struct run_window_options {
    bool is_fullscreen, is_mirrored;
    bool shows_overlay, hides_overlay, hides_panel;
    bool is_end_set; /* else by what is written: see run_window */
    int32_t monitor; /* from 1; 0 = the primary one */
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
    const char *save_map_path; /* NULL = not saved */
    run_window_options window;
} run_options;

/* Returns -1 to go on, or an exit status. */
int run_parse(int argc, char **argv, run_options *o);
/* Runs the session's frames in a window until it is closed. Another source, scene or settings that
 * its user chooses take the place of what is in *s. */
rlf_result run_window(const run_options *o, session *s, run_output *output);
/* Frees what bodies borrow. After session_close. */
void run_window_end(void);

#endif
