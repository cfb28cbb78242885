/* Lists of pictures and of poses, with their times. */
#ifndef RLF_IO_FOLDER_LISTS_H
#define RLF_IO_FOLDER_LISTS_H

#include "io/file.h"
#include "relief/base.h"
#include "relief/math.h"

#define IO_NUMBERED_RATE 30 /* frames per second when the names hold numbers only */

/* ---- In which unit a list's times are: seconds, or what other programs write in their place */

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

/* ---- Lists of timestamped files: depth.txt and rgb.txt of the TUM RGB-D layout ---- */

#define IO_LIST_FILE_MAX ((size_t)256 << 20)

typedef struct io_list_entry {
    int64_t time_ns;
    int32_t line;     /* in the file, from 1 */
    const char *name; /* as written, usually relative to the folder */
} io_list_entry;

/* Entries in order of time; equal times keep the order of the file. */
typedef struct io_frame_list {
    io_list_entry *entries;
    int32_t count;
    char *text; /* holds the names */
} io_frame_list;

/* Lines "SECONDS NAME", or in another unit that is beyond doubt (time_unit.h), which is told; empty
 * lines and lines that start with # are skipped. Times that go backwards are sorted, with a
 * warning. */
rlf_result io_frame_list_parse(const io_bytes *file, io_frame_list *out);
void io_frame_list_free(io_frame_list *list);

/* ---- associations.txt: depth and colour pictures in pairs, one per line ---- */

/* Lines "TIME FILE TIME FILE", depth or colour first: the one with "depth" in its name is depth.
 * *out_has_numbers: the times were frame numbers (0, 1, 2, ...), as ICL-NUIM writes them; they are
 * taken as 30 per second. */
rlf_result io_associations_parse(const io_bytes *file, io_frame_list *out_depth,
                                 io_frame_list *out_color, bool *out_has_numbers);

/* ---- Where the camera was, from the files that come with data sets ---- */

#define IO_POSE_FILE_MAX ((size_t)256 << 20)

/* Camera to world. A pose whose quaternion is 0 is none. */
typedef struct io_pose_list {
    int64_t *times; /* nanoseconds, not decreasing; of a file without times 0, 1, 2, ... */
    rlf_pose *poses;
    int32_t count;
} io_pose_list;

void io_pose_list_free(io_pose_list *list);

/* TUM: "SECONDS tx ty tz qx qy qz qw" per line, # before comments. Lines that are no pose, NaN and
 * zero quaternions are none. `first_s` and `last_s` are the pictures' times in seconds: they tell
 * when the file has another unit (time_unit.h). */
rlf_result io_pose_list_tum(const io_bytes *file, double first_s, double last_s, io_pose_list *out);

/* Open3D and Redwood: three numbers, then four rows of a 4x4 matrix, and so on. */
rlf_result io_pose_list_log(const io_bytes *file, io_pose_list *out);

/* 7-Scenes: one 4x4 matrix. False when it is no rigid motion. */
bool io_pose_matrix(const io_bytes *file, rlf_pose *out);

/* Pose of each time: the nearest one, at most `gap_ns` away. */
void io_pose_list_match(const io_pose_list *list, const int64_t *times, int32_t count,
                        int64_t gap_ns, rlf_pose *out);

/* The same motion with the y axis the other way round, of the world and of the camera. */
rlf_pose io_pose_flip_y(const rlf_pose *pose);

#endif
