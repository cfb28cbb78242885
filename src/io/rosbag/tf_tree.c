/* The tree of coordinate frames that ROS calls tf. */
#include "io/rosbag/tf_tree.h"

#include "io/clip/cursor.h"
#include "io/rosbag/messages.h"

#define EDGES_MAX 512

struct tf_edge {
    char parent[IO_ROS_NAME_MAX], child[IO_ROS_NAME_MAX];
    rlf_pose T_parent_child;
};

/* Old drivers write a slash in front. */
static const char *plain(const char *frame)
{
    return frame[0] == '/' ? frame + 1 : frame;
}

static const tf_edge *above(const tf_tree *tree, const char *frame)
{
    for (int32_t i = 0; i < tree->count; i++) {
        if (strcmp(tree->edges[i].child, frame) == 0) {
            return &tree->edges[i];
        }
    }
    return NULL;
}

static void add_edge(tf_tree *tree, const tf_edge *edge)
{
    if (tree->edges == NULL) {
        tree->edges = rlf_alloc_array(EDGES_MAX, sizeof(tree->edges[0]));
    }
    if (tree->edges != NULL && tree->count < EDGES_MAX && above(tree, edge->child) == NULL) {
        tree->edges[tree->count++] = *edge;
    }
}

static void add_message(tf_tree *tree, const io_bytes *message)
{
    cursor c = {message->data, message->size, false};
    const uint32_t count = cursor_u32(&c);
    for (uint32_t i = 0; i < count; i++) {
        tf_edge edge;
        char name[IO_ROS_NAME_MAX];
        cursor_u32(&c);
        cursor_time(&c);
        cursor_text(&c, name, sizeof(name));
        memmove(edge.parent, plain(name), strlen(plain(name)) + 1);
        cursor_text(&c, name, sizeof(name));
        memmove(edge.child, plain(name), strlen(plain(name)) + 1);
        const uint8_t *at = cursor_take(&c, 7 * sizeof(double));
        if (at == NULL) {
            return;
        }
        const io_bytes transform = {message->name, at, 7 * sizeof(double)};
        if (message_read_transform(&transform, &edge.T_parent_child)) {
            add_edge(tree, &edge);
        }
    }
}

void tf_tree_read(tf_tree *tree, bag *b)
{
    for (int32_t i = 0; i < bag_entry_count(b); i++) {
        const bag_entry *entry = bag_entry_at(b, i);
        io_bytes message;
        if (message_kind_of(bag_connection_at(b, entry->connection)->type) == MESSAGE_TF &&
            bag_message(b, entry, &message) == RLF_OK) {
            add_message(tree, &message);
        }
    }
}

void tf_tree_free(tf_tree *tree)
{
    rlf_free(tree->edges);
    tree->edges = NULL;
    tree->count = 0;
}

/* The pose of `frame` in its root; a loop ends after as many steps as there are edges. */
static rlf_pose pose_in_root(const tf_tree *tree, const char *frame, const char **out_root)
{
    rlf_pose pose = rlf_pose_identity();
    *out_root = plain(frame);
    for (int32_t i = 0; i < tree->count; i++) {
        const tf_edge *edge = above(tree, *out_root);
        if (edge == NULL) {
            break;
        }
        pose = rlf_pose_mul(&edge->T_parent_child, &pose);
        *out_root = edge->parent;
    }
    return pose;
}

bool tf_tree_find(const tf_tree *tree, const char *from, const char *to, rlf_pose *out)
{
    const char *from_root = NULL;
    const char *to_root = NULL;
    const rlf_pose T_root_from = pose_in_root(tree, from, &from_root);
    const rlf_pose T_root_to = pose_in_root(tree, to, &to_root);
    const rlf_pose T_to_root = rlf_pose_invert(&T_root_to);
    *out = rlf_pose_mul(&T_to_root, &T_root_from);
    return strcmp(from_root, to_root) == 0;
}
