/* Videos by their name: a file, standard output or a virtual camera. */
#define _POSIX_C_SOURCE 200809L
#include "relief/io.h"
#include "base/messages.h"
#include "io/video/video.h"

#include <errno.h>
#include <string.h>
#include <time.h>

#ifndef RLF_HAVE_LIBAV
rlf_result io_mp4_open(const char *path, const io_video_format *format, io_video_sink *out)
{
    (void)format, (void)out;
    return rlf_fail(
        RLF_ERROR_UNSUPPORTED,
        "%s: this build cannot write MP4: use a name that ends in .y4m, or " RLF_GET_PART(
            "libavcodec-dev libavformat-dev libavutil-dev", "script/bootstrap",
            "RELIEF_WITH_VIDEO"),
        path);
}
#endif
#ifndef RLF_HAVE_PIPEWIRE
rlf_result io_pipewire_open(const char *name, const io_video_format *format, io_video_sink *out)
{
    (void)format, (void)out;
    return rlf_fail(
        RLF_ERROR_UNSUPPORTED,
        "pipewire:%s: this build has no PipeWire: give /dev/videoN of v4l2loopback, "
        "or " RLF_GET_PART("libpipewire-0.3-dev", "script/bootstrap --all", "RELIEF_WITH_PIPEWIRE"),
        name);
}
#endif

/* ---- Y4M: uncompressed video that every tool reads --------------------------------------- */

static rlf_result y4m_write(void *self, const io_yuv *yuv, const rlf_image_rgba8 *image)
{
    (void)image;
    io_out_file *file = self;
    rlf_result result = io_out_write(file, "FRAME\n", strlen("FRAME\n"));
    return result == RLF_OK ? io_out_write(file, yuv->y, io_yuv_size(yuv)) : result;
}

static rlf_result y4m_close(void *self, rlf_result result)
{
    io_out_file *file = self;
    if (file->stream != stdout) {
        result = io_out_close(file, result);
    } else if (fflush(stdout) != 0 && result == RLF_OK) {
        result = rlf_fail(RLF_ERROR_IO, "stdout: cannot be written: %s: check what reads the pipe",
                          strerror(errno));
    }
    rlf_free(file);
    return result;
}

static rlf_result open_file(const char *path, io_out_file *file)
{
    if (strcmp(path, "-") != 0) {
        return io_out_open(file, path);
    }
    file->stream = stdout;
    file->is_direct = true;
    memcpy(file->path, "stdout", sizeof("stdout"));
    return RLF_OK;
}

/* Y4M to a file, or to standard output for "-". */
static rlf_result open_y4m(const char *path, const io_video_format *format, io_video_sink *out)
{
    io_out_file *file = rlf_alloc(sizeof(*file));
    if (file == NULL) {
        return RLF_ERROR_MEMORY;
    }
    rlf_result result = open_file(path, file);
    if (result != RLF_OK) {
        rlf_free(file);
        return result;
    }
    *out = (io_video_sink){.write = y4m_write, .close = y4m_close, .self = file};
    char header[128];
    int length =
        snprintf(header, sizeof(header),
                 "YUV4MPEG2 W%d H%d F%d:%d Ip A1:1 C420jpeg XYSCSS=420JPEG XCOLORRANGE=LIMITED\n",
                 (int)format->width, (int)format->height, (int)format->rate.numerator,
                 (int)format->rate.denominator);
    result = io_out_write(file, header, (size_t)length);
    return result == RLF_OK ? result : y4m_close(file, result);
}

#define RATE_MAX 1000.0
#define NS_PER_S INT64_C(1000000000)

struct rlf_video {
    int32_t width, height; /* of the pictures given, perhaps odd */
    io_yuv yuv;
    rlf_result result; /* the first error; nothing is written after it */
    io_video_sink sink;
    int64_t period_ns;
    int64_t due_ns; /* when a virtual camera's next picture is due */
};

static bool has_ending(const char *path, const char *ending)
{
    size_t length = strlen(path);
    size_t ending_length = strlen(ending);
    return length > ending_length && strcmp(path + length - ending_length, ending) == 0;
}

static bool has_start(const char *path, const char *start)
{
    return strncmp(path, start, strlen(start)) == 0;
}

static rlf_result open_by_name(rlf_video *video, const char *path, double frames_per_second)
{
    io_video_format format = {video->yuv.width, video->yuv.height, io_rate_from(frames_per_second)};
    if (strcmp(path, "-") == 0 || has_ending(path, ".y4m")) {
        return open_y4m(path, &format, &video->sink);
    }
    if (has_ending(path, ".mp4")) {
        return io_mp4_open(path, &format, &video->sink);
    }
    if (has_start(path, "/dev/video")) {
        return io_v4l2_open(path, &format, &video->sink);
    }
    if (has_start(path, "pipewire:")) {
        format.width = video->width;
        format.height = video->height;
        return io_pipewire_open(path + strlen("pipewire:"), &format, &video->sink);
    }
    return rlf_fail(RLF_ERROR_INVALID,
                    "%s: is not a known kind of video: end its name in .mp4 or .y4m, or give - for "
                    "Y4M on stdout, pipewire:NAME or /dev/videoN for a virtual camera",
                    path);
}

static rlf_result finish(rlf_video *video)
{
    rlf_result result = video->sink.close != NULL
                            ? video->sink.close(video->sink.self, video->result)
                            : video->result;
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
    video->period_ns = (int64_t)((double)NS_PER_S / frames_per_second);
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

/* Waits until the picture is due. A program that has fallen behind does not race. */
static void keep_to_the_clock(rlf_video *video)
{
    const int64_t now_ns = rlf_clock_ns();
    if (video->due_ns > now_ns) {
        const int64_t wait_ns = video->due_ns - now_ns;
        const struct timespec wait = {(time_t)(wait_ns / NS_PER_S), (long)(wait_ns % NS_PER_S)};
        nanosleep(&wait, NULL); /* a signal ends it early: so be it */
    }
    const int64_t earliest_ns = now_ns - video->period_ns;
    video->due_ns = (video->due_ns > earliest_ns ? video->due_ns : earliest_ns) + video->period_ns;
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
    if (video->sink.is_camera) {
        keep_to_the_clock(video);
    }
    if (!video->sink.takes_rgba) {
        io_yuv_from_rgba(image, &video->yuv);
    }
    video->result = video->sink.takes_rgba ? video->sink.write(video->sink.self, NULL, image)
                                           : video->sink.write(video->sink.self, &video->yuv, NULL);
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
