/* Thesis 4.4.1: the first frames are averaged into a background that never changes, and what
 * differs from it by more than a threshold is foreground.
 *
 * The mean is over the valid samples of a pixel. Where the background is missing, the difference
 * does not exist (the thesis's comparison with NaN is false): such a pixel is not foreground. */
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <string.h>

static void add_frame(rlf_background *background, const float *depth, int32_t count)
{
    for (int32_t i = 0; i < count; i++) {
        background->mean[i] += depth[i];
        background->weight[i] = (uint8_t)(background->weight[i] + (depth[i] > 0.0f ? 1 : 0));
    }
    background->frames++;
}

static void divide(rlf_background *background, int32_t count)
{
    for (int32_t i = 0; i < count; i++) {
        int32_t n = background->weight[i];
        background->mean[i] = n > 0 ? background->mean[i] / (float)n : 0.0f;
    }
}

void rlf_background_average_update(rlf_reconstruct *stage, rlf_slot *slot)
{
    rlf_background *background = &stage->background;
    int32_t count = stage->grid.count;
    if (background->state != RLF_BACKGROUND_READY) {
        background->state = RLF_BACKGROUND_LEARNING;
        memset(slot->foreground, 0, (size_t)count);
        add_frame(background, slot->depth, count);
        if (background->frames == stage->def.background_frames) {
            divide(background, count);
            background->state = RLF_BACKGROUND_READY;
            rlf_sheet_publish(stage, NULL);
        }
        return;
    }
    float threshold = (float)stage->def.foreground_threshold_m;
    for (int32_t i = 0; i < count; i++) {
        float z = slot->depth[i], behind = background->mean[i];
        bool differs = rlf_kernel_abs(z - behind) > threshold;
        slot->foreground[i] = z > 0.0f && behind > 0.0f && differs;
    }
    for (int32_t y = 0; y < stage->grid.height; y++) {
        int32_t width = stage->grid.width;
        stage->work.front[y] = rlf_background_span(slot->foreground + (ptrdiff_t)y * width, width);
    }
}
