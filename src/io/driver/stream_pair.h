/* Depth and colour pictures that a live device sends as two streams, paired by their times. */
#ifndef RLF_IO_DRIVER_STREAM_PAIR_H
#define RLF_IO_DRIVER_STREAM_PAIR_H

#include "relief/source.h"

#define IO_STREAM_SLOTS 4

/* A picture that arrived. */
typedef struct io_stream_slot {
    void *data;
    int64_t time_ns; /* the device's own */
    int64_t host_time_ns;
    uint64_t sequence; /* of depth */
} io_stream_slot;

/* Call take after every push until it says no: then two depth pictures are the most that wait. */
typedef struct io_stream_pair {
    const rlf_rig *rig; /* borrowed: sizes */
    double units_per_metre;
    int64_t interval_ns;
    uint32_t flags; /* rlf_frame_flag of every frame */
    io_stream_slot depth[IO_STREAM_SLOTS], color[IO_STREAM_SLOTS];
    int32_t shown_depth, shown_color;  /* what the last frame points to; -1 = nothing */
    int32_t waiting[2], waiting_count; /* depth pictures not given yet, oldest first */
    int32_t colors[2], color_count;    /* newest colour pictures, oldest first */
    int64_t last_time_ns, last_index;  /* of the depth picture pushed last */
    int64_t shift_ns;                  /* added to the device's time, which may start again */
    uint64_t sequence;                 /* of the depth picture pushed last */
    bool has_last, is_broken;          /* is_broken: the next frame does not follow */
    rlf_source_status status;
} io_stream_pair;

/* Allocates the pictures. `rig` lives as long as the pair. */
rlf_result io_stream_pair_init(io_stream_pair *pair, const rlf_rig *rig, double units_per_metre,
                               double frames_per_second);
/* A pair that was never made is allowed, when it is zero. */
void io_stream_pair_finish(io_stream_pair *pair);
/* Forgets all pictures that wait: the next frame does not follow the last one. */
void io_stream_pair_clear(io_stream_pair *pair);

/* Where the next picture goes: depth as rig->depth.width x height uint16_t, colour as RGBA. */
uint16_t *io_stream_pair_depth(io_stream_pair *pair);
rlf_image_rgba8 io_stream_pair_color(io_stream_pair *pair);

/* The picture is there. `index` is the device's count of depth pictures; -1 = it has none, and lost
 * ones are told by the time. A second picture of the same time is dropped. */
void io_stream_pair_push_depth(io_stream_pair *pair, int64_t time_ns, int64_t index);
void io_stream_pair_push_color(io_stream_pair *pair, int64_t time_ns);

/* Fills *out when a frame is ready: its colour is within half a frame's time, or can no longer
 * come. `is_last`: nothing more is waited for. */
bool io_stream_pair_take(io_stream_pair *pair, bool is_last, rlf_frame *out);

/* Copies a row of `width` pixels of 3 bytes as RGBA, turned round when `flips`. */
void io_rgb_row(const uint8_t *rgb, int32_t width, bool flips, uint8_t *out_rgba);
void io_depth_row(const uint16_t *depth, int32_t width, bool flips, uint16_t *out);

#endif
