/* The messages of ROS 1 that hold pictures and calibrations. */
#include "io/rosbag/messages.h"

#include "io/clip/cursor.h"

#include <math.h>

message_kind message_kind_of(const char *type)
{
    static const struct {
        const char *type;
        message_kind kind;
    } kinds[] = {
        {"sensor_msgs/Image", MESSAGE_IMAGE},
        {"sensor_msgs/CompressedImage", MESSAGE_COMPRESSED_IMAGE},
        {"sensor_msgs/CameraInfo", MESSAGE_CAMERA_INFO},
        {"tf2_msgs/TFMessage", MESSAGE_TF},
        {"tf/tfMessage", MESSAGE_TF},
        {"geometry_msgs/Transform", MESSAGE_TRANSFORM},
        {"std_msgs/Float32", MESSAGE_FLOAT},
        {"diagnostic_msgs/KeyValue", MESSAGE_KEY_VALUE},
    };
    for (size_t i = 0; i < sizeof(kinds) / sizeof(kinds[0]); i++) {
        if (strcmp(kinds[i].type, type) == 0) {
            return kinds[i].kind;
        }
    }
    return MESSAGE_OTHER;
}

static rlf_result fail_short(const io_bytes *message)
{
    return rlf_fail(RLF_ERROR_FORMAT, "%s: a message is cut short: copy or record it again",
                    message->name);
}

/* std_msgs/Header. */
static int64_t read_header(cursor *c, char frame_id[IO_ROS_NAME_MAX])
{
    cursor_u32(c); /* counts up */
    const int64_t time_ns = cursor_time(c);
    cursor_text(c, frame_id, IO_ROS_NAME_MAX);
    return time_ns;
}

static void read_raw(cursor *c, const char *name, message_image *out)
{
    io_pixels *p = &out->pixels;
    p->name = name;
    p->height = cursor_u32(c);
    p->width = cursor_u32(c);
    cursor_text(c, out->encoding, sizeof(out->encoding));
    p->encoding = out->encoding;
    p->is_bigendian = cursor_u8(c) != 0;
    p->step = cursor_u32(c);
    const cursor data = cursor_block(c);
    p->data = data.data;
    p->size = data.left;
    /* librealsense appends metres per count, and marks that in the header. */
    if (!c->is_short && c->left >= 4 && strcmp(out->frame_id, "1") == 0) {
        const double metres = (double)cursor_f32(c);
        out->units_per_metre = metres >= 1e-6 && metres <= 1.0 ? 1.0 / metres : 0.0;
    }
}

rlf_result message_read_image(const io_bytes *message, message_kind kind, message_image *out)
{
    memset(out, 0, sizeof(*out));
    cursor c = {message->data, message->size, false};
    out->time_ns = read_header(&c, out->frame_id);
    out->is_compressed = kind == MESSAGE_COMPRESSED_IMAGE;
    if (out->is_compressed) {
        cursor_text(&c, out->encoding, sizeof(out->encoding));
        const cursor data = cursor_block(&c);
        out->file = (io_bytes){message->name, data.data, data.left};
    } else {
        read_raw(&c, message->name, out);
    }
    return c.is_short ? fail_short(message) : RLF_OK;
}

bool message_read_time(const io_bytes *message, int64_t *out_ns)
{
    cursor c = {message->data, message->size, false};
    cursor_u32(&c);
    *out_ns = cursor_time(&c);
    return !c.is_short;
}

static void read_doubles(cursor *c, double *out, int count)
{
    for (int i = 0; i < count; i++) {
        out[i] = cursor_f64(c);
    }
}

static io_camera_window read_window(cursor *c)
{
    io_camera_window w;
    w.binning_x = cursor_u32(c);
    w.binning_y = cursor_u32(c);
    w.x = cursor_u32(c);
    w.y = cursor_u32(c);
    w.height = cursor_u32(c);
    w.width = cursor_u32(c);
    return w;
}

bool message_read_info(const io_bytes *message, io_camera_info *out)
{
    cursor c = {message->data, message->size, false};
    memset(out, 0, sizeof(*out));
    read_header(&c, out->frame_id);
    out->height = cursor_u32(&c);
    out->width = cursor_u32(&c);
    cursor_text(&c, out->model, sizeof(out->model));
    out->d_count = cursor_u32(&c);
    const int kept =
        out->d_count < IO_ROS_DISTORTION_MAX ? (int)out->d_count : IO_ROS_DISTORTION_MAX;
    read_doubles(&c, out->d, kept);
    cursor_take(&c, ((size_t)out->d_count - (size_t)kept) * sizeof(double));
    read_doubles(&c, out->k, 9);
    read_doubles(&c, out->r, 9);
    read_doubles(&c, out->p, 12);
    out->window = read_window(&c);
    return !c.is_short;
}

bool message_read_transform(const io_bytes *message, rlf_pose *out)
{
    cursor c = {message->data, message->size, false};
    double v[7];
    for (int i = 0; i < 7; i++) {
        v[i] = cursor_f64(&c);
    }
    out->p = rlf_vec3_make(v[0], v[1], v[2]);
    out->q = (rlf_quat){v[3], v[4], v[5], v[6]};
    const double square = v[3] * v[3] + v[4] * v[4] + v[5] * v[5] + v[6] * v[6];
    if (c.is_short || !rlf_vec3_is_finite(out->p) || !(fabs(square - 1.0) < 1e-2)) {
        return false;
    }
    out->q = rlf_quat_normalize(out->q);
    return true;
}

bool message_read_float(const io_bytes *message, double *out)
{
    cursor c = {message->data, message->size, false};
    *out = (double)cursor_f32(&c);
    return !c.is_short && isfinite(*out);
}

bool message_read_value(const io_bytes *message, const char *key, char *out, size_t capacity)
{
    cursor c = {message->data, message->size, false};
    char name[64];
    cursor_text(&c, name, sizeof(name));
    char value[128];
    cursor_text(&c, value, sizeof(value));
    if (c.is_short || strcmp(name, key) != 0) {
        return false;
    }
    snprintf(out, capacity, "%s", value);
    return true;
}
