/* Which of the topics that are published are read, to find out what a camera is. */
#include "io/ros2/find_camera.h"

#include <string.h>

static bool has(const char *name, const char *word)
{
    return strstr(name, word) != NULL;
}

static bool is_type(const io_ros2_topic *t, io_ros_type type)
{
    return strcmp(t->type, io_ros_type_name(type)) == 0;
}

static bool is_picture(const io_ros2_topic *t)
{
    return is_type(t, IO_ROS_IMAGE) || is_type(t, IO_ROS_COMPRESSED_IMAGE);
}

bool io_ros2_is_below(const char *topic, const char *place)
{
    size_t length = strlen(place);
    while (length > 0 && place[length - 1] == '/') {
        length--;
    }
    const size_t begin = length > 0 && place[0] != '/' ? 1 : 0;
    return length == 0 ||
           (strlen(topic) >= length + begin && strncmp(topic + begin, place, length) == 0 &&
            (topic[begin + length] == '/' || topic[begin + length] == '\0'));
}

static bool is_named_depth(const char *name)
{
    return has(name, "depth") || has(name, "stereo") || has(name, "disparity");
}

/* How image_transport packs it; 0 = it does not, or not so that it is read here. */
static size_t packed_length(const char *name)
{
    static const char *const ends[] = {"/compressedDepth", "/compressed"};
    const size_t whole = strlen(name);
    for (size_t i = 0; i < sizeof(ends) / sizeof(ends[0]); i++) {
        const size_t length = strlen(ends[i]);
        if (whole > length && strcmp(name + whole - length, ends[i]) == 0) {
            return length;
        }
    }
    return 0;
}

static bool is_packed_of(const char *packed, const char *raw)
{
    const size_t length = strlen(packed) - packed_length(packed);
    return length < strlen(packed) && strlen(raw) == length && strncmp(packed, raw, length) == 0;
}

/* A driver packs a picture only for who reads it, each way anew: one way is enough. */
static bool is_other_way(const io_ros2_topic *topics, int32_t count, const io_ros2_topic *t,
                         bool is_packed_wanted)
{
    const size_t packed = packed_length(t->name);
    if (packed > 0 && (t->name[strlen(t->name) - 1] == 'h') != is_named_depth(t->name)) {
        return true; /* compressedDepth of colour, and depth by JPEG */
    }
    for (int32_t i = 0; i < count; i++) {
        const io_ros2_topic *other = &topics[i];
        const bool is_readable =
            (packed_length(other->name) > 0) != (packed > 0) && is_picture(other) && other != t;
        if (is_readable && packed > 0 && !is_packed_wanted && is_packed_of(t->name, other->name)) {
            return true;
        }
        const bool is_right =
            (other->name[strlen(other->name) - 1] == 'h') == is_named_depth(other->name);
        if (is_readable && packed == 0 && is_packed_wanted && is_right &&
            is_packed_of(other->name, t->name)) {
            return true;
        }
    }
    return false;
}

static bool is_wanted_picture(const io_ros2_topic *topics, int32_t count, const io_ros2_topic *t,
                              const io_ros2_wish *wish)
{
    if (!is_picture(t)) {
        return false;
    }
    const bool is_depth = wish->depth != NULL && strcmp(wish->depth, t->name) == 0;
    const bool is_color = wish->color != NULL && strcmp(wish->color, t->name) == 0;
    if (is_depth || is_color) {
        return true;
    }
    if (!io_ros2_is_below(t->name, wish->place) ||
        is_other_way(topics, count, t, wish->is_packed)) {
        return false;
    }
    return wish->depth == NULL || (wish->color == NULL && !is_named_depth(t->name));
}

int32_t io_ros2_choose_topics(const io_ros2_topic *topics, int32_t count, const io_ros2_wish *wish,
                              int32_t *out, int32_t capacity)
{
    int32_t chosen = 0;
    for (int32_t i = 0; i < count && chosen < capacity; i++) {
        const io_ros2_topic *t = &topics[i];
        const bool is_info = is_type(t, IO_ROS_CAMERA_INFO) &&
                             (wish->depth != NULL || io_ros2_is_below(t->name, wish->place));
        const bool is_tf = is_type(t, IO_ROS_TF) && strcmp(t->name, "/tf_static") == 0;
        if (is_info || is_tf || is_wanted_picture(topics, count, t, wish)) {
            out[chosen++] = i;
        }
    }
    return chosen;
}

bool io_ros2_has_depth(const io_ros2_topic *topics, int32_t count, const io_ros2_wish *wish)
{
    for (int32_t i = 0; i < count; i++) {
        const io_ros2_topic *t = &topics[i];
        if (is_picture(t) &&
            (wish->depth != NULL ? strcmp(wish->depth, t->name) == 0
                                 : io_ros2_is_below(t->name, wish->place) &&
                                       (wish->place[0] != '\0' || is_named_depth(t->name)))) {
            return true;
        }
    }
    return false;
}

/* The part of a path that a driver puts its depth pictures into. */
static bool is_depth_part(const char *part)
{
    return strncmp(part, "depth", 5) == 0 || strncmp(part, "aligned_depth", 13) == 0 ||
           strncmp(part, "stereo", 6) == 0;
}

bool io_ros2_camera_of(const io_ros2_topic *topic, char *out, size_t size)
{
    if (!is_picture(topic)) {
        return false;
    }
    for (const char *part = strchr(topic->name, '/'); part != NULL; part = strchr(part + 1, '/')) {
        if (is_depth_part(part + 1)) {
            const size_t length = (size_t)(part - topic->name);
            if (length + 1 > size) {
                return false;
            }
            memcpy(out, topic->name, length);
            out[length] = '\0';
            return true;
        }
    }
    return false;
}
