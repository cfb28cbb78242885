/* Another room: the recording was cut, or the camera was moved. Then no pixel's own history is
 * worth keeping, and the background starts anew.
 *
 * A thing that comes or goes changes pixels in one direction: it is nearer than the background, or
 * the background is seen where it was. Another room is nearer in some places and farther in others,
 * nearly everywhere, from one frame to the next and from then on. */
#include "surface/steps.h"

enum {
    SAMPLES = 32,      /* so many pixels of a row are looked at, as far apart in both directions */
    FRAMES = 3,        /* in a row */
    CHANGED_OF_10 = 6, /* of the pixels with depth and a known background, so many tenths differ */
    EITHER_OF_10 = 1   /* and at least so many are nearer, and as many farther */
};

typedef struct tally {
    int32_t known, nearer, farther;
} tally;

static tally count(const rlf_reconstruct *stage, const float *depth)
{
    const rlf_grid *grid = &stage->grid;
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

bool rlf_background_is_cut(rlf_reconstruct *stage, const float *depth)
{
    tally sum = count(stage, depth);
    int32_t fewest = sum.nearer < sum.farther ? sum.nearer : sum.farther;
    bool other = sum.known > 0 && 10 * (sum.nearer + sum.farther) >= CHANGED_OF_10 * sum.known &&
                 10 * fewest >= EITHER_OF_10 * sum.known;
    stage->background.other_frames = other ? stage->background.other_frames + 1 : 0;
    return stage->background.other_frames >= FRAMES;
}
