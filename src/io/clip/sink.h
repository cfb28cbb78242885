/* Where a recording goes: an MCAP file or a folder. */
#ifndef RLF_IO_CLIP_SINK_H
#define RLF_IO_CLIP_SINK_H

#include "relief/io.h"

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
rlf_result io_folder_sink_open(const char *path, const rlf_source_info *info,
                               const rlf_recording_def *def, io_sink *out);

/* Rows without padding: the frame's own, or copied to `scratch`. */
const void *io_depth_rows(const rlf_frame *frame, const rlf_rig *rig, void *scratch);

#endif
