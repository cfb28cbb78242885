/* The desktop's video sources in a build without PipeWire. */
#include "io/video/video.h"

rlf_result io_pipewire_open(const char *name, const io_video_format *format, io_video_sink *out)
{
    (void)format;
    (void)out;
    return rlf_fail(RLF_ERROR_UNSUPPORTED,
                    "pipewire:%s: this build has no PipeWire: install libpipewire-0.3-dev and "
                    "build again, or give /dev/videoN of v4l2loopback",
                    name);
}
