/* Pixels that have depth where the background has none: the room's wall, seen for the first time,
 * or something that came?
 *
 * In the first frames a part of the room is in the sensor's shadow of what stands before it. When
 * that leaves, or the sensor sees past it, such a pixel shows a face that goes on beside it, where
 * the background is known and seen now: then it is background. What does not go on is foreground
 * when it hangs together with foreground or is large. */
#include "surface/depth/depth.h"
#include "surface/normals/face.h"
#include "surface/steps.h"
#include "surface/window.h"

#include <string.h>

enum {
    HOLE_FRAMES = 10,        /* background samples in a row that fill a hole of the model */
    HOLE_FRAMES_FRONT = 250, /* the same for what was taken as foreground */
    REACH = 64               /* pixels to where the background is known */
};

static const float slant = 0.05f; /* radians: error of the background's normals */

/* vote[0][c]: pixels of component c that are in front of a known background; vote[1][c]: those that
 * were covered (hidden.c). */
static void count_seeds(const rlf_reconstruct *stage, const uint8_t *mask, int32_t components)
{
    const rlf_runs *runs = &stage->work.runs;
    int32_t *seeds = stage->work.vote[0], *covered = stage->work.vote[1];
    memset(seeds, 0, (size_t)(components + 1) * sizeof *seeds);
    memset(covered, 0, (size_t)(components + 1) * sizeof *covered);
    for (int32_t y = 0; y < stage->grid.height; y++) {
        const uint8_t *row = mask + (ptrdiff_t)y * stage->grid.width;
        const uint8_t *cover = stage->background.covered + (ptrdiff_t)y * stage->grid.width;
        for (int32_t r = runs->first[y]; r < runs->first[y + 1]; r++) {
            const rlf_run *run = &runs->run[r];
            for (int32_t x = run->x0; x < run->x1; x++) {
                seeds[run->component] += row[x] == RLF_SEEN_FOREGROUND ? 1 : 0;
                covered[run->component] += cover[x] == RLF_COVERED ? 1 : 0;
            }
        }
    }
}

static void learn_hole(rlf_reconstruct *stage, int32_t i, float z, bool front)
{
    rlf_background *background = &stage->background;
    int32_t age = background->unknown_age[i] + 1;
    if (age >= (front ? HOLE_FRAMES_FRONT : HOLE_FRAMES)) {
        background->mean[i] = z;
        background->deviation[i] = 0.0f;
        background->weight[i] = 1;
        background_image_changed(background, &stage->grid, i % stage->grid.width,
                                 i / stage->grid.width, 1);
        age = 0;
    }
    background->unknown_age[i] = (uint8_t)age;
}

typedef struct reveal_job {
    const rlf_reconstruct *stage;
    const rlf_slot *slot;
    const background_image *image;
} reveal_job;

/* Pixel i is on the plane of background pixel `at`, `steps` away, which is seen now. */
static bool goes_on(const reveal_job *job, ptrdiff_t i, ptrdiff_t at, int32_t steps)
{
    const rlf_reconstruct *stage = job->stage;
    const image_grid *grid = &stage->grid;
    const rlf_faces faces = {grid->ray_x, grid->ray_y, stage->background.mean, job->image->normal};
    float mean = stage->background.mean[at], z = job->slot->depth[i];
    bool is_seen =
        job->slot->foreground[at] == RLF_SEEN_BACKGROUND &&
        rlf_kernel_abs(job->slot->depth[at] - mean) < rlf_background_gate(&stage->def, mean);
    float turned = slant * (float)steps * z / (float)grid->camera.fx;
    float plane = is_seen ? rlf_face_depth(&faces, at, i) : 0.0f;
    return plane > 0.0f && rlf_kernel_abs(plane - z) < rlf_background_gate(&stage->def, z) + turned;
}

/* The next known pixels of the background go on at (x, y): on both sides along its row or its
 * column, or on one side of what does not move. */
static bool is_revealed(const reveal_job *job, int32_t x, int32_t y)
{
    const image_grid *grid = &job->stage->grid;
    const float *mean = job->stage->background.mean;
    const int32_t room[4] = {x, grid->width - 1 - x, y, grid->height - 1 - y};
    const ptrdiff_t step[4] = {-1, 1, -grid->width, grid->width};
    ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
    bool may_move = temporal_may_move(job->stage, x, y), is_there[4];
    for (int k = 0; k < 4; k++) {
        int32_t steps = 1, most = rlf_least(room[k], REACH);
        while (steps <= most && !(mean[i + steps * step[k]] > 0.0f)) {
            steps++;
        }
        is_there[k] = steps <= most && goes_on(job, i, i + steps * step[k], steps);
        if (is_there[k] && (!may_move || (k % 2 == 1 && is_there[k - 1]))) {
            return true;
        }
    }
    return false;
}

static void reveal_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const reveal_job *job = context;
    const image_grid *grid = &job->stage->grid;
    for (int32_t y = begin; y < end; y++) {
        const rlf_span span = job->stage->work.front[y];
        const uint8_t *front = job->slot->foreground + (ptrdiff_t)y * grid->width;
        uint8_t *mark = job->stage->background.covered + (ptrdiff_t)y * grid->width;
        memset(mark, 0, (size_t)grid->width);
        for (int32_t x = span.x0; (x = rlf_kernel_next_mark(front, x, span.x1)) < span.x1; x++) {
            mark[x] = front[x] == RLF_SEEN_UNKNOWN && is_revealed(job, x, y);
        }
    }
}

void rlf_background_reveal(rlf_reconstruct *stage, const rlf_slot *slot)
{
    const image_grid *grid = &stage->grid;
    reveal_job job = {stage, slot, background_image_newest(stage)};
    if (job.image == NULL) {
        return;
    }
    rlf_parallel_for(stage->def.pool, grid->height, RLF_ROW_GRAIN, reveal_rows, &job);
    const uint8_t *mark = stage->background.covered;
    for (int32_t i = 0; (i = rlf_kernel_next_mark(mark, i, grid->count)) < grid->count; i++) {
        learn_hole(stage, i, slot->depth[i], false);
        slot->foreground[i] = RLF_SEEN_BACKGROUND;
    }
}

/* Foreground where it hangs together with foreground, or is large. What was covered does not make a
 * region of what is too small for one; apart from what it belongs to, it stays. */
static bool is_component_front(const rlf_reconstruct *stage, int32_t component)
{
    const rlf_work *work = &stage->work;
    int32_t size = work->size[component], own = size - work->vote[1][component];
    int32_t least = stage->def.min_region_points;
    if (stage->def.background_method == RLF_BACKGROUND_GIVEN) {
        return 2 * work->vote[0][component] >= size; /* a camera that turns sees new walls */
    }
    return (10 * work->vote[0][component] >= size || size >= least) &&
           (own == size || own >= least || own == 0);
}

/* Decides about pixel i of a component; takes back its depth if it has none of its own. */
static void decide_pixel(rlf_reconstruct *stage, const rlf_slot *slot, int32_t i, bool front)
{
    if (slot->foreground[i] == RLF_SEEN_UNKNOWN) {
        learn_hole(stage, i, slot->depth[i], front);
    }
    if (!front && stage->background.covered[i] == RLF_COVERED) {
        slot->depth[i] = 0.0f;
        slot->reason[i] = RLF_REASON_NO_RETURN;
        for (int k = 0; k < 3; k++) {
            slot->normal[k][i] = 0.0f;
        }
    }
    slot->foreground[i] = front;
}

/* Otherwise a hole of the model, which is filled in time. */
void rlf_background_decide_unknown(rlf_reconstruct *stage, const rlf_slot *slot)
{
    const rlf_work *work = &stage->work;
    count_seeds(stage, slot->foreground, stage->component_count);
    for (int32_t y = 0; y < stage->grid.height; y++) {
        int32_t row = y * stage->grid.width;
        for (int32_t r = work->runs.first[y]; r < work->runs.first[y + 1]; r++) {
            rlf_run *run = &work->runs.run[r];
            bool front = is_component_front(stage, run->component);
            for (int32_t i = row + run->x0; i < row + run->x1; i++) {
                decide_pixel(stage, slot, i, front);
            }
            run->component = front ? run->component : 0;
        }
    }
}
