/* How much of the sensor's noise no mean over time takes away.
 *
 * Windows of normals shrink as averaging lowers the noise (kernel/plane_tile.c), and a sensor whose
 * errors are the same in every frame, as those of structured light partly are, must not be taken
 * for a curved surface. So what planes leave of the means is measured: most of a room is flat, and
 * there it is noise alone. What is curved leaves more, so a low quantile of many windows is taken.
 * An error that lasts is one of disparity: the same in inverse depth at any distance.
 */
#include "surface/steps.h"

#include "kernel/plane_window.h"

enum {
    SAMPLES = 10, /* of a window, on each side ... */
    APART = 2,    /* ... pixels: errors alike in neighbours must show */
    SIDE = SAMPLES * APART,
    PITCH = 16, /* pixels between windows */
    PHASES = 8, /* looks until all rows of windows have been seen */
    REST = 4,   /* frames from one look to the next, once it is known */
    LEAST_COUNT = 40
};

static const float WHOLE = 99.5f;      /* samples */
static const float MOST_LEFT = 0.25f;  /* of the noise: a mean of four frames */
static const float MOST_SLANT = 1.2f;  /* 50 degrees */
static const double MOST_SIGMAS = 2.0; /* of one frame's noise, at 2 m: the last bin */

/* Errors that are alike in neighbours are few in a window: of a sum of five squares the lower
 * quartile is a third of what nearly all of them, with the gate of a plane, stay below. */
static const float UPPER = 1.7320508f;

static rlf_plane_moments sum_window(const rlf_reconstruct *stage, const float *depth,
                                    ptrdiff_t corner, rlf_plane_reference ref)
{
    const image_grid *grid = &stage->grid;
    rlf_plane_moments sum = {0};
    for (int32_t y = 0; y < SIDE; y += APART) {
        for (int32_t x = 0; x < SIDE; x += APART) {
            ptrdiff_t i = corner + (ptrdiff_t)y * grid->width + x;
            sum = rlf_plane_add(sum, rlf_plane_pixel(depth[i], stage->temporal.frames[i],
                                                     grid->ray_x[i], grid->ray_y[i], ref));
        }
    }
    return sum;
}

/* Error of inverse depth that a plane leaves beyond what averaging explains, 1/m; false where it
 * cannot be told: at a low angle noise hides it. */
static bool look_at(const rlf_reconstruct *stage, const float *depth, ptrdiff_t corner, float *out)
{
    ptrdiff_t middle = corner + (ptrdiff_t)(SIDE / 2) * stage->grid.width + SIDE / 2;
    if (!(depth[middle] > 0.0f)) {
        return false;
    }
    rlf_plane_reference ref = {stage->grid.ray_x[middle], stage->grid.ray_y[middle],
                               1.0f / depth[middle]};
    rlf_plane_moments sum = sum_window(stage, depth, corner, ref);
    if (!(sum.n > WHOLE) || !(sum.left < MOST_LEFT * sum.n)) {
        return false;
    }
    rlf_plane_rest rest = rlf_plane_leave(sum, ref);
    rlf_kernel_noise noise = rlf_kernel_noise_make(&stage->def.rig.noise);
    float sigma = rest.slant * rlf_kernel_inverse_sigma(noise, rest.w);
    float beyond = rest.variance - sigma * sigma * (sum.left / sum.n);
    *out = beyond > 0.0f ? sqrtf(beyond) : 0.0f;
    return rest.slant < MOST_SLANT;
}

/* Of a bin, 1/m. */
static float step_of(const rlf_reconstruct *stage)
{
    const double at = 2.0; /* metres */
    return (float)(MOST_SIGMAS * rlf_depth_noise_sigma(&stage->def.rig.noise, at) / (at * at) /
                   RLF_LASTING_BINS);
}

static void look_at_rows(const rlf_reconstruct *stage, const float *depth, int32_t phase,
                         int32_t count[RLF_LASTING_BINS])
{
    const image_grid *grid = &stage->grid;
    float step = step_of(stage);
    for (int32_t y = PITCH * phase; y + SIDE <= grid->height; y += PITCH * PHASES) {
        for (int32_t x = 0; x + SIDE <= grid->width; x += PITCH) {
            float left;
            if (look_at(stage, depth, (ptrdiff_t)y * grid->width + x, &left)) {
                left /= step;
                int32_t last = RLF_LASTING_BINS - 1;
                count[left < (float)last ? (int32_t)left : last]++;
            }
        }
    }
}

/* The bin of the lower quartile; -1 when there are too few. */
static int32_t quartile(const int32_t count[RLF_LASTING_BINS])
{
    int32_t all = 0, bin = 0;
    for (int32_t k = 0; k < RLF_LASTING_BINS; k++) {
        all += count[k];
    }
    for (int32_t sum = count[0]; 4 * sum < all; sum += count[++bin]) {
    }
    return all < LEAST_COUNT ? -1 : bin;
}

/* Once it is known it changes in steps and seldom: normals of what stands still must not flicker.
 */
void rlf_lasting_measure(rlf_reconstruct *stage, const float *depth)
{
    rlf_lasting *lasting = &stage->normals.lasting;
    bool is_known = lasting->sigma < (float)RLF_LASTING_ALL;
    lasting->frame = (lasting->frame + 1) % REST;
    if (is_known && lasting->frame != 0) {
        return;
    }
    look_at_rows(stage, depth, lasting->phase, lasting->count);
    lasting->phase = (lasting->phase + 1) % PHASES;
    int32_t bin = !is_known || lasting->phase == 0 ? quartile(lasting->count) : -1;
    if (bin >= 0) {
        lasting->sigma = UPPER * (float)bin * step_of(stage);
    }
    for (int32_t k = 0; k < RLF_LASTING_BINS && lasting->phase == 0; k++) {
        lasting->count[k] /= 2;
    }
}
