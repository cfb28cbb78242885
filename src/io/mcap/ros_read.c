/* ROS 2 messages: from CDR to values. The bytes may be anything. */
#include "io/mcap/ros.h"

#define NS_PER_S INT64_C(1000000000)

static void get_header(io_cdr_reader *r, io_ros_header *out)
{
    const int32_t seconds = (int32_t)io_cdr_get_u32(r);
    const uint32_t nanoseconds = io_cdr_get_u32(r);
    out->stamp_ns = seconds * NS_PER_S + nanoseconds;
    io_cdr_get_text(r, out->frame_id, sizeof(out->frame_id));
}

bool io_ros_read_header(const uint8_t *data, size_t size, io_ros_header *out)
{
    io_cdr_reader r = io_cdr_open(data, size);
    get_header(&r, out);
    return !r.is_bad;
}

bool io_ros_read_image(const uint8_t *data, size_t size, io_ros_image *out)
{
    io_cdr_reader r = io_cdr_open(data, size);
    get_header(&r, &out->header);
    out->height = io_cdr_get_u32(&r);
    out->width = io_cdr_get_u32(&r);
    io_cdr_get_text(&r, out->encoding, sizeof(out->encoding));
    out->is_bigendian = io_cdr_get_u8(&r) != 0;
    out->step = io_cdr_get_u32(&r);
    out->data = io_cdr_get_bytes(&r);
    return !r.is_bad;
}

bool io_ros_read_compressed(const uint8_t *data, size_t size, io_ros_image *out)
{
    io_cdr_reader r = io_cdr_open(data, size);
    get_header(&r, &out->header);
    io_cdr_get_text(&r, out->encoding, sizeof(out->encoding));
    out->data = io_cdr_get_bytes(&r);
    out->width = 0;
    out->height = 0;
    out->step = 0;
    out->is_bigendian = false;
    return !r.is_bad;
}

static io_camera_window get_window(io_cdr_reader *r)
{
    io_camera_window w;
    w.binning_x = io_cdr_get_u32(r);
    w.binning_y = io_cdr_get_u32(r);
    w.x = io_cdr_get_u32(r);
    w.y = io_cdr_get_u32(r);
    w.height = io_cdr_get_u32(r);
    w.width = io_cdr_get_u32(r);
    return w;
}

bool io_ros_read_camera_info(const uint8_t *data, size_t size, io_camera_info *out)
{
    io_cdr_reader r = io_cdr_open(data, size);
    io_ros_header header;
    memset(out, 0, sizeof(*out));
    get_header(&r, &header);
    memcpy(out->frame_id, header.frame_id, sizeof(out->frame_id));
    out->height = io_cdr_get_u32(&r);
    out->width = io_cdr_get_u32(&r);
    io_cdr_get_text(&r, out->model, sizeof(out->model));
    out->d_count = io_cdr_get_u32(&r);
    for (uint32_t i = 0; i < out->d_count && !r.is_bad; i++) {
        double d;
        io_cdr_get_doubles(&r, &d, 1);
        if (i < IO_ROS_DISTORTION_MAX) {
            out->d[i] = d;
        }
    }
    io_cdr_get_doubles(&r, out->k, 9);
    io_cdr_get_doubles(&r, out->r, 9);
    io_cdr_get_doubles(&r, out->p, 12);
    out->window = get_window(&r);
    return !r.is_bad;
}

static rlf_pose get_pose(io_cdr_reader *r)
{
    double n[7];
    io_cdr_get_doubles(r, n, 7);
    return (rlf_pose){.p = {n[0], n[1], n[2]}, .q = {n[3], n[4], n[5], n[6]}};
}

bool io_ros_read_tf(const uint8_t *data, size_t size, io_ros_transform *out, uint32_t capacity,
                    uint32_t *out_count)
{
    io_cdr_reader r = io_cdr_open(data, size);
    const uint32_t count = io_cdr_get_u32(&r);
    *out_count = 0;
    for (uint32_t i = 0; i < count && i < capacity && !r.is_bad; i++) {
        io_ros_header header;
        get_header(&r, &header);
        out[i].stamp_ns = header.stamp_ns;
        memcpy(out[i].parent, header.frame_id, sizeof(out[i].parent));
        io_cdr_get_text(&r, out[i].child, sizeof(out[i].child));
        out[i].T_parent_child = get_pose(&r);
        *out_count = r.is_bad ? i : i + 1;
    }
    return !r.is_bad;
}

bool io_ros_read_pose(const uint8_t *data, size_t size, io_ros_header *header, rlf_pose *out)
{
    io_cdr_reader r = io_cdr_open(data, size);
    get_header(&r, header);
    *out = get_pose(&r);
    return !r.is_bad;
}

bool io_ros_read_string(const uint8_t *data, size_t size, char *out, size_t capacity)
{
    io_cdr_reader r = io_cdr_open(data, size);
    io_cdr_get_text(&r, out, capacity);
    return !r.is_bad;
}
