/* The desktop's video sources in a build without PipeWire. */
#include "io/video/video.h"

#include "base/messages.h"

rlf_result io_pipewire_open(const char *name, const io_video_format *format, io_video_sink *out)
{
    (void)format;
    (void)out;
    return rlf_fail(
        RLF_ERROR_UNSUPPORTED,
        "pipewire:%s: this build has no PipeWire: give /dev/videoN of v4l2loopback, "
        "or " RLF_GET_PART("libpipewire-0.3-dev", "script/bootstrap --all", "RELIEF_WITH_PIPEWIRE"),
        name);
}
