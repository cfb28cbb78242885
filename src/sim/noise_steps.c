/* Depth as structured light measures it: a shift of the pattern, in steps of an eighth of a pixel,
 * found by matching windows, so that it errs alike in neighbouring pixels; partly the same in every
 * frame, because the pattern is. */
#include "sim/hash.h"
#include "sim/noise.h"

enum { PITCH = 4 }; /* pixels between independent errors */

#define STEPS_M 348.0f     /* of a shift at 1 m: 8 x 75 mm x 580 pixels, a Kinect v1 */
#define SHIFT_SIGMA 0.35f  /* steps */
#define ALWAYS 0xffffffffu /* instead of a frame's number */

/* Standard normal numbers on a grid, interpolated; twice 1.5 makes up for what that averages. */
static float smooth_normal(uint32_t seed, uint32_t frame, int32_t x, int32_t y)
{
    uint32_t column = (uint32_t)x / PITCH, row = (uint32_t)y / PITCH;
    float fx = (float)(x % PITCH) / PITCH, fy = (float)(y % PITCH) / PITCH;
    float at[2];
    for (uint32_t k = 0; k < 2; k++) {
        uint32_t key = synth_hash2(synth_hash2(seed, frame), row + k) + column * 0x9e3779b9u;
        float left = synth_normal(synth_hash(key));
        at[k] = left + (synth_normal(synth_hash(key + 0x9e3779b9u)) - left) * fx;
    }
    return 1.5f * (at[0] + (at[1] - at[0]) * fy);
}

float synth_noise_steps(const synth_noise *noise, uint32_t frame, int32_t x, int32_t y, float z)
{
    const float half = 0.70710678f;
    float error =
        half * (smooth_normal(noise->seed, ALWAYS, x, y) + smooth_normal(noise->seed, frame, x, y));
    float shift = STEPS_M / z + SHIFT_SIGMA * error;
    int32_t steps = (int32_t)(shift + 0.5f);
    return STEPS_M / (float)(steps < 1 ? 1 : steps);
}
