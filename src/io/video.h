/* The encoders behind rlf_video. */
#ifndef RLF_IO_VIDEO_H
#define RLF_IO_VIDEO_H

#include "io/file.h"
#include "io/yuv.h"

/* MP4 through libav; every function is there also without it, and open then fails with
 * RLF_ERROR_UNSUPPORTED. The size is even. */
typedef struct io_mp4 io_mp4;
rlf_result io_mp4_open(const char *path, const io_yuv *size, io_rate rate, io_mp4 **out);
rlf_result io_mp4_write(io_mp4 *mp4, const io_yuv *picture);
/* RLF_OK given: finishes the file and gives it its name. An error given, or met: removes it.
 * Returns the first error. Nulls the pointer; NULL in it is allowed. */
rlf_result io_mp4_close(io_mp4 **mp4, rlf_result result);

#endif
