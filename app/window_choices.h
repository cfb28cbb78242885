/* What the window offers to open: cameras, recordings and scenes. */
#ifndef RELIEF_APP_WINDOW_CHOICES_H
#define RELIEF_APP_WINDOW_CHOICES_H

#include "relief/window.h"

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

#endif
