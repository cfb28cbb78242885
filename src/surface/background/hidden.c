/* What a thing hides without returning anything: hair, a black sleeve, a print on a shirt.
 *
 * A pixel without depth is the thing's where nothing of the background is seen about it: along its
 * row and its column the nearest pixels with depth are the thing's, or there are none up to the
 * picture's border (the rim that many cameras leave empty). Or the background has always returned
 * something there and now there is nothing: something hides it. Only beside a thing a sensor's
 * shadow (shadow.c) explains that as well.
 *
 * Its depth and normal are those of the thing's pixels that the row and the column meet, the nearer
 * ones counting more. */
#include "surface/depth_step.h"
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <string.h>

enum {
    LEFT,
    RIGHT,
    UP,
    DOWN,
    WAYS,
    SELDOM = 64, /* of 255: a pixel without depth in fewer frames has it as a rule */
    LEARN_SHIFT = 2,
    LEARN_ROWS = 4,
    LEAST_SEEN = 3 /* samples of a background pixel that is known */
};

static const float reach_m = 0.25f; /* from what was seen of a thing: the hair of a head */

typedef struct hidden_job {
    const rlf_reconstruct *stage;
    const rlf_slot *slot;
    const float *seen;  /* plane: depth before holes were filled */
    rlf_rect area;      /* where something in front may hide a pixel; empty while learning */
    int32_t *up, *down; /* planes: nearest pixel with depth in the column, < 0 = none */
    uint8_t *busy;      /* plane: not 0 where a thing may be why nothing returns */
    depth_step step;
    bool is_learning;
} hidden_job;

static bool is_empty(const hidden_job *job, int32_t i)
{
    const uint8_t reason = job->slot->reason[i];
    return (reason == RLF_REASON_NO_RETURN || reason == RLF_REASON_FLYING) &&
           !(job->slot->depth[i] > 0.0f);
}

/* Finds `hit` of a row from the row `step` pixels away, which is done; outside there is none. */
static void look_beside(const hidden_job *job, int32_t y, int32_t step, int32_t *hit)
{
    const image_grid *grid = &job->stage->grid;
    for (int32_t x = job->area.x0; x < job->area.x1; x++) {
        int32_t i = y * grid->width + x, beside = i + step;
        bool is_in = beside >= 0 && beside < grid->count;
        hit[i] = is_in && is_empty(job, beside) ? hit[beside] : is_in ? beside : -1;
    }
}

/* The pixels with depth that are met from an empty one. */
typedef struct hits {
    int32_t at[WAYS];      /* < 0 = none */
    float away[WAYS];      /* pixels */
    int32_t ends;          /* how many there are, */
    int32_t fronts, backs; /* foreground, and background that was seen and not filled */
    int32_t nearest;       /* way to the nearest foreground; < 0 = there is none */
} hits;

static bool is_front(const hidden_job *job, int32_t at)
{
    return at >= 0 && job->slot->foreground[at] == RLF_SEEN_FOREGROUND;
}

static hits look_about(const hidden_job *job, int32_t x, int32_t y, rlf_span run)
{
    int32_t width = job->stage->grid.width, row = y * width;
    hits h = {.at = {run.x0 > 0 ? row + run.x0 - 1 : -1, run.x1 < width ? row + run.x1 : -1,
                     job->up[row + x], job->down[row + x]},
              .nearest = -1};
    h.away[LEFT] = (float)(x - run.x0 + 1);
    h.away[RIGHT] = (float)(run.x1 - x);
    h.away[UP] = (float)(y - h.at[UP] / width);
    h.away[DOWN] = (float)(h.at[DOWN] / width - y);
    for (int32_t k = 0; k < WAYS; k++) {
        bool front = is_front(job, h.at[k]);
        h.fronts += front ? 1 : 0;
        h.ends += h.at[k] >= 0 ? 1 : 0;
        h.backs += h.at[k] >= 0 && !front && job->seen[h.at[k]] > 0.0f ? 1 : 0;
        h.nearest = front && (h.nearest < 0 || h.away[k] < h.away[h.nearest]) ? k : h.nearest;
    }
    return h;
}

/* The shadow of what is seen on one side of it, foreground or not, explains that nothing is
 * returned. Of a run that is wider than the shadow, the part beside the background is the shadow.
 */
static bool is_in_shadow(const hidden_job *job, int32_t i, const hits *h)
{
    const float mixed = 1.0f; /* pixels: half of what drivers drop at an edge */
    float behind = job->stage->background.mean[i];
    for (int32_t k = LEFT; k <= RIGHT; k++) {
        int32_t other = LEFT + RIGHT - k, at = h->at[k];
        float z = at >= 0 ? job->slot->depth[at] : behind;
        rlf_shadow_side side = k == LEFT ? RLF_SHADOW_RIGHT : RLF_SHADOW_LEFT;
        float wide = rlf_shadow_width(job->stage, side, z, behind);
        bool throws = is_front(job, at) || wide >= 1.0f;
        bool is_open = h->at[other] >= 0 && !is_front(job, h->at[other]);
        if (throws && (is_open ? h->away[other] : h->away[k]) <= wide + mixed) {
            return true;
        }
    }
    return false;
}

/* As a rule the background is seen at pixel i. */
static bool is_returning(const rlf_background *background, int32_t i)
{
    return background->weight[i] >= LEAST_SEEN && background->mean[i] > 0.0f &&
           background->absent[i] < SELDOM;
}

/* No more than drivers drop beside edges: between the thing and the background, or between the
 * background on both sides of something slender. */
static bool is_at_edge(const hidden_job *job, const hits *h)
{
    for (int32_t k = 0; k < WAYS; k += 2) {
        bool is_between = h->at[k] >= 0 && h->at[k + 1] >= 0;
        int32_t edges = is_front(job, h->at[k]) || is_front(job, h->at[k + 1]) ? 1 : 2;
        float wide = h->away[k] + h->away[k + 1] - 1.0f;
        if (is_between && wide <= (float)(edges * 2 * RLF_SHADOW_MIXED + edges - 1)) {
            return true;
        }
    }
    return false;
}

static bool is_hidden(const hidden_job *job, int32_t i, const hits *h)
{
    float away = h->away[h->nearest], z = job->slot->depth[h->at[h->nearest]];
    float behind = job->stage->background.mean[i];
    if (away * z > reach_m * (float)job->stage->grid.camera.fx || (behind > 0.0f && z >= behind)) {
        return false;
    }
    bool is_enclosed = h->backs == 0 && (h->fronts == h->ends || h->fronts > WAYS / 2);
    return is_enclosed || (is_returning(&job->stage->background, i) && !is_at_edge(job, h) &&
                           !is_in_shadow(job, i, h));
}

/* Where nothing is in front, how often a pixel returns nothing. */
RLF_KERNEL static void learn_row(const float *restrict seen, const uint8_t *restrict busy,
                                 const uint8_t *restrict front, int32_t shift, int32_t count,
                                 uint8_t *restrict absent)
{
    int32_t round = (1 << shift) - 1;
    for (int32_t x = 0; x < count; x++) {
        int32_t old = absent[x];
        int32_t up = old + ((255 - old + round) >> shift), down = old - ((old + round) >> shift);
        int32_t next = seen[x] > 0.0f ? down : up;
        absent[x] = (uint8_t)((busy[x] | front[x]) != 0 ? old : next);
    }
}

/* The thing goes on over pixel i as it is about it. */
static void cover(const hidden_job *job, int32_t i, const hits *h)
{
    const rlf_slot *slot = job->slot;
    float nearest = slot->depth[h->at[h->nearest]], inverse = 0.0f, weights = 0.0f;
    rlf_vec3 normal = {0.0, 0.0, 0.0};
    for (int32_t k = 0; k < WAYS; k++) {
        int32_t at = h->at[k];
        if (!is_front(job, at) || depth_step_between(&job->step, slot->depth[at], nearest)) {
            continue;
        }
        float weight = 1.0f / h->away[k];
        inverse += weight / slot->depth[at];
        weights += weight;
        const rlf_vec3 n = {slot->normal[0][at], slot->normal[1][at], slot->normal[2][at]};
        normal = rlf_mad(normal, n, weight);
    }
    slot->depth[i] = weights / inverse;
    slot->reason[i] = RLF_REASON_FILLED;
    slot->foreground[i] = RLF_SEEN_FOREGROUND;
    if (rlf_dot(normal, normal) > 0.0) {
        normal = rlf_normalize(normal);
        slot->normal[0][i] = (float)normal.x;
        slot->normal[1][i] = (float)normal.y;
        slot->normal[2][i] = (float)normal.z;
    }
}

enum { BUSY = 1, HIDDEN = RLF_COVERED };

/* The run of empty pixels of a row that x is in. */
static rlf_span find_run(const hidden_job *job, int32_t row, int32_t x)
{
    rlf_span run = {x, x + 1};
    while (run.x0 > 0 && is_empty(job, row + run.x0 - 1)) {
        run.x0--;
    }
    while (run.x1 < job->stage->grid.width && is_empty(job, row + run.x1)) {
        run.x1++;
    }
    return run;
}

/* Something in front is met from pixel i of a run in a row or column. */
static bool is_beside_front(const hidden_job *job, int32_t i, rlf_span run, int32_t row)
{
    int32_t width = job->stage->grid.width;
    return is_front(job, job->up[i]) || is_front(job, job->down[i]) ||
           (run.x0 > 0 && is_front(job, row + run.x0 - 1)) ||
           (run.x1 < width && is_front(job, row + run.x1));
}

/* Of the empty pixels of a row within the area: whether they are hidden. */
static void decide_row(const hidden_job *job, int32_t y)
{
    int32_t row = y * job->stage->grid.width, end = job->area.x1;
    const uint8_t *reason = job->slot->reason + row; /* 0 = OK */
    rlf_span run = {0, 0};
    for (int32_t x = job->area.x0; (x = rlf_kernel_next_mark(reason, x, end)) < end; x++) {
        if (!is_empty(job, row + x)) {
            continue;
        }
        run = x < run.x1 ? run : find_run(job, row, x);
        if (is_beside_front(job, row + x, run, row)) {
            hits h = look_about(job, x, y, run);
            job->busy[row + x] = is_hidden(job, row + x, &h) ? HIDDEN : BUSY;
        }
    }
}

/* Covers those that are. No pixel that is covered is asked about by another one any more. */
static void cover_row(const hidden_job *job, int32_t y)
{
    int32_t width = job->stage->grid.width, row = y * width;
    const uint8_t *busy = job->busy + row;
    rlf_span run = {0, 0}, *front = &job->stage->work.front[y];
    for (int32_t x = 0; (x = rlf_kernel_next_mark(busy, x, width)) < width; x++) {
        if (busy[x] == HIDDEN) {
            run = x < run.x1 ? run : find_run(job, row, x);
            const hits h = look_about(job, x, y, run);
            cover(job, row + x, &h);
            *front = rlf_span_unite(*front, (rlf_span){x, x + 1});
        }
    }
}

/* In each frame a fourth of the rows is learnt, while the background is learnt all. */
static void cover_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const hidden_job *job = context;
    ptrdiff_t width = job->stage->grid.width;
    for (int32_t y = begin; y < end; y++) {
        memset(job->busy + y * width, 0, (size_t)width);
        if (y >= job->area.y0 && y < job->area.y1) {
            decide_row(job, y);
            cover_row(job, y);
        }
        if (job->is_learning || (y - job->stage->background.frames) % LEARN_ROWS == 0) {
            ptrdiff_t row = y * width;
            learn_row(job->seen + row, job->busy + row, job->slot->foreground + row,
                      job->is_learning ? 1 : LEARN_SHIFT, (int32_t)width,
                      job->stage->background.absent + row);
        }
    }
}

/* About what is in front, as far as it may hide something when it is a metre away. */
static rlf_rect find_area(const rlf_reconstruct *stage)
{
    const image_grid *grid = &stage->grid;
    rlf_rect area = {grid->width, grid->height, 0, 0};
    for (int32_t y = 0; y < grid->height; y++) {
        const rlf_span span = stage->work.front[y];
        if (span.x0 < span.x1) {
            area.x0 = rlf_least(area.x0, span.x0);
            area.x1 = span.x1 > area.x1 ? span.x1 : area.x1;
            area.y0 = rlf_least(area.y0, y);
            area.y1 = y + 1;
        }
    }
    if (area.x0 >= area.x1) {
        return (rlf_rect){0, 0, 0, 0};
    }
    int32_t reach = (int32_t)(reach_m * (float)grid->camera.fx) + 1;
    return (rlf_rect){area.x0 > reach ? area.x0 - reach : 0, area.y0 > reach ? area.y0 - reach : 0,
                      rlf_least(area.x1 + reach, grid->width),
                      rlf_least(area.y1 + reach, grid->height)};
}

void rlf_background_cover(rlf_reconstruct *stage, const float *kept, const rlf_slot *slot,
                          bool is_learning)
{
    const image_grid *grid = &stage->grid;
    if (!stage->def.enable_fill) {
        return;
    }
    hidden_job job = {.stage = stage,
                      .slot = slot,
                      .seen = kept,
                      .area = is_learning ? (rlf_rect){0, 0, 0, 0} : find_area(stage),
                      .up = stage->background.up,
                      .down = stage->work.map,
                      .busy = stage->background.covered,
                      .step = depth_step_make(&stage->def.rig.noise, grid->camera.fx),
                      .is_learning = is_learning};
    for (int32_t y = 0; y < job.area.y1; y++) {
        look_beside(&job, y, -grid->width, job.up);
    }
    for (int32_t y = grid->height - 1; y >= job.area.y0 && job.area.y1 > 0; y--) {
        look_beside(&job, y, grid->width, job.down);
    }
    rlf_parallel_for(stage->def.pool, grid->height, RLF_ROW_GRAIN, cover_rows, &job);
}
