/* Which topics of a bag are the depth and the colour pictures. */
#include "io/rosbag/topics.h"

#include "io/picture/picture.h"
#include "io/pixels/compressed_depth.h"

#include <string.h>

/* Of what does not change one message is enough; transforms come spread over a few. */
#define FEW 256

void bag_topics_mark(bag *b)
{
    for (int32_t i = 0; i < bag_connection_count(b); i++) {
        bag_connection *c = bag_connection_at(b, i);
        switch (message_kind_of(c->type)) {
        case MESSAGE_IMAGE:
        case MESSAGE_COMPRESSED_IMAGE: c->limit = INT32_MAX; break;
        case MESSAGE_CAMERA_INFO: c->limit = 1; break;
        case MESSAGE_OTHER: c->limit = 0; break;
        default: c->limit = FEW; break;
        }
    }
}

rlf_result bag_topics_first(bag *b, int32_t connection, io_bytes *out)
{
    const bag_connection *c = bag_connection_at(b, connection);
    if (c->count > 0) {
        return bag_message(b, bag_entry_at(b, c->first), out);
    }
    return rlf_fail(RLF_ERROR_FORMAT, "%s: holds no messages: choose another topic", c->topic);
}

/* How many parts of the path two topics begin with alike. */
static int32_t common_parts(const char *a, const char *b)
{
    int32_t count = 0;
    for (; *a != '\0' && *a == *b; a++, b++) {
        count += a[1] == '/' && b[1] == '/' ? 1 : 0;
    }
    return count;
}

int32_t bag_topics_beside(bag *b, int32_t connection, int32_t depth, const char *suffix)
{
    const char *topic = bag_connection_at(b, connection)->topic;
    for (int32_t i = 0; i < bag_connection_count(b); i++) {
        const char *other = bag_connection_at(b, i)->topic;
        const size_t length = strlen(other);
        if (length >= strlen(suffix) && strcmp(other + length - strlen(suffix), suffix) == 0 &&
            common_parts(topic, other) >= depth) {
            return i;
        }
    }
    return -1;
}

static io_ros_picture kind_of(const message_image *image)
{
    if (image->is_compressed) {
        int32_t width, height;
        return io_compressed_depth_is(&image->file, image->encoding) ? IO_ROS_PICTURE_DEPTH
               : io_picture_size(&image->file, &width, &height)      ? IO_ROS_PICTURE_COLOR
                                                                     : IO_ROS_PICTURE_NONE;
    }
    if (io_pixels_is_depth(image->encoding)) {
        return IO_ROS_PICTURE_DEPTH;
    }
    const bool is_grey =
        strcmp(image->encoding, "mono8") == 0 || strcmp(image->encoding, "8UC1") == 0;
    return is_grey                                 ? IO_ROS_PICTURE_GREY
           : io_pixels_is_picture(image->encoding) ? IO_ROS_PICTURE_COLOR
                                                   : IO_ROS_PICTURE_NONE;
}

static bool size_of(const message_image *image, int32_t *out_width, int32_t *out_height)
{
    const io_pixels *p = &image->pixels;
    if (image->is_compressed) {
        return io_compressed_depth_is(&image->file, image->encoding)
                   ? io_compressed_depth_size(&image->file, image->encoding, out_width, out_height)
                   : io_picture_size(&image->file, out_width, out_height);
    }
    if (p->width < 1 || p->height < 1 || p->width > RLF_IMAGE_SIZE_MAX ||
        p->height > RLF_IMAGE_SIZE_MAX) {
        return false;
    }
    *out_width = (int32_t)p->width;
    *out_height = (int32_t)p->height;
    return true;
}

/* What a connection's first picture is. */
static void add_pictures(bag_topics *t, int32_t connection)
{
    const bag_connection *c = bag_connection_at(t->bag, connection);
    io_ros_topic *topic = &t->pictures[t->lists.picture_count];
    io_bytes message;
    message_image image;
    *topic = (io_ros_topic){.name = c->topic, .count = c->count, .encoding = "no pictures"};
    t->connections[t->lists.picture_count++] = connection;
    if (bag_topics_first(t->bag, connection, &message) != RLF_OK ||
        message_read_image(&message, message_kind_of(c->type), &image) != RLF_OK) {
        return;
    }
    memcpy(topic->encoding, image.encoding, sizeof(topic->encoding));
    memcpy(topic->frame_id, image.frame_id, sizeof(topic->frame_id));
    topic->kind =
        size_of(&image, &topic->width, &topic->height) ? kind_of(&image) : IO_ROS_PICTURE_NONE;
}

static void add_info(bag_topics *t, int32_t connection)
{
    io_bytes message;
    io_ros_info_topic *topic = &t->infos[t->lists.info_count];
    topic->name = bag_connection_at(t->bag, connection)->topic;
    if (bag_topics_first(t->bag, connection, &message) == RLF_OK &&
        message_read_info(&message, &topic->info)) {
        t->lists.info_count++;
    }
}

/* librealsense has its transforms in topics of their own. */
static bool is_joined(void *self, const char *from, const char *to)
{
    const bag_topics *t = self;
    rlf_pose pose;
    return strncmp(t->pictures[0].name, "/device_", 8) == 0 ||
           tf_tree_find(&t->transforms, from, to, &pose);
}

rlf_result bag_topics_read(bag *b, const char *path, bag_topics *out)
{
    const int32_t count = bag_connection_count(b);
    *out = (bag_topics){.bag = b, .depth = -1, .color = -1};
    out->pictures = rlf_alloc_array((size_t)count, sizeof(out->pictures[0]));
    out->connections = rlf_alloc_array((size_t)count, sizeof(out->connections[0]));
    out->infos = rlf_alloc_array((size_t)count, sizeof(out->infos[0]));
    if (out->pictures == NULL || out->connections == NULL || out->infos == NULL) {
        return RLF_ERROR_MEMORY;
    }
    out->lists = (io_ros_topics){.name = path,
                                 .pictures = out->pictures,
                                 .infos = out->infos,
                                 .strangers = out->strangers,
                                 .is_joined = is_joined,
                                 .self = out};
    for (int32_t i = 0; i < count; i++) {
        const message_kind kind = message_kind_of(bag_connection_at(b, i)->type);
        if (kind == MESSAGE_IMAGE || kind == MESSAGE_COMPRESSED_IMAGE) {
            add_pictures(out, i);
        } else if (kind == MESSAGE_CAMERA_INFO) {
            add_info(out, i);
        } else if (kind == MESSAGE_OTHER && io_ros_is_stranger(bag_connection_at(b, i)->type)) {
            io_ros_add_stranger(out->strangers, sizeof(out->strangers),
                                bag_connection_at(b, i)->topic, bag_connection_at(b, i)->type, "");
        }
    }
    tf_tree_read(&out->transforms, b);
    return RLF_OK;
}

void bag_topics_free(bag_topics *topics)
{
    tf_tree_free(&topics->transforms);
    rlf_free(topics->pictures);
    rlf_free(topics->connections);
    rlf_free(topics->infos);
}
