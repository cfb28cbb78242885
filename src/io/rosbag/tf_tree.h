/* The tree of coordinate frames that ROS calls tf, as far as it does not move. */
#ifndef RLF_IO_ROSBAG_TF_TREE_H
#define RLF_IO_ROSBAG_TF_TREE_H

#include "relief/math.h"
#include "io/rosbag/bag.h"

typedef struct tf_edge tf_edge;

typedef struct tf_tree {
    tf_edge *edges;
    int32_t count;
} tf_tree;

/* Adds the transforms of a bag; of each pair of frames the first one counts. What does not fit or
 * is no transform is left out. */
void tf_tree_read(tf_tree *tree, bag *b);
void tf_tree_free(tf_tree *tree);

/* p_to = T p_from. False when the two frames are not joined. */
bool tf_tree_find(const tf_tree *tree, const char *from, const char *to, rlf_pose *out);

#endif
