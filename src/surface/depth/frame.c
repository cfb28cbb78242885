/* Depth of a frame, step by step. Each may be switched off. */
#include "surface/depth/depth.h"
#include "surface/steps.h"

#include <string.h>

void depth_read_frame(rlf_reconstruct *stage, const rlf_frame *frame, float *raw, float *kept,
                      uint8_t *reason)
{
    depth_read(stage, frame, raw, reason);
    if (stage->def.background_method == RLF_BACKGROUND_ADAPTIVE ||
        stage->def.background_method == RLF_BACKGROUND_GIVEN) {
        rlf_ego_motion_watch(stage, raw);
    }
    rlf_stage_add_time(stage, RLF_SURFACE_READ);
    if (stage->def.enable_flying_removal) {
        flying_remove(stage, raw, kept, reason);
        rlf_stage_add_time(stage, RLF_SURFACE_FLYING);
    } else {
        memcpy(kept, raw, (size_t)stage->grid.count * sizeof *kept);
    }
}

void depth_track_thin(rlf_reconstruct *stage, const float *kept, const rlf_slot *slot)
{
    const thin_in in = {.grid = &stage->grid,
                        .noise = &stage->def.rig.noise,
                        .before = stage->previous,
                        .dt = rlf_stage_elapsed_s(stage, slot),
                        .depth = kept};
    if (stage->thin.expected != NULL) {
        thin_track(&in, &stage->thin);
    }
}

void depth_average(rlf_reconstruct *stage, const float *raw, float *kept, uint8_t *reason)
{
    if (stage->def.enable_steadying) {
        if (stage->def.enable_hold) {
            temporal_recall(stage, raw, kept, reason);
        }
        temporal_mean(stage, kept, reason);
        rlf_stage_add_time(stage, RLF_SURFACE_STEADY);
    }
}

void depth_fill(rlf_reconstruct *stage, const rlf_frame *frame, const float *kept, rlf_slot *slot,
                uint8_t *was_seen)
{
    if (!stage->def.enable_fill) {
        rlf_kernel_has_row(slot->depth, stage->grid.count, was_seen);
        return;
    }
    rlf_shadow_learn(stage, kept);
    rlf_color_guide_start(stage, frame);
    rlf_fill_holes(stage, slot, was_seen);
    rlf_color_guide_learn(stage);
    rlf_stage_add_time(stage, RLF_SURFACE_FILL);
}
