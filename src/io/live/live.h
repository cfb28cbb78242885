/* A camera that frames come from by themselves, made safe for a loop that must not stop: captured
 * in a thread of its own, newest frame first, watched, and opened again when it was gone. */
#ifndef RLF_IO_LIVE_LIVE_H
#define RLF_IO_LIVE_LIVE_H

#include "relief/backend.h"

/* Opens the back end's address in a new thread and waits for the first frame. The source gives
 * RLF_NO_FRAME after a twentieth of a second without one. All calls of the back end come from that
 * thread. */
rlf_result io_live_open(const rlf_backend *backend, const rlf_address *address, rlf_opened *out);

#endif
