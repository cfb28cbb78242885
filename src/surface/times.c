/* Times of the steps of one frame, for whoever asks. */
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

void rlf_stage_start_times(rlf_reconstruct *stage)
{
    if (stage->times != NULL) {
        memset(stage->times, 0, sizeof *stage->times);
        stage->clock_ns = rlf_clock_ns();
    }
}

void rlf_stage_add_time(rlf_reconstruct *stage, rlf_surface_step step)
{
    if (stage->times != NULL) {
        int64_t now = rlf_clock_ns();
        stage->times->step_ms[step] += (double)(now - stage->clock_ns) * 1e-6;
        stage->clock_ns = now;
    }
}
