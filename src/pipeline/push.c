/* A camera that calls its program back has no `next` to ask: its frames are pushed. They go through
 * a source of one frame, so that they are checked as any source's. */
#include "pipeline/push.h"

static rlf_result next(void *self, rlf_frame *out_frame)
{
    pushed_frame *slot = self;
    if (!slot->is_full) {
        return RLF_NO_FRAME;
    }
    slot->is_full = false;
    *out_frame = slot->frame;
    return RLF_OK;
}

static rlf_result restart(void *self)
{
    ((pushed_frame *)self)->is_full = false;
    return RLF_OK;
}

rlf_result pushed_frame_open(pushed_frame *slot, const rlf_rig *rig)
{
    const rlf_source_methods methods = {.next = next, .restart = restart};
    const rlf_source_info info = {.name = "pushed frame", .rig = *rig, .frame_count = -1};
    slot->is_full = false;
    return rlf_source_create_custom(&methods, &info, slot, &slot->source);
}

void pushed_frame_put(pushed_frame *slot, const rlf_frame *frame)
{
    slot->is_full = frame != NULL;
    slot->frame = frame != NULL ? *frame : (rlf_frame){0};
}

void pushed_frame_close(pushed_frame *slot)
{
    rlf_source_destroy(&slot->source);
}
