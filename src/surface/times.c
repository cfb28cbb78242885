/* Time from frame to frame, and that of the steps of one frame, for whoever asks. */
#include "surface/stage.h"

#include <string.h>

const char *rlf_surface_step_name(rlf_surface_step step)
{
    static const char *const names[RLF_SURFACE_STEP_COUNT] = {
        "read",       "flying",  "smooth",  "fill",     "complete",  "steady",
        "background", "normals", "segment", "velocity", "thickness", "publish"};
    return step >= 0 && step < RLF_SURFACE_STEP_COUNT ? names[step] : "unknown";
}

void rlf_reconstruct_set_times(rlf_reconstruct *stage, rlf_surface_times *times)
{
    if (RLF_ASSERT(stage != NULL)) {
        stage->times = times;
    }
}

int64_t rlf_stage_elapsed_ns(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    const int64_t hour = INT64_C(3600000000000);
    const rlf_slot *before = stage->previous;
    if (before == NULL || slot->surface.time_ns <= before->surface.time_ns) {
        return 0;
    }
    /* Unsigned, because a difference of any two times may be too large for int64_t. */
    uint64_t ns = (uint64_t)slot->surface.time_ns - (uint64_t)before->surface.time_ns;
    return ns < (uint64_t)hour ? (int64_t)ns : hour;
}

float rlf_stage_elapsed_s(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    const double longest_s = 0.2;
    double dt = 1e-9 * (double)rlf_stage_elapsed_ns(stage, slot);
    return dt <= longest_s ? (float)dt : 0.0f;
}

void rlf_stage_start_times(rlf_reconstruct *stage)
{
    if (stage->times != NULL) {
        memset(stage->times, 0, sizeof *stage->times);
        stage->clock_ns = rlf_clock_ns();
    }
}

void rlf_stage_add_time(rlf_reconstruct *stage, rlf_surface_step step)
{
    arena_spoil(&stage->arena);
    if (stage->times != NULL) {
        int64_t now = rlf_clock_ns();
        stage->times->step_ms[step] += (double)(now - stage->clock_ns) * 1e-6;
        stage->clock_ns = now;
    }
}
