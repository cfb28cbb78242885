/* The window's start page: a list to choose a source from. */
#ifndef RELIEF_APP_VIEWER_START_H
#define RELIEF_APP_VIEWER_START_H

#include "relief/base.h"

#include <signal.h>

#define VIEWER_CHOICES_MAX 64
#define VIEWER_CHOICE_SOURCE 1024

typedef struct viewer_choice {
    char source[VIEWER_CHOICE_SOURCE];
    char scene[VIEWER_CHOICE_SOURCE]; /* to play it with; "" = the default one */
    char text[96];                    /* what the page says of it */
} viewer_choice;

/* Lists what there is to choose: at most VIEWER_CHOICES_MAX, returns how many. */
typedef int32_t (*viewer_list_fn)(void *context, viewer_choice *out);

/* Opens a window with the list, of which it shows a part when it is long, over a picture of the
 * simulated room, until one is chosen by arrows and Enter, number, wheel or click. RLF_OK: *out is
 * it; RLF_END: the window was closed, or *interrupted was set. RLF_ERROR_DEVICE: no window to be
 * had. */
rlf_result viewer_choose(viewer_list_fn list, void *context,
                         const volatile sig_atomic_t *interrupted, viewer_choice *out);

#endif
