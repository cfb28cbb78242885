/* `relief-lab bench --live`: how soon a camera shows, how late its pictures are, how soon it is
 * missed.
 */
#ifndef RELIEF_APP_BENCH_LIVE_H
#define RELIEF_APP_BENCH_LIVE_H

#include "relief/base.h"

/* Plays the source as a simulated camera in real time for some fourteen seconds, with a cable that
 * is pulled and put back and a stall, and prints. Replaces the log writer. */
rlf_result bench_live(const char *source, int32_t threads);

#endif
