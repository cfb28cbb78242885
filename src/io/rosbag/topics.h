/* Which topics of a bag are the depth and the colour pictures. */
#ifndef RLF_IO_ROSBAG_TOPICS_H
#define RLF_IO_ROSBAG_TOPICS_H

#include "io/rosbag/bag.h"
#include "io/rosbag/messages.h"
#include "io/rosbag/tf_tree.h"
#include "io/ros/topics.h"

/* What a bag holds, and what was chosen of it. */
typedef struct bag_topics {
    bag *bag;
    tf_tree transforms;
    io_ros_topic *pictures;
    int32_t *connections; /* of the pictures */
    io_ros_info_topic *infos;
    io_ros_topics lists;
    char strangers[512];
    int32_t depth, color; /* pictures; -1 = none */
} bag_topics;

/* Marks what bag_index shall list. */
void bag_topics_mark(bag *b);

/* Looks at each topic's first picture and first calibration. bag_topics_free in either case. */
rlf_result bag_topics_read(bag *b, const char *path, bag_topics *out);
void bag_topics_free(bag_topics *topics);

/* First message of a connection; RLF_ERROR_FORMAT when there is none. */
rlf_result bag_topics_first(bag *b, int32_t connection, io_bytes *out);

/* First connection whose topic begins as that of `connection` does, by `depth` parts of its path at
 * least, and ends in `suffix`; -1 = none. */
int32_t bag_topics_beside(bag *b, int32_t connection, int32_t depth, const char *suffix);

#endif
