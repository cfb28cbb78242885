/* Transforms of a ROS 2 recording. */
#include "io/mcap/transforms.h"

#include <string.h>

#define TRANSFORMS_MAX 256

typedef struct transforms {
    io_ros_transform items[TRANSFORMS_MAX];
    uint32_t count;
} transforms;

static bool is_usable(const rlf_pose *pose)
{
    const rlf_quat q = pose->q;
    const double square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    return square > 0.99 && square < 1.01 && rlf_vec3_is_finite(pose->p);
}

static void read_transforms(io_mcap_reader *reader, transforms *out)
{
    for (int32_t i = 0; i < io_mcap_channel_count(reader); i++) {
        const io_mcap_channel *channel = io_mcap_channel_at(reader, i);
        if (channel->type != IO_ROS_TF || strstr(channel->topic, "tf_static") == NULL) {
            continue;
        }
        for (int32_t m = 0; m < channel->count && out->count < TRANSFORMS_MAX; m++) {
            io_cdr_span bytes;
            uint32_t got = 0;
            if (io_mcap_read(reader, channel->first + m, &bytes) == RLF_OK) {
                io_ros_read_tf(bytes.data, bytes.size, out->items + out->count,
                               TRANSFORMS_MAX - out->count, &got);
            }
            out->count += got;
        }
    }
}

/* From a frame up to the root of its tree: p_root = T p_frame. A circle ends after as many steps as
 * there are transforms. */
static const char *climb(const transforms *t, const char *frame, rlf_pose *out)
{
    *out = rlf_pose_identity();
    for (uint32_t steps = 0; steps < t->count; steps++) {
        const io_ros_transform *up = NULL;
        for (uint32_t i = 0; i < t->count && up == NULL; i++) {
            const bool leads = strcmp(t->items[i].child, frame) == 0;
            up = leads && is_usable(&t->items[i].T_parent_child) ? &t->items[i] : NULL;
        }
        if (up == NULL) {
            break;
        }
        *out = rlf_pose_mul(&up->T_parent_child, out);
        frame = up->parent;
    }
    return frame;
}

/* The step between two frames that are joined directly keeps its numbers as they are. */
static const rlf_pose *find_direct(const transforms *t, const char *from, const char *to)
{
    for (uint32_t i = 0; i < t->count; i++) {
        const io_ros_transform *item = &t->items[i];
        if (strcmp(item->child, from) == 0 && strcmp(item->parent, to) == 0 &&
            is_usable(&item->T_parent_child)) {
            return &item->T_parent_child;
        }
    }
    return NULL;
}

bool io_mcap_find_transform(io_mcap_reader *reader, const char *from, const char *to,
                            rlf_pose *out_T_to_from)
{
    transforms *t = rlf_alloc(sizeof(*t));
    if (t == NULL) {
        return false;
    }
    read_transforms(reader, t);
    rlf_pose up_from, up_to;
    const rlf_pose *direct = find_direct(t, from, to);
    const char *root = climb(t, from, &up_from);
    const bool is_joined = direct != NULL || strcmp(root, climb(t, to, &up_to)) == 0;
    if (direct != NULL) {
        *out_T_to_from = *direct;
    } else if (is_joined) {
        const rlf_pose down = rlf_pose_invert(&up_to);
        *out_T_to_from = rlf_pose_mul(&down, &up_from);
        out_T_to_from->q = rlf_quat_normalize(out_T_to_from->q);
    }
    rlf_free(t);
    return is_joined;
}
