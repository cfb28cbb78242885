/* Loaded before the C library: /dev/video9 is a v4l2loopback device that keeps its pictures in the
 * file that RELIEF_MOCK_V4L2 names; /dev/video8 is a camera, which takes none. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/videodev2.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>

static int output = -1;
static int camera = -1;

int open(const char *path, int flags, ...)
{
    va_list rest;
    va_start(rest, flags);
    const unsigned mode = (flags & O_CREAT) != 0 ? va_arg(rest, unsigned) : 0;
    va_end(rest);
    int (*real_open)(const char *, int, ...) = NULL;
    *(void **)&real_open = dlsym(RTLD_NEXT, "open");
    if (strcmp(path, "/dev/video9") == 0) {
        output = real_open(getenv("RELIEF_MOCK_V4L2"), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        return output;
    }
    if (strcmp(path, "/dev/video8") == 0) {
        camera = real_open("/dev/null", O_RDWR);
        return camera;
    }
    return real_open(path, flags, mode);
}

static int query(int file, struct v4l2_capability *out)
{
    memset(out, 0, sizeof(*out));
    out->capabilities = V4L2_CAP_DEVICE_CAPS | V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_VIDEO_CAPTURE;
    out->device_caps = file == output ? V4L2_CAP_VIDEO_OUTPUT : V4L2_CAP_VIDEO_CAPTURE;
    return 0;
}

static int set_format(const struct v4l2_format *format)
{
    const struct v4l2_pix_format *p = &format->fmt.pix;
    if (format->type != V4L2_BUF_TYPE_VIDEO_OUTPUT || p->pixelformat != V4L2_PIX_FMT_YUV420 ||
        p->sizeimage != p->width * p->height * 3 / 2 || p->bytesperline != p->width) {
        errno = EINVAL;
        return -1;
    }
    return 0;
}

int ioctl(int file, unsigned long request, ...)
{
    va_list rest;
    va_start(rest, request);
    void *argument = va_arg(rest, void *);
    va_end(rest);
    if (file >= 0 && (file == output || file == camera)) {
        if (request == VIDIOC_QUERYCAP) {
            return query(file, argument);
        }
        if (request == VIDIOC_S_FMT) {
            return set_format(argument);
        }
        errno = ENOTTY;
        return -1;
    }
    int (*real_ioctl)(int, unsigned long, ...) = NULL;
    *(void **)&real_ioctl = dlsym(RTLD_NEXT, "ioctl");
    return real_ioctl(file, request, argument);
}
