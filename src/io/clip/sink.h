/* Where a recording goes: an MCAP file or a folder. */
#ifndef RLF_IO_CLIP_SINK_H
#define RLF_IO_CLIP_SINK_H

#include "relief/io.h"

#include <string.h>

/* Methods of a sink; `self` is what its open made. */
typedef struct io_sink {
    rlf_result (*add)(void *self, const rlf_frame *frame);
    /* NULL = such a sink keeps no bodies. */
    rlf_result (*add_bodies)(void *self, int64_t time_ns, const rlf_snapshot *snapshot);
    /* Finishes and frees. Sets how many frames and bytes can be read back. */
    rlf_result (*close)(void *self, rlf_recording_status *status);
    /* Bytes written so far. */
    uint64_t (*bytes)(const void *self);
    void *self;
} io_sink;

rlf_result io_mcap_sink_open(const char *path, const rlf_source_info *info,
                             const rlf_recording_def *def, io_sink *out);
rlf_result io_ros2_sink_open(const char *path, const rlf_source_info *info,
                             const rlf_recording_def *def, io_sink *out);
rlf_result io_folder_sink_open(const char *path, const rlf_source_info *info,
                               const rlf_recording_def *def, io_sink *out);

/* Rows without padding: the frame's own, or copied to `scratch`. */
static inline const void *io_depth_rows(const rlf_frame *frame, const rlf_rig *rig, void *scratch)
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

#endif
