/* Simulated cameras stay plugged in while programs open and close them. */
#ifndef RLF_IO_SIMULATED_DEVICE_H
#define RLF_IO_SIMULATED_DEVICE_H

#include "relief/base.h"

/* When the camera of that name was opened first (rlf_clock_ns), from when its faults are counted;
 * now, if it never was. Both calls are thread-safe. */
int64_t simulated_device_start(const char *name);
/* It was opened; the first time counts. */
rlf_result simulated_device_note(const char *name);

#endif
