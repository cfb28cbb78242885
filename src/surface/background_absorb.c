/* Furniture that was moved: what stands nearer than the background and still for long enough
 * becomes background. What it hides is kept beneath it, and comes back at once when it is seen
 * again. */
#include "surface/steps.h"

#include "kernel/kernel.h"

enum { STILL_WEIGHT = 8, LONGEST_STEP_MS = 200 };

static float gate_at(const rlf_reconstruct_def *def, float z)
{
    float scaled = (float)(def->foreground_sigmas * rlf_depth_noise_sigma(&def->rig.noise, z));
    return scaled > (float)def->foreground_min_m ? scaled : (float)def->foreground_min_m;
}

static int32_t step_ms(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    if (stage->previous == NULL) {
        return 0;
    }
    int64_t ms = (slot->surface.time_ns - stage->previous->surface.time_ns) / 1000000;
    ms = ms < 0 ? 0 : ms;
    return ms > LONGEST_STEP_MS ? LONGEST_STEP_MS : (int32_t)ms;
}

static void replace(rlf_background *background, int32_t i, float z)
{
    background->mean[i] = z;
    background->deviation[i] = 0.0f;
    background->weight[i] = STILL_WEIGHT;
    background->beyond[i] = 0;
    background->still_ms[i] = 0;
    background->changed++;
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

void rlf_background_absorb(rlf_reconstruct *stage, const rlf_slot *slot)
{
    const rlf_reconstruct_def *def = &stage->def;
    rlf_background *background = &stage->background;
    int32_t limit_ms = (int32_t)(1000.0 * def->absorb_after_s);
    if (limit_ms == 0) {
        return;
    }
    int32_t passed_ms = step_ms(stage, slot);
    for (int32_t i = 0; i < stage->grid.count; i++) {
        float z = slot->depth[i], beneath = background->beneath[i];
        if (!(z > 0.0f)) {
            continue;
        }
        if (slot->foreground[i]) {
            if (is_still(background, i, z, gate_at(def, z), limit_ms, passed_ms)) {
                background->beneath[i] = beneath > 0.0f ? beneath : background->mean[i];
                replace(background, i, background->still[i]);
            }
            continue;
        }
        background->still_ms[i] = 0;
        if (beneath > 0.0f && z > background->mean[i]) {
            float gate = gate_at(def, z);
            if (z - background->mean[i] > gate && rlf_kernel_abs(z - beneath) <= gate) {
                replace(background, i, beneath);
                background->beneath[i] = 0.0f;
            }
        }
    }
}
