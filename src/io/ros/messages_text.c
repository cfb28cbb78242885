/* The message definitions that go into a file. */
#include "io/ros/messages.h"

#include <stdio.h>
#include <string.h>

#define RULE "================================================================================\n"
#define HEADER                                                                                     \
    RULE "MSG: std_msgs/Header\n"                                                                  \
         "builtin_interfaces/Time stamp\nstring frame_id\n" RULE                                   \
         "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
#define QUATERNION                                                                                 \
    RULE "MSG: geometry_msgs/Quaternion\n"                                                         \
         "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"

static const struct {
    const char *name, *text;
} types[IO_ROS_TYPE_COUNT] = {
    [IO_ROS_IMAGE] = {"sensor_msgs/msg/Image",
                      "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\n"
                      "uint8 is_bigendian\nuint32 step\nuint8[] data\n" HEADER},
    [IO_ROS_COMPRESSED_IMAGE] = {"sensor_msgs/msg/CompressedImage",
                                 "std_msgs/Header header\nstring format\nuint8[] data\n" HEADER},
    [IO_ROS_CAMERA_INFO] =
        {"sensor_msgs/msg/CameraInfo",
         "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\n"
         "float64[] d\nfloat64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\n"
         "uint32 binning_y\nsensor_msgs/RegionOfInterest roi\n" HEADER RULE
         "MSG: sensor_msgs/RegionOfInterest\nuint32 x_offset\nuint32 y_offset\nuint32 height\n"
         "uint32 width\nbool do_rectify\n"},
    [IO_ROS_TF] = {"tf2_msgs/msg/TFMessage",
                   "geometry_msgs/TransformStamped[] transforms\n" RULE
                   "MSG: geometry_msgs/TransformStamped\nstd_msgs/Header header\n"
                   "string child_frame_id\ngeometry_msgs/Transform transform\n" HEADER RULE
                   "MSG: geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\n"
                   "geometry_msgs/Quaternion rotation\n" RULE
                   "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n" QUATERNION},
    [IO_ROS_POSE_STAMPED] = {"geometry_msgs/msg/PoseStamped",
                             "std_msgs/Header header\ngeometry_msgs/Pose pose\n" HEADER RULE
                             "MSG: geometry_msgs/Pose\ngeometry_msgs/Point position\n"
                             "geometry_msgs/Quaternion orientation\n" RULE
                             "MSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\n"
                             "float64 z\n" QUATERNION},
    [IO_ROS_STRING] = {"std_msgs/msg/String", "string data\n"},
};

io_ros_type io_ros1_type_of(const char *name)
{
    static const struct {
        const char *name;
        io_ros_type type;
    } names[] = {{"sensor_msgs/Image", IO_ROS_IMAGE},
                 {"sensor_msgs/CompressedImage", IO_ROS_COMPRESSED_IMAGE},
                 {"sensor_msgs/CameraInfo", IO_ROS_CAMERA_INFO},
                 {"tf2_msgs/TFMessage", IO_ROS_TF},
                 {"tf/tfMessage", IO_ROS_TF},
                 {"geometry_msgs/Transform", IO_ROS_TRANSFORM},
                 {"std_msgs/Float32", IO_ROS_FLOAT},
                 {"diagnostic_msgs/KeyValue", IO_ROS_KEY_VALUE}};
    for (size_t i = 0; i < sizeof(names) / sizeof(names[0]); i++) {
        if (strcmp(names[i].name, name) == 0) {
            return names[i].type;
        }
    }
    return IO_ROS_OTHER;
}

const char *io_ros_type_name(io_ros_type type)
{
    return types[type].name;
}

const char *io_ros_type_text(io_ros_type type)
{
    return types[type].text;
}
