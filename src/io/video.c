/* Videos by their name: MP4, or Y4M to a file or to stdout. */
#include "relief/io.h"
#include "io/video.h"

#include <errno.h>
#include <string.h>

#define RATE_MAX 1000.0

struct rlf_video {
    int32_t width, height; /* of the pictures given, perhaps odd */
    io_yuv yuv;
    rlf_result result; /* the first error; nothing is written after it */
    io_mp4 *mp4;       /* either this ... */
    io_out_file y4m;   /* ... or this, with stream stdout for "-" */
};

static bool has_ending(const char *path, const char *ending)
{
    size_t length = strlen(path);
    size_t ending_length = strlen(ending);
    return length > ending_length && strcmp(path + length - ending_length, ending) == 0;
}

static rlf_result open_y4m(rlf_video *video, const char *path, io_rate rate)
{
    rlf_result result = RLF_OK;
    if (strcmp(path, "-") == 0) {
        video->y4m.stream = stdout;
        video->y4m.is_direct = true;
        memcpy(video->y4m.path, "stdout", sizeof("stdout"));
    } else {
        result = io_out_open(&video->y4m, path);
    }
    if (result != RLF_OK) {
        return result;
    }
    char header[128];
    int length = snprintf(
        header, sizeof(header),
        "YUV4MPEG2 W%d H%d F%d:%d Ip A1:1 C420jpeg XYSCSS=420JPEG XCOLORRANGE=LIMITED\n",
        (int)video->yuv.width, (int)video->yuv.height, (int)rate.numerator, (int)rate.denominator);
    return io_out_write(&video->y4m, header, (size_t)length);
}

static rlf_result close_y4m(rlf_video *video)
{
    if (video->y4m.stream != stdout) {
        return io_out_close(&video->y4m, video->result);
    }
    if (fflush(stdout) != 0 && video->result == RLF_OK) {
        return rlf_fail(RLF_ERROR_IO, "stdout: cannot be written: %s: check what reads the pipe",
                        strerror(errno));
    }
    return video->result;
}

static rlf_result open_by_name(rlf_video *video, const char *path, double frames_per_second)
{
    io_rate rate = io_rate_from(frames_per_second);
    if (strcmp(path, "-") == 0 || has_ending(path, ".y4m")) {
        return open_y4m(video, path, rate);
    }
    if (has_ending(path, ".mp4")) {
        return io_mp4_open(path, &video->yuv, rate, &video->mp4);
    }
    return rlf_fail(RLF_ERROR_INVALID,
                    "%s: is not a known kind of video: end its name in .mp4 or .y4m, or give - for "
                    "Y4M on stdout",
                    path);
}

static rlf_result finish(rlf_video *video)
{
    rlf_result result =
        video->mp4 != NULL ? io_mp4_close(&video->mp4, video->result) : close_y4m(video);
    io_yuv_destroy(&video->yuv);
    rlf_free(video);
    return result;
}

rlf_result rlf_video_open(const char *path, int32_t width, int32_t height, double frames_per_second,
                          rlf_video **out)
{
    if (!RLF_ASSERT(path != NULL && out != NULL) ||
        !RLF_ASSERT(width > 0 && width <= RLF_IMAGE_SIZE_MAX) ||
        !RLF_ASSERT(height > 0 && height <= RLF_IMAGE_SIZE_MAX)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    if (!(frames_per_second >= 0.001 && frames_per_second <= RATE_MAX)) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: %g frames per second: use 0.001 to %g", path,
                        frames_per_second, RATE_MAX);
    }
    rlf_video *video = rlf_alloc(sizeof(*video));
    if (video == NULL) {
        return RLF_ERROR_MEMORY;
    }
    video->width = width;
    video->height = height;
    video->result = io_yuv_create(width, height, &video->yuv);
    if (video->result == RLF_OK) {
        video->result = open_by_name(video, path, frames_per_second);
    }
    if (video->result != RLF_OK) {
        return finish(video);
    }
    *out = video;
    return RLF_OK;
}

rlf_result rlf_video_write(rlf_video *video, const rlf_image_rgba8 *image)
{
    if (!RLF_ASSERT(video != NULL && image != NULL && image->data != NULL) ||
        !RLF_ASSERT(image->width == video->width && image->height == video->height)) {
        return RLF_ERROR_INVALID;
    }
    if (video->result != RLF_OK) {
        return video->result;
    }
    io_yuv_from_rgba(image, &video->yuv);
    if (video->mp4 != NULL) {
        video->result = io_mp4_write(video->mp4, &video->yuv);
        return video->result;
    }
    video->result = io_out_write(&video->y4m, "FRAME\n", strlen("FRAME\n"));
    if (video->result == RLF_OK) {
        video->result = io_out_write(&video->y4m, video->yuv.y, io_yuv_size(&video->yuv));
    }
    return video->result;
}

rlf_result rlf_video_close(rlf_video **video)
{
    if (video == NULL || *video == NULL) {
        return RLF_OK;
    }
    rlf_result result = finish(*video);
    *video = NULL;
    return result;
}
