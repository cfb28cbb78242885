/* The parts of the registered depth that a picture needs. */
#ifndef RLF_ENVIRONMENT_REAL_WINDOWS_H
#define RLF_ENVIRONMENT_REAL_WINDOWS_H

#include "camera/register.h"

#define REAL_WINDOWS_MOST 4 /* what is between bodies far apart is not registered */

typedef struct real_windows {
    pixel_rect window[REAL_WINDOWS_MOST];
    int32_t count;
} real_windows;

/* Adds a window to the one that it meets, to none or, when there are enough, to the last. */
void real_windows_add(real_windows *windows, const pixel_rect *more);

/* Joins those of which one would be drawn into what another one needs, with no depth nearer than
 * `nearest` metres; 0 = not known. */
void real_windows_join(real_windows *windows, const rlf_registration *registration, double nearest);

#endif
