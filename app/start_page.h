/* What `relief` and `relief run` show without a SOURCE: a page to choose one from. */
#ifndef RELIEF_APP_START_PAGE_H
#define RELIEF_APP_START_PAGE_H

#include "relief/window.h"

/* Cameras, the simulated room, recent recordings: at most RLF_WINDOW_CHOICES_MAX; returns how many.
 */
int32_t start_page_list(rlf_window_choice *out);
/* Those and the scenes. RLF_OK: *out is what was chosen; RLF_END: the window was closed;
 * RLF_ERROR_DEVICE: no window to be had. */
rlf_result start_page_choose(rlf_window_choice *out);

#endif
