/* Recordings that are one long list of frames, each a depth and a colour picture with their sizes
 * in front: what .klg and .sens have in common. */
#ifndef RLF_IO_FORMATS_FRAME_LOG_H
#define RLF_IO_FORMATS_FRAME_LOG_H

#include "relief/backend.h"
#include "io/clip/clip.h"

typedef struct io_log_frame {
    int64_t time_ns; /* as in the file; what that means when the clip is made */
    int64_t depth_position, color_position;
    uint32_t depth_size, color_size; /* bytes; colour 0 = none */
    rlf_pose pose;                   /* T_world_camera; no unit quaternion = none */
} io_log_frame;

typedef struct io_log {
    io_file file;
    io_log_frame *frames;
    int32_t count, room;
    io_shots color;
    rlf_rig rig;
    double units_per_metre;
    bool has_poses, is_bgr;
    io_buffer buffer;
} io_log;

/* Opens a file; *out is freed by io_log_free, or by the clip. */
rlf_result io_log_open(const char *path, io_log **out);
void io_log_free(void *log);

/* Reads exactly `size` bytes; false at the end of the file. */
bool io_log_read(const io_log *log, int64_t position, void *out, size_t size);

/* Adds a frame whose pictures begin at `position`, depth or colour first; *out_end is what follows.
 * RLF_END when the file does not hold them whole. */
rlf_result io_log_add(io_log *log, const io_log_frame *frame, int64_t position, bool is_color_first,
                      int64_t *out_end);

/* Makes the clip. Depth is raw or packed with zlib, colour is JPEG, PNG or raw RGB: told apart by
 * sizes and first bytes. On failure the log stays the caller's. */
rlf_result io_log_to_clip(io_log *log, const char *device, rlf_opened *out);

#endif
