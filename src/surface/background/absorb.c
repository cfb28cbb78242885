/* Furniture that was moved: what stands nearer than the background and still for long enough
 * becomes background. What it hides is kept beneath it, and comes back at once when it is seen
 * again. */
#include "surface/steps.h"

#include "kernel/kernel.h"

enum { STILL_WEIGHT = 8, LONGEST_STEP_MS = 200 };

static int32_t step_ms(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    if (stage->previous == NULL) {
        return 0;
    }
    int64_t ms = (slot->surface.time_ns - stage->previous->surface.time_ns) / 1000000;
    ms = ms < 0 ? 0 : ms;
    return ms > LONGEST_STEP_MS ? LONGEST_STEP_MS : (int32_t)ms;
}

static void replace(rlf_reconstruct *stage, int32_t i, float z)
{
    rlf_background *background = &stage->background;
    background->mean[i] = z;
    background->deviation[i] = 0.0f;
    background->weight[i] = STILL_WEIGHT;
    background->beyond[i] = 0;
    background->still_ms[i] = 0;
    rlf_sheet_changed(background, &stage->grid, i % stage->grid.width, i / stage->grid.width, 1);
}

/* Follows the depth of one foreground pixel; true when it has been still for `limit_ms`. */
static bool is_still(rlf_background *background, int32_t i, float z, float gate, int32_t limit_ms,
                     int32_t passed_ms)
{
    float off = z - background->still[i];
    if (background->still_ms[i] == 0 || rlf_kernel_abs(off) > gate) {
        background->still[i] = z;
        background->still_ms[i] = 1;
        return false;
    }
    background->still[i] += off / (float)STILL_WEIGHT;
    int32_t age = background->still_ms[i] + passed_ms;
    background->still_ms[i] = (uint16_t)(age > limit_ms ? limit_ms : age);
    return age >= limit_ms;
}

/* Pixels of a row that are foreground or were; returns where pixels that stand still are left. */
static rlf_span absorb_row(rlf_reconstruct *stage, const rlf_slot *slot, int32_t y, rlf_span span,
                           int32_t passed_ms)
{
    const rlf_reconstruct_def *def = &stage->def;
    rlf_background *background = &stage->background;
    int32_t limit_ms = (int32_t)(1000.0 * def->absorb_after_s);
    rlf_span left = {stage->grid.width, 0};
    for (int32_t x = span.x0; x < span.x1; x++) {
        int32_t i = y * stage->grid.width + x;
        float z = slot->depth[i], beneath = background->beneath[i];
        if (!slot->foreground[i]) {
            background->still_ms[i] = z > 0.0f ? 0 : background->still_ms[i];
        } else if (is_still(background, i, z, rlf_background_gate(def, z), limit_ms, passed_ms)) {
            background->beneath[i] = beneath > 0.0f ? beneath : background->mean[i];
            background->hides[y] = 1;
            replace(stage, i, background->still[i]);
        }
        if (background->still_ms[i] != 0) {
            left.x0 = x < left.x0 ? x : left.x0;
            left.x1 = x + 1;
        }
    }
    return left;
}

void rlf_background_absorb(rlf_reconstruct *stage, const rlf_slot *slot)
{
    if (!(stage->def.absorb_after_s > 0.0)) {
        return;
    }
    int32_t passed_ms = step_ms(stage, slot);
    for (int32_t y = 0; y < stage->grid.height; y++) {
        rlf_span *still = &stage->background.standing[y];
        *still =
            absorb_row(stage, slot, y, rlf_span_unite(*still, stage->work.front[y]), passed_ms);
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
