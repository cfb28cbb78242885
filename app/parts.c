/* What `relief --version` says of the build. */
#include "parts.h"

#include "base/messages.h"

#include <stdio.h>

/* 1 where the build defines the name (as 1), 0 where it does not. */
#define HAS(name) HAS_VALUE(name)
#define HAS_VALUE(value) HAS_PICK(HAS_IF_##value)
#define HAS_PICK(pair) HAS_SECOND(pair 1, 0, 0)
#define HAS_SECOND(first, second, ...) second
#define HAS_IF_1 0,

#define DEFAULT "script/bootstrap"
#define ALL "script/bootstrap --all"

static const struct {
    const char *name, *cure;
    bool is_built;
} parts[PART_COUNT] = {
    [PART_WINDOW] = {"window",
                     RLF_GET_PART("libglfw3-dev libepoxy-dev libegl-dev libgl-dev", DEFAULT,
                                  "RELIEF_WITH_GL=ON -DRELIEF_WITH_VIEWER"),
                     HAS(RLF_HAVE_VIEWER)},
    [PART_PANEL] = {"panel", RLF_GET_PART("libimgui-dev g++", DEFAULT, "RELIEF_WITH_IMGUI"),
                    HAS(RLF_HAVE_PANEL)},
    [PART_OPENGL] = {"OpenGL",
                     RLF_GET_PART("libepoxy-dev libegl-dev libgl-dev", DEFAULT, "RELIEF_WITH_GL"),
                     HAS(RLF_HAVE_GL)},
    [PART_MP4] = {"MP4",
                  RLF_GET_PART("libavcodec-dev libavformat-dev libavutil-dev", DEFAULT,
                               "RELIEF_WITH_VIDEO"),
                  HAS(RLF_HAVE_LIBAV)},
    [PART_PIPEWIRE] = {"PipeWire", RLF_GET_PART("libpipewire-0.3-dev", ALL, "RELIEF_WITH_PIPEWIRE"),
                       HAS(RLF_HAVE_PIPEWIRE)},
    [PART_HULLS] = {"hulls", RLF_GET_PART("libqhull-dev", DEFAULT, "RELIEF_WITH_QHULL"),
                    HAS(RLF_HAVE_QHULL)},
    [PART_MCAP] = {"MCAP", RLF_GET_PART("libzstd-dev liblz4-dev", DEFAULT, "RELIEF_WITH_MCAP"),
                   HAS(RLF_HAVE_MCAP)},
    [PART_LZ4] = {"lz4 bags", RLF_GET_PART("liblz4-dev", DEFAULT, "RELIEF_WITH_LZ4"),
                  HAS(RLF_HAVE_LZ4)},
    [PART_BZ2] = {"bz2 bags", RLF_GET_PART("libbz2-dev", DEFAULT, "RELIEF_WITH_BZ2"),
                  HAS(RLF_HAVE_BZ2)},
    [PART_OPENNI2] = {"OpenNI2", RLF_GET_PART("libopenni2-0", ALL, "RELIEF_WITH_OPENNI2"),
                      HAS(RLF_HAVE_OPENNI2)},
    [PART_FREENECT] = {"freenect", RLF_GET_PART("libfreenect0.5", ALL, "RELIEF_WITH_FREENECT"),
                       HAS(RLF_HAVE_FREENECT)},
    [PART_FREENECT2] = {"freenect2",
                        "build libfreenect2 from source (not in Debian), then `cmake --preset "
                        "release -DRELIEF_WITH_FREENECT2=ON` and build again",
                        HAS(RLF_HAVE_FREENECT2)},
    [PART_WEBSOCKET] = {"WebSocket",
                        RLF_GET_PART("libwebsockets-dev", DEFAULT, "RELIEF_WITH_WEBSOCKET"),
                        HAS(RLF_HAVE_WEBSOCKET)},
    [PART_OSC] = {"OSC", RLF_GET_PART("liblo-dev", DEFAULT, "RELIEF_WITH_OSC"), HAS(RLF_HAVE_OSC)},
    [PART_ROS2] = {"ROS 2", RLF_GET_PART("cyclonedds-dev", ALL, "RELIEF_WITH_ROS2"),
                   HAS(RLF_HAVE_ROS2)},
    [PART_OPENCV] = {"calibrate", RLF_GET_PART("libopencv-calib3d-dev", ALL, "RELIEF_WITH_OPENCV"),
                     HAS(RLF_HAVE_OPENCV)},
};

bool part_is_built(part which)
{
    return parts[which].is_built;
}

const char *part_cure(part which)
{
    return parts[which].cure;
}

void parts_print(void)
{
    const char *before = "with: ";
    for (int i = 0; i < PART_COUNT; i++) {
        if (parts[i].is_built) {
            printf("%s%s", before, parts[i].name);
            before = ", ";
        }
    }
    printf("\n");
    for (int i = 0; i < PART_COUNT; i++) {
        if (!parts[i].is_built) {
            printf("without %s: %s\n", parts[i].name, parts[i].cure);
        }
    }
}
