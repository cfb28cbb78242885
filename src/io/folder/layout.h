/* How the pictures of a folder are arranged, which data set does it so, and what camera it used. */
#ifndef RLF_IO_FOLDER_LAYOUT_H
#define RLF_IO_FOLDER_LAYOUT_H

#include "io/folder/frame_list.h"
#include "relief/backend.h"

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

#endif
