/* A recorded clip as a source: pairs depth with colour by time, counts what is missing, goes to any
 * frame. Every file format gives its frames through this one. */
#ifndef RLF_IO_CLIP_CLIP_H
#define RLF_IO_CLIP_CLIP_H

#include "io/file.h"
#include "io/source/address.h"
#include "relief/backend.h"
#include "relief/base.h"
#include "relief/frame.h"

/* Colour farther in time than this shows something else than the depth (one and a half frames at
 * 30 per second; TUM clips differ by up to 20 ms). */
#define IO_COLOR_GAP_MAX_NS INT64_C(50000000)

#define IO_FRAME_NOTE_TEXT 128

/* What a recording keeps of a frame that its pictures and their times do not tell. */

/* A frame is as usual when its number is one more than that of the frame before (0 for the first),
 * its flags are those of the whole recording, and its colour is the picture nearest in time. */
typedef struct io_frame_note {
    int64_t time_ns; /* of the frame */
    uint64_t sequence;
    uint32_t flags;
    bool has_color;
    int64_t color_time_ns;
} io_frame_note;

/* Follows the frames of a recording and says which of them are not as usual. */
typedef struct io_frame_notes {
    uint32_t flags;        /* of the whole recording */
    bool has_color_camera; /* else no frame has colour, which is as usual */
    bool has_last, has_color;
    uint64_t last_sequence;
    int64_t color_ns[2];  /* the last two pictures */
    io_frame_note opener; /* the first frame with the last picture, while it is not noted */
} io_frame_notes;

/* Writes at most two notes: of this frame, and of an earlier one to which this frame's picture is
 * nearer than its own. Returns how many. */
int32_t io_frame_notes_add(io_frame_notes *notes, const rlf_frame *frame, io_frame_note out[2]);

/* One line of JSON. */
void io_frame_note_print(const io_frame_note *note, char out[IO_FRAME_NOTE_TEXT]);
/* False for a text that is none. */
bool io_frame_note_parse(const char *text, io_frame_note *out);

/* The note of the frame with that time, of a list that is sorted by time; NULL = there is none. */
const io_frame_note *io_frame_note_find(const io_frame_note *notes, int32_t count, int64_t time_ns);
void io_frame_notes_sort(io_frame_note *notes, int32_t count);

/* ---- Pairs of depth and colour pictures by their times ---- */

/* Whether it lies within RLF_TIME_MAX_NS, so that any two times can be subtracted. */
bool io_time_is_usable(int64_t time_ns);

/* a + b, wrapped around: clocks of bad drivers may say anything. */
static inline int64_t io_time_sum(int64_t a_ns, int64_t b_ns)
{
    return (int64_t)((uint64_t)a_ns + (uint64_t)b_ns);
}

/* Times that do not decrease: of an array, or the first members of an array's items. */
typedef struct io_times {
    const void *first;
    size_t step; /* bytes from one to the next */
    int32_t count;
} io_times;

static inline int64_t io_time_at(const io_times *times, int32_t index)
{
    return *(const int64_t *)(const void *)((const char *)times->first +
                                            (size_t)index * times->step);
}

/* Index of the time nearest to time_ns (the earlier of two equally near), or -1 when there is none
 * or the nearest is more than max_gap_ns away. */
int32_t io_time_nearest(const io_times *times, int64_t time_ns, int64_t max_gap_ns);

/* Median interval, nanoseconds; 0 when there are fewer than two times. */
rlf_result io_time_interval(const io_times *times, int64_t *out_ns);

/* How many frames are missing between two of them that are `gap_ns` apart: 0 up to one and a half
 * intervals. */
int64_t io_time_lost(int64_t gap_ns, int64_t interval_ns);

/* A picture of a recording: when it was taken, and where its bytes are. */
typedef struct io_shot {
    int64_t time_ns;
    int64_t position; /* in the file, or its number where the reader has a list of its own */
    uint32_t size;    /* bytes */
} io_shot;

typedef struct io_shots {
    io_shot *items;
    int32_t count, room;
} io_shots;

/* `file` is for the error line of one picture too many. */
rlf_result io_shots_add(io_shots *shots, const char *file, io_shot shot);
/* By time, and by place where times are equal. False when they were in order. */
bool io_shots_sort(io_shots *shots);
io_times io_shots_times(const io_shots *shots);
void io_shots_free(io_shots *shots);

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

/* What a reader knows once its file is open. What is pointed to is copied. */
typedef struct io_clip_def {
    const char *name;   /* path, for error lines */
    const char *device; /* for rlf_source_info; NULL = as the caller fills it in */
    rlf_rig rig;
    double units_per_metre; /* of u16 depth; 0 = depth is float, metres */
    io_times depth, color;  /* no colour: none of its times */
    const rlf_pose *poses;  /* T_world_camera of each depth frame; NULL = none; a quaternion that is
                               not of unit length = none for that frame */
    int64_t color_gap_max_ns; /* colour farther in time is not paired; 0 = 50 ms */
    uint32_t flags;           /* rlf_frame_flag of every frame */
    io_clip_origin origin;
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

/* ---- Calibration of recordings that hold none ---- */

/* The user's own (?camera=FILE), else FILE.json beside the recording FILE.xyz, else camera.json in
 * its folder. *out_found tells whether there is one; when there is none the others keep what they
 * hold. */
rlf_result io_rig_beside(const rlf_address *address, rlf_rig *out, double *out_units_per_metre,
                         bool *out_found);
/* Such a calibration may be of other pictures than those that are there, of depth or of a topic. */
rlf_result io_rig_check_size(const char *name, const char *what, int64_t width, int64_t height,
                             const rlf_camera *camera);

/* How a recording is played: keys of a SOURCE that every back end of files understands. */

#define IO_REPLAY_FILE_KEYS "loop speed start count drop seed aligned"
#define IO_REPLAY_LIVE_KEYS "aligned direct" /* of what cannot be played again */

typedef struct io_replay {
    bool is_wanted; /* at least one key of playing was given */
    bool is_direct; /* a camera without a thread of its own: every frame in turn */
    bool loop;
    double speed;    /* 1 = as recorded, 2 = twice as fast; 0 = as fast as it is asked */
    int64_t start;   /* first frame */
    int64_t count;   /* frames from there on; 0 = to the end */
    double drop;     /* share of the frames to lose, 0..1 */
    uint64_t seed;   /* of which ones */
    int32_t aligned; /* -1 = as the file says */
} io_replay;

/* Takes out the keys above but for those that the back end has as its own. */
rlf_result io_replay_take(io_address *parts, const rlf_backend *backend, io_replay *out);

/* Puts the playing around the parts of a source. On failure they are left as they were. */
rlf_result io_replay_wrap(const io_replay *replay, const char *source, rlf_opened *inout);

/* ---- A frame that stays while its source goes on ---- */

typedef struct io_frame_copy {
    rlf_frame frame; /* its planes are the slot's */
    void *depth;     /* of either kind */
    uint8_t *color, *confidence;
} io_frame_copy;

rlf_result io_frame_copy_create(const rlf_rig *rig, io_frame_copy *out);
void io_frame_copy_destroy(io_frame_copy *slot);

/* A frame that rlf_frame_check allows. */
void io_frame_copy_set(io_frame_copy *slot, const rlf_rig *rig, const rlf_frame *frame);

#endif
