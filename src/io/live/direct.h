/* A camera whose every frame is given in its turn, none overtaken and nothing tried again, for
 * tests and measurements. */
#ifndef RLF_IO_LIVE_DIRECT_H
#define RLF_IO_LIVE_DIRECT_H

#include "relief/backend.h"

/* Opens the back end's address in a new thread, which all its calls come from, so that a driver
 * that hangs later does not keep the program: next gives RLF_NO_FRAME meanwhile. */
rlf_result io_direct_open(const rlf_backend *backend, const rlf_address *address, rlf_opened *out);

#endif
