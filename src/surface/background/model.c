/* The background model: emptied, asked, and given up when it shows another room. */
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <string.h>

enum {
    SAMPLES = 32,      /* of a row of the picture: so many pixels tell whether it is another room */
    FRAMES = 3,        /* in a row */
    CHANGED_OF_10 = 6, /* of the pixels with depth and a known background, so many tenths differ */
    EITHER_OF_10 = 1   /* and at least so many are nearer, and as many farther */
};

void rlf_background_reset(rlf_background *background, const image_grid *grid)
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
    if (background->depart.thing != NULL) {
        memset(background->depart.thing, 0, n);
        memset(background->depart.left, 0, n);
    }
    background->frames = 0;
    memset(background->changes, 0,
           (size_t)background_image_tiles(grid) * sizeof *background->changes);
    memset(background->age, 0, (size_t)background_image_tiles(grid));
    memset(background->is_better, 0, (size_t)background_image_tiles(grid));
    background->changed = 0;
    background->image_age = 0;
    background->is_drafting = false;
    background->is_made = false;
    background->object_steps = 0;
    background->next_version++; /* newer than that of an image that was never published: 0 */
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

void background_clear_front(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    memset(slot->foreground, 0, (size_t)stage->grid.count);
    memset(stage->work.front, 0, (size_t)stage->grid.height * sizeof *stage->work.front);
}

rlf_span rlf_background_span(const uint8_t *foreground, int32_t width)
{
    rlf_span span = {rlf_kernel_next_mark(foreground, 0, width), width};
    while (span.x1 > span.x0 && foreground[span.x1 - 1] == 0) {
        span.x1--;
    }
    return span;
}

/* ---- another room ---- */

typedef struct tally {
    int32_t known, nearer, farther;
} tally;

static tally count(const rlf_reconstruct *stage, const float *depth)
{
    const image_grid *grid = &stage->grid;
    const float *mean = stage->background.mean;
    tally sum = {0, 0, 0};
    int32_t step = grid->width > SAMPLES ? grid->width / SAMPLES : 1;
    for (int32_t y = step / 2; y < grid->height; y += step) {
        for (int32_t x = step / 2; x < grid->width; x += step) {
            int32_t i = y * grid->width + x;
            if (!(depth[i] > 0.0f) || !(mean[i] > 0.0f)) {
                continue;
            }
            float gate = rlf_background_gate(&stage->def, depth[i]);
            sum.known++;
            sum.nearer += depth[i] < mean[i] - gate ? 1 : 0;
            sum.farther += depth[i] > mean[i] + gate ? 1 : 0;
        }
    }
    return sum;
}

/* A thing that comes or goes changes pixels in one direction: it is nearer than the background, or
 * the background is seen where it was. Where the recording was cut or the camera was moved, the
 * room is nearer in some places and farther in others, nearly everywhere, from then on. */
bool rlf_background_is_cut(rlf_reconstruct *stage, const float *depth)
{
    tally sum = count(stage, depth);
    int32_t fewest = sum.nearer < sum.farther ? sum.nearer : sum.farther;
    bool other = sum.known > 0 && 10 * (sum.nearer + sum.farther) >= CHANGED_OF_10 * sum.known &&
                 10 * fewest >= EITHER_OF_10 * sum.known;
    stage->background.other_frames = other ? stage->background.other_frames + 1 : 0;
    return stage->background.other_frames >= FRAMES;
}
