/* What goes wrong with a simulated camera, and when. */
#ifndef RLF_IO_SIMULATED_FAULTS_H
#define RLF_IO_SIMULATED_FAULTS_H

#include "relief/backend.h"

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
