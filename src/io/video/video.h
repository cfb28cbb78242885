/* What is behind rlf_video: files, pipes and virtual cameras. */
#ifndef RLF_IO_VIDEO_VIDEO_H
#define RLF_IO_VIDEO_VIDEO_H

#include "io/file.h"
#include "relief/image.h"

/* ---- Pictures as video encoders want them: planar YUV 4:2:0 ---- */

/* Limited range (16..235), BT.601 matrix, chroma in the middle of each 2x2 block. Width and height
 * are even; planes have no padding and lie in one rlf_alloc block. */
typedef struct io_yuv {
    int32_t width, height;
    uint8_t *y, *u, *v;
} io_yuv;

/* Room for a picture of width x height, each rounded up to even. */
rlf_result io_yuv_create(int32_t width, int32_t height, io_yuv *out);
void io_yuv_destroy(io_yuv *yuv);
size_t io_yuv_size(const io_yuv *yuv);

/* Converts; the last column and row are repeated where the picture's size is odd. Alpha is not
 * used. */
void io_yuv_from_rgba(const rlf_image_rgba8 *image, io_yuv *yuv);

/* Frame rate as a fraction. */
typedef struct io_rate {
    int32_t numerator, denominator;
} io_rate;

/* 29.97 and its kin as N * 1000 / 1001, others to a thousandth. */
io_rate io_rate_from(double frames_per_second);

/* What a picture goes to. Every function is there also in a build without the library it needs,
 * and then fails with RLF_ERROR_UNSUPPORTED. */
typedef struct io_video_sink {
    /* Takes one picture in the form that `takes_rgba` says; the other argument is NULL. */
    rlf_result (*write)(void *self, const io_yuv *yuv, const rlf_image_rgba8 *image);
    /* RLF_OK given: finishes, and a file gets its name. An error given, or met: removes the file.
     * Returns the first error and frees `self`. */
    rlf_result (*close)(void *self, rlf_result result);
    void *self;
    bool takes_rgba;
    bool is_camera; /* others watch it as it comes: pictures keep to the clock */
} io_video_sink;

/* Size, even, and rate of the pictures that will come. */
typedef struct io_video_format {
    int32_t width, height;
    io_rate rate;
} io_video_format;

/* H.264 through libav. */
rlf_result io_mp4_open(const char *path, const io_video_format *format, io_video_sink *out);
/* A v4l2loopback device, "/dev/videoN": other programs see it as a camera. */
rlf_result io_v4l2_open(const char *path, const io_video_format *format, io_video_sink *out);
/* "pipewire:" or "pipewire:NAME": a video source of the desktop, with that name. `format` has the
 * pictures' true size, which may be odd. */
rlf_result io_pipewire_open(const char *name, const io_video_format *format, io_video_sink *out);

#endif
