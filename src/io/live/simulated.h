/* A camera without hardware, for tests and for people without one. */
#ifndef RLF_IO_LIVE_SIMULATED_H
#define RLF_IO_LIVE_SIMULATED_H

#include "relief/backend.h"
#include "relief/base.h"
#include "relief/source.h"

typedef rlf_result (*io_open_fn)(const char *source, rlf_pool *pool, rlf_source **out);

/* Lends it the function that opens what it plays. It cannot call it by name: that function knows
 * all back ends, this one among them. Thread-safe. */
void io_simulated_lend_open(io_open_fn opener);

/* ---- Simulated cameras stay plugged in while programs open and close them ---- */

/* When the camera of that name was opened first (rlf_clock_ns), from when its faults are counted;
 * now, if it never was. Both calls are thread-safe. */
int64_t simulated_device_start(const char *name);
/* It was opened; the first time counts. */
rlf_result simulated_device_note(const char *name);

/* ---- What goes wrong with a simulated camera, and when ---- */

/* Times are seconds since the camera was opened first; < 0 = never. */
typedef struct simulated_faults {
    double unplug_s, replug_s;    /* pulled out; put back in that long after */
    double stall_s, stall_from_s; /* no frames for stall_s; stall_s 0 = never */
    double hang_s;                /* from then on its driver does not return */
    double time_back_s;           /* its clock starts again from zero */
    double jitter_s;              /* frames come up to that much late */
    int32_t drop, doubled;        /* every n-th frame is lost, comes twice; 0 = none */
} simulated_faults;

/* Keys unplug_after, replug_after, stall, hang, time_back, jitter, drop, doubled. */
rlf_result simulated_faults_parse(const rlf_address *address, simulated_faults *out);

/* Whether it is plugged in, and whether its bus carries frames. */
bool simulated_is_plugged(const simulated_faults *faults, double time_s);
bool simulated_is_stalled(const simulated_faults *faults, double time_s);

#endif
