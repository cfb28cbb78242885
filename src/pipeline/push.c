/* A camera that calls its program back has no `next` to ask: its frames are pushed. They go through
 * a source of one frame, so that they are checked as any source's. */
#include "pipeline/push.h"

#include "pipeline/state.h"

#include <string.h>

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

void pushed_frame_close(pushed_frame *slot)
{
    rlf_source_destroy(&slot->source);
}

rlf_result rlf_pipeline_push(rlf_pipeline *p, const rlf_frame *frame, rlf_pipeline_output *out)
{
    if (!RLF_ASSERT(p != NULL && frame != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    if (p->pushed.source == NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "pipeline: it has a source: call rlf_pipeline_step, or "
                                           "make its def with rlf_pipeline_def_for_rig");
    }
    p->pushed.frame = *frame;
    p->pushed.is_full = true;
    rlf_result result = rlf_pipeline_step(p, out);
    p->pushed.is_full = false;
    memset(&p->pushed.frame, 0, sizeof(p->pushed.frame));
    return result;
}
