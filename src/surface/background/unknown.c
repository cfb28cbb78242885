/* Pixels that have depth where the background has none, or behind it: the room, seen for the first
 * time, or something that moves?
 *
 * A surface behind all that was known at its pixels proves that what was there has left; it is room
 * at once. So is what goes on beside it, where the background is known and seen now, and what does
 * not stand in front of what is seen on its left and right. It is foreground when it hangs together
 * with foreground; or when it is large, stands in front, and nothing was known there or it was
 * nearer in the frame before: who goes away from the camera is behind where he was, too. */
#include "surface/depth_step.h"
#include "surface/steps.h"

#include <string.h>

enum {
    HOLE_FRAMES = 10,        /* background samples in a row that fill a hole of the model */
    HOLE_FRAMES_FRONT = 250, /* the same for what was taken as foreground */
    REACH = 64               /* pixels to where the background is known */
};

static const float fastest = 3.0f; /* m/s, of who goes away */
static const float steep = 1.73f;  /* tan of 60 degrees: of a surface that nobody saw */
static const float slant = 0.05f;  /* radians: error of the background's normals */

/* Of each component; planes of the work that components_find no longer needs. */
typedef struct evidence {
    int32_t *seeds;   /* pixels that are in front of a known background */
    int32_t *covered; /* pixels that were covered (hidden.c) */
    int32_t *stands;  /* ends of its rows that are in front of what is beside, less the others */
    int32_t *comes;   /* pixels that moved or are of an unknown place, less those that show what
                         was behind */
} evidence;

static evidence evidence_of(const rlf_reconstruct *stage)
{
    const rlf_work *work = &stage->work;
    return (evidence){work->vote[0], work->vote[1], work->parent, work->map};
}

/* It went away from the camera since the frame before: no faster than people do. */
static bool is_leaving(const rlf_reconstruct *stage, const rlf_slot *slot, int32_t i)
{
    float z = slot->depth[i], before = stage->previous != NULL ? stage->previous->depth[i] : 0.0f;
    float way = before > 0.0f ? z - before : 0.0f;
    return way > rlf_background_gate(&stage->def, z) &&
           way < fastest * rlf_stage_elapsed_s(stage, slot);
}

/* What moves is no background, and hides what is behind it. */
static void leave(rlf_reconstruct *stage, int32_t i, float z)
{
    if (stage->background.depart.left != NULL) {
        stage->background.depart.left[i] = RLF_LEFT_AWAY;
        background_put(stage, i, z, RLF_LEFT_WEIGHT);
    }
}

/* 1 when the pixel of row y at the end of a run, and the next one that way that has depth, show
 * that the run stands in front; -1 when not; 0 when there is none. */
static int32_t stands_at(const rlf_reconstruct *stage, const rlf_slot *slot, int32_t y, int32_t x,
                         int32_t way)
{
    const image_grid *grid = &stage->grid;
    const float *depth = slot->depth + (ptrdiff_t)y * grid->width;
    const depth_step step = depth_step_make(&stage->def.rig.noise, grid->camera.fx);
    int32_t beside = x + way;
    while (beside >= 0 && beside < grid->width && !(depth[beside] > 0.0f)) {
        beside += way;
    }
    if (beside < 0 || beside >= grid->width) {
        return 0;
    }
    float apart = (float)((beside - x) * way);
    bool is_step = depth_step_is(&step, depth[x], depth[beside], steep, apart);
    return is_step && depth[x] < depth[beside] ? 1 : -1;
}

static void weigh_run(const rlf_reconstruct *stage, const rlf_slot *slot, int32_t y,
                      const rlf_run *run, const evidence *sum)
{
    int32_t row = y * stage->grid.width, c = run->component;
    for (int32_t i = row + run->x0; i < row + run->x1; i++) {
        uint8_t seen = slot->foreground[i];
        bool came = seen == RLF_SEEN_UNKNOWN || is_leaving(stage, slot, i);
        sum->seeds[c] += seen == RLF_SEEN_FOREGROUND ? 1 : 0;
        sum->covered[c] += stage->background.covered[i] == RLF_COVERED ? 1 : 0;
        sum->comes[c] += seen == RLF_SEEN_FOREGROUND ? 0 : came ? 1 : -1;
    }
    sum->stands[c] += stands_at(stage, slot, y, run->x0, -1);
    sum->stands[c] += stands_at(stage, slot, y, run->x1 - 1, 1);
}

static void weigh(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    const rlf_runs *runs = &stage->work.runs;
    const evidence sum = evidence_of(stage);
    const size_t size = (size_t)(stage->component_count + 1) * sizeof(int32_t);
    memset(sum.seeds, 0, size);
    memset(sum.covered, 0, size);
    memset(sum.stands, 0, size);
    memset(sum.comes, 0, size);
    for (int32_t y = 0; y < stage->grid.height; y++) {
        for (int32_t r = runs->first[y]; r < runs->first[y + 1]; r++) {
            weigh_run(stage, slot, y, &runs->run[r], &sum);
        }
    }
}

static void learn_hole(rlf_reconstruct *stage, int32_t i, float z, bool front)
{
    rlf_background *background = &stage->background;
    int32_t age = background->unknown_age[i] + 1;
    if (age >= (front ? HOLE_FRAMES_FRONT : HOLE_FRAMES)) {
        background_put(stage, i, z, 1);
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

/* It went away from the camera; or the floor at its feet was taken for it. */
static bool is_away(const reveal_job *job, ptrdiff_t i)
{
    const uint8_t *left = job->stage->background.depart.left;
    return left != NULL && left[i] == RLF_LEFT_AWAY;
}

static bool is_known(const reveal_job *job, ptrdiff_t i)
{
    return job->stage->background.mean[i] > 0.0f && job->slot->foreground[i] != RLF_SEEN_PAST &&
           !is_away(job, i);
}

/* The next known pixels of the background go on at (x, y): on both sides along its row or its
 * column, or on one side of what does not move. */
static bool is_revealed(const reveal_job *job, int32_t x, int32_t y)
{
    const image_grid *grid = &job->stage->grid;
    const int32_t room[4] = {x, grid->width - 1 - x, y, grid->height - 1 - y};
    const ptrdiff_t step[4] = {-1, 1, -grid->width, grid->width};
    ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
    bool may_move = temporal_may_move(job->stage, x, y), is_there[4];
    for (int k = 0; k < 4; k++) {
        int32_t steps = 1, most = rlf_least(room[k], REACH);
        while (steps <= most && !is_known(job, i + steps * step[k])) {
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
        const ptrdiff_t row = (ptrdiff_t)y * grid->width;
        const uint8_t *front = job->slot->foreground + row;
        uint8_t *mark = job->stage->background.covered + row;
        memset(mark, 0, (size_t)grid->width);
        for (int32_t x = span.x0; (x = rlf_kernel_next_mark(front, x, span.x1)) < span.x1; x++) {
            bool is_open = front[x] != RLF_SEEN_FOREGROUND || is_away(job, row + x);
            mark[x] = is_open && is_revealed(job, x, y);
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
        if (slot->foreground[i] == RLF_SEEN_UNKNOWN) {
            learn_hole(stage, i, slot->depth[i], false);
        } else if (slot->foreground[i] == RLF_SEEN_FOREGROUND) {
            stage->background.depart.left[i] = 0;
        }
        slot->foreground[i] = RLF_SEEN_BACKGROUND;
    }
}

/* Foreground where it hangs together with foreground, or is large. What was covered does not make a
 * region of what is too small for one; apart from what it belongs to, it stays. */
static bool is_component_front(const rlf_reconstruct *stage, int32_t component)
{
    const evidence sum = evidence_of(stage);
    int32_t size = stage->work.size[component], own = size - sum.covered[component];
    int32_t least = stage->def.min_region_points;
    if (stage->def.background_method == RLF_BACKGROUND_GIVEN) {
        return 2 * sum.seeds[component] >= size; /* a camera that turns sees new walls */
    }
    bool came = size >= least && sum.stands[component] > 0 && sum.comes[component] > 0;
    return (10 * sum.seeds[component] >= size || came) && (own == size || own >= least || own == 0);
}

/* Decides about pixel i of a component; takes back its depth if it has none of its own. */
static void decide_pixel(rlf_reconstruct *stage, const rlf_slot *slot, int32_t i, bool front)
{
    if (slot->foreground[i] == RLF_SEEN_UNKNOWN) {
        learn_hole(stage, i, slot->depth[i], front);
    }
    if (front && slot->foreground[i] == RLF_SEEN_PAST) {
        front = is_leaving(stage, slot, i); /* or something that it uncovered */
        if (front) {
            leave(stage, i, slot->depth[i]);
        }
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
    weigh(stage, slot);
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
