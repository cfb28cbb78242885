/* In which unit a list's times are: seconds, or what other programs write in their place. */
#ifndef RLF_IO_FOLDER_TIME_UNIT_H
#define RLF_IO_FOLDER_TIME_UNIT_H

#include "relief/base.h"

#define IO_SECONDS_MAX 4600000000.0 /* the year 2115; RLF_TIME_MAX_NS in seconds */

/* Units per second: 1, 1000, 1000000 or 1000000000. Of pictures' times, which do not decrease:
 * seconds where they can be, with pictures at most 10 s apart (an hour, from 2000 on as Unix time).
 * Else the one unit that puts them 1 ms to 10 s apart, in the middle; of two such units the one in
 * which all are Unix times from 2000 to 2100. 0 = in doubt. `scratch` has room for `count`. */
int64_t io_time_unit(const double *times, int32_t count, double *scratch);

/* The same of times that go with others, first to last in seconds. Seconds, unless only another
 * unit brings the two spans together, or in it they have half of both in common, and more than
 * twice as much as in seconds. */
int64_t io_time_unit_beside(double from, double to, double first_s, double last_s);

/* Tells that the file's times are not seconds. Nothing for seconds. */
void io_time_unit_tell(const char *file, int64_t unit);

/* A number as it stands in a file, in nanoseconds: whole units, and billionths of one. */
int64_t io_time_in_ns(int64_t whole, int64_t billionths, int64_t unit);

#endif
