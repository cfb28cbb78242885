/* What a run without anybody at the machine needs besides its window. */
#ifndef RELIEF_APP_KIOSK_H
#define RELIEF_APP_KIOSK_H

#include "relief/base.h"
#include "session.h"

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
