/* Where a point that was seen is a little later. */
#include "surface/past/past.h"

static const double longest_gap_s = 0.2;
static const float least_z = 0.1f;
static const float body_jump_m = 0.04f;

float rlf_past_elapsed(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    double dt = 1e-9 * (double)rlf_stage_elapsed_ns(stage, slot);
    return dt <= longest_gap_s ? (float)dt : 0.0f;
}

rlf_kernel_motion rlf_past_motion(const rlf_grid *grid, float dt)
{
    return (rlf_kernel_motion){.dt = dt,
                               .fx = (float)grid->camera.fx,
                               .fy = (float)grid->camera.fy,
                               .least_z = least_z,
                               .width = grid->width,
                               .height = grid->height};
}

rlf_kernel_moving_row rlf_past_row(const rlf_grid *grid, const rlf_slot *slot, int32_t x, int32_t y,
                                   int32_t count)
{
    ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
    return (rlf_kernel_moving_row){
        .foreground = slot->foreground + i,
        .depth = slot->depth + i,
        .ray_x = grid->ray_x + i,
        .ray_y = grid->ray_y + i,
        .velocity = {slot->velocity[0] + i, slot->velocity[1] + i, slot->velocity[2] + i},
        .x = x,
        .y = y,
        .count = count};
}

/* Pixels of the same body from k on along `step`, up to `limit`. */
static int32_t run_length(const rlf_slot *slot, ptrdiff_t k, ptrdiff_t step, int32_t limit)
{
    float z = slot->depth[k];
    for (int32_t n = 0; n < limit; n++) {
        k += step;
        float next = slot->depth[k], jump = next - z;
        if (slot->foreground[k] == 0 || !(next > 0.0f) || jump > body_jump_m ||
            jump < -body_jump_m) {
            return n;
        }
        z = next;
    }
    return limit;
}

static int32_t least_of(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

bool rlf_past_is_narrow(const rlf_grid *grid, const rlf_slot *slot, ptrdiff_t k, int32_t most)
{
    int32_t x = (int32_t)(k % grid->width), y = (int32_t)(k / grid->width);
    int32_t wide = run_length(slot, k, 1, least_of(most, grid->width - 1 - x));
    wide += run_length(slot, k, -1, least_of(most - wide, x));
    if (wide < most) {
        return true;
    }
    int32_t high = run_length(slot, k, grid->width, least_of(most, grid->height - 1 - y));
    high += run_length(slot, k, -(ptrdiff_t)grid->width, least_of(most - high, y));
    return high < most;
}
