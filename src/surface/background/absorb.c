/* Furniture that was moved: what stands nearer than the background and still for long enough
 * becomes background. What it hides is kept beneath it, and comes back at once when it is seen
 * again. */
#include "surface/steps.h"
#include "surface/window.h"

#include "kernel/kernel.h"

enum { LONGEST_STEP_MS = 200, CHUNK = 128 };

static int32_t step_ms(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    int64_t ms = rlf_stage_elapsed_ns(stage, slot) / 1000000;
    return ms > LONGEST_STEP_MS ? LONGEST_STEP_MS : (int32_t)ms;
}

static void replace(rlf_reconstruct *stage, int32_t i, float z)
{
    rlf_background *background = &stage->background;
    background->mean[i] = z;
    background->deviation[i] = 0.0f;
    background->weight[i] = RLF_STILL_WEIGHT;
    background->beyond[i] = 0;
    background->still_ms[i] = 0;
    background_image_changed(background, &stage->grid, i % stage->grid.width, i / stage->grid.width,
                             1);
}

static rlf_kernel_still still_of(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    const rlf_reconstruct_def *def = &stage->def;
    return (rlf_kernel_still){.noise = def->rig.noise,
                              .sigmas = def->foreground_sigmas,
                              .least = (float)def->foreground_min_m,
                              .limit_ms = (int32_t)(1000.0 * def->absorb_after_s),
                              .passed_ms = step_ms(stage, slot)};
}

static void absorb_pixel(rlf_reconstruct *stage, int32_t i)
{
    rlf_background *background = &stage->background;
    float beneath = background->beneath[i];
    bool has_left = background->depart.left != NULL && background->depart.left[i];
    background->beneath[i] = beneath > 0.0f || has_left ? beneath : background->mean[i];
    background->hides[i / stage->grid.width] = 1;
    if (has_left) {
        background->depart.left[i] = 0;
    }
    replace(stage, i, background->still[i]);
}

/* Where pixels that stand still are left in row y, of those that are foreground or were. */
static rlf_span find_left(const rlf_reconstruct *stage, int32_t y, rlf_span span)
{
    const uint16_t *still_ms = stage->background.still_ms + (ptrdiff_t)y * stage->grid.width;
    while (span.x0 < span.x1 && still_ms[span.x0] == 0) {
        span.x0++;
    }
    while (span.x1 > span.x0 && still_ms[span.x1 - 1] == 0) {
        span.x1--;
    }
    return span;
}

static void absorb_row(rlf_reconstruct *stage, const rlf_slot *slot, const rlf_kernel_still *p,
                       int32_t y, rlf_span span)
{
    rlf_background *background = &stage->background;
    for (int32_t x = span.x0; x < span.x1; x += CHUNK) {
        uint8_t is_due[CHUNK];
        int32_t i = y * stage->grid.width + x, count = rlf_least(CHUNK, span.x1 - x);
        rlf_kernel_still_row(p, slot->foreground + i, slot->depth + i, count, background->still + i,
                             background->still_ms + i, is_due);
        for (int32_t k = 0; (k = rlf_kernel_next_mark(is_due, k, count)) < count; k++) {
            absorb_pixel(stage, i + k);
        }
    }
}

void rlf_background_absorb(rlf_reconstruct *stage, const rlf_slot *slot)
{
    if (!(stage->def.absorb_after_s > 0.0)) {
        return;
    }
    const rlf_kernel_still still = still_of(stage, slot);
    for (int32_t y = 0; y < stage->grid.height; y++) {
        rlf_span *left = &stage->background.standing[y];
        rlf_span span = rlf_span_unite(*left, stage->work.front[y]);
        absorb_row(stage, slot, &still, y, span);
        *left = find_left(stage, y, span);
    }
}

/* Takes back what is hidden in one row where it is seen again; true while any is left. */
static bool restore_row(rlf_reconstruct *stage, const rlf_slot *slot, int32_t y)
{
    rlf_background *background = &stage->background;
    bool any = false;
    for (int32_t i = y * stage->grid.width; i < (y + 1) * stage->grid.width; i++) {
        float z = slot->depth[i], beneath = background->beneath[i];
        any = any || beneath > 0.0f;
        if (!(beneath > 0.0f) || slot->foreground[i] || !(z > background->mean[i])) {
            continue;
        }
        float gate = rlf_background_gate(&stage->def, z);
        if (z - background->mean[i] > gate && rlf_kernel_abs(z - beneath) <= gate) {
            replace(stage, i, beneath);
            background->beneath[i] = 0.0f;
        }
    }
    return any;
}

void rlf_background_restore(rlf_reconstruct *stage, const rlf_slot *slot)
{
    for (int32_t y = 0; y < stage->grid.height; y++) {
        if (stage->background.hides[y]) {
            stage->background.hides[y] = restore_row(stage, slot, y);
        }
    }
}
