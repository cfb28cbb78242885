/* What all live cameras need: their modes, the user's calibration, and counts of what was lost. */
#ifndef RLF_IO_LIVE_DRIVER_H
#define RLF_IO_LIVE_DRIVER_H

#include "relief/backend.h"
#include "relief/base.h"
#include "relief/camera.h"
#include "relief/source.h"

/* How long a live source's `next` waits before it says RLF_NO_FRAME. */
#define IO_LIVE_WAIT_MS 100

/* Random error of time-of-flight cameras, frontal surfaces (Fankhauser et al. 2015, Kinect v2). */
#define IO_TIME_OF_FLIGHT_NOISE ((rlf_depth_noise){0.0015, -0.0005, 0.0003})

/* A picture's size and rate as a user asks for it; 0 = any. */
typedef struct io_mode {
    int32_t width, height;
    int32_t frames_per_second;
} io_mode;

/* Value of `key` as WIDTHxHEIGHT@RATE or WIDTHxHEIGHT; *out is left alone when it was not given. */
rlf_result io_mode_get(const rlf_address *address, const char *key, io_mode *out);

/* Value of `key`, 0 or 1; *out is left alone when it was not given. */
rlf_result io_switch_get(const rlf_address *address, const char *key, int *out);

/* What a live camera's open tells, but for the device's name. */
void io_live_opened(const rlf_source_methods *methods, void *self, const char *source,
                    const rlf_rig *rig, double frames_per_second, rlf_opened *out);

/* Room for pictures of the rig's colour camera; *out stays as it is where there is none. */
rlf_result io_live_make_color(const rlf_rig *rig, rlf_image_rgba8 *out);

/* Puts the user's calibration (?camera=FILE) in place of the device's; an error when its pictures
 * have another size. */
rlf_result io_live_use_rig(const rlf_address *address, rlf_rig *rig);

/* A driver's transform: nine numbers of a rotation, row by row, and a translation in units of
 * `metres`. False when it is no rotation. */
bool io_live_pose(const float rotation[9], const float translation[3], double metres,
                  rlf_pose *out);

/* Order of the frames of one device. Zero before the first. */
typedef struct io_live_count {
    bool has_last;
    uint64_t number;     /* the device's, of the last frame */
    int64_t time_ns;     /* the device's, of the last frame */
    int64_t offset_ns;   /* from the device's time to what is told, which never goes back */
    int64_t interval_ns; /* nominal; set by the caller */
    bool is_restarted;   /* set by the caller: the next frame's time is of another clock */
    uint64_t sequence;
    uint64_t lost, doubled;
    uint64_t damaged, unpaired; /* counted by the caller */
} io_live_count;

/* A device's microseconds in nanoseconds; 0 for more than RLF_TIME_MAX_NS. */
int64_t io_live_time(uint64_t microseconds);

/* Sets sequence, time_ns and the flag of a discontinuity of *out from the device's count and time.
 * False when the frame is the last one again: it must not be given. A count or a time that goes
 * back is a device that started anew. */
bool io_live_count_frame(io_live_count *c, uint64_t number, int64_t time_ns, rlf_frame *out);

/* The counts, as a source tells them. */
void io_live_count_tell(const io_live_count *c, rlf_source_status *out);

/* For devices without a count: told from the gap of two times and the nominal interval. */
bool io_live_count_time(io_live_count *c, int64_t time_ns, rlf_frame *out);

/* Driver libraries that are opened when a camera is asked for: a program made without a vendor's
 * development files still runs every camera whose library is installed. */

/* A function of the library, and where its pointer goes in the caller's table. */
typedef struct io_symbol {
    const char *name;
    size_t offset;
    bool is_optional; /* its pointer stays NULL in versions that have none */
} io_symbol;

typedef struct io_library {
    const char *variable; /* of the environment: path of the library to take instead */
    const char *folder;   /* of the environment: a folder that is looked in first; NULL = none */
    const char *const *names; /* tried in turn, "%d" as each of the versions; NULL past the last */
    int32_t newest, oldest;   /* versions */
    const char *cure;         /* what to install */
    const io_symbol *symbols;
    int32_t symbol_count;
    void *table; /* of pointers to fill */
    const char *(*check)(
        void); /* what is wrong with a library that was loaded; NULL = nothing can be */
    bool is_tried, is_loaded; /* the last three are filled in */
    char reason[320];
} io_library;

/* A driver's `unavailable`: NULL, and the table is filled, or a line that says what is missing and
 * what to do. The library is loaded when it is first asked for, and stays: drivers leave threads
 * behind. Relief asks before it lists or opens. Thread-safe. */
const char *io_library_fault(io_library *library);

/* ---- A lens model from the fields of view that a device or a file tells ---- */

/* Angles in radians. The fields of view cover whole pixels, so the centre lies between the middle
 * ones. False: they are no angles, and out is a typical PrimeSense camera (58 degrees). */
bool io_camera_from_fov(int32_t width, int32_t height, double fov_x, double fov_y, rlf_camera *out);

/* A lens that is known only by where it puts rays, as Relief's plumb_bob model. */

typedef struct io_lens_sample {
    double x, y; /* ray (x, y, 1) */
    double u, v; /* its pixel */
} io_lens_sample;

/* Sets the camera's distortion to the k1 k2 p1 p2 k3 that fit best; fx, fy, cx, cy are given.
 * Returns the largest distance that is left, pixels; infinity when nothing fits, and then the
 * camera is left without distortion. */
double io_lens_fit(const io_lens_sample *samples, int32_t count, rlf_camera *camera);

/* ---- Linear least squares with few unknowns, by normal equations ---- */

#define IO_UNKNOWNS_MAX 16

/* Zero but for `count` before the first row. */
typedef struct io_least_squares {
    int32_t count; /* unknowns */
    double a[IO_UNKNOWNS_MAX][IO_UNKNOWNS_MAX];
    double b[IO_UNKNOWNS_MAX];
} io_least_squares;

/* One equation: the sum of row[i] x[i] is `value`. */
void io_least_squares_add(io_least_squares *ls, const double *row, double value);

/* Writes the `count` unknowns; false when the rows do not determine them. Uses *ls up. */
bool io_least_squares_solve(io_least_squares *ls, double *out);

/* Depth and colour pictures that a live device sends as two streams, paired by their times. */

#define IO_STREAM_SLOTS 4

/* A picture that arrived. */
typedef struct io_stream_slot {
    void *data;
    int64_t time_ns; /* the device's own */
    int64_t host_time_ns;
    uint64_t sequence; /* of depth */
} io_stream_slot;

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

/* Where the next picture goes: depth as rig->depth.width x height uint16_t, colour as RGBA. */
uint16_t *io_stream_pair_depth(io_stream_pair *pair);
rlf_image_rgba8 io_stream_pair_color(io_stream_pair *pair);

/* The picture is there. `index` is the device's count of depth pictures; -1 = it has none, and lost
 * ones are told by the time. A second picture of the same time is dropped. */
void io_stream_pair_push_depth(io_stream_pair *pair, int64_t time_ns, int64_t index);
void io_stream_pair_push_color(io_stream_pair *pair, int64_t time_ns);

/* A rlf_source's `next`: pumps until a frame is ready, for IO_LIVE_WAIT_MS at most. `pump` waits at
 * most so long for a picture and pushes it; an error of it is returned. */
rlf_result io_stream_pair_next(io_stream_pair *pair,
                               rlf_result (*pump)(void *self, int32_t wait_ms), void *self,
                               rlf_frame *out);

/* Copies a row of `width` pixels of 3 bytes as RGBA, turned round when `flips`. */
void io_rgb_row(const uint8_t *rgb, int32_t width, bool flips, uint8_t *out_rgba);
void io_depth_row(const uint16_t *depth, int32_t width, bool flips, uint16_t *out);

#endif
