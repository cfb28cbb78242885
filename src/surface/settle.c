/* Normals at edges of what stands still, decided over time.
 *
 * At creases and outlines each frame chooses one of several faces for a pixel, and noise chooses
 * anew in every frame. Which normal most frames agree on is found by a majority vote that keeps one
 * candidate and a count (Boyer and Moore 1991): a frame that agrees adds to it and refines it, one
 * that does not takes from it, and at zero the next candidate is the newest. So what has changed
 * stays for no longer than its votes, and only at the depth where it was. Only pixels that ever
 * were filled or lay on a crease are watched, and only while they show the background: what moves
 * has nothing to agree on.
 *
 * The gates of the next frame's steadying go by what the frame itself saw (rlf_settle_lags): a
 * pixel that was overruled by a steep face's noise must not count as motion, or the other way
 * round. */
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <math.h>
#include <string.h>

static const float AGREED = 0.94f;     /* cosine: 20 degrees */
static const float MOST_APART = 0.03f; /* share of the depth, of one surface */

enum {
    MOST_VOTES = 32, /* a second: as long may what was stay */
    /* A pixel's mark is how many frames it is still watched for. */
    MOST_IDLE = 8, /* frames in a row that gave no reason to */
    DUE = 128,     /* the newest frame gives one */
    TOGETHER = 64  /* pixels */
};

typedef struct settle_job {
    int32_t width;
    const uint8_t *reason, *foreground;
    const float *depth;
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
    if (s->votes == MOST_VOTES) {
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

static void overrule(const settle_job *job, ptrdiff_t i, const float normal[3])
{
    rlf_settled *s = &job->settled[i];
    memcpy(s->own, normal, sizeof s->own);
    for (int32_t k = 0; k < 3; k++) {
        job->normal[k][i] = s->normal[k];
    }
    job->overruled[i] = 1;
}

/* False when the frame has nothing to say about the pixel. What is only in front of the background
 * gives no reason to watch it. */
static bool is_asked(const settle_job *job, ptrdiff_t i)
{
    uint8_t mark = job->mark[i];
    if (job->foreground[i] != 0) {
        job->mark[i] = mark & (DUE - 1);
        return false;
    }
    job->mark[i] = (uint8_t)(mark >= DUE ? MOST_IDLE : mark - 1);
    if (job->mark[i] == 0) {
        job->settled[i].votes = 0;
    }
    return job->mark[i] != 0 && job->depth[i] > 0.0f;
}

/* What a watched pixel has now. */
typedef struct ballot {
    float normal[3], depth;
    int32_t votes; /* of the normal so far */
} ballot;

static void vote(const settle_job *job, ptrdiff_t i, const ballot *now)
{
    float z = now->depth, cosine = 0.0f, square = 0.0f;
    rlf_settled *s = &job->settled[i];
    for (int32_t k = 0; k < 3; k++) {
        cosine += now->normal[k] * s->normal[k];
        square += now->normal[k] * now->normal[k];
    }
    bool is_near = rlf_kernel_abs(z - s->depth) < MOST_APART * z;
    if (!(square > 0.5f)) {
        return;
    }
    if (now->votes == 0) {
        propose(s, now->normal, z);
    } else if (is_near && cosine > AGREED) {
        agree(s, now->normal, z);
    } else if (--s->votes == 0) {
        propose(s, now->normal, z);
    } else if (is_near) {
        overrule(job, i, now->normal);
    }
}

/* What pixels have is far apart in memory: fetched together it is waited for once. */
static void vote_all(const settle_job *job, ptrdiff_t row, const int32_t *asked, int32_t count)
{
    ballot now[TOGETHER];
    for (int32_t k = 0; k < count; k++) {
        ptrdiff_t i = row + asked[k];
        now[k] = (ballot){{job->normal[0][i], job->normal[1][i], job->normal[2][i]},
                          job->depth[i],
                          job->settled[i].votes};
    }
    for (int32_t k = 0; k < count; k++) {
        vote(job, row + asked[k], &now[k]);
    }
}

static void settle_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const settle_job *job = context;
    for (int32_t y = begin; y < end; y++) {
        ptrdiff_t row = (ptrdiff_t)y * job->width;
        const uint8_t *reason = job->reason + row; /* 0 = OK */
        uint8_t *mark = job->mark + row;
        memset(job->overruled + row, 0, (size_t)job->width);
        for (int32_t x = 0; (x = rlf_kernel_next_mark(reason, x, job->width)) < job->width; x++) {
            mark[x] |= reason[x] == RLF_REASON_FILLED ? DUE : 0;
        }
        int32_t asked[TOGETHER], count = 0;
        for (int32_t x = 0; (x = rlf_kernel_next_mark(mark, x, job->width)) < job->width;) {
            for (; x < job->width && mark[x] != 0; x++) {
                asked[count] = x;
                count += is_asked(job, row + x);
                if (count == TOGETHER) {
                    vote_all(job, row, asked, count);
                    count = 0;
                }
            }
        }
        vote_all(job, row, asked, count);
    }
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

void rlf_settle_watch(const rlf_reconstruct *stage, ptrdiff_t first, const uint8_t *marks,
                      int32_t count)
{
    for (int32_t k = 0; k < count; k++) {
        stage->steady.mark[first + k] |= marks[k] != 0 ? DUE : 0;
    }
}

void rlf_settle_lags(const rlf_reconstruct *stage, ptrdiff_t row, const rlf_kernel_lag_in *in,
                     int8_t *lag)
{
    const uint8_t *overruled = stage->steady.overruled + row;
    int32_t width = stage->grid.width;
    rlf_kernel_noise noise = rlf_kernel_noise_make(&stage->def.rig.noise);
    for (int32_t x = 0; (x = rlf_kernel_next_mark(overruled, x, width)) < width; x++) {
        const float *own = stage->steady.settled[row + x].own;
        const rlf_kernel_lag_in one = {{&own[0], &own[1], &own[2]},
                                       in->ray_x + x,
                                       in->ray_y + x,
                                       in->depth + x,
                                       in->mean + x,
                                       in->frames + x};
        rlf_kernel_lag_row(noise, &one, 1, lag + x);
    }
}
