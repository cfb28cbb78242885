/* Normals at edges of what stands still, by a vote over time.
 *
 * At creases and contours each frame chooses one of several faces for a pixel, and noise chooses
 * anew in every frame. So frames vote. Of all normals that a pixel was ever given, the one that
 * more than half of its frames agree on is found with one candidate and one count (Boyer and Moore
 * 1991): a frame that agrees adds one to the count, one that does not takes one away, and at zero
 * the newest normal becomes the candidate. The count ends at a second's frames, so what has changed
 * stays no longer than that, and only at the depth where it was.
 *
 * Only pixels that were filled or lay on a crease in one of the last frames vote, and only while
 * they show the background: what moves has nothing to agree on. When the background is known, all
 * pixels that found something else take the candidate. A filled pixel takes the depth, too: each
 * frame guesses anew on which side of a contour it is. */
#include "surface/depth_step.h"
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <math.h>
#include <string.h>

static const float AGREED = 0.94f; /* cosine: 20 degrees */

enum {
    LEAST_VOTES = 3, /* for the published background */
    WATCHED = 9      /* frames that a pixel votes in after one that gave reason to */
};

typedef struct vote_job {
    const rlf_reconstruct *stage;
    const uint8_t *reason, *foreground;
    float *depth;
    float *const *normal;
    rlf_vote *votes;
    uint8_t *watch;
    depth_step step;
} vote_job;

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void read_normal(const vote_job *job, ptrdiff_t i, float out[3])
{
    for (int32_t k = 0; k < 3; k++) {
        out[k] = job->normal[k][i];
    }
}

static void write_normal(const vote_job *job, ptrdiff_t i, const float normal[3])
{
    for (int32_t k = 0; k < 3; k++) {
        job->normal[k][i] = normal[k];
    }
}

static bool is_there(const vote_job *job, const rlf_vote *v, ptrdiff_t i)
{
    return !depth_step_between(&job->step, job->depth[i], v->depth);
}

/* ---- the vote ---- */

static void propose(rlf_vote *v, const float normal[3], float depth)
{
    memcpy(v->normal, normal, sizeof v->normal);
    v->depth = depth;
    v->count = 1;
}

/* The candidate is the mean of those that agree. */
static void agree(rlf_vote *v, const float normal[3], float depth)
{
    if (v->count == RLF_VOTE_MOST) {
        return;
    }
    v->count++;
    float part = 1.0f / (float)v->count;
    for (int32_t k = 0; k < 3; k++) {
        v->normal[k] += part * (normal[k] - v->normal[k]);
    }
    float inverse = 1.0f / sqrtf(dot(v->normal, v->normal));
    for (int32_t k = 0; k < 3; k++) {
        v->normal[k] *= inverse;
    }
    v->depth += part * (depth - v->depth);
}

static void vote(const vote_job *job, ptrdiff_t i)
{
    rlf_vote *v = &job->votes[i];
    float own[3], depth = job->depth[i];
    read_normal(job, i, own);
    bool is_near = is_there(job, v, i);
    if (!(dot(own, own) > 0.5f)) {
        return; /* it has none */
    }
    if (v->count == 0) {
        propose(v, own, depth);
    } else if (is_near && dot(own, v->normal) > AGREED) {
        agree(v, own, depth);
    } else if (--v->count == 0) {
        propose(v, own, depth);
    } else if (is_near || job->reason[i] == RLF_REASON_FILLED) {
        write_normal(job, i, v->normal);
        job->depth[i] = is_near ? depth : v->depth;
    }
}

/* Filled pixels of the background are watched from now on. */
static void watch_filled(const vote_job *job, ptrdiff_t row, int32_t width)
{
    const uint8_t *restrict reason = job->reason + row, *restrict front = job->foreground + row;
    uint8_t *restrict watch = job->watch + row;
    for (int32_t x = 0; x < width; x++) {
        watch[x] = (reason[x] == RLF_REASON_FILLED) & (front[x] == 0) ? WATCHED : watch[x];
    }
}

static void vote_pixel(const vote_job *job, ptrdiff_t i)
{
    if (job->foreground[i] != 0) { /* what stands in front keeps its own normal */
        return;
    }
    job->watch[i]--;
    if (job->watch[i] == 0) {
        job->votes[i].count = 0;
    } else if (job->depth[i] > 0.0f) {
        vote(job, i);
    }
}

static void vote_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const vote_job *job = context;
    int32_t width = job->stage->grid.width;
    for (int32_t y = begin; y < end; y++) {
        ptrdiff_t row = (ptrdiff_t)y * width;
        watch_filled(job, row, width);
        for (int32_t x = 0; (x = rlf_kernel_next_mark(job->watch + row, x, width)) < width; x++) {
            vote_pixel(job, row + x);
        }
    }
}

void vote_normals(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    vote_job job = {.stage = stage,
                    .reason = slot->reason,
                    .foreground = slot->foreground,
                    .depth = slot->depth,
                    .normal = slot->normal,
                    .votes = stage->normals.vote.votes,
                    .watch = stage->normals.vote.watch,
                    .step = depth_step_make(&stage->def.rig.noise, stage->grid.camera.fx)};
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, vote_rows, &job);
}

/* ---- what others ask ---- */

bool vote_is_wanted(const rlf_reconstruct_def *def)
{
    bool exact = def->normal_method == RLF_NORMALS_INVERSE_DEPTH && def->normals_face_camera;
    bool known = def->background_method != RLF_BACKGROUND_OFF;
    return exact && known && def->enable_smoothing && def->enable_steadying &&
           def->enable_edge_normals;
}

const rlf_vote *vote_at(const rlf_reconstruct *stage, ptrdiff_t i)
{
    const normals_votes *state = &stage->normals.vote;
    bool any = state->votes != NULL && state->watch[i] != 0;
    return any && state->votes[i].count >= LEAST_VOTES ? &state->votes[i] : NULL;
}

void vote_watch(const rlf_reconstruct *stage, ptrdiff_t first, const uint8_t *marks, int32_t count)
{
    uint8_t *restrict watch = stage->normals.vote.watch + first; /* no byte of the marks */
    for (int32_t k = 0; k < count; k++) {
        watch[k] = marks[k] != 0 ? WATCHED : watch[k];
    }
}
