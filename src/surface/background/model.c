/* The background's model: emptied, and what its methods ask of it. */
#include "surface/steps.h"

#include <string.h>

void rlf_background_reset(rlf_background *background, const rlf_grid *grid)
{
    size_t n = (size_t)grid->count;
    memset(background->mean, 0, n * sizeof *background->mean);
    memset(background->deviation, 0, n * sizeof *background->deviation);
    memset(background->weight, 0, n);
    memset(background->beyond, 0, n);
    memset(background->absent, 0, n);
    memset(background->unknown_age, 0, n);
    memset(background->still_ms, 0, n * sizeof *background->still_ms);
    memset(background->beneath, 0, n * sizeof *background->beneath);
    memset(background->standing, 0, (size_t)grid->height * sizeof *background->standing);
    memset(background->color, 0, n * sizeof *background->color);
    memset(background->hides, 0, (size_t)grid->height);
    if (background->depart.thing != NULL) {
        memset(background->depart.thing, 0, n);
        memset(background->depart.left, 0, n);
    }
    background->frames = 0;
    memset(background->changes, 0, (size_t)rlf_sheet_tiles(grid) * sizeof *background->changes);
    memset(background->age, 0, (size_t)rlf_sheet_tiles(grid));
    memset(background->is_better, 0, (size_t)rlf_sheet_tiles(grid));
    background->changed = 0;
    background->sheet_age = 0;
    background->is_drafting = false;
    background->is_made = false;
    background->object_steps = 0;
    background->next_version++; /* newer than that of a sheet that was never published: 0 */
    background->state = RLF_BACKGROUND_NONE;
    background->newest = -1;
    background->is_stale = false;
    background->other_frames = 0;
}

float rlf_background_gate(const rlf_reconstruct_def *def, float z)
{
    float scaled = (float)(def->foreground_sigmas * rlf_depth_noise_sigma(&def->rig.noise, z));
    return scaled > (float)def->foreground_min_m ? scaled : (float)def->foreground_min_m;
}

rlf_span rlf_background_span(const uint8_t *foreground, int32_t width)
{
    rlf_span span = {0, width};
    uint64_t eight = 0;
    for (; span.x0 + 8 <= width; span.x0 += 8) {
        memcpy(&eight, foreground + span.x0, sizeof eight);
        if (eight != 0) {
            break;
        }
    }
    while (span.x0 < width && foreground[span.x0] == 0) {
        span.x0++;
    }
    for (; span.x1 - 8 >= span.x0; span.x1 -= 8) {
        memcpy(&eight, foreground + span.x1 - 8, sizeof eight);
        if (eight != 0) {
            break;
        }
    }
    while (span.x1 > span.x0 && foreground[span.x1 - 1] == 0) {
        span.x1--;
    }
    return span;
}
