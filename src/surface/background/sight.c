/* How much of the room a frame shows. A sensor that warms up, or a covered lens, gives frames with
 * no depth or hardly any: they say nothing of the room, and nothing is learnt of them. When the
 * room comes into sight after the background was learnt, it is learnt again with what is known. */
#include "surface/depth_step.h"
#include "surface/steps.h"

#include "kernel/kernel.h"

enum {
    /* One of so many parts of the picture has depth: there is a room. No more than that of the
     * known background has: nothing is seen. A sensor that warms up shows more by that, at least.
     */
    FEW_SHARE = 10,
    MORE_SHARE = 4,   /* of the picture one of so many parts comes into sight */
    MORE_OF_KNOWN = 2 /* the same while the background is learnt, of what is known */
};

#define WARM_UP_NS 3000000000 /* from the first depth on: a sensor has started by then */

typedef struct tally {
    int32_t seen;           /* pixels with depth as it came */
    int32_t known;          /* background */
    int32_t unknown, fresh; /* depth that it is not known of; and there was none before */
} tally;

RLF_KERNEL static void count_row(const float *restrict raw, const float *restrict depth,
                                 const float *restrict mean, const float *restrict before,
                                 int32_t count, tally *restrict sum)
{
    int32_t seen = 0, known = 0, unknown = 0, fresh = 0;
    for (int32_t i = 0; i < count; i++) {
        int32_t is_known = mean[i] > 0.0f ? 1 : 0, was_empty = before[i] > 0.0f ? 0 : 1;
        int32_t is_new = (depth[i] > 0.0f ? 1 : 0) & (1 - is_known);
        seen += raw[i] > 0.0f ? 1 : 0;
        known += is_known;
        unknown += is_new;
        fresh += is_new & was_empty;
    }
    sum->seen += seen;
    sum->known += known;
    sum->unknown += unknown;
    sum->fresh += fresh;
}

static tally count_all(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    const rlf_slot *last = stage->previous != NULL ? stage->previous : stage->before;
    const int32_t width = stage->grid.width;
    tally sum = {0, 0, 0, 0};
    for (int32_t y = 0; y < stage->grid.height; y++) {
        const ptrdiff_t row = (ptrdiff_t)y * width;
        const float *before = last != NULL ? last->depth + row : stage->work.zeros;
        count_row(stage->work.raw + row, slot->depth + row, stage->background.mean + row, before,
                  width, &sum);
    }
    return sum;
}

void rlf_sight_reset(rlf_sight *sight)
{
    *sight = (rlf_sight){.is_blind = true};
}

/* True from the frame on that shows a room. Of a room that has little depth for good, too. */
static bool has_room(rlf_sight *sight, const tally *t, int32_t count, int64_t time_ns)
{
    if (t->seen > 0 && !sight->has_depth) {
        sight->has_depth = true;
        sight->first_ns = time_ns;
    }
    sight->is_warm = sight->has_depth && time_ns - sight->first_ns >= WARM_UP_NS;
    return sight->has_room || FEW_SHARE * (int64_t)t->seen >= count ||
           (sight->is_warm && t->seen > 0);
}

static bool is_learning(const rlf_reconstruct *stage)
{
    return stage->background.frames < stage->def.background_frames;
}

static bool shows_enough(const rlf_reconstruct *stage, const tally *t)
{
    const rlf_sight *sight = &stage->sight;
    const int64_t seen = t->seen, more = seen - sight->seen;
    const bool is_rising =
        is_learning(stage) && !sight->is_warm && sight->seen > 0 && FEW_SHARE * more > sight->seen;
    return sight->has_room && seen > 0 && FEW_SHARE * seen >= t->known && !is_rising;
}

typedef struct border {
    int32_t pairs, steps; /* of neighbours, one of a known background; with a depth step between */
} border;

static void add_pair(const rlf_reconstruct *stage, const depth_step *step, int32_t a, int32_t b,
                     border *sum)
{
    const float *depth = stage->work.raw, *mean = stage->background.mean;
    if (depth[a] > 0.0f && depth[b] > 0.0f && (mean[a] > 0.0f) != (mean[b] > 0.0f)) {
        sum->pairs++;
        sum->steps += depth_step_between(step, depth[a], depth[b]);
    }
}

/* What comes into sight goes on from what is known: it is the room. A thing stands before it. */
static bool goes_on(const rlf_reconstruct *stage)
{
    const image_grid *grid = &stage->grid;
    const depth_step step = depth_step_make(&stage->def.rig.noise, grid->camera.fx);
    border sum = {0, 0};
    for (int32_t i = grid->width; i < grid->count; i++) {
        add_pair(stage, &step, i, i - grid->width, &sum);
        if (i % grid->width > 0) {
            add_pair(stage, &step, i, i - 1, &sum);
        }
    }
    return 2 * sum.steps < sum.pairs;
}

static bool shows_more(const rlf_reconstruct *stage, const tally *t)
{
    const int64_t more = stage->sight.is_warm ? t->fresh : t->unknown;
    const bool is_much = is_learning(stage) ? MORE_OF_KNOWN * more >= t->known
                                            : MORE_SHARE * more >= stage->grid.count;
    return stage->background.frames > 0 && is_much && (t->known == 0 || goes_on(stage));
}

void rlf_sight_take(rlf_reconstruct *stage, const rlf_slot *slot)
{
    rlf_sight *sight = &stage->sight;
    const tally t = count_all(stage, slot);
    sight->has_room = has_room(sight, &t, stage->grid.count, slot->surface.time_ns);
    sight->is_blind = !shows_enough(stage, &t);
    sight->seen = t.seen;
    sight->shows_more = !sight->is_blind && shows_more(stage, &t);
}
