/* How a recording is played: over and over, at a speed, a part of it, with lost frames. */
#define _POSIX_C_SOURCE 200809L
#include "io/clip/clip.h"

#include <time.h>

#define WAIT_MAX_NS 50000000 /* a call sleeps no longer: the caller has a window to serve */
/* A caller that comes later than this paused: playing goes on from where it is. */
#define LATE_MAX_NS 250000000
#define INTERVAL_DEFAULT_NS 33333333 /* over the seam of a loop when the rate is not known */

/* Of a slower recording the rate is taken as unknown, and no frame is due later than that. */
#define RATE_MIN 1e-9
#define SINCE_MAX_NS 9e18

typedef struct replay {
    io_replay keys;
    rlf_opened inner;
    int64_t begin, end; /* frames of the recording; end -1 = unknown */
    int64_t position;   /* of the recording's next frame */
    /* What the seams of a loop add. */
    int64_t time_offset_ns, sequence_offset;
    int64_t interval_ns, last_time_ns;
    uint64_t last_sequence;
    uint64_t dropped, frames_in; /* frames_in counts over all loops */
    bool is_first, has_jumped, is_at_seam;
    /* Playing at a speed: a frame is read, and given when it is due. */
    bool is_held, is_started;
    rlf_frame held;
    int64_t due_base_ns, time_base_ns;
    io_frame_copy given; /* must stay while the next one is waited for */
} replay;

/* SplitMix64 (Steele, Lea and Flood 2014) of the frame's number. */
static bool is_dropped(const replay *r, int64_t index)
{
    uint64_t z = r->keys.seed * UINT64_C(1000003) + r->frames_in;
    z = (z + 1) * UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    const double share = (double)((z ^ (z >> 31)) >> 11) / 9007199254740992.0;
    /* Not the last one: reading it would spoil the planes of the frame given before the end. */
    const bool is_last = r->end >= 0 && index + 1 >= r->end;
    return share < r->keys.drop && !is_last;
}

static rlf_result go_to_begin(replay *r)
{
    const rlf_source_methods *m = &r->inner.methods;
    r->position = r->begin;
    if (r->begin == 0 && m->restart != NULL) {
        return m->restart(r->inner.self);
    }
    return m->seek(r->inner.self, r->begin);
}

/* Over the seam the times go on by one interval. */
static rlf_result start_again(replay *r)
{
    rlf_result result = go_to_begin(r);
    r->has_jumped = true;
    r->is_first = true;
    return result;
}

static rlf_result fail_time(const replay *r, int64_t time_ns)
{
    return rlf_fail(RLF_ERROR_FORMAT,
                    "%s: a frame has the time %lld ns, more than 146 years: record it again, or "
                    "correct its times",
                    r->inner.info.name, (long long)time_ns);
}

/* Time and count go on over the seam of a loop. */
static rlf_result renumber(replay *r, rlf_frame *f)
{
    if (!io_time_is_usable(f->time_ns)) {
        return fail_time(r, f->time_ns);
    }
    if (r->is_first && r->has_jumped) {
        r->time_offset_ns = io_time_sum(r->last_time_ns, r->interval_ns - f->time_ns);
        r->sequence_offset = (int64_t)(r->last_sequence + 1 - f->sequence);
        r->is_at_seam = true;
    }
    const bool has_color_time = f->color_time_ns != 0;
    f->time_ns = io_time_sum(f->time_ns, r->time_offset_ns);
    f->color_time_ns = has_color_time ? io_time_sum(f->color_time_ns, r->time_offset_ns) : 0;
    if (!io_time_is_usable(f->time_ns)) {
        return fail_time(r, f->time_ns);
    }
    f->sequence += (uint64_t)r->sequence_offset;
    if (r->is_first) {
        f->flags &= ~(uint32_t)RLF_FRAME_DISCONTINUITY; /* of going to `start` */
    }
    r->last_time_ns = f->time_ns;
    r->last_sequence = f->sequence;
    r->is_first = false;
    return RLF_OK;
}

static void set_flags(replay *r, rlf_frame *f)
{
    f->flags |= r->is_at_seam ? (uint32_t)RLF_FRAME_DISCONTINUITY : 0u;
    r->is_at_seam = false;
    if (r->keys.aligned >= 0) {
        f->flags &= ~(uint32_t)RLF_FRAME_ALIGNED;
        f->flags |= r->keys.aligned != 0 ? (uint32_t)RLF_FRAME_ALIGNED : 0u;
    }
}

/* Reads on until there is a frame that is not to be lost. */
static rlf_result read_on(replay *r, rlf_frame *out)
{
    bool is_over = r->end >= 0 && r->position >= r->end;
    if (is_over && r->keys.loop) {
        rlf_result result = start_again(r);
        if (result != RLF_OK) {
            return result;
        }
        is_over = false;
    }
    for (;;) {
        rlf_result result = is_over ? RLF_END : r->inner.methods.next(r->inner.self, out);
        if (result == RLF_NO_FRAME || result == RLF_END) {
            return result;
        }
        const int64_t index = r->position++;
        result = result == RLF_OK ? renumber(r, out) : result;
        if (result != RLF_OK || !is_dropped(r, index)) {
            r->frames_in++;
            return result;
        }
        r->frames_in++;
        r->dropped++;
    }
}

static rlf_result read_frame(replay *r, rlf_frame *out)
{
    rlf_result result = read_on(r, out);
    if (result == RLF_END && r->keys.loop && r->frames_in > 0 && !r->is_first) {
        /* The recording is shorter than it said, or says nothing of its length. */
        result = start_again(r);
        result = result == RLF_OK ? read_on(r, out) : result;
    }
    if (result == RLF_OK) {
        set_flags(r, out);
    }
    return result;
}

/* RLF_OK once the held frame is due. */
static rlf_result wait_for_due(replay *r)
{
    const int64_t now_ns = rlf_clock_ns();
    const double since = (double)(r->held.time_ns - r->time_base_ns) / r->keys.speed;
    const int64_t since_ns = (int64_t)rlf_clamp(since, -SINCE_MAX_NS, SINCE_MAX_NS);
    int64_t wait_ns = r->is_started ? r->due_base_ns + since_ns - now_ns : 0;
    if (!r->is_started || wait_ns < -LATE_MAX_NS) {
        r->is_started = true;
        r->due_base_ns = now_ns;
        r->time_base_ns = r->held.time_ns;
        return RLF_OK;
    }
    if (wait_ns <= 0) {
        return RLF_OK;
    }
    const int64_t sleep_ns = wait_ns < WAIT_MAX_NS ? wait_ns : WAIT_MAX_NS;
    const struct timespec rest = {0, (long)sleep_ns};
    nanosleep(&rest, NULL);
    return sleep_ns == wait_ns ? RLF_OK : RLF_NO_FRAME;
}

static rlf_result replay_next(void *self, rlf_frame *out)
{
    replay *r = self;
    if (r->keys.speed <= 0.0) {
        return read_frame(r, out);
    }
    if (!r->is_held) {
        rlf_result result = read_frame(r, &r->held);
        if (result != RLF_OK) {
            return result;
        }
        r->is_held = true;
    }
    rlf_result result = wait_for_due(r);
    if (result == RLF_OK) {
        io_frame_copy_set(&r->given, &r->inner.info.rig, &r->held);
        *out = r->given.frame;
        r->is_held = false;
    }
    return result;
}

static rlf_result replay_seek(void *self, int64_t index)
{
    replay *r = self;
    if (r->end >= 0 && r->begin + index >= r->end) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: there is no frame %lld: use 0 to %lld",
                        r->inner.info.name, (long long)index, (long long)(r->end - r->begin - 1));
    }
    rlf_result result = r->inner.methods.seek(r->inner.self, r->begin + index);
    r->position = r->begin + index;
    r->is_held = r->is_started = r->is_first = r->is_at_seam = false;
    r->time_offset_ns = r->sequence_offset = 0;
    return result;
}

static rlf_result replay_restart(void *self)
{
    replay *r = self;
    r->is_held = r->is_started = r->has_jumped = r->is_at_seam = false;
    r->is_first = true;
    r->time_offset_ns = r->sequence_offset = 0;
    r->frames_in = 0;
    return go_to_begin(r);
}

static const rlf_truth *replay_truth(void *self)
{
    replay *r = self;
    return r->inner.methods.truth(r->inner.self);
}

static void replay_status(void *self, rlf_source_status *out)
{
    const replay *r = self;
    if (r->inner.methods.status != NULL) {
        r->inner.methods.status(r->inner.self, out);
    }
    out->lost += r->dropped;
}

static void free_replay(replay *r)
{
    io_frame_copy_destroy(&r->given);
    rlf_free(r);
}

static void replay_destroy(void *self)
{
    replay *r = self;
    if (r->inner.methods.destroy != NULL) {
        r->inner.methods.destroy(r->inner.self);
    }
    free_replay(r);
}

/* The part of the recording that is given, and whether this source can be played so. */
static rlf_result set_range(replay *r, const char *source)
{
    const rlf_source_info *info = &r->inner.info;
    const rlf_source_methods *m = &r->inner.methods;
    const io_replay *k = &r->keys;
    r->begin = k->start;
    r->end = info->frame_count;
    if (r->end >= 0 && k->start >= r->end) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: start=%lld: there are %lld frames: use 0 to %lld",
                        source, (long long)k->start, (long long)r->end, (long long)r->end - 1);
    }
    if (k->count > 0 && (r->end < 0 || k->count < r->end - k->start)) {
        r->end = k->start + k->count;
    }
    if ((k->start > 0 && m->seek == NULL) ||
        (k->loop && m->seek == NULL && (m->restart == NULL || k->start > 0))) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: this source has no position to go to: leave start and loop out",
                        source);
    }
    return k->start > 0 ? go_to_begin(r) : RLF_OK;
}

/* Aligned pictures have one camera, at two sizes perhaps. */
static void set_aligned(rlf_rig *rig)
{
    if (rig->has_color) {
        rig->color = rlf_camera_resize(&rig->depth, rig->color.width, rig->color.height);
        rig->T_color_depth = rlf_pose_identity();
    }
}

static void describe(replay *r, rlf_opened *inout)
{
    const rlf_source_methods *inner = &r->inner.methods;
    inout->methods = (rlf_source_methods){
        .next = replay_next,
        .restart = inner->restart != NULL || inner->seek != NULL ? replay_restart : NULL,
        .truth = inner->truth != NULL ? replay_truth : NULL,
        .destroy = replay_destroy,
        .seek = inner->seek != NULL ? replay_seek : NULL,
        .status = replay_status,
    };
    inout->self = r;
    inout->info.frame_count = r->keys.loop || r->end < 0 ? -1 : r->end - r->begin;
    const double rate = inout->info.frames_per_second;
    r->interval_ns = rate > RATE_MIN ? (int64_t)(1e9 / rate + 0.5) : INTERVAL_DEFAULT_NS;
    if (r->keys.aligned == 1) {
        set_aligned(&inout->info.rig);
    }
}

rlf_result io_replay_wrap(const io_replay *keys, const char *source, rlf_opened *inout)
{
    replay *r = rlf_alloc(sizeof(*r));
    if (r == NULL) {
        return RLF_ERROR_MEMORY;
    }
    r->keys = *keys;
    r->inner = *inout;
    r->is_first = true;
    rlf_result result = set_range(r, source);
    if (result == RLF_OK && keys->speed > 0.0) {
        result = io_frame_copy_create(&r->inner.info.rig, &r->given);
    }
    if (result != RLF_OK) {
        free_replay(r);
        return result;
    }
    r->position = r->begin;
    describe(r, inout);
    return RLF_OK;
}
