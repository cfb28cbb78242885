/* The cameras of a bag. */
#include "io/rosbag/bag_rig.h"

#include "io/camera_json.h"
#include "io/rosbag/tf_tree.h"
#include "io/clip/rig_beside.h"

#include <string.h>

/* Error of a stereo match, pixels: what Intel's guide for tuning depth cameras calls good. */
#define MATCH_ERROR_PX 0.08

/* librealsense's own topics: /device_0/sensor_0/Depth_0/image/data. */
static bool is_realsense(const char *topic)
{
    return strncmp(topic, "/device_", 8) == 0;
}

static bool is_rectified(const char *topic)
{
    return strstr(topic, "rect") != NULL;
}

/* The frame of a topic's first picture; "" when it says none. */
static void frame_of(bag *b, int32_t connection, char out[FRAME_ID_MAX])
{
    io_bytes message;
    message_image image;
    out[0] = '\0';
    if (bag_topics_first(b, connection, &message) == RLF_OK &&
        message_read_image(&message, message_kind_of(bag_connection_at(b, connection)->type),
                           &image) == RLF_OK) {
        memcpy(out, image.frame_id, FRAME_ID_MAX);
    }
}

static rlf_result read_camera(bag *b, int32_t pictures, int32_t info, rlf_camera *out)
{
    io_bytes message;
    char frame_id[FRAME_ID_MAX];
    rlf_result result = bag_topics_first(b, info, &message);
    return result == RLF_OK
               ? message_read_camera(&message, is_rectified(bag_connection_at(b, pictures)->topic),
                                     out, frame_id)
               : result;
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

static void find_realsense_pose(bag *b, const bag_topics *topics, bag_rig *out)
{
    const rlf_pose T_depth_reference = realsense_pose(b, topics->depth);
    const rlf_pose T_color_reference = realsense_pose(b, topics->color);
    const rlf_pose T_reference_depth = rlf_pose_invert(&T_depth_reference);
    out->rig.T_color_depth = rlf_pose_mul(&T_color_reference, &T_reference_depth);
}

static void find_tf_pose(bag *b, const bag_topics *topics, bag_rig *out)
{
    char depth_frame[FRAME_ID_MAX];
    char color_frame[FRAME_ID_MAX];
    frame_of(b, topics->depth, depth_frame);
    frame_of(b, topics->color, color_frame);
    out->is_aligned = strcmp(depth_frame, color_frame) == 0;
    if (out->is_aligned) {
        return;
    }
    tf_tree tree = {0};
    for (int32_t i = 0; i < bag_entry_count(b); i++) {
        const bag_entry *entry = bag_entry_at(b, i);
        io_bytes message;
        if (message_kind_of(bag_connection_at(b, entry->connection)->type) == MESSAGE_TF &&
            bag_message(b, entry, &message) == RLF_OK) {
            tf_tree_add(&tree, &message);
        }
    }
    if (!tf_tree_find(&tree, depth_frame, color_frame, &out->rig.T_color_depth)) {
        out->rig.T_color_depth = rlf_pose_identity();
        rlf_log(RLF_LOG_WARNING,
                "%s: no transform leads from \"%s\" to \"%s\", so depth and colour are taken as "
                "seen from one place: record /tf_static, or give ?camera=FILE",
                bag_connection_at(b, topics->depth)->topic, depth_frame, color_frame);
    }
    tf_tree_free(&tree);
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

static void read_realsense(bag *b, const bag_topics *topics, bag_rig *out)
{
    out->units_per_metre = realsense_units(b, topics->depth);
    /* sigma = z^2 e / (f b) of a stereo camera; the baseline is in millimetres. */
    const double baseline = realsense_option(b, topics->depth, "/Stereo Baseline/value") / 1000.0;
    if (baseline > 0.01 && baseline < 1.0 && out->rig.depth.fx > 1.0) {
        out->rig.noise =
            (rlf_depth_noise){0.0005, 0.0, MATCH_ERROR_PX / (out->rig.depth.fx * baseline)};
    }
}

static void read_device(bag *b, const bag_topics *topics, bag_rig *out)
{
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
                 bag_connection_at(b, topics->depth)->topic);
    }
}

static void read_color(bag *b, const bag_topics *topics, bag_rig *out)
{
    const char *topic = bag_connection_at(b, topics->color)->topic;
    if (topics->color_info < 0) {
        rlf_log(RLF_LOG_WARNING,
                "%s: has no CameraInfo, so there is no colour: record its camera_info, or give "
                "?camera=FILE",
                topic);
        return;
    }
    if (read_camera(b, topics->color, topics->color_info, &out->rig.color) != RLF_OK) {
        rlf_log(RLF_LOG_WARNING, "%s; so there is no colour", rlf_error_text());
        return;
    }
    out->rig.has_color = true;
    if (is_realsense(topic)) {
        find_realsense_pose(b, topics, out);
    } else {
        find_tf_pose(b, topics, out);
    }
}

rlf_result bag_rig_read(const rlf_address *address, bag *b, const bag_topics *topics, bag_rig *out)
{
    memset(out, 0, sizeof(*out));
    out->rig = io_rig_default();
    out->units_per_metre = 1000.0;
    read_device(b, topics, out);
    const bool has_info = topics->depth_info >= 0;
    if (address->rig != NULL || !has_info) {
        bool is_found = false;
        rlf_result result = io_rig_beside(address, &out->rig, &out->units_per_metre, &is_found);
        if (result != RLF_OK || is_found) {
            return result;
        }
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: topic %s has no CameraInfo: record its camera_info, or give the "
                        "calibration with ?camera=FILE",
                        address->source, bag_connection_at(b, topics->depth)->topic);
    }
    rlf_result result = read_camera(b, topics->depth, topics->depth_info, &out->rig.depth);
    if (result != RLF_OK) {
        return result;
    }
    if (is_realsense(bag_connection_at(b, topics->depth)->topic)) {
        read_realsense(b, topics, out);
    }
    if (topics->color >= 0) {
        read_color(b, topics, out);
    }
    return RLF_OK;
}
