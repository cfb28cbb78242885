/* Transforms of a ROS 2 recording. */
#ifndef RLF_IO_MCAP_TRANSFORMS_H
#define RLF_IO_MCAP_TRANSFORMS_H

#include "io/mcap/read.h"

/* From /tf_static; false when the two frames are not joined. */
bool io_mcap_find_transform(io_mcap_reader *reader, const char *from, const char *to,
                            rlf_pose *out_T_to_from);

#endif
