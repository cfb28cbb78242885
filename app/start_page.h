/* What `relief run` shows without a SOURCE: a page to choose one from. */
#ifndef RELIEF_APP_START_PAGE_H
#define RELIEF_APP_START_PAGE_H

#include "viewer/start.h"

#define START_PAGE_SOURCE 1024

/* Cameras, the simulated room, recent recordings: at most VIEWER_CHOICES_MAX; returns how many. */
int32_t start_page_list(viewer_choice *out);
/* -1: *out is the SOURCE; else the exit status. */
int start_page_choose(char out[START_PAGE_SOURCE]);

#endif
