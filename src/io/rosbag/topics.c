/* Which topics of a bag are the depth and the colour pictures. */
#define _POSIX_C_SOURCE 200809L
#include "io/rosbag/topics.h"

#include <string.h>
#include <strings.h>

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

/* How much of a CameraInfo's topic is its camera's: drivers put it into the pictures' own folder,
 * librealsense one below. */
static size_t folder_length(const char *topic)
{
    const char *slash = strrchr(topic, '/');
    size_t length = slash != NULL ? (size_t)(slash - topic) : 0;
    if (length >= 5 && strncmp(topic + length - 5, "/info", 5) == 0) {
        length -= 5;
    }
    return length;
}

/* The CameraInfo of the innermost folder that the pictures are in. */
static int32_t find_info(bag *b, int32_t connection)
{
    const char *topic = bag_connection_at(b, connection)->topic;
    int32_t best = -1;
    size_t best_length = 0;
    for (int32_t i = 0; i < bag_connection_count(b); i++) {
        const bag_connection *c = bag_connection_at(b, i);
        const size_t length = folder_length(c->topic);
        if (message_kind_of(c->type) == MESSAGE_CAMERA_INFO && c->count > 0 &&
            strncmp(topic, c->topic, length) == 0 && topic[length] == '/' &&
            (best < 0 || length > best_length)) {
            best = i;
            best_length = length;
        }
    }
    return best;
}

static bool has(const char *topic, const char *word)
{
    const size_t length = strlen(word);
    for (; *topic != '\0'; topic++) {
        if (strncasecmp(topic, word, length) == 0) {
            return true;
        }
    }
    return false;
}

typedef enum picture_kind {
    PICTURE_OTHER,
    PICTURE_DEPTH,
    PICTURE_COLOR,
    PICTURE_GREY
} picture_kind;

static picture_kind kind_of(bag *b, int32_t connection)
{
    io_bytes message;
    message_image image;
    const message_kind kind = message_kind_of(bag_connection_at(b, connection)->type);
    if ((kind != MESSAGE_IMAGE && kind != MESSAGE_COMPRESSED_IMAGE) ||
        bag_topics_first(b, connection, &message) != RLF_OK ||
        message_read_image(&message, kind, &image) != RLF_OK) {
        return PICTURE_OTHER;
    }
    if (image.is_compressed) {
        const bool is_depth = strstr(image.encoding, "compressedDepth") != NULL ||
                              strncmp(image.encoding, "16UC1", 5) == 0 ||
                              strncmp(image.encoding, "mono16", 6) == 0;
        return is_depth ? PICTURE_DEPTH : PICTURE_COLOR;
    }
    const bool is_grey =
        strcmp(image.encoding, "mono8") == 0 || strcmp(image.encoding, "8UC1") == 0;
    return io_pixels_is_depth(image.encoding) ? PICTURE_DEPTH
                                              : (is_grey ? PICTURE_GREY : PICTURE_COLOR);
}

/* How likely a topic of depth pictures is the one that is meant: one named so, as the camera made
 * it, with its calibration, before a copy of it. */
static int32_t depth_score(bag *b, int32_t connection)
{
    const char *topic = bag_connection_at(b, connection)->topic;
    return 16 + (has(topic, "depth") ? 8 : 0) -
           (has(topic, "infra") || has(topic, "/ir") ? 12 : 0) - (has(topic, "aligned") ? 1 : 0) -
           (has(topic, "compressed") ? 1 : 0) + (find_info(b, connection) >= 0 ? 4 : 0);
}

static int32_t color_score(bag *b, int32_t connection, const char *depth_topic)
{
    const char *topic = bag_connection_at(b, connection)->topic;
    const bool is_other = has(topic, "infra") || has(topic, "/ir") || has(topic, "fisheye") ||
                          has(topic, "confidence") || has(topic, "depth");
    return 8 + (has(topic, "rgb") || has(topic, "color") ? 8 : 0) - (is_other ? 16 : 0) +
           (kind_of(b, connection) == PICTURE_GREY ? -4 : 0) +
           (find_info(b, connection) >= 0 ? 4 : 0) - (has(topic, "compressed") ? 1 : 0) +
           2 * common_parts(topic, depth_topic);
}

static int32_t find_named(bag *b, const char *name)
{
    for (int32_t i = 0; i < bag_connection_count(b); i++) {
        const bag_connection *c = bag_connection_at(b, i);
        const message_kind kind = message_kind_of(c->type);
        if (strcmp(c->topic, name) == 0 && c->count > 0 &&
            (kind == MESSAGE_IMAGE || kind == MESSAGE_COMPRESSED_IMAGE)) {
            return i;
        }
    }
    return -1;
}

/* The best topic, more pictures first where two score alike. */
static int32_t find_best(bag *b, const char *depth_topic)
{
    int32_t best = -1;
    int32_t best_score = 0;
    for (int32_t i = 0; i < bag_connection_count(b); i++) {
        const picture_kind kind = kind_of(b, i);
        const bool fits = depth_topic == NULL ? kind == PICTURE_DEPTH
                                              : kind == PICTURE_COLOR || kind == PICTURE_GREY;
        const int32_t score =
            !fits ? 0 : (depth_topic == NULL ? depth_score(b, i) : color_score(b, i, depth_topic));
        const bool is_longer =
            best >= 0 && bag_connection_at(b, i)->count > bag_connection_at(b, best)->count;
        if (score > best_score || (score > 0 && score == best_score && is_longer)) {
            best = i;
            best_score = score;
        }
    }
    return best;
}

static rlf_result fail_topic(const char *path, const char *key, const char *name)
{
    return rlf_fail(RLF_ERROR_INVALID,
                    "%s: %s=%.100s: holds no pictures of that topic: rosbag info lists the topics",
                    path, key, name);
}

rlf_result bag_topics_choose(bag *b, const char *path, const char *depth_name,
                             const char *color_name, bag_topics *out)
{
    *out = (bag_topics){-1, -1, -1, -1};
    out->depth = depth_name != NULL ? find_named(b, depth_name) : find_best(b, NULL);
    if (out->depth < 0) {
        return depth_name != NULL
                   ? fail_topic(path, "depth", depth_name)
                   : rlf_fail(RLF_ERROR_FORMAT,
                              "%s: holds no depth pictures (sensor_msgs/Image of 16UC1, mono16 or "
                              "32FC1, or compressedDepth): record the camera's depth topic too",
                              path);
    }
    if (color_name == NULL) {
        out->color = find_best(b, bag_connection_at(b, out->depth)->topic);
    } else if (strcmp(color_name, "none") != 0) {
        out->color = find_named(b, color_name);
        if (out->color < 0) {
            return fail_topic(path, "color", color_name);
        }
    }
    out->depth_info = find_info(b, out->depth);
    out->color_info = out->color >= 0 ? find_info(b, out->color) : -1;
    return RLF_OK;
}
