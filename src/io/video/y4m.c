/* Y4M: uncompressed video that every tool reads, to a file or to standard output. */
#include "io/video/video.h"

#include <errno.h>
#include <string.h>

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

rlf_result io_y4m_open(const char *path, const io_video_format *format, io_video_sink *out)
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
