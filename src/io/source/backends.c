/* The back ends of this build. */
#include "io/source/backends.h"

#include "base/messages.h"

/* In the order in which they are asked for a file: a folder is asked last, as it takes any. */
static const rlf_backend *const built_in[] = {
    &io_backend_simulated,
#ifdef RLF_HAVE_OPENNI2
    &io_backend_openni2,
#endif
#ifdef RLF_HAVE_FREENECT
    &io_backend_freenect,
#endif
    &io_backend_realsense, &io_backend_k4a,  &io_backend_freenect2,
#ifdef RLF_HAVE_MCAP
    &io_backend_mcap,
#endif
#ifdef RLF_HAVE_ROS2
    &io_backend_ros2,
#endif
    &io_backend_oni,       &io_backend_pcd,  &io_backend_klg,       &io_backend_matroska,
    &io_backend_rosbag,    &io_backend_sens, &io_backend_folder,
};
#define BUILT_IN_COUNT ((int32_t)(sizeof(built_in) / sizeof(built_in[0])))

const rlf_backend *io_backend_built_in_at(int32_t index)
{
    return index >= 0 && index < BUILT_IN_COUNT ? built_in[index] : NULL;
}

static const io_backend_absent absent[] = {
#ifndef RLF_HAVE_OPENNI2
    {"openni2", NULL, "RELIEF_WITH_OPENNI2", "cameras through OpenNI2",
     RLF_GET_PART("libopenni2-0", "script/bootstrap --all", "RELIEF_WITH_OPENNI2")},
#endif
#ifndef RLF_HAVE_FREENECT
    {"freenect", NULL, "RELIEF_WITH_FREENECT", "Kinect v1 through libfreenect",
     RLF_GET_PART("libfreenect0.5", "script/bootstrap --all", "RELIEF_WITH_FREENECT")},
#endif
#ifndef RLF_HAVE_MCAP
    {"mcap", ".mcap", "RELIEF_WITH_MCAP", "a recording: MCAP with ROS 2 pictures",
     RLF_GET_PART("libzstd-dev liblz4-dev", "script/bootstrap", "RELIEF_WITH_MCAP")},
#endif
#ifndef RLF_HAVE_ROS2
    {"ros2", NULL, "RELIEF_WITH_ROS2", "any camera with a ROS 2 driver",
     RLF_GET_PART("cyclonedds-dev", "script/bootstrap --all", "RELIEF_WITH_ROS2")},
#endif
    {0},
};

const io_backend_absent *io_backend_absent_at(int32_t index)
{
    return index >= 0 && absent[index].scheme != NULL ? &absent[index] : NULL;
}
