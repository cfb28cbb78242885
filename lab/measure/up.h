/* Which way is up in each frame, and how far off that is where the clip knows its camera's motion.
 */
#ifndef RELIEF_APP_MEASURE_UP_H
#define RELIEF_APP_MEASURE_UP_H

#include "relief/io.h"

/* Prints how the camera looks, as floors, tables and walls of each frame by itself say; and, for a
 * folder with a groundtruth.txt of the TUM RGB-D benchmark (its z is up), how far off that is.
 * is_turned: the same of each frame turned by quarters and mirrored, beside the unturned answer. */
rlf_result measure_up_run(const char *source_name, int64_t frames, bool is_turned);

#endif
