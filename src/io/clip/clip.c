/* A recorded clip as a source. */
#include "io/clip/clip.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* So many frames in a row that cannot be read end the clip: it is not this or that picture. */
#define UNREAD_MAX 10

/* A depth frame that is given: where it is, and the colour picture that goes with it. */
typedef struct clip_frame {
    int32_t depth, color; /* indices into the reader's times; color -1 = none */
    int64_t time_ns, color_time_ns;
    int64_t sequence; /* with the frames that the camera lost before it */
    uint32_t flags;
    rlf_pose pose;
    bool has_pose;
} clip_frame;

typedef struct clip {
    io_clip_def def;
    char name[4096];
    clip_frame *frames;
    int32_t count, next;
    bool is_continued; /* the next frame follows the one given last */
    int32_t shown_color;
    void *depth;
    rlf_image_rgba8 color;
    uint64_t doubled, unpaired, lost;
    uint64_t unread, unread_color; /* pictures */
    int32_t unread_in_a_row;
    bool has_given, has_told_first, has_told;
    char first_error[512]; /* of a depth picture */
} clip;

static rlf_result read_color(clip *c, int32_t index)
{
    if (index == c->shown_color) {
        return RLF_OK;
    }
    c->shown_color = -1; /* a failed decoding may leave half a picture */
    rlf_result result = c->def.read_color(c->def.self, index, &c->color);
    if (result == RLF_OK) {
        c->shown_color = index;
    }
    return result;
}

static void fill_frame(const clip *c, const clip_frame *f, bool has_color, rlf_frame *out)
{
    const bool is_float = c->def.units_per_metre <= 0.0;
    memset(out, 0, sizeof(*out));
    out->sequence = (uint64_t)f->sequence;
    out->time_ns = f->time_ns;
    out->color_time_ns = has_color ? f->color_time_ns : 0;
    out->flags = f->flags | (c->is_continued ? 0u : (uint32_t)RLF_FRAME_DISCONTINUITY);
    out->depth_f32 = is_float ? c->depth : NULL;
    out->depth_u16 = is_float ? NULL : c->depth;
    out->depth_stride = (ptrdiff_t)c->def.rig.depth.width * (is_float ? 4 : 2);
    out->depth_units_per_metre = c->def.units_per_metre;
    out->color = has_color ? c->color : (rlf_image_rgba8){0};
    out->has_pose = f->has_pose;
    out->T_world_camera = f->pose;
}

static void count_given(clip *c, const clip_frame *f)
{
    if (c->is_continued && f > c->frames) {
        const int64_t step = f->sequence - f[-1].sequence; /* a count may have begun anew */
        c->lost += step > 1 ? (uint64_t)step - 1 : 0;
    }
    c->unpaired += c->def.color.count > 0 && f->color < 0 ? 1 : 0;
}

/* A depth picture that cannot be read leaves its frame out. */
static rlf_result leave_out(clip *c, rlf_result result)
{
    char reason[sizeof(c->first_error)];
    snprintf(reason, sizeof(reason), "%s", rlf_error_text());
    if (c->unread++ == 0) {
        memcpy(c->first_error, reason, sizeof(reason));
    }
    if (++c->unread_in_a_row < UNREAD_MAX) {
        return RLF_OK;
    }
    c->unread_in_a_row = 0;
    return rlf_fail(result, "%s (and the %d frames before it could not be read either)", reason,
                    UNREAD_MAX - 1);
}

/* The first one, once it is known that others can be read. */
static void tell_first(clip *c)
{
    if (c->unread > 0 && !c->has_told_first) {
        c->has_told_first = true;
        rlf_log(RLF_LOG_WARNING, "%s; frames that cannot be read are left out", c->first_error);
    }
}

/* Depth counts: without its colour picture a frame goes without colour. */
static bool find_color(clip *c, const clip_frame *f)
{
    if (f->color < 0 || read_color(c, f->color) == RLF_OK) {
        return f->color >= 0;
    }
    if (c->unread_color++ == 0) {
        rlf_log(RLF_LOG_WARNING, "%s; such frames have no colour", rlf_error_text());
    }
    return false;
}

/* One line about what could not be read, when the clip is over. */
static void tell_unread(clip *c)
{
    if (c->has_told || !c->has_given) {
        return;
    }
    c->has_told = true;
    tell_first(c);
    if (c->unread > 0) {
        rlf_log(RLF_LOG_WARNING, "%s: %llu of %d depth pictures could not be read: left out",
                c->name, (unsigned long long)c->unread, (int)c->count);
    }
    if (c->unread_color > 0) {
        rlf_log(RLF_LOG_WARNING,
                "%s: %llu colour pictures could not be read: frames without colour", c->name,
                (unsigned long long)c->unread_color);
    }
}

static rlf_result end_clip(clip *c)
{
    tell_unread(c);
    return c->has_given || c->unread == 0
               ? RLF_END
               : rlf_fail(RLF_ERROR_FORMAT, "%s (and no other frame could be read)",
                          c->first_error);
}

static rlf_result clip_next(void *self, rlf_frame *out)
{
    clip *c = self;
    while (c->next < c->count) {
        /* A frame that fails is passed over by the next call: the caller may go on. */
        const clip_frame *f = &c->frames[c->next++];
        rlf_result result = c->def.read_depth(c->def.self, f->depth, c->depth);
        if (result == RLF_OK) {
            tell_first(c);
            count_given(c, f);
            fill_frame(c, f, find_color(c, f), out);
            c->is_continued = c->has_given = true;
            c->unread_in_a_row = 0;
            return RLF_OK;
        }
        result = result == RLF_ERROR_MEMORY ? result : leave_out(c, result);
        if (result != RLF_OK) {
            return result;
        }
    }
    return end_clip(c);
}

static rlf_result clip_seek(void *self, int64_t index)
{
    clip *c = self;
    c->next = (int32_t)index;
    c->is_continued = index == 0;
    return RLF_OK;
}

static rlf_result clip_restart(void *self)
{
    return clip_seek(self, 0);
}

static void clip_status(void *self, rlf_source_status *out)
{
    const clip *c = self;
    out->lost = c->lost;
    out->doubled = c->doubled;
    out->unpaired = c->unpaired;
    out->damaged = c->unread + c->unread_color;
}

static void free_clip(clip *c)
{
    rlf_free(c->frames);
    rlf_free(c->depth);
    rlf_free(c->color.data);
    rlf_free(c);
}

static void clip_destroy(void *self)
{
    clip *c = self;
    tell_unread(c);
    if (c->def.destroy != NULL) {
        c->def.destroy(c->def.self);
    }
    free_clip(c);
}

/* What the times tell: the frame's number and its colour. */
static void follow_times(const clip *c, int64_t interval_ns, clip_frame *f)
{
    const io_clip_def *d = &c->def;
    const int64_t gap_max = d->color_gap_max_ns > 0 ? d->color_gap_max_ns : IO_COLOR_GAP_MAX_NS;
    if (f > c->frames) {
        const int64_t gap_ns = f->time_ns - f[-1].time_ns;
        f->sequence =
            f[-1].sequence + 1 + (d->origin.has_notes ? 0 : io_time_lost(gap_ns, interval_ns));
    }
    f->flags = d->flags;
    f->color = io_time_nearest(&d->color, f->time_ns, gap_max);
}

static void follow_note(const clip *c, clip_frame *f)
{
    const io_clip_def *d = &c->def;
    const io_frame_note *note =
        io_frame_note_find(d->origin.notes, d->origin.note_count, f->time_ns);
    if (note == NULL) {
        return;
    }
    f->sequence = (int64_t)note->sequence;
    f->flags = note->flags;
    f->color = note->has_color ? io_time_nearest(&d->color, note->color_time_ns, 0) : -1;
}

/* Of two frames with the same time the first is given. */
static void list_frames(clip *c, int64_t interval_ns)
{
    const io_clip_def *d = &c->def;
    for (int32_t i = 0; i < d->depth.count; i++) {
        const int64_t time_ns = io_time_at(&d->depth, i);
        if (c->count > 0 && time_ns == c->frames[c->count - 1].time_ns) {
            c->doubled++;
            continue;
        }
        clip_frame *f = &c->frames[c->count++];
        f->depth = i;
        f->time_ns = time_ns;
        follow_times(c, interval_ns, f);
        follow_note(c, f);
        f->color_time_ns = f->color >= 0 ? io_time_at(&d->color, f->color) : 0;
        f->pose = d->poses != NULL ? d->poses[i] : rlf_pose_identity();
        const rlf_quat q = f->pose.q;
        const double square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
        f->has_pose =
            d->poses != NULL && fabs(square - 1.0) < 1e-3 && rlf_vec3_is_finite(f->pose.p);
    }
    /* The reader's arrays were the caller's. */
    c->def.depth.first = c->def.color.first = NULL;
    c->def.poses = NULL;
    c->def.origin.notes = NULL;
}

static rlf_result allocate(clip *c)
{
    const rlf_rig *rig = &c->def.rig;
    const size_t depth_size = c->def.units_per_metre > 0.0 ? 2 : 4;
    c->frames = rlf_alloc_array((size_t)c->def.depth.count, sizeof(c->frames[0]));
    c->depth = rlf_alloc_array((size_t)rig->depth.width * (size_t)rig->depth.height, depth_size);
    if (c->frames == NULL || c->depth == NULL) {
        return RLF_ERROR_MEMORY;
    }
    if (rig->has_color) {
        const int32_t width = rig->color.width;
        const int32_t height = rig->color.height;
        uint8_t *data = rlf_alloc_array((size_t)width * (size_t)height, 4);
        c->color = (rlf_image_rgba8){data, width, height, (ptrdiff_t)width * 4};
        return data != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    }
    return RLF_OK;
}

static void describe(const clip *c, int64_t interval_ns, rlf_opened *out)
{
    static const rlf_source_methods methods = {.next = clip_next,
                                               .restart = clip_restart,
                                               .destroy = clip_destroy,
                                               .seek = clip_seek,
                                               .status = clip_status};
    memset(out, 0, sizeof(*out));
    out->methods = methods;
    snprintf(out->info.name, sizeof(out->info.name), "%.127s", c->def.name);
    if (c->def.device != NULL) {
        snprintf(out->info.device, sizeof(out->info.device), "%s", c->def.device);
    }
    out->info.rig = c->def.rig;
    out->info.frame_count = c->count;
    const io_clip_origin *origin = &c->def.origin;
    out->info.frames_per_second = origin->frames_per_second > 0.0 ? origin->frames_per_second
                                  : interval_ns > 0               ? 1e9 / (double)interval_ns
                                                                  : 0.0;
    out->info.gravity = origin->gravity;
    out->info.is_simulated = origin->is_simulated;
    out->info.can_seek = true;
}

static rlf_result check_rig(const io_clip_def *def)
{
    rlf_result result = rlf_camera_check(&def->rig.depth, def->name);
    if (result == RLF_OK && def->rig.has_color && def->color.count > 0) {
        result = rlf_camera_check(&def->rig.color, def->name);
    }
    return result;
}

static rlf_result check_times(const char *name, const char *kind, const io_times *times)
{
    for (int32_t i = 0; i < times->count; i++) {
        if (!io_time_is_usable(io_time_at(times, i))) {
            return rlf_fail(RLF_ERROR_FORMAT,
                            "%s: %s picture %d has the time %lld ns, more than 146 years: record "
                            "it again, or correct its times",
                            name, kind, (int)i, (long long)io_time_at(times, i));
        }
    }
    return RLF_OK;
}

rlf_result io_clip_open(const io_clip_def *def, rlf_opened *out)
{
    if (def->depth.count < 1) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: holds no depth pictures", def->name);
    }
    rlf_result result = check_rig(def);
    result = result == RLF_OK ? check_times(def->name, "depth", &def->depth) : result;
    result = result == RLF_OK ? check_times(def->name, "colour", &def->color) : result;
    if (result != RLF_OK) {
        return result;
    }
    clip *c = rlf_alloc(sizeof(*c));
    if (c == NULL) {
        return RLF_ERROR_MEMORY;
    }
    c->def = *def;
    c->def.rig.has_color = def->rig.has_color && def->color.count > 0;
    c->def.color.count = c->def.rig.has_color ? def->color.count : 0;
    snprintf(c->name, sizeof(c->name), "%s", def->name);
    c->def.name = c->name;
    c->shown_color = -1;
    c->is_continued = true;
    int64_t interval_ns = 0;
    result = allocate(c);
    result = result == RLF_OK ? io_time_interval(&def->depth, &interval_ns) : result;
    if (result != RLF_OK) {
        free_clip(c);
        return result;
    }
    list_frames(c, interval_ns);
    describe(c, interval_ns, out);
    out->self = c;
    return RLF_OK;
}
