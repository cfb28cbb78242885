/* Scenes to choose from in the window. */
#ifndef RELIEF_APP_SCENE_LIST_H
#define RELIEF_APP_SCENE_LIST_H

#include "relief/window.h"

/* The scenes that come with Relief; before them the *.json files beside the scene that is open,
 * where that is none of these. At most RLF_WINDOW_CHOICES_MAX; returns how many. */
int32_t scene_list(const char *scene_path, rlf_window_choice *out);

/* The scenes that come with Relief, each with the source that it was made for, where that is there.
 * At most `capacity`; returns how many. */
int32_t scene_list_played(rlf_window_choice *out, int32_t capacity);

#endif
