/* Which topics of a bag are the depth and the colour pictures. */
#ifndef RLF_IO_ROSBAG_TOPICS_H
#define RLF_IO_ROSBAG_TOPICS_H

#include "io/rosbag/bag.h"
#include "io/rosbag/messages.h"

/* Connections; -1 = none. */
typedef struct bag_topics {
    int32_t depth, color;
    int32_t depth_info, color_info; /* their CameraInfo */
} bag_topics;

/* Marks what bag_index shall list. */
void bag_topics_mark(bag *b);

/* Chooses by names and by what each topic's first picture is; a name given decides ("none" = no
 * colour). NULL = not given. */
rlf_result bag_topics_choose(bag *b, const char *path, const char *depth_name,
                             const char *color_name, bag_topics *out);

/* First message of a connection; RLF_ERROR_FORMAT when there is none. */
rlf_result bag_topics_first(bag *b, int32_t connection, io_bytes *out);

/* First connection whose topic is `prefix` up to `depth` slashes, and ends in `suffix`; -1 = none.
 */
int32_t bag_topics_beside(bag *b, int32_t connection, int32_t depth, const char *suffix);

#endif
