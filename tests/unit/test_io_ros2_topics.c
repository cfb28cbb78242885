/* Which topics are a camera's: as the drivers name them. */
#include "test.h"

#include "io/ros2/find_camera.h"

#include <string.h>

#define IMAGE "sensor_msgs/msg/Image"
#define PACKED "sensor_msgs/msg/CompressedImage"
#define INFO "sensor_msgs/msg/CameraInfo"
#define TF "tf2_msgs/msg/TFMessage"

typedef struct driver {
    const char *place, *camera; /* camera: as it is listed */
    const char *plain, *packed; /* what is read, each way, with blanks around */
    io_ros2_topic topics[14];
    int32_t count;
} driver;

/* From the documents of realsense2_camera, OrbbecSDK_ROS2, Azure_Kinect_ROS_Driver, depthai_ros and
 * zed_ros2_wrapper. */
static const driver drivers[] = {
    {"/camera/camera",
     "/camera/camera",
     " /camera/camera/depth/image_rect_raw /camera/camera/color/image_raw ",
     " /camera/camera/depth/image_rect_raw/compressedDepth "
     "/camera/camera/color/image_raw/compressed ",
     {{"/camera/camera/color/camera_info", INFO, false},
      {"/camera/camera/color/image_raw", IMAGE, true},
      {"/camera/camera/color/image_raw/compressed", PACKED, true},
      {"/camera/camera/color/image_raw/compressedDepth", PACKED, true},
      {"/camera/camera/color/image_raw/theora", "theora_image_transport/msg/Packet", true},
      {"/camera/camera/depth/camera_info", INFO, true},
      {"/camera/camera/depth/image_rect_raw", IMAGE, true},
      {"/camera/camera/depth/image_rect_raw/compressed", PACKED, true},
      {"/camera/camera/depth/image_rect_raw/compressedDepth", PACKED, true},
      {"/tf_static", TF, true}},
     10},
    {"/camera",
     "/camera",
     " /camera/color/image_raw /camera/depth/image_raw ",
     " /camera/color/image_raw/compressed /camera/depth/image_raw/compressedDepth ",
     {{"/camera/color/camera_info", INFO, true},
      {"/camera/color/image_raw", IMAGE, true},
      {"/camera/color/image_raw/compressed", PACKED, true},
      {"/camera/depth/camera_info", INFO, true},
      {"/camera/depth/image_raw", IMAGE, true},
      {"/camera/depth/image_raw/compressedDepth", PACKED, true},
      {"/camera/depth/points", "sensor_msgs/msg/PointCloud2", true},
      {"/other/depth/image_raw", IMAGE, true}},
     8},
    {"/",
     "",
     " /depth/image_raw /rgb/image_raw ",
     " /depth/image_raw /rgb/image_raw/compressed ",
     {{"/depth/camera_info", INFO, true},
      {"/depth/image_raw", IMAGE, true},
      {"/points2", "sensor_msgs/msg/PointCloud2", true},
      {"/rgb/camera_info", INFO, true},
      {"/rgb/image_raw", IMAGE, true},
      {"/rgb/image_raw/compressed", PACKED, true}},
     6},
    {"/oak",
     "/oak",
     " /oak/rgb/image_raw /oak/stereo/image_raw ",
     " /oak/rgb/image_raw/compressed /oak/stereo/image_raw/compressedDepth ",
     {{"/oak/rgb/camera_info", INFO, false},
      {"/oak/rgb/image_raw", IMAGE, false},
      {"/oak/rgb/image_raw/compressed", PACKED, false},
      {"/oak/stereo/camera_info", INFO, false},
      {"/oak/stereo/image_raw", IMAGE, false},
      {"/oak/stereo/image_raw/compressedDepth", PACKED, false}},
     6},
    {"/zed/zed_node",
     "/zed/zed_node",
     " /zed/zed_node/depth/depth_registered /zed/zed_node/rgb/image_rect_color ",
     " /zed/zed_node/depth/depth_registered /zed/zed_node/rgb/image_rect_color/compressed ",
     {{"/zed/zed_node/depth/camera_info", INFO, true},
      {"/zed/zed_node/depth/depth_registered", IMAGE, true},
      {"/zed/zed_node/rgb/camera_info", INFO, true},
      {"/zed/zed_node/rgb/image_rect_color", IMAGE, true},
      {"/zed/zed_node/rgb/image_rect_color/compressed", PACKED, true}},
     5}};
#define DRIVER_COUNT (sizeof(drivers) / sizeof(drivers[0]))

static bool is_in(const char *list, const char *name)
{
    char word[IO_ROS2_TOPIC_MAX + 2];
    snprintf(word, sizeof(word), " %s ", name);
    return strstr(list, word) != NULL;
}

static void check_choice(const driver *d, bool is_packed)
{
    const io_ros2_wish wish = {.place = d->place, .is_packed = is_packed};
    const char *wanted = is_packed ? d->packed : d->plain;
    int32_t chosen[IO_ROS2_CHANNELS_MAX];
    const int32_t count =
        io_ros2_choose_topics(d->topics, d->count, &wish, chosen, IO_ROS2_CHANNELS_MAX);
    for (int32_t t = 0; t < d->count; t++) {
        const io_ros2_topic *topic = &d->topics[t];
        bool is_chosen = false;
        for (int32_t i = 0; i < count; i++) {
            is_chosen = is_chosen || chosen[i] == t;
        }
        const bool is_info =
            strcmp(topic->type, INFO) == 0 || strcmp(topic->name, "/tf_static") == 0;
        if (is_chosen != (is_info || is_in(wanted, topic->name))) {
            fail_msg("%s: %s is %s", d->place, topic->name, is_chosen ? "read" : "left out");
        }
    }
    assert_true(io_ros2_has_depth(d->topics, d->count, &wish));
}

TEST_CASE(test_drivers)
{
    for (size_t i = 0; i < DRIVER_COUNT; i++) {
        check_choice(&drivers[i], false);
        check_choice(&drivers[i], true);
    }
}

TEST_CASE(test_cameras_are_told)
{
    for (size_t i = 0; i < DRIVER_COUNT; i++) {
        char camera[IO_ROS2_TOPIC_MAX];
        int32_t told = 0;
        for (int32_t t = 0; t < drivers[i].count; t++) {
            const io_ros2_topic *topic = &drivers[i].topics[t];
            if (io_ros2_is_below(topic->name, drivers[i].place) &&
                io_ros2_camera_of(topic, camera, sizeof(camera))) {
                assert_string_equal(camera, drivers[i].camera);
                told++;
            }
        }
        assert_true(told > 0);
    }
}

TEST_CASE(test_named_topics_alone)
{
    const driver *d = &drivers[1];
    const io_ros2_wish wish = {
        .place = "", .depth = "/other/depth/image_raw", .color = "/camera/color/image_raw"};
    int32_t chosen[IO_ROS2_CHANNELS_MAX];
    const int32_t count =
        io_ros2_choose_topics(d->topics, d->count, &wish, chosen, IO_ROS2_CHANNELS_MAX);
    for (int32_t i = 0; i < count; i++) {
        const io_ros2_topic *topic = &d->topics[chosen[i]];
        assert_true(strcmp(topic->type, INFO) == 0 || strcmp(topic->name, wish.depth) == 0 ||
                    strcmp(topic->name, wish.color) == 0);
    }
    assert_int_equal(count, 4);
}

TEST_CASE(test_below)
{
    assert_true(io_ros2_is_below("/camera/depth", "/camera"));
    assert_true(io_ros2_is_below("/camera/depth", "/camera/"));
    assert_true(io_ros2_is_below("/camera/depth", "camera"));
    assert_true(io_ros2_is_below("/camera/depth", ""));
    assert_true(io_ros2_is_below("/camera/depth", "/"));
    assert_false(io_ros2_is_below("/camera2/depth", "/camera"));
    assert_false(io_ros2_is_below("/cam", "/camera"));
}

TEST_CASE(test_names)
{
    char out[64];
    assert_true(io_ros2_topic_to_dds("/camera/x", out, sizeof(out)));
    assert_string_equal(out, "rt/camera/x");
    assert_true(io_ros2_topic_from_dds("rt/camera/x", out, sizeof(out)));
    assert_string_equal(out, "/camera/x");
    assert_false(io_ros2_topic_from_dds("rq/service", out, sizeof(out)));
    assert_false(io_ros2_topic_from_dds("rt/a", out, 2));
    assert_true(io_ros2_type_to_dds(IMAGE, out, sizeof(out)));
    assert_string_equal(out, "sensor_msgs::msg::dds_::Image_");
    assert_true(io_ros2_type_from_dds("sensor_msgs::msg::dds_::Image_", out, sizeof(out)));
    assert_string_equal(out, IMAGE);
    static const char *const strangers[] = {
        "", "Image", "a::msg::dds_::", "a::msg::dds_::_", "a::srv::dds_::B_", "a::msg::dds_::B"};
    for (size_t i = 0; i < sizeof(strangers) / sizeof(strangers[0]); i++) {
        assert_false(io_ros2_type_from_dds(strangers[i], out, sizeof(out)));
    }
}
