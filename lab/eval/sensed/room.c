/* Opening what the figures run on, with frames lost on the way if asked. */
#include "eval/sensed/room.h"

#include "command.h"
#include "eval/oracle.h"

#include <string.h>

static rlf_result next_kept(void *self, rlf_frame *out)
{
    eval_room *stage = self;
    rlf_result result = rlf_source_next(stage->truth, out);
    for (int32_t i = 0; i < stage->lost && result == RLF_OK; i++) {
        result = rlf_source_next(stage->truth, out);
    }
    return result;
}

rlf_result eval_room_open(const char *source, int32_t lost, rlf_profile profile, int32_t oracle,
                          eval_room *out)
{
    static const rlf_source_methods methods = {.next = next_kept};
    memset(out, 0, sizeof(*out));
    out->lost = lost;
    rlf_result result = rlf_open_source(source, NULL, &out->truth);
    if (result == RLF_OK && lost > 0) {
        rlf_source_info info = *rlf_source_get_info(out->truth);
        result = rlf_source_create_custom(&methods, &info, out, &out->source);
    }
    if (result == RLF_OK && oracle != 0) {
        result = eval_oracle_create(out->truth, oracle, &out->oracle);
    }
    if (result == RLF_OK) {
        rlf_source *seen = out->source != NULL ? out->source : out->truth;
        rlf_pipeline_def def = rlf_pipeline_def_default(profile, seen, NULL);
        def.enable_render = false;
        def.world.border = RLF_BORDER_EXTEND;
        rlf_vec3 down = {0, 1, 0};
        (void)rlf_synthetic_get_down(out->truth, &down);
        def.world.gravity = rlf_scale(down, 9.81);
        def.replace_surface = oracle != 0 ? eval_oracle_replace : NULL;
        def.replace_context = out->oracle;
        result = rlf_pipeline_create(&def, &out->pipeline);
    }
    if (result != RLF_OK) {
        eval_room_close(out);
        return result;
    }
    out->world = rlf_pipeline_get_world(out->pipeline);
    return RLF_OK;
}

void eval_room_close(eval_room *stage)
{
    rlf_pipeline_destroy(&stage->pipeline);
    eval_oracle_destroy(&stage->oracle);
    rlf_source_destroy(&stage->source);
    rlf_source_destroy(&stage->truth);
}

rlf_result eval_room_step(eval_room *stage)
{
    return command_interrupted ? RLF_END : rlf_pipeline_step(stage->pipeline, &stage->frame);
}
