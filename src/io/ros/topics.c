/* The topics of a recording: what each one's first readable message is. */
#include "io/ros/recording.h"

#include <string.h>

static rlf_result fail_picture(const char *topic)
{
    return rlf_fail(RLF_ERROR_FORMAT,
                    "%s: a message is damaged or not the picture that it should be: copy or record "
                    "it again",
                    topic);
}

rlf_result io_ros_read_picture(const io_ros_log *log, const io_ros_stream *stream, int32_t index,
                               io_ros_image *out)
{
    io_cdr_reader message;
    rlf_result result = io_ros_log_read(log, stream->channel, index, &message);
    if (result != RLF_OK) {
        return result;
    }
    const bool is_good = stream->is_compressed ? io_ros_read_compressed(message, out)
                                               : io_ros_read_image(message, out);
    return is_good ? RLF_OK : fail_picture(log->channels[stream->channel].topic);
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

static void add_pictures(io_ros_recording *r, int32_t index)
{
    const io_ros_channel *channel = &r->log.channels[index];
    io_ros_stream *s = &r->streams[r->lists.picture_count];
    io_ros_topic *topic = &r->pictures[r->lists.picture_count++];
    *s = (io_ros_stream){.channel = index,
                         .is_compressed = channel->type == IO_ROS_COMPRESSED_IMAGE};
    *topic =
        (io_ros_topic){.name = channel->topic, .count = channel->count, .encoding = "no pictures"};
    for (int32_t i = 0; i < channel->count; i++) {
        io_ros_image image;
        if (io_ros_read_picture(&r->log, s, i, &image) == RLF_OK) {
            s->pixels = io_ros_pixels_of(&image, s->is_compressed);
            memcpy(topic->frame_id, image.header.frame_id, sizeof(topic->frame_id));
            memcpy(topic->encoding, image.encoding, sizeof(topic->encoding));
            topic->kind = io_ros_picture_size(&image, s->pixels, &topic->width, &topic->height)
                              ? kind_of(s->pixels)
                              : IO_ROS_PICTURE_NONE;
            return;
        }
    }
}

static void add_info(io_ros_recording *r, int32_t index)
{
    io_ros_info_topic *topic = &r->infos[r->lists.info_count];
    topic->name = r->log.channels[index].topic;
    for (int32_t m = 0; m < r->log.channels[index].count; m++) {
        io_cdr_reader message;
        if (io_ros_log_read(&r->log, index, m, &message) == RLF_OK &&
            io_ros_read_camera_info(message, &topic->info)) {
            r->lists.info_count++;
            return;
        }
    }
}

/* Drivers with transforms of their own say nothing in tf. */
static bool is_joined(void *self, const char *from, const char *to)
{
    const io_ros_recording *r = self;
    rlf_pose pose;
    return r->log.has_own_poses || io_ros_transforms_find(r->transforms, from, to, &pose);
}

rlf_result io_ros_list_topics(io_ros_recording *r)
{
    const size_t count = (size_t)r->log.channel_count;
    r->streams = rlf_alloc_array(count, sizeof(r->streams[0]));
    r->pictures = rlf_alloc_array(count, sizeof(r->pictures[0]));
    r->infos = rlf_alloc_array(count, sizeof(r->infos[0]));
    if (r->streams == NULL || r->pictures == NULL || r->infos == NULL) {
        return RLF_ERROR_MEMORY;
    }
    r->lists = (io_ros_topics){.name = r->log.name,
                               .is_live = r->log.is_live,
                               .pictures = r->pictures,
                               .infos = r->infos,
                               .strangers = r->log.strangers,
                               .is_joined = is_joined,
                               .self = r};
    for (int32_t i = 0; i < r->log.channel_count; i++) {
        const io_ros_type type = r->log.channels[i].type;
        if (type == IO_ROS_IMAGE || type == IO_ROS_COMPRESSED_IMAGE) {
            add_pictures(r, i);
        } else if (type == IO_ROS_CAMERA_INFO) {
            add_info(r, i);
        }
    }
    return io_ros_transforms_read(&r->log, &r->transforms);
}
