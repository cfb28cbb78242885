/* What the window of `relief run` offers to open and to throw, and what a kiosk needs besides. */
#ifndef RELIEF_APP_RUN_WINDOW_H
#define RELIEF_APP_RUN_WINDOW_H

#include "session.h"
#include "relief/window.h"

/* ---- window_choices.c: what the window offers to open: cameras, recordings and scenes */

/* Cameras, the simulated room, recent recordings: at most RLF_WINDOW_CHOICES_MAX; returns how many.
 */
int32_t start_page_list(rlf_window_choice *out);
/* Those and the scenes. RLF_OK: *out is what was chosen; RLF_END: the window was closed;
 * RLF_ERROR_DEVICE: no window to be had. */
rlf_result start_page_choose(rlf_window_choice *out);

/* The scenes that come with Relief; before them the *.json files beside the scene that is open,
 * where that is none of these. At most RLF_WINDOW_CHOICES_MAX; returns how many. */
int32_t scene_list(const char *scene_path, rlf_window_choice *out);

/* The scenes that come with Relief, each with the source that it was made for, where that is there.
 * At most `capacity`; returns how many. */
int32_t scene_list_played(rlf_window_choice *out, int32_t capacity);

/* ---- body_model.c: model files as bodies to throw */

#define BODY_MODELS_MAX 64 /* model files, and sizes of them */

typedef struct body_model {
    char path[1024];
    double size_m;
    rlf_model *model; /* owned by the first with that path */
    bool owns_model;
    rlf_hull *hull;
    rlf_look look;
} body_model;

/* All that were loaded, since bodies borrow them; zero = none. */
typedef struct body_models {
    body_model list[BODY_MODELS_MAX];
    int32_t count;
} body_models;

/* The hull around a model, `size_m` metres along its longest side. */
rlf_result body_models_load(body_models *models, const char *path, double size_m,
                            rlf_shape *out_shape, rlf_look *out_look);
void body_models_destroy(body_models *models);

/* ---- kiosk.c: what a run without anybody at the machine needs besides its window */

/* From now on all that is logged goes to a file, too, with its time; NULL = kiosk.log in the state
 * folder. One that has grown past a megabyte becomes NAME.old first. RLF_ERROR_IO names the file.
 */
rlf_result kiosk_log_open(const char *path);
/* The last line; nothing where none is open. */
void kiosk_log_close(void);
/* session_open until it succeeds, or Ctrl-C: a camera may be switched on after the machine. Gives
 * up on what waiting does not mend: RLF_ERROR_INVALID and RLF_ERROR_FORMAT. */
rlf_result kiosk_session_open(const session_options *options, session *out);

#endif
