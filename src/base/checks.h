/* What is checked of a caller's defs and times. */
#ifndef RLF_BASE_CHECKS_H
#define RLF_BASE_CHECKS_H

#include "relief/base.h"

/* ---- Every def made by a _default function carries this cookie; a zeroed or stray struct does
 * not. */

#define RLF_DEF_COOKIE 0x52454c46u /* "RELF" */

/* ---- Whether times can be subtracted from each other. */

static inline bool time_is_usable(int64_t time_ns)
{
    return time_ns >= -RLF_TIME_MAX_NS && time_ns <= RLF_TIME_MAX_NS;
}

#endif
