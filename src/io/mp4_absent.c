/* MP4 in a build without libav. */
#include "io/video.h"

rlf_result io_mp4_open(const char *path, const io_yuv *size, io_rate rate, io_mp4 **out)
{
    (void)size;
    (void)rate;
    *out = NULL;
    return rlf_fail(RLF_ERROR_UNSUPPORTED,
                    "%s: this build cannot write MP4: use a name that ends in .y4m, or build with "
                    "RELIEF_WITH_VIDEO=ON",
                    path);
}

rlf_result io_mp4_write(io_mp4 *mp4, const io_yuv *picture)
{
    (void)mp4;
    (void)picture;
    return RLF_ERROR_UNSUPPORTED;
}

rlf_result io_mp4_close(io_mp4 **mp4, rlf_result result)
{
    *mp4 = NULL;
    return result;
}
