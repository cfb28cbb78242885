/* Where the camera was, from the files that come with data sets. */
#ifndef RLF_IO_FOLDER_POSE_FILES_H
#define RLF_IO_FOLDER_POSE_FILES_H

#include "io/file.h"
#include "relief/math.h"

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
