/* Simulated cameras stay plugged in while programs open and close them. */
#ifndef RLF_IO_SIMULATED_DEVICE_H
#define RLF_IO_SIMULATED_DEVICE_H

#include "relief/base.h"

/* When the camera of that name was plugged in (rlf_clock_ns): now, if it is new. Thread-safe. */
rlf_result simulated_device_find(const char *name, int64_t *out_plugged_ns);

#endif
