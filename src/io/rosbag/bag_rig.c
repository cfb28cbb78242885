/* The cameras of a bag. */
#include "io/rosbag/bag_rig.h"

#include "io/camera_json.h"
#include "io/clip/rig_beside.h"

#include <string.h>

/* Error of a stereo match, pixels: what Intel's guide for tuning depth cameras calls good. */
#define MATCH_ERROR_PX 0.08

/* librealsense's own topics: /device_0/sensor_0/Depth_0/image/data. */
static bool is_realsense(const char *topic)
{
    return strncmp(topic, "/device_", 8) == 0;
}

static int32_t connection_of(const bag_topics *topics, int32_t picture)
{
    return topics->connections[picture];
}

/* False when no calibration fits, or the one that does cannot be used; `out_problem` tells. */
static bool read_camera(const bag_topics *topics, int32_t picture, rlf_camera *out,
                        char out_problem[256])
{
    const io_ros_topic *topic = &topics->pictures[picture];
    const int32_t found = io_ros_find_info(&topics->lists, topic);
    if (found < 0) {
        io_ros_tell_info(&topics->lists, topic, out_problem, 256);
        return false;
    }
    rlf_result result =
        io_camera_info_lens(&topics->infos[found].info, topics->lists.name, topic->name, out);
    snprintf(out_problem, 256, "%.255s", result != RLF_OK ? rlf_error_text() : "");
    return result == RLF_OK;
}

/* A stream's transform from the device's reference stream (p_stream = T p_reference). */
static rlf_pose realsense_pose(bag *b, int32_t connection)
{
    rlf_pose pose = rlf_pose_identity();
    io_bytes message;
    const int32_t index = bag_topics_beside(b, connection, 3, "/tf/0");
    if (index < 0 || bag_topics_first(b, index, &message) != RLF_OK ||
        !message_read_transform(&message, &pose)) {
        rlf_log(RLF_LOG_WARNING,
                "%s: has no transform to the other camera: give one with ?camera=FILE",
                bag_connection_at(b, connection)->topic);
    }
    return pose;
}

static void find_realsense_pose(const bag_topics *topics, bag_rig *out)
{
    const rlf_pose T_depth_reference =
        realsense_pose(topics->bag, connection_of(topics, topics->depth));
    const rlf_pose T_color_reference =
        realsense_pose(topics->bag, connection_of(topics, topics->color));
    const rlf_pose T_reference_depth = rlf_pose_invert(&T_depth_reference);
    out->rig.T_color_depth = rlf_pose_mul(&T_color_reference, &T_reference_depth);
}

static void find_tf_pose(const bag_topics *topics, bag_rig *out)
{
    const char *depth_frame = topics->pictures[topics->depth].frame_id;
    const char *color_frame = topics->pictures[topics->color].frame_id;
    out->is_aligned = strcmp(depth_frame, color_frame) == 0;
    if (!out->is_aligned &&
        !tf_tree_find(&topics->transforms, depth_frame, color_frame, &out->rig.T_color_depth)) {
        out->rig.T_color_depth = rlf_pose_identity();
        rlf_log(RLF_LOG_WARNING,
                "%s: no transform leads from \"%s\" to \"%s\", so depth and colour are taken as "
                "seen from one place: record /tf_static, or give ?camera=FILE",
                topics->pictures[topics->depth].name, depth_frame, color_frame);
    }
}

/* The value of an option of the depth sensor; 0 = it has none. */
static double realsense_option(bag *b, int32_t depth, const char *suffix)
{
    io_bytes message;
    double value = 0.0;
    const int32_t index = bag_topics_beside(b, depth, 2, suffix);
    const bool is_read = index >= 0 && bag_topics_first(b, index, &message) == RLF_OK &&
                         message_read_float(&message, &value);
    return is_read && value > 0.0 ? value : 0.0;
}

static double realsense_units(bag *b, int32_t depth)
{
    io_bytes message;
    message_image image;
    if (bag_topics_first(b, depth, &message) == RLF_OK &&
        message_read_image(&message, MESSAGE_IMAGE, &image) == RLF_OK &&
        image.units_per_metre > 0.0) {
        return image.units_per_metre;
    }
    const double metres = realsense_option(b, depth, "/Depth Units/value");
    return metres >= 1e-6 && metres <= 1.0 ? 1.0 / metres : 1000.0;
}

static void read_realsense(const bag_topics *topics, bag_rig *out)
{
    bag *b = topics->bag;
    const int32_t depth = connection_of(topics, topics->depth);
    out->units_per_metre = realsense_units(b, depth);
    /* sigma = z^2 e / (f b) of a stereo camera; the baseline is in millimetres. */
    const double baseline = realsense_option(b, depth, "/Stereo Baseline/value") / 1000.0;
    if (baseline > 0.01 && baseline < 1.0 && out->rig.depth.fx > 1.0) {
        out->rig.noise =
            (rlf_depth_noise){0.0005, 0.0, MATCH_ERROR_PX / (out->rig.depth.fx * baseline)};
    }
}

static void read_device(const bag_topics *topics, bag_rig *out)
{
    bag *b = topics->bag;
    char name[64] = "ROS 1 bag";
    char serial[48] = "";
    for (int32_t i = 0; i < bag_entry_count(b); i++) {
        const bag_entry *entry = bag_entry_at(b, i);
        const bag_connection *c = bag_connection_at(b, entry->connection);
        io_bytes message;
        if (strcmp(c->topic, "/device_0/info") == 0 &&
            message_kind_of(c->type) == MESSAGE_KEY_VALUE &&
            bag_message(b, entry, &message) == RLF_OK) {
            message_read_value(&message, "Name", name, sizeof(name));
            message_read_value(&message, "Serial Number", serial, sizeof(serial));
        }
    }
    if (serial[0] != '\0') {
        snprintf(out->device, sizeof(out->device), "%s, serial number %s", name, serial);
    } else {
        snprintf(out->device, sizeof(out->device), "%s, %.90s", name,
                 topics->pictures[topics->depth].name);
    }
}

static void read_color(const bag_topics *topics, bag_rig *out)
{
    char problem[256];
    const char *topic = topics->pictures[topics->color].name;
    if (!read_camera(topics, topics->color, &out->rig.color, problem)) {
        rlf_log(RLF_LOG_WARNING,
                "%s: has no usable CameraInfo (%s), so there is no colour: record its camera_info, "
                "or give ?camera=FILE",
                topic, problem);
        return;
    }
    out->rig.has_color = true;
    if (is_realsense(topic)) {
        find_realsense_pose(topics, out);
    } else {
        find_tf_pose(topics, out);
    }
}

rlf_result bag_rig_read(const rlf_address *address, const bag_topics *topics, bag_rig *out)
{
    char problem[256] = "";
    memset(out, 0, sizeof(*out));
    out->rig = rlf_rig_default();
    out->units_per_metre = 1000.0;
    read_device(topics, out);
    const char *topic = topics->pictures[topics->depth].name;
    if (address->rig != NULL || !read_camera(topics, topics->depth, &out->rig.depth, problem)) {
        bool is_found = false;
        rlf_result result = io_rig_beside(address, &out->rig, &out->units_per_metre, &is_found);
        if (result != RLF_OK || is_found) {
            return result;
        }
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: topic %s has no usable CameraInfo (%s): record its camera_info, or "
                        "give the calibration with ?camera=FILE",
                        address->source, topic, problem);
    }
    if (is_realsense(topic)) {
        read_realsense(topics, out);
    }
    if (topics->color >= 0) {
        read_color(topics, out);
    }
    return RLF_OK;
}
