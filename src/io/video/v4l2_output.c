/* A v4l2loopback device as a virtual camera: video output of Video4Linux2 by write(). */
#define _POSIX_C_SOURCE 200809L
#include "io/video/video.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

#ifdef __linux__
#include <linux/videodev2.h>
#include <sys/ioctl.h>

typedef struct v4l2_device {
    char path[128];
    int file;
} v4l2_device;

static rlf_result v4l2_write(void *self, const io_yuv *yuv, const rlf_image_rgba8 *image)
{
    (void)image;
    const v4l2_device *output = self;
    const size_t size = io_yuv_size(yuv);
    ssize_t written;
    do {
        written = write(output->file, yuv->y, size);
    } while (written < 0 && errno == EINTR);
    if (written == (ssize_t)size) {
        return RLF_OK;
    }
    return rlf_fail(RLF_ERROR_DEVICE, "%s: the picture cannot be written: %s", output->path,
                    written < 0 ? strerror(errno) : "the device took a part of it only");
}

static rlf_result v4l2_close(void *self, rlf_result result)
{
    v4l2_device *output = self;
    close(output->file);
    rlf_free(output);
    return result;
}

/* ioctl that goes on after a signal. */
static int control(int file, unsigned long request, void *argument)
{
    int result;
    do {
        result = ioctl(file, request, argument);
    } while (result < 0 && errno == EINTR);
    return result;
}

static rlf_result set_format(const v4l2_device *output, const io_video_format *format)
{
    struct v4l2_capability capability;
    memset(&capability, 0, sizeof(capability));
    if (control(output->file, VIDIOC_QUERYCAP, &capability) != 0) {
        return rlf_fail(RLF_ERROR_DEVICE, "%s: is no video device: %s", output->path,
                        strerror(errno));
    }
    const uint32_t able = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0
                              ? capability.device_caps
                              : capability.capabilities;
    if ((able & V4L2_CAP_VIDEO_OUTPUT) == 0) {
        return rlf_fail(RLF_ERROR_DEVICE,
                        "%s: takes no pictures, it is a camera or is read already: load "
                        "v4l2loopback (modprobe v4l2loopback exclusive_caps=1) and give its device",
                        output->path);
    }
    struct v4l2_format wanted;
    memset(&wanted, 0, sizeof(wanted));
    wanted.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    wanted.fmt.pix.width = (uint32_t)format->width;
    wanted.fmt.pix.height = (uint32_t)format->height;
    wanted.fmt.pix.pixelformat = V4L2_PIX_FMT_YUV420;
    wanted.fmt.pix.field = V4L2_FIELD_NONE;
    wanted.fmt.pix.bytesperline = (uint32_t)format->width;
    wanted.fmt.pix.sizeimage = (uint32_t)(format->width * format->height / 2 * 3);
    wanted.fmt.pix.colorspace = V4L2_COLORSPACE_SMPTE170M;
    if (control(output->file, VIDIOC_S_FMT, &wanted) != 0) {
        return rlf_fail(RLF_ERROR_DEVICE, "%s: refuses %d x %d pictures: %s", output->path,
                        (int)format->width, (int)format->height, strerror(errno));
    }
    if (wanted.fmt.pix.width != (uint32_t)format->width ||
        wanted.fmt.pix.height != (uint32_t)format->height ||
        wanted.fmt.pix.pixelformat != V4L2_PIX_FMT_YUV420) {
        return rlf_fail(RLF_ERROR_DEVICE,
                        "%s: is set to %u x %u pictures by another program, and these are %d x %d: "
                        "close what reads it",
                        output->path, wanted.fmt.pix.width, wanted.fmt.pix.height,
                        (int)format->width, (int)format->height);
    }
    return RLF_OK;
}

rlf_result io_v4l2_open(const char *path, const io_video_format *format, io_video_sink *out)
{
    v4l2_device *output = rlf_alloc(sizeof(*output));
    if (output == NULL) {
        return RLF_ERROR_MEMORY;
    }
    snprintf(output->path, sizeof(output->path), "%s", path);
    output->file = open(path, O_RDWR | O_CLOEXEC);
    if (output->file < 0) {
        rlf_result result =
            rlf_fail(RLF_ERROR_DEVICE,
                     "%s: cannot be opened: %s: load v4l2loopback (apt install v4l2loopback-dkms, "
                     "modprobe v4l2loopback exclusive_caps=1) and give its device",
                     path, strerror(errno));
        rlf_free(output);
        return result;
    }
    rlf_result result = set_format(output, format);
    if (result != RLF_OK) {
        return v4l2_close(output, result);
    }
    *out = (io_video_sink){
        .write = v4l2_write, .close = v4l2_close, .self = output, .is_camera = true};
    return RLF_OK;
}
#else
rlf_result io_v4l2_open(const char *path, const io_video_format *format, io_video_sink *out)
{
    (void)format;
    (void)out;
    return rlf_fail(RLF_ERROR_UNSUPPORTED, "%s: virtual cameras of this kind need Linux", path);
}
#endif
