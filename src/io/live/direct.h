/* A camera whose every frame is given in its turn, none overtaken and nothing tried again, for tests
 * and measurements. */
#ifndef RLF_IO_LIVE_DIRECT_H
#define RLF_IO_LIVE_DIRECT_H

#include "relief/backend.h"

/* Puts a thread between the program and the driver that was opened, so that one that hangs does not
 * keep the program: next gives RLF_NO_FRAME meanwhile. On failure the driver is left to the
 * caller. */
rlf_result io_direct_wrap(const char *name, rlf_opened *inout);

#endif
