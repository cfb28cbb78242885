/* The tree of coordinate frames that ROS calls tf, as far as it does not move. */
#include "io/ros/recording.h"

#include <string.h>

#define TRANSFORMS_MAX 512
#define AT_ONCE 64 /* of a message */

struct io_ros_transforms {
    bool is_ros1;
    io_ros_transform items[TRANSFORMS_MAX];
    int32_t count;
};

/* Old drivers write a slash in front. */
static const char *plain(const char *frame)
{
    return frame[0] == '/' ? frame + 1 : frame;
}

static const io_ros_transform *above(const io_ros_transforms *t, const char *frame)
{
    for (int32_t i = 0; i < t->count; i++) {
        if (strcmp(t->items[i].child, frame) == 0) {
            return &t->items[i];
        }
    }
    return NULL;
}

/* Of each pair of frames the first one counts. */
static void add(io_ros_transforms *t, const io_ros_transform *item)
{
    if (t->count == TRANSFORMS_MAX || !io_ros_is_pose(&item->T_parent_child)) {
        return;
    }
    io_ros_transform *to = &t->items[t->count];
    *to = *item;
    memmove(to->parent, plain(to->parent), strlen(plain(to->parent)) + 1);
    memmove(to->child, plain(to->child), strlen(plain(to->child)) + 1);
    if (t->is_ros1) {
        to->T_parent_child.q = rlf_quat_normalize(to->T_parent_child.q);
    }
    t->count += above(t, to->child) == NULL ? 1 : 0;
}

static void read_channel(const io_ros_log *log, int32_t channel, io_ros_transforms *t,
                         io_ros_transform *room)
{
    for (int32_t m = 0; m < log->channels[channel].count; m++) {
        io_cdr_reader message;
        uint32_t count = 0;
        if (io_ros_log_read(log, channel, m, &message) == RLF_OK) {
            io_ros_read_tf(message, room, AT_ONCE, &count);
        }
        for (uint32_t i = 0; i < count; i++) {
            add(t, &room[i]);
        }
    }
}

rlf_result io_ros_transforms_read(const io_ros_log *log, io_ros_transforms **out)
{
    io_ros_transforms *t = rlf_alloc(sizeof(*t));
    io_ros_transform *room = rlf_alloc_array(AT_ONCE, sizeof(*room));
    *out = t;
    if (t != NULL && room != NULL) {
        t->is_ros1 = log->is_ros1;
        for (int32_t i = 0; i < log->channel_count; i++) {
            const io_ros_channel *channel = &log->channels[i];
            if (channel->type == IO_ROS_TF &&
                (log->is_ros1 || strstr(channel->topic, "tf_static") != NULL)) {
                read_channel(log, i, t, room);
            }
        }
    }
    rlf_free(room);
    return t != NULL && room != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

/* From a frame up to the root of its tree: p_root = T p_frame. A circle ends after as many steps as
 * there are transforms. */
static const char *climb(const io_ros_transforms *t, const char *frame, rlf_pose *out)
{
    *out = rlf_pose_identity();
    for (int32_t steps = 0; steps < t->count; steps++) {
        const io_ros_transform *up = above(t, frame);
        if (up == NULL) {
            break;
        }
        *out = rlf_pose_mul(&up->T_parent_child, out);
        frame = up->parent;
    }
    return frame;
}

bool io_ros_transforms_find(const io_ros_transforms *t, const char *from, const char *to,
                            rlf_pose *out_T_to_from)
{
    rlf_pose up_from, up_to;
    from = plain(from);
    to = plain(to);
    const io_ros_transform *up = above(t, from);
    /* The step between two frames that are joined directly keeps its numbers as they are. */
    if (!t->is_ros1 && up != NULL && strcmp(up->parent, to) == 0) {
        *out_T_to_from = up->T_parent_child;
        return true;
    }
    const char *root = climb(t, from, &up_from);
    if (strcmp(root, climb(t, to, &up_to)) != 0) {
        return false;
    }
    const rlf_pose down = rlf_pose_invert(&up_to);
    *out_T_to_from = rlf_pose_mul(&down, &up_from);
    if (!t->is_ros1) {
        out_T_to_from->q = rlf_quat_normalize(out_T_to_from->q);
    }
    return true;
}
