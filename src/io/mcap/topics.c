/* Which topics of a ROS 2 recording are the depth and the colour pictures. */
#include "io/mcap/topics.h"

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

/* What a channel's first readable picture is. */
static bool look_at(io_mcap_reader *reader, int32_t index, io_mcap_stream *out)
{
    const io_mcap_channel *channel = io_mcap_channel_at(reader, index);
    memset(out, 0, sizeof(*out));
    out->channel = index;
    out->is_compressed = channel->type == IO_ROS_COMPRESSED_IMAGE;
    if (channel->type != IO_ROS_IMAGE && !out->is_compressed) {
        return false;
    }
    io_ros_image image;
    for (int32_t i = 0; i < channel->count; i++) {
        if (io_mcap_read_picture(reader, out, i, &image) == RLF_OK) {
            out->pixels = io_ros_pixels_of(&image, out->is_compressed);
            memcpy(out->frame_id, image.header.frame_id, sizeof(out->frame_id));
            return out->pixels != IO_ROS_UNKNOWN &&
                   io_ros_picture_size(&image, out->pixels, &out->width, &out->height);
        }
    }
    return false;
}

/* Greater is better; 0 = not what is looked for. */
static int32_t rank(const io_mcap_reader *reader, const io_mcap_stream *s, bool wants_depth,
                    const char *wished)
{
    const io_mcap_channel *channel = io_mcap_channel_at(reader, s->channel);
    if (io_ros_is_depth(s->pixels) != wants_depth) {
        return 0;
    }
    if (wished != NULL) {
        return strcmp(channel->topic, wished) == 0 ? 1 : 0;
    }
    const bool is_grey = s->pixels == IO_ROS_MONO8; /* an infrared picture, mostly */
    return is_grey ? 1 : 1 + channel->count;
}

static void find_stream(io_mcap_reader *reader, bool wants_depth, const char *wished,
                        io_mcap_stream *out)
{
    int32_t best = 0;
    out->channel = -1;
    for (int32_t i = 0; i < io_mcap_channel_count(reader); i++) {
        io_mcap_stream stream;
        if (look_at(reader, i, &stream)) {
            const int32_t value = rank(reader, &stream, wants_depth, wished);
            if (value > best) {
                best = value;
                *out = stream;
            }
        }
    }
}

/* The topics of pictures, for an error line. */
static const char *list_topics(const io_mcap_reader *reader, char *out, size_t size)
{
    size_t length = 0;
    out[0] = '\0';
    for (int32_t i = 0; i < io_mcap_channel_count(reader); i++) {
        const io_mcap_channel *c = io_mcap_channel_at(reader, i);
        if ((c->type == IO_ROS_IMAGE || c->type == IO_ROS_COMPRESSED_IMAGE) && length < size) {
            const int got = snprintf(out + length, size - length, " %s", c->topic);
            length += got > 0 ? (size_t)got : 0;
        }
    }
    return length > 0 ? out : " none";
}

rlf_result io_mcap_find_streams(io_mcap_reader *reader, const char *path,
                                const io_mcap_wishes *wishes, io_mcap_stream *depth,
                                io_mcap_stream *color)
{
    char topics[512];
    find_stream(reader, true, wishes->depth, depth);
    find_stream(reader, false, wishes->color, color);
    if (depth->channel < 0) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: holds no whole depth picture%s%s (16UC1, 32FC1 or compressedDepth in "
                        "a ROS 2 Image or CompressedImage); its topics of pictures are:%s",
                        path, wishes->depth != NULL ? " of topic " : "",
                        wishes->depth != NULL ? wishes->depth : "",
                        list_topics(reader, topics, sizeof(topics)));
    }
    if (color->channel < 0 && wishes->color != NULL) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: has no colour pictures of topic %s: its topics of pictures are:%s",
                        path, wishes->color, list_topics(reader, topics, sizeof(topics)));
    }
    return RLF_OK;
}

/* ---- calibration ------------------------------------------------------------------------------
 */

/* "/camera/depth/image_raw/compressedDepth" is described by "/camera/depth/camera_info". */
static bool is_beside(const char *info_topic, const char *topic, bool is_compressed)
{
    static const char name[] = "/camera_info";
    const char *end = strrchr(topic, '/');
    for (int levels = is_compressed ? 2 : 1; levels > 0 && end != NULL; levels--) {
        const size_t length = (size_t)(end - topic);
        if (strncmp(info_topic, topic, length) == 0 && strcmp(info_topic + length, name) == 0) {
            return true;
        }
        do {
            end--;
        } while (end > topic && *end != '/');
        end = end > topic ? end : NULL;
    }
    return false;
}

/* 3 = beside it, 2 = the same frame_id, 1 = the same size, 0 = another camera's. */
static int32_t rank_info(const io_mcap_reader *reader, const io_mcap_channel *info_channel,
                         const io_ros_camera_info *info, const io_mcap_stream *stream)
{
    const io_mcap_channel *channel = io_mcap_channel_at(reader, stream->channel);
    if (info->width != (uint32_t)stream->width || info->height != (uint32_t)stream->height) {
        return 0;
    }
    if (is_beside(info_channel->topic, channel->topic, stream->is_compressed)) {
        return 3;
    }
    return strcmp(info->header.frame_id, stream->frame_id) == 0 ? 2 : 1;
}

static bool has_distortion(const io_ros_camera_info *info)
{
    for (int i = 0; i < 8; i++) {
        if (info->d[i] < 0.0 || info->d[i] > 0.0) {
            return true;
        }
    }
    return false;
}

static void set_camera(const char *path, const io_ros_camera_info *info, bool is_rectified,
                       rlf_camera *out)
{
    const bool uses_p = is_rectified && info->p[0] > 0.0;
    memset(out, 0, sizeof(*out));
    out->width = (int32_t)info->width;
    out->height = (int32_t)info->height;
    out->fx = uses_p ? info->p[0] : info->k[0];
    out->fy = uses_p ? info->p[5] : info->k[4];
    out->cx = uses_p ? info->p[2] : info->k[2];
    out->cy = uses_p ? info->p[6] : info->k[5];
    if (uses_p || !has_distortion(info)) {
        return;
    }
    const bool is_rational = strcmp(info->model, "rational_polynomial") == 0;
    if (!is_rational && strcmp(info->model, "plumb_bob") != 0) {
        rlf_log(RLF_LOG_WARNING,
                "%s: the lens model \"%.31s\" is not known here: the lens is taken as free of "
                "distortion; give a calibration with ?camera=FILE",
                path, info->model);
        return;
    }
    out->distortion_model =
        is_rational ? RLF_DISTORTION_RATIONAL_POLYNOMIAL : RLF_DISTORTION_PLUMB_BOB;
    memcpy(out->distortion, info->d, (is_rational ? 8 : 5) * sizeof(info->d[0]));
}

bool io_mcap_find_camera(io_mcap_reader *reader, const char *path, const io_mcap_stream *stream,
                         rlf_camera *out)
{
    io_ros_camera_info best_info;
    int32_t best = 0;
    for (int32_t i = 0; i < io_mcap_channel_count(reader); i++) {
        const io_mcap_channel *channel = io_mcap_channel_at(reader, i);
        io_cdr_span bytes;
        io_ros_camera_info info;
        bool is_read = false;
        for (int32_t m = 0; channel->type == IO_ROS_CAMERA_INFO && m < channel->count && !is_read;
             m++) {
            is_read = io_mcap_read(reader, channel->first + m, &bytes) == RLF_OK &&
                      io_ros_read_camera_info(bytes.data, bytes.size, &info);
        }
        const int32_t value = is_read ? rank_info(reader, channel, &info, stream) : 0;
        if (value > best) {
            best = value;
            best_info = info;
        }
    }
    if (best > 0) {
        /* "image_rect", "image_rect_raw", "image_rect_color": pictures that P describes. */
        const char *topic = io_mcap_channel_at(reader, stream->channel)->topic;
        set_camera(path, &best_info, strstr(topic, "rect") != NULL, out);
    }
    return best > 0;
}

/* ---- transforms -------------------------------------------------------------------------------
 */

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
