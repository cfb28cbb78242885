/* ROS 2 in a build without Cyclone DDS. */
#include "io/clip/sink.h"

#include "base/messages.h"

#define CURE                                                                                       \
    "this build has no ROS 2: " RLF_GET_PART("cyclonedds-dev", "script/bootstrap --all",           \
                                             "RELIEF_WITH_ROS2")

rlf_result io_ros2_sink_open(const char *path, const rlf_source_info *info,
                             const rlf_recording_def *def, io_sink *out)
{
    (void)info;
    (void)def;
    (void)out;
    return rlf_fail(RLF_ERROR_UNSUPPORTED, "%s: " CURE, path);
}

rlf_result rlf_ros2_publisher_open(const char *address, const rlf_source_info *info,
                                   rlf_ros2_publisher **out)
{
    if (!RLF_ASSERT(address != NULL && info != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    return rlf_fail(RLF_ERROR_UNSUPPORTED, "%s: " CURE, address);
}

/* There is none. */
void rlf_ros2_publisher_add(rlf_ros2_publisher *publisher, const rlf_pipeline_output *frame)
{
    (void)RLF_ASSERT(publisher != NULL && frame != NULL);
}

rlf_ros2_status rlf_ros2_publisher_get_status(rlf_ros2_publisher *publisher)
{
    (void)RLF_ASSERT(publisher != NULL);
    return (rlf_ros2_status){0};
}

void rlf_ros2_publisher_close(rlf_ros2_publisher **publisher)
{
    (void)publisher;
}
