/* Rows of depth as a file wants them. */
#include "io/clip/sink.h"

#include <string.h>

const void *io_depth_rows(const rlf_frame *frame, const rlf_rig *rig, void *scratch)
{
    const bool is_float = frame->depth_f32 != NULL;
    const void *from = is_float ? (const void *)frame->depth_f32 : (const void *)frame->depth_u16;
    const size_t row = (size_t)rig->depth.width * (is_float ? 4 : 2);
    if ((size_t)frame->depth_stride == row) {
        return from;
    }
    for (int32_t y = 0; y < rig->depth.height; y++) {
        memcpy((char *)scratch + (size_t)y * row,
               (const char *)from + (ptrdiff_t)y * frame->depth_stride, row);
    }
    return scratch;
}
