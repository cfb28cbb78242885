/* A recorded clip as a source: pairs depth with colour by time, counts what is missing, goes to any
 * frame. Every file format gives its frames through this one. */
#ifndef RLF_IO_CLIP_CLIP_H
#define RLF_IO_CLIP_CLIP_H

#include "io/clip/frame_note.h"
#include "relief/backend.h"

#define IO_GRAVITY_MAX 1000.0 /* m/s^2 */
#define IO_RATE_MAX 1e6       /* frames a second */

/* What a recording of Relief's own keeps of its source; all zero = it is none. */
typedef struct io_clip_origin {
    rlf_vec3 gravity; /* as in rlf_source_info */
    bool is_simulated;
    double frames_per_second;   /* 0 = by the times */
    bool has_notes;             /* what is not noted of a frame is as usual */
    const io_frame_note *notes; /* sorted by time */
    int32_t note_count;
} io_clip_origin;

/* What a reader knows once its file is open. Arrays are copied. */
typedef struct io_clip_def {
    const char *name; /* path, for error lines */
    rlf_rig rig;
    double units_per_metre;                   /* of u16 depth; 0 = depth is float, metres */
    const int64_t *depth_times, *color_times; /* nanoseconds, not decreasing */
    int32_t depth_count, color_count;         /* depth_count >= 1; color_count 0 = no colour */
    const rlf_pose *poses; /* T_world_camera of each depth frame; NULL = none; a quaternion that is
                              not of unit length = none for that frame */
    int64_t color_gap_max_ns; /* colour farther in time is not paired; 0 = 50 ms */
    uint32_t flags;           /* rlf_frame_flag of every frame */
    io_clip_origin origin;
    bool skips_damaged; /* a frame that cannot be read is counted and passed over */
    /* Reads entry `index` of the depth times: rig.depth.width x height uint16_t or float. */
    rlf_result (*read_depth)(void *self, int32_t index, void *out);
    /* Reads entry `index` of the colour times into the whole picture. */
    rlf_result (*read_color)(void *self, int32_t index, const rlf_image_rgba8 *out);
    /* Closes the reader. NULL = nothing to close. */
    void (*destroy)(void *self);
    void *self;
} io_clip_def;

/* Makes the source's parts. On failure the reader is left to the caller. */
rlf_result io_clip_open(const io_clip_def *def, rlf_opened *out);

/* Frames per second from the median interval of sorted times; 0 when it cannot be told. */
rlf_result io_clip_rate(const int64_t *times, int32_t count, double *out_frames_per_second);

#endif
