/* How the pictures of a folder are arranged, which data set does it so, and what camera it used. */
#ifndef RLF_IO_FOLDER_LAYOUT_H
#define RLF_IO_FOLDER_LAYOUT_H

#include "io/clip/clip.h"
#include "io/folder/lists.h"
#include "relief/backend.h"
#include "relief/camera.h"

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
