/* Playing a recording: loops, holds and seeks behind the frame loop's back. */
#include "relief/playback.h"

#include <string.h>

#define NS_PER_S 1000000000.0
/* Between two frames that do not follow each other: longer than the second and the ten frames from
 * which on the frame loop lets bodies wait, since nobody saw what was between. */
#define CUT_S 2.0
#define CUT_FRAMES 20.0

struct rlf_playback {
    rlf_source *source;
    rlf_playback_end end;
    rlf_frame last; /* its planes are the source's until its next frame */
    bool has_last, is_cut;
    int64_t index;      /* of `last` */
    int64_t next_index; /* of the source's next frame */
    int64_t offset_ns;  /* added to the source's times */
};

static const char *const end_names[] = {"stop", "loop", "hold"};

bool rlf_playback_parse(const char *text, rlf_playback_end *out)
{
    if (!RLF_ASSERT(text != NULL && out != NULL)) {
        return false;
    }
    for (int i = 0; i < 3; i++) {
        if (strcmp(text, end_names[i]) == 0) {
            *out = (rlf_playback_end)i;
            return true;
        }
    }
    return false;
}

const char *rlf_playback_name(rlf_playback_end end)
{
    return RLF_ASSERT(end >= RLF_PLAYBACK_STOP && end <= RLF_PLAYBACK_HOLD) ? end_names[end] : "";
}

static double frames_per_second(const rlf_playback *p)
{
    const double fps = rlf_source_get_info(p->source)->frames_per_second;
    return fps > 0.0 ? fps : 30.0;
}

/* Time goes on by two seconds, however far the two frames are apart. */
static void join(rlf_playback *p, rlf_frame *frame)
{
    if (p->is_cut && p->has_last) {
        const double cut_s = rlf_max(CUT_S, CUT_FRAMES / frames_per_second(p));
        p->offset_ns = p->last.time_ns + (int64_t)(cut_s * NS_PER_S) - frame->time_ns;
    }
    p->is_cut = false;
    frame->time_ns += p->offset_ns;
}

static rlf_result take(rlf_playback *p, rlf_frame *out)
{
    rlf_result result = rlf_source_next(p->source, out);
    if (result == RLF_OK) {
        join(p, out);
        p->last = *out;
        p->has_last = true;
        p->index = p->next_index++;
    }
    return result;
}

static rlf_result hold(rlf_playback *p, rlf_frame *out)
{
    p->last.time_ns += (int64_t)(NS_PER_S / frames_per_second(p));
    p->is_cut = true;
    *out = p->last;
    return RLF_OK;
}

static rlf_result playback_next(void *self, rlf_frame *out)
{
    rlf_playback *p = self;
    rlf_result result = take(p, out);
    if (result != RLF_END || !p->has_last || p->end == RLF_PLAYBACK_STOP) {
        return result;
    }
    if (p->end == RLF_PLAYBACK_LOOP && rlf_source_restart(p->source) == RLF_OK) {
        p->is_cut = true;
        p->next_index = 0;
        result = take(p, out);
    }
    return result == RLF_END ? hold(p, out) : result;
}

static rlf_result playback_restart(void *self)
{
    rlf_playback *p = self;
    const rlf_result result = rlf_source_restart(p->source);
    if (result == RLF_OK) {
        p->has_last = false;
        p->is_cut = false;
        p->next_index = 0;
        p->offset_ns = 0;
    }
    return result;
}

static const rlf_truth *playback_truth(void *self)
{
    return rlf_source_get_truth(((rlf_playback *)self)->source);
}

static void playback_status(void *self, rlf_source_status *out)
{
    *out = rlf_source_get_status(((rlf_playback *)self)->source);
}

static void playback_destroy(void *self)
{
    rlf_playback *p = self;
    rlf_source_destroy(&p->source);
    rlf_free(p);
}

static rlf_result playback_go(void *self, int64_t index)
{
    return rlf_playback_seek(self, index);
}

rlf_result rlf_playback_wrap(rlf_source **source, rlf_playback_end end, rlf_playback **out)
{
    static const rlf_source_methods methods = {.next = playback_next,
                                               .restart = playback_restart,
                                               .seek = playback_go,
                                               .truth = playback_truth,
                                               .status = playback_status,
                                               .destroy = playback_destroy};
    if (!RLF_ASSERT(source != NULL && *source != NULL && out != NULL)) {
        return rlf_fail(RLF_ERROR_INVALID, "rlf_playback_wrap: NULL");
    }
    rlf_source_info info = *rlf_source_get_info(*source);
    info.rig.depth_offset_m = 0.0; /* is taken away already */
    *out = NULL;
    if (info.is_live) {
        return RLF_OK;
    }
    rlf_playback *p = rlf_alloc(sizeof(*p));
    if (p == NULL) {
        return RLF_ERROR_MEMORY;
    }
    *p = (rlf_playback){.source = *source, .end = end, .index = -1};
    rlf_source *played = NULL;
    const rlf_result result = rlf_source_create_custom(&methods, &info, p, &played);
    if (result != RLF_OK) {
        rlf_free(p);
        return result;
    }
    rlf_source_expect_range(p->source, 0.0, 0.0); /* it is asked of what is played */
    *source = played;
    *out = p;
    return RLF_OK;
}

void rlf_playback_set_end(rlf_playback *p, rlf_playback_end end)
{
    if (RLF_ASSERT(p != NULL)) {
        p->end = end;
    }
}

rlf_playback_end rlf_playback_get_end(const rlf_playback *p)
{
    return RLF_ASSERT(p != NULL) ? p->end : RLF_PLAYBACK_STOP;
}

int64_t rlf_playback_get_index(const rlf_playback *p)
{
    return RLF_ASSERT(p != NULL) ? p->index : 0;
}

int64_t rlf_playback_get_count(const rlf_playback *p)
{
    if (!RLF_ASSERT(p != NULL)) {
        return 0;
    }
    const rlf_source_info *info = rlf_source_get_info(p->source);
    return info->can_seek ? info->frame_count : -1;
}

rlf_result rlf_playback_seek(rlf_playback *p, int64_t index)
{
    if (!RLF_ASSERT(p != NULL)) {
        return rlf_fail(RLF_ERROR_INVALID, "rlf_playback_seek: NULL");
    }
    const rlf_result result = rlf_source_seek(p->source, index);
    if (result == RLF_OK) {
        p->is_cut = index != p->index + 1;
        p->next_index = index;
    }
    return result;
}
