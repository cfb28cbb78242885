/* Messages of ROS 1 and 2 to values. The bytes may be anything. */
#include "io/ros/messages.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define NS_PER_S INT64_C(1000000000)

static int64_t get_stamp(io_cdr_reader *r)
{
    if (r->is_ros1) {
        io_cdr_get_u32(r); /* counts up */
    }
    const uint32_t bits = io_cdr_get_u32(r);
    const int64_t seconds = r->is_ros1 ? (int64_t)bits : (int32_t)bits;
    const uint32_t nanoseconds = io_cdr_get_u32(r);
    return seconds * NS_PER_S + nanoseconds;
}

static void get_header(io_cdr_reader *r, io_ros_header *out)
{
    out->stamp_ns = get_stamp(r);
    io_cdr_get_text(r, out->frame_id, sizeof(out->frame_id));
}

bool io_ros_read_stamp(io_cdr_reader r, int64_t *out_ns)
{
    *out_ns = get_stamp(&r);
    return !r.is_bad;
}

bool io_ros_read_image(io_cdr_reader r, io_ros_image *out)
{
    get_header(&r, &out->header);
    out->height = io_cdr_get_u32(&r);
    out->width = io_cdr_get_u32(&r);
    io_cdr_get_text(&r, out->encoding, sizeof(out->encoding));
    out->is_bigendian = io_cdr_get_u8(&r) != 0;
    out->step = io_cdr_get_u32(&r);
    out->data = io_cdr_get_bytes(&r);
    out->units_per_metre = 0.0;
    const bool is_good = !r.is_bad;
    /* librealsense appends metres per count, and marks that in the header. */
    if (r.is_ros1 && is_good && strcmp(out->header.frame_id, "1") == 0) {
        const double metres = (double)io_cdr_get_float(&r);
        out->units_per_metre = !r.is_bad && metres >= 1e-6 && metres <= 1.0 ? 1.0 / metres : 0.0;
    }
    return is_good;
}

bool io_ros_read_compressed(io_cdr_reader r, io_ros_image *out)
{
    get_header(&r, &out->header);
    io_cdr_get_text(&r, out->encoding, sizeof(out->encoding));
    out->data = io_cdr_get_bytes(&r);
    out->width = 0;
    out->height = 0;
    out->step = 0;
    out->is_bigendian = false;
    out->units_per_metre = 0.0;
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

bool io_ros_read_camera_info(io_cdr_reader r, io_camera_info *out)
{
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

bool io_ros_read_tf(io_cdr_reader r, io_ros_transform *out, uint32_t capacity, uint32_t *out_count)
{
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

bool io_ros_read_pose(io_cdr_reader r, io_ros_header *header, rlf_pose *out)
{
    get_header(&r, header);
    *out = get_pose(&r);
    return !r.is_bad;
}

bool io_ros_read_string(io_cdr_reader r, char *out, size_t capacity)
{
    io_cdr_get_text(&r, out, capacity);
    return !r.is_bad;
}

bool io_ros_read_transform(io_cdr_reader r, rlf_pose *out)
{
    *out = get_pose(&r);
    return !r.is_bad && io_ros_is_pose(out);
}

bool io_ros_is_pose(const rlf_pose *pose)
{
    const rlf_quat q = pose->q;
    const double square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    return square > 0.99 && square < 1.01 && rlf_vec3_is_finite(pose->p);
}

bool io_ros_read_float(io_cdr_reader r, double *out)
{
    *out = (double)io_cdr_get_float(&r);
    return !r.is_bad && isfinite(*out);
}

bool io_ros_read_value(io_cdr_reader r, const char *key, char *out, size_t capacity)
{
    char name[64], value[128];
    io_cdr_get_text(&r, name, sizeof(name));
    io_cdr_get_text(&r, value, sizeof(value));
    if (r.is_bad || strcmp(name, key) != 0) {
        return false;
    }
    snprintf(out, capacity, "%s", value);
    return true;
}
