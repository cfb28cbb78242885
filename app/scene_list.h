/* Scene files to choose from in the window. */
#ifndef RELIEF_APP_SCENE_LIST_H
#define RELIEF_APP_SCENE_LIST_H

#include "viewer/start.h"

/* The *.json files beside the scene that is open; without one those of ./scenes, else those that
 * are installed. In order, at most VIEWER_CHOICES_MAX; returns how many. */
int32_t scene_list(const char *scene_path, viewer_choice *out);

#endif
