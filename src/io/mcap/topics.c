/* Which topics of a ROS 2 recording are the depth and the colour pictures. */
#include "io/mcap/topics.h"

#include "io/mcap/transforms.h"
#include "io/ros/topics.h"

struct io_mcap_topics {
    io_mcap_reader *reader;
    io_mcap_stream *streams; /* of the pictures, in their order */
    io_ros_topic *pictures;
    io_ros_info_topic *infos;
    io_ros_topics lists;
};

rlf_result io_mcap_read_picture(io_mcap_reader *reader, const io_mcap_stream *stream, int32_t index,
                                io_ros_image *out)
{
    const io_mcap_channel *channel = io_mcap_channel_at(reader, stream->channel);
    io_cdr_span bytes;
    rlf_result result = io_mcap_read(reader, channel->first + index, &bytes);
    if (result != RLF_OK) {
        return result;
    }
    const bool is_good = stream->is_compressed ? io_ros_read_compressed(bytes.data, bytes.size, out)
                                               : io_ros_read_image(bytes.data, bytes.size, out);
    return is_good ? RLF_OK
                   : rlf_fail(RLF_ERROR_FORMAT,
                              "%s: a message is not the picture that it should "
                              "be: record it again",
                              channel->topic);
}

static io_ros_picture kind_of(io_ros_pixels pixels)
{
    if (pixels == IO_ROS_UNKNOWN) {
        return IO_ROS_PICTURE_NONE;
    }
    return io_ros_is_depth(pixels)  ? IO_ROS_PICTURE_DEPTH
           : pixels == IO_ROS_MONO8 ? IO_ROS_PICTURE_GREY
                                    : IO_ROS_PICTURE_COLOR;
}

/* What a channel's first readable picture is. */
static void add_pictures(io_mcap_topics *t, int32_t index)
{
    const io_mcap_channel *channel = io_mcap_channel_at(t->reader, index);
    io_mcap_stream *s = &t->streams[t->lists.picture_count];
    io_ros_topic *topic = &t->pictures[t->lists.picture_count++];
    *s = (io_mcap_stream){.channel = index,
                          .is_compressed = channel->type == IO_ROS_COMPRESSED_IMAGE};
    *topic = (io_ros_topic){.name = channel->topic, .count = channel->count};
    snprintf(topic->encoding, sizeof(topic->encoding), "no pictures");
    for (int32_t i = 0; i < channel->count; i++) {
        io_ros_image image;
        if (io_mcap_read_picture(t->reader, s, i, &image) == RLF_OK) {
            s->pixels = io_ros_pixels_of(&image, s->is_compressed);
            memcpy(s->frame_id, image.header.frame_id, sizeof(s->frame_id));
            memcpy(topic->frame_id, image.header.frame_id, sizeof(topic->frame_id));
            memcpy(topic->encoding, image.encoding, sizeof(topic->encoding));
            const bool is_sized = io_ros_picture_size(&image, s->pixels, &s->width, &s->height);
            topic->kind = is_sized ? kind_of(s->pixels) : IO_ROS_PICTURE_NONE;
            topic->width = s->width;
            topic->height = s->height;
            return;
        }
    }
}

static void add_info(io_mcap_topics *t, int32_t index)
{
    const io_mcap_channel *channel = io_mcap_channel_at(t->reader, index);
    io_ros_info_topic *topic = &t->infos[t->lists.info_count];
    topic->name = channel->topic;
    for (int32_t m = 0; m < channel->count; m++) {
        io_cdr_span bytes;
        if (io_mcap_read(t->reader, channel->first + m, &bytes) == RLF_OK &&
            io_ros_read_camera_info(bytes.data, bytes.size, &topic->info)) {
            t->lists.info_count++;
            return;
        }
    }
}

static bool is_joined(void *self, const char *from, const char *to)
{
    const io_mcap_topics *t = self;
    rlf_pose pose;
    return io_mcap_find_transform(t->reader, from, to, &pose);
}

rlf_result io_mcap_topics_create(io_mcap_reader *reader, const char *path, io_mcap_topics **out)
{
    *out = NULL;
    io_mcap_topics *t = rlf_alloc(sizeof(*t));
    if (t == NULL) {
        return RLF_ERROR_MEMORY;
    }
    const size_t count = (size_t)io_mcap_channel_count(reader);
    t->reader = reader;
    t->streams = rlf_alloc_array(count, sizeof(t->streams[0]));
    t->pictures = rlf_alloc_array(count, sizeof(t->pictures[0]));
    t->infos = rlf_alloc_array(count, sizeof(t->infos[0]));
    if (t->streams == NULL || t->pictures == NULL || t->infos == NULL) {
        io_mcap_topics_destroy(&t);
        return RLF_ERROR_MEMORY;
    }
    t->lists = (io_ros_topics){.name = path,
                               .pictures = t->pictures,
                               .infos = t->infos,
                               .strangers = io_mcap_strangers(reader),
                               .is_joined = is_joined,
                               .self = t};
    for (int32_t i = 0; i < io_mcap_channel_count(reader); i++) {
        const io_ros_type type = io_mcap_channel_at(reader, i)->type;
        if (type == IO_ROS_IMAGE || type == IO_ROS_COMPRESSED_IMAGE) {
            add_pictures(t, i);
        } else if (type == IO_ROS_CAMERA_INFO) {
            add_info(t, i);
        }
    }
    *out = t;
    return RLF_OK;
}

void io_mcap_topics_destroy(io_mcap_topics **topics)
{
    io_mcap_topics *t = *topics;
    *topics = NULL;
    if (t != NULL) {
        rlf_free(t->streams);
        rlf_free(t->pictures);
        rlf_free(t->infos);
        rlf_free(t);
    }
}

rlf_result io_mcap_find_streams(const io_mcap_topics *topics, const io_mcap_wishes *wishes,
                                io_mcap_stream *depth, io_mcap_stream *color)
{
    int32_t d = -1, c = -1;
    rlf_result result = io_ros_choose(&topics->lists, wishes->depth, wishes->color, &d, &c);
    if (result == RLF_OK) {
        *depth = topics->streams[d];
        *color = c >= 0 ? topics->streams[c] : (io_mcap_stream){.channel = -1};
    }
    return result;
}

static const io_ros_topic *topic_of(const io_mcap_topics *topics, const io_mcap_stream *stream)
{
    int32_t i = 0;
    while (topics->streams[i].channel != stream->channel) {
        i++;
    }
    return &topics->pictures[i];
}

bool io_mcap_find_camera(const io_mcap_topics *topics, const io_mcap_stream *stream,
                         rlf_camera *out)
{
    const io_ros_topic *topic = topic_of(topics, stream);
    const int32_t found = io_ros_find_info(&topics->lists, topic);
    if (found < 0) {
        return false;
    }
    const io_camera_info *info = &topics->infos[found].info;
    if (io_camera_info_lens(info, topics->lists.name, topic->name, out) != RLF_OK) {
        rlf_log(RLF_LOG_WARNING, "%s", rlf_error_text());
        return false;
    }
    return true;
}

const char *io_mcap_why_no_camera(const io_mcap_topics *topics, const io_mcap_stream *stream,
                                  char *out, size_t size)
{
    return io_ros_tell_info(&topics->lists, topic_of(topics, stream), out, size);
}
