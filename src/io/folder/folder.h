/* Folders of pictures: how they are arranged, which data set does it so, and what camera it used.
 */
#ifndef RLF_IO_FOLDER_FOLDER_H
#define RLF_IO_FOLDER_FOLDER_H

#include "io/clip/clip.h"
#include "io/file.h"
#include "relief/backend.h"
#include "relief/camera.h"
#include "relief/math.h"

#define IO_NUMBERED_RATE 30 /* frames per second when the names hold numbers only */

static inline int64_t io_numbered_time(int64_t number)
{
    return number / IO_NUMBERED_RATE * 1000000000 +
           number % IO_NUMBERED_RATE * 1000000000 / IO_NUMBERED_RATE;
}

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

/* Lines "SECONDS NAME", or in another unit that is beyond doubt (io_time_unit), which is told;
 * empty lines and lines that start with # are skipped. Times that go backwards are sorted, with a
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
 * when the file has another unit (io_time_unit). */
rlf_result io_pose_list_tum(const io_bytes *file, double first_s, double last_s, io_pose_list *out);

/* Open3D and Redwood: three numbers, then four rows of a 4x4 matrix, and so on. */
rlf_result io_pose_list_log(const io_bytes *file, io_pose_list *out);

/* 7-Scenes: one 4x4 matrix. Zero when it is no rigid motion. */
rlf_pose io_pose_matrix(const io_bytes *file);

/* Pose of a time: the nearest one, at most `gap_ns` away, or none. */
rlf_pose io_pose_list_at(const io_pose_list *list, int64_t time_ns, int64_t gap_ns);

/* The same motion with the y axis the other way round, of the world and of the camera. */
rlf_pose io_pose_flip_y(const rlf_pose *pose);

/* ---- Pictures of a folder that nothing lists, in the order of their names ---- */

/* Files of folder/sub ("" = the folder itself) whose names hold `word` ("" = any) and end with one
 * of `endings` (NULL after the last), in natural order: 2 before 10. The n-th is n / 30 s. No such
 * folder gives an empty list. */
rlf_result io_named_list(const char *folder, const char *sub, const char *word,
                         const char *const *endings, io_frame_list *out);
/* Gives both lists the times of the numbers in their names (the last of each name), where all have
 * one. Else pictures go together one by one, if there are as many of depth as of colour. False:
 * nobody knows which go together. */
bool io_named_pair(io_frame_list *depth, io_frame_list *color);

/* ---- Lists of pictures made from the names in a folder ---- */

/* Files of folder/sub ("" = the folder itself) whose names begin with `prefix`, go on with a number
 * and end with one of `endings` (NULL after the last). Times are number / 30 s, or, of names like
 * 000012-000000400320.png, the microseconds after the minus. In order of time. No such folder gives
 * an empty list. */
rlf_result io_numbered_list(const char *folder, const char *sub, const char *prefix,
                            const char *const *endings, io_frame_list *out);

/* ---- The camera of a clip that names none, guessed from the size of its depth pictures ---- */

/* What cameras that give pictures of width x height usually have. NULL: no camera is known for that
 * size. Else the camera's name, for a message. */
const char *io_guess_camera(int32_t width, int32_t height, rlf_camera *out);

/* Counts per metre of a 16-bit depth picture: 1000 (millimetres), or 5000 (TUM RGB-D) where
 * millimetres would put the middle of the picture beyond any room. */
double io_guess_units(const uint16_t *depth, size_t count);

typedef enum io_layout_kind {
    IO_LAYOUT_TUM = 0,     /* depth.txt, rgb.txt or associations.txt */
    IO_LAYOUT_ICL = 1,     /* the same by ICL-NUIM: frame numbers in place of times, y up */
    IO_LAYOUT_SCENES7 = 2, /* frame-NNNNNN.depth.png, .color.png, .pose.txt */
    IO_LAYOUT_REDWOOD = 3, /* depth/ and color/ or image/ or rgb/, numbered (Open3D) */
    IO_LAYOUT_NAMED = 4    /* pictures with any names, in their order */
} io_layout_kind;

typedef struct io_layout {
    io_layout_kind kind;
    const char *description;                       /* for rlf_source_info.device */
    const char *depth_list_name, *color_list_name; /* where a picture's line stands, for messages */
    io_frame_list depth, color;
    uint16_t missing;       /* depth that means none, beside 0; 0 = no such */
    rlf_pose *poses;        /* of each depth picture; NULL = none */
    double units_per_metre; /* by habit of the data set; 0 = there is none */
} io_layout;

/* Lists the pictures. Fails when the folder is arranged in none of these ways. */
rlf_result io_layout_read(const char *folder, io_layout *out);
/* Reads the poses that lie beside the pictures, if there are any. */
rlf_result io_layout_read_poses(const char *folder, io_layout *layout);
/* The camera when there is no camera.json: intrinsic.json, else what the data set is known to have
 * used, else what cameras with such pictures usually have, with a warning. `width`, `height`: of
 * the depth pictures. */
rlf_result io_layout_camera(const char *folder, io_layout *layout, int32_t width, int32_t height,
                            rlf_camera *out);
void io_layout_free(io_layout *layout);

/* ---- What a folder that Relief has recorded says beside its pictures: source.json and frames.txt
 * ---- */

#define IO_FOLDER_SOURCE "source.json"
#define IO_FOLDER_FRAMES "frames.txt"
#define IO_FOLDER_POSES "groundtruth.txt"
#define IO_FOLDER_FRAMES_MAX ((size_t)256 << 20)

/* Writes source.json. `flags`: of every frame. */
rlf_result io_folder_write_origin(const char *folder, const rlf_source_info *info, uint32_t flags);
/* Reads both; a folder without source.json says nothing, and *out stays as it is. The notes are
 * *out_notes, a new array that *out borrows. */
rlf_result io_folder_read_origin(const char *folder, io_clip_origin *out, uint32_t *out_flags,
                                 io_frame_note **out_notes);

#endif
