/* What `relief run` shows without a SOURCE: a page to choose one from. */
#ifndef RELIEF_APP_START_PAGE_H
#define RELIEF_APP_START_PAGE_H

#include "relief/base.h"

#define START_PAGE_SOURCE 1024

/* -1: *out is the SOURCE; else the exit status. */
int start_page_choose(char out[START_PAGE_SOURCE]);

#endif
