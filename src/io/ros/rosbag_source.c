/* Frames from ROS 1 bags, and from the bags that librealsense records. */
#include "io/ros/recording.h"
#include "io/ros/bag.h"
#include "io/source/backends.h"

#include <string.h>

/* Error of a stereo match, pixels: what Intel's guide for tuning depth cameras calls good. */
#define MATCH_ERROR_PX 0.08

typedef struct rosbag {
    io_ros_recording ros; /* the clip's self */
    char path[IO_PATH_MAX];
    bag *bag;
} rosbag;

static void rosbag_destroy(void *self)
{
    rosbag *b = self;
    io_ros_recording_free(&b->ros);
    bag_close(&b->bag);
    rlf_free(b);
}

/* ---- RealSense: /device_0/sensor_0/Depth_0/image/data and its neighbours -------------------- */

/* The first message of the first topic that begins as `topic` does, by `parts` parts of its path at
 * least, and ends in `suffix`. */
static bool read_beside(const rosbag *b, const char *topic, int32_t parts, const char *suffix,
                        io_cdr_reader *out)
{
    const io_ros_log *log = &b->ros.log;
    for (int32_t i = 0; i < log->channel_count; i++) {
        const io_ros_channel *c = &log->channels[i];
        const size_t length = strlen(c->topic);
        if (length >= strlen(suffix) && strcmp(c->topic + length - strlen(suffix), suffix) == 0 &&
            io_ros_common_parts(topic, c->topic) >= parts) {
            return c->count > 0 && io_ros_log_read(log, i, 0, out) == RLF_OK;
        }
    }
    return false;
}

/* A stream's transform from the device's reference stream (p_stream = T p_reference). */
static rlf_pose stream_pose(const rosbag *b, const char *topic)
{
    rlf_pose pose = rlf_pose_identity();
    io_cdr_reader message;
    if (!read_beside(b, topic, 3, "/tf/0", &message) || !io_ros_read_transform(message, &pose)) {
        rlf_log(RLF_LOG_WARNING,
                "%s: has no transform to the other camera: give one with ?camera=FILE", topic);
        return rlf_pose_identity();
    }
    pose.q = rlf_quat_normalize(pose.q);
    return pose;
}

/* The value of an option of the depth sensor; 0 = it has none. */
static double option(const rosbag *b, const char *topic, const char *suffix)
{
    io_cdr_reader message;
    double value = 0.0;
    return read_beside(b, topic, 2, suffix, &message) && io_ros_read_float(message, &value) &&
                   value > 0.0
               ? value
               : 0.0;
}

static double units_of(const rosbag *b, const char *topic)
{
    io_ros_image image;
    if (io_ros_read_picture(&b->ros.log, &b->ros.depth, 0, &image) == RLF_OK &&
        image.units_per_metre > 0.0) {
        return image.units_per_metre;
    }
    const double metres = option(b, topic, "/Depth Units/value");
    return metres >= 1e-6 && metres <= 1.0 ? 1.0 / metres : 1000.0;
}

static void read_realsense(rosbag *b)
{
    io_ros_recording *r = &b->ros;
    const char *depth = r->pictures[r->depth.picture].name;
    r->units_per_metre = units_of(b, depth);
    /* sigma = z^2 e / (f b) of a stereo camera; the baseline is in millimetres. */
    const double baseline = option(b, depth, "/Stereo Baseline/value") / 1000.0;
    if (baseline > 0.01 && baseline < 1.0 && r->rig.depth.fx > 1.0) {
        r->rig.noise =
            (rlf_depth_noise){0.0005, 0.0, MATCH_ERROR_PX / (r->rig.depth.fx * baseline)};
    }
    if (r->rig.has_color) {
        const rlf_pose T_depth_reference = stream_pose(b, depth);
        const rlf_pose T_color_reference = stream_pose(b, r->pictures[r->color.picture].name);
        const rlf_pose T_reference_depth = rlf_pose_invert(&T_depth_reference);
        r->rig.T_color_depth = rlf_pose_mul(&T_color_reference, &T_reference_depth);
    }
}

static void describe(const rosbag *b, rlf_opened *out)
{
    char name[64] = "ROS 1 bag", serial[48] = "";
    const io_ros_log *log = &b->ros.log;
    for (int32_t i = 0; i < log->channel_count; i++) {
        const io_ros_channel *c = &log->channels[i];
        const bool is_info = c->type == IO_ROS_KEY_VALUE && strcmp(c->topic, "/device_0/info") == 0;
        for (int32_t m = 0; m < c->count && is_info; m++) {
            io_cdr_reader message;
            if (io_ros_log_read(log, i, m, &message) == RLF_OK) {
                io_ros_read_value(message, "Name", name, sizeof(name));
                io_ros_read_value(message, "Serial Number", serial, sizeof(serial));
            }
        }
    }
    const char *depth = b->ros.pictures[b->ros.depth.picture].name;
    snprintf(out->info.device, sizeof(out->info.device), "%s, %s%.90s", name,
             serial[0] != '\0' ? "serial number " : "", serial[0] != '\0' ? serial : depth);
}

/* ---- opening -------------------------------------------------------------------------------- */

static rlf_result open_recording(const rlf_address *address, rosbag *b, rlf_opened *out)
{
    io_clip_def def = {.destroy = rosbag_destroy, .self = b};
    rlf_result result = io_ros_prepare(&b->ros, address);
    if (result == RLF_OK && b->ros.log.has_own_poses && !b->ros.has_given_rig) {
        read_realsense(b);
    }
    result = result == RLF_OK ? io_ros_list_pictures(&b->ros, bag_is_fast(b->bag)) : result;
    result = result == RLF_OK ? io_ros_open_clip(&b->ros, address, &def, out) : result;
    if (result == RLF_OK) {
        describe(b, out);
    }
    return result;
}

static rlf_result open_all(const rlf_address *address, rosbag *b, rlf_opened *out)
{
    snprintf(b->path, sizeof(b->path), "%s", address->place);
    b->ros.log.name = b->path;
    rlf_result result = bag_open(b->path, &b->ros.log, &b->bag);
    return result == RLF_OK ? open_recording(address, b, out) : result;
}

static rlf_result rosbag_open(const rlf_address *address, rlf_opened *out)
{
    rosbag *b = rlf_alloc(sizeof(*b));
    return io_open_end(b != NULL ? open_all(address, b, out) : RLF_ERROR_MEMORY, b, rosbag_destroy);
}

const rlf_backend io_backend_rosbag = {
    .version = RLF_BACKEND_VERSION,
    .scheme = "rosbag",
    .extensions = ".bag",
    .keys = "depth color gap",
    .summary = "a recording: ROS 1 or RealSense .bag (depth=TOPIC color=TOPIC gap=MS)",
    .open = rosbag_open,
};
