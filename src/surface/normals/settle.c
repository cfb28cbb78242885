/* Normals at edges of what stands still, decided over time.
 *
 * At creases and outlines each frame chooses one of several faces for a pixel, and noise chooses
 * anew in every frame. Which normal most frames agree on is found by a majority vote that keeps one
 * candidate and a count (Boyer and Moore 1991): a frame that agrees adds to it and refines it, one
 * that does not takes from it, and at zero the next candidate is the newest. So what has changed
 * stays for no longer than its votes, and only at the depth where it was. Only pixels that ever
 * were filled or lay on a crease are watched, and only while they show the background: what moves
 * has nothing to agree on. What was filled is completed from what has been settled for what was
 * seen beside it. On which side of an outline a filled pixel is, each frame guesses anew as well:
 * one that is on another than most frames agree on is put back, depth and normal.
 *
 * The gates of the next frame's steadying go by what the frame itself saw (rlf_settle_lags): a
 * pixel that was overruled by a steep face's noise must not count as motion, or the other way
 * round. What has been settled for long may be the steeper one, and counts then: a side that frames
 * take for the front beside it is as noisy as a side. */
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <math.h>
#include <string.h>

static const float AGREED = 0.94f;     /* cosine: 20 degrees */
static const float MOST_APART = 0.03f; /* share of the depth, of one surface */

enum {
    LEAST_VOTES = 3,    /* for the published background */
    LEADING_VOTES = 16, /* for what is completed from what was seen */
    /* A pixel's mark is how many frames it is still watched for. */
    MOST_IDLE = 8, /* frames in a row that gave no reason to */
    DUE = 128,     /* the newest frame gives one */
    AGREES = 64,   /* it agrees, and all votes are for that already */
    TOGETHER = 64, /* pixels */
    SPAN = 512
};

enum { ASKED = 1, ENDED };

enum { OVERRULED = 1, OVERRULED_AHEAD /* of the vote */ };

typedef struct settle_job {
    int32_t width;
    const uint8_t *reason, *foreground, *known;
    float *depth;
    float *const *normal;
    rlf_settled *settled;
    uint8_t *mark, *overruled;
} settle_job;

static void propose(rlf_settled *s, const float normal[3], float depth)
{
    memcpy(s->normal, normal, sizeof s->normal);
    s->depth = depth;
    s->votes = 1;
}

static void agree(rlf_settled *s, const float normal[3], float depth)
{
    if (s->votes == RLF_SETTLE_MOST_VOTES) {
        return;
    }
    s->votes++;
    float part = 1.0f / (float)s->votes, square = 0.0f;
    for (int32_t k = 0; k < 3; k++) {
        s->normal[k] += part * (normal[k] - s->normal[k]);
        square += s->normal[k] * s->normal[k];
    }
    float inverse = 1.0f / sqrtf(square);
    for (int32_t k = 0; k < 3; k++) {
        s->normal[k] *= inverse;
    }
    s->depth += part * (depth - s->depth);
}

static void write_normal(const settle_job *job, ptrdiff_t i, const float normal[3])
{
    for (int32_t k = 0; k < 3; k++) {
        job->normal[k][i] = normal[k];
    }
}

static void overrule(const settle_job *job, ptrdiff_t i, const float normal[3])
{
    rlf_settled *s = &job->settled[i];
    memmove(s->own, normal, sizeof s->own);
    write_normal(job, i, s->normal);
    job->overruled[i] = OVERRULED;
}

/* What a watched pixel has now, and how that is to what was settled. */
typedef struct ballot {
    float normal[3], depth, cosine;
    bool is_near;
} ballot;

static void vote(const settle_job *job, ptrdiff_t i, const ballot *now)
{
    rlf_settled *s = &job->settled[i];
    if (s->votes == 0) {
        propose(s, now->normal, now->depth);
    } else if (now->is_near && now->cosine > AGREED) {
        agree(s, now->normal, now->depth);
    } else if (--s->votes == 0) {
        write_normal(job, i, now->normal);
        propose(s, now->normal, now->depth);
    } else if (now->is_near) {
        overrule(job, i, now->normal);
    } else if (job->reason[i] == RLF_REASON_FILLED) {
        overrule(job, i, now->normal);
        job->depth[i] = s->depth;
    }
}

/* Returns whether the vote matters: it does not where there is no normal, or one that all votes are
 * for already. */
static bool compare(const settle_job *job, ptrdiff_t i, ballot *now)
{
    const rlf_settled *s = &job->settled[i];
    float z = job->depth[i], square = 0.0f;
    *now = (ballot){{job->normal[0][i], job->normal[1][i], job->normal[2][i]}, z, 0.0f, false};
    if (job->overruled[i] == OVERRULED_AHEAD) {
        memcpy(now->normal, s->own, sizeof s->own);
    }
    for (int32_t k = 0; k < 3; k++) {
        now->cosine += now->normal[k] * s->normal[k];
        square += now->normal[k] * now->normal[k];
    }
    now->is_near = rlf_kernel_abs(z - s->depth) < MOST_APART * z;
    bool is_settled = (s->votes == RLF_SETTLE_MOST_VOTES) & now->is_near & (now->cosine > AGREED);
    return (square > 0.5f) & !is_settled;
}

/* What pixels have is far apart in memory: looked at together, without a branch, it is waited for
 * once. */
static void vote_all(const settle_job *job, ptrdiff_t row, const int32_t *asked, int32_t count)
{
    ballot now[TOGETHER + 1];
    int32_t voting[TOGETHER + 1], votes = 0;
    for (int32_t k = 0; k < count; k++) {
        voting[votes] = asked[k];
        votes += compare(job, row + asked[k], &now[votes]);
    }
    for (int32_t k = 0; k < votes; k++) {
        vote(job, row + voting[k], &now[k]);
    }
}

/* Without a branch: whole rows are looked at. */
static uint8_t choose(bool first, uint8_t a, uint8_t b)
{
    uint8_t mask = (uint8_t) - (int32_t)first;
    return (uint8_t)((a & mask) | (b & ~mask));
}

/* Counts the marks on, and says which pixels are asked and which are no longer watched. What is
 * only in front of the background gives no reason to watch it. */
static void count_marks(const uint8_t *restrict reason, const uint8_t *restrict foreground,
                        int32_t count, uint8_t *restrict mark, uint8_t *restrict now)
{
    for (int32_t x = 0; x < count; x++) {
        bool is_front = foreground[x] != 0;
        bool agrees = (mark[x] & AGREES) != 0;
        uint8_t old = (uint8_t)((mark[x] & (uint8_t)~AGREES) |
                                choose(reason[x] == RLF_REASON_FILLED, DUE, 0));
        uint8_t next = choose(old >= DUE, MOST_IDLE, (uint8_t)(old - (old != 0)));
        mark[x] = choose(is_front, old & (DUE - 1), next);
        now[x] = choose(is_front, 0,
                        choose(next != 0, choose(agrees, 0, ASKED), choose(old != 0, ENDED, 0)));
    }
}

RLF_KERNEL_PART void fetch(const settle_job *job, ptrdiff_t i)
{
    RLF_KERNEL_SOON(&job->settled[i]);
    for (int32_t k = 0; k < 3; k++) {
        RLF_KERNEL_SOON(&job->normal[k][i]);
    }
}

static void settle_pixels(const settle_job *job, ptrdiff_t first, int32_t count)
{
    uint8_t now[SPAN];
    int32_t asked[TOGETHER], waiting = 0;
    count_marks(job->reason + first, job->foreground + first, count, job->mark + first, now);
    for (int32_t x = 0; (x = rlf_kernel_next_mark(now, x, count)) < count; x++) {
        if (now[x] == ENDED) {
            job->settled[first + x].votes = 0;
        } else if (job->depth[first + x] > 0.0f) {
            fetch(job, first + x);
            asked[waiting++] = x;
        }
        if (waiting == TOGETHER) {
            vote_all(job, first, asked, waiting);
            waiting = 0;
        }
    }
    vote_all(job, first, asked, waiting);
}

/* What stands in front keeps its own normals. */
static void take_back(const settle_job *job, ptrdiff_t row)
{
    uint8_t *overruled = job->overruled + row;
    for (int32_t x = 0; (x = rlf_kernel_next_mark(overruled, x, job->width)) < job->width; x++) {
        if (job->foreground[row + x] != 0) {
            write_normal(job, row + x, job->settled[row + x].own);
            overruled[x] = 0;
        }
    }
}

static void settle_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const settle_job *job = context;
    for (int32_t y = begin; y < end; y++) {
        ptrdiff_t row = (ptrdiff_t)y * job->width;
        take_back(job, row);
        for (int32_t x = 0; x < job->width; x += SPAN) {
            settle_pixels(job, row + x, job->width - x < SPAN ? job->width - x : SPAN);
        }
    }
}

/* ---- before what was filled is completed ---- */

/* A seen pixel that is watched has what was settled at its depth, unless it found that itself. */
static void lead(const settle_job *job, ptrdiff_t i)
{
    rlf_settled *s = &job->settled[i];
    float z = job->depth[i], cosine = 0.0f, square = 0.0f;
    const float own[3] = {job->normal[0][i], job->normal[1][i], job->normal[2][i]};
    for (int32_t k = 0; k < 3; k++) {
        cosine += own[k] * s->normal[k];
        square += own[k] * own[k];
    }
    bool is_near = rlf_kernel_abs(z - s->depth) < MOST_APART * z;
    bool agrees = cosine > AGREED;
    bool is_settled = (s->votes == RLF_SETTLE_MOST_VOTES) & is_near & agrees;
    job->mark[i] = (uint8_t)(job->mark[i] | (is_settled ? AGREES : 0));
    if ((square > 0.5f) & (s->votes >= LEADING_VOTES) & is_near & !agrees) {
        memcpy(s->own, own, sizeof own);
        write_normal(job, i, s->normal);
        job->overruled[i] = OVERRULED_AHEAD;
    }
}

/* As with votes: what some pixels have is on its way while the next are found. */
static void lead_row(const settle_job *job, ptrdiff_t row)
{
    const uint8_t *mark = job->mark + row, *known = job->known + row;
    for (int32_t x = 0; x < job->width;) {
        int32_t seen[TOGETHER], count = 0;
        for (; count < TOGETHER; x++) {
            x = rlf_kernel_next_mark(mark, x, job->width);
            if (x >= job->width) {
                break;
            }
            if (known[x] != 0) {
                fetch(job, row + x);
                seen[count++] = x;
            }
        }
        for (int32_t k = 0; k < count; k++) {
            lead(job, row + seen[k]);
        }
    }
}

static void lead_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const settle_job *job = context;
    for (int32_t y = begin; y < end; y++) {
        ptrdiff_t row = (ptrdiff_t)y * job->width;
        memset(job->overruled + row, 0, (size_t)job->width);
        lead_row(job, row);
    }
}

void rlf_settle_lead(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    settle_job job = {.width = stage->grid.width,
                      .known = stage->work.mask[0],
                      .depth = slot->depth,
                      .normal = slot->normal,
                      .settled = stage->steady.settled,
                      .mark = stage->steady.mark,
                      .overruled = stage->steady.overruled};
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, lead_rows, &job);
}

bool rlf_settle_is_wanted(const rlf_reconstruct_def *def)
{
    bool exact = def->normal_method == RLF_NORMALS_INVERSE_DEPTH && def->normals_face_camera;
    bool known = def->background_method != RLF_BACKGROUND_OFF;
    return exact && known && def->enable_smoothing && def->enable_steadying &&
           def->enable_edge_normals;
}

void rlf_settle_normals(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    settle_job job = {.width = stage->grid.width,
                      .reason = slot->reason,
                      .foreground = slot->foreground,
                      .depth = slot->depth,
                      .normal = slot->normal,
                      .settled = stage->steady.settled,
                      .mark = stage->steady.mark,
                      .overruled = stage->steady.overruled};
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, settle_rows, &job);
}

const rlf_settled *rlf_settle_at(const rlf_reconstruct *stage, ptrdiff_t i)
{
    const rlf_steady *steady = &stage->steady;
    bool any =
        steady->settled != NULL && steady->mark[i] != 0 && steady->settled[i].votes >= LEAST_VOTES;
    return any ? &steady->settled[i] : NULL;
}

void rlf_settle_watch(const rlf_reconstruct *stage, ptrdiff_t first, const uint8_t *marks,
                      int32_t count)
{
    uint8_t *restrict mark = stage->steady.mark + first; /* no byte of the marks that are given */
    for (int32_t k = 0; k < count; k++) {
        mark[k] = (uint8_t)(mark[k] | (marks[k] != 0 ? DUE : 0));
    }
}

void rlf_settle_ask(const rlf_reconstruct *stage, ptrdiff_t i)
{
    if (stage->steady.mark != NULL) {
        stage->steady.mark[i] &= (uint8_t)~AGREES;
    }
}

/* The steeper of the normals that pixel i found and that were settled, in the frame before. */
static const float *steeper(const rlf_reconstruct *stage, ptrdiff_t i)
{
    const rlf_settled *s = &stage->steady.settled[i];
    float x = stage->grid.ray_x[i], y = stage->grid.ray_y[i];
    float own = s->own[0] * x + s->own[1] * y + s->own[2];
    float settled = s->normal[0] * x + s->normal[1] * y + s->normal[2];
    return settled > own && s->votes > LEADING_VOTES ? s->normal : s->own;
}

void rlf_settle_lags(const rlf_reconstruct *stage, ptrdiff_t row, const rlf_kernel_lag_in *in,
                     int8_t *lag)
{
    const uint8_t *overruled = stage->steady.overruled + row;
    int32_t width = stage->grid.width;
    rlf_kernel_noise noise = rlf_kernel_noise_make(&stage->def.rig.noise);
    for (int32_t x = 0; (x = rlf_kernel_next_mark(overruled, x, width)) < width; x++) {
        const float *own = steeper(stage, row + x);
        const rlf_kernel_lag_in one = {{&own[0], &own[1], &own[2]},
                                       in->ray_x + x,
                                       in->ray_y + x,
                                       in->depth + x,
                                       in->mean + x,
                                       in->frames + x};
        rlf_kernel_lag_row(noise, &one, 1, lag + x);
    }
}
