/* ROS 2 in a build without Cyclone DDS. */
#include "io/clip/sink.h"

#include "base/messages.h"

rlf_result io_ros2_sink_open(const char *path, const rlf_source_info *info,
                             const rlf_recording_def *def, io_sink *out)
{
    (void)info;
    (void)def;
    (void)out;
    return rlf_fail(RLF_ERROR_UNSUPPORTED,
                    "%s: this build has no ROS 2: " RLF_GET_PART(
                        "cyclonedds-dev", "script/bootstrap --all", "RELIEF_WITH_ROS2"),
                    path);
}
