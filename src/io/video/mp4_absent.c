/* MP4 in a build without libav. */
#include "io/video/video.h"

#include "base/messages.h"

rlf_result io_mp4_open(const char *path, const io_video_format *format, io_video_sink *out)
{
    (void)format;
    (void)out;
    return rlf_fail(
        RLF_ERROR_UNSUPPORTED,
        "%s: this build cannot write MP4: use a name that ends in .y4m, or " RLF_GET_PART(
            "libavcodec-dev libavformat-dev libavutil-dev", "script/bootstrap",
            "RELIEF_WITH_VIDEO"),
        path);
}
