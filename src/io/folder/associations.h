/* associations.txt: depth and colour pictures in pairs, one per line. */
#ifndef RLF_IO_FOLDER_ASSOCIATIONS_H
#define RLF_IO_FOLDER_ASSOCIATIONS_H

#include "io/folder/frame_list.h"

/* Lines "TIME FILE TIME FILE", depth or colour first: the one with "depth" in its name is depth.
 * *out_has_numbers: the times were frame numbers (0, 1, 2, ...), as ICL-NUIM writes them; they are
 * taken as 30 per second. */
rlf_result io_associations_parse(const io_bytes *file, io_frame_list *out_depth,
                                 io_frame_list *out_color, bool *out_has_numbers);

#endif
