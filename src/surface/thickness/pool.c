/* What the lines beside a chord say about its body.
 *
 * Its shape: sums are pooled with those of the neighbours, which count less the farther they are.
 * The depth of its middle: a row's front says less about it than the rows above and below do
 * together. Trunks and limbs have axes, whose depth changes little from row to row. Two sweeps,
 * down and up, carry it from chord to chord as a Kalman filter and smoother do. */
#include "surface/thickness/thickness.h"

static const float pooled_share = 0.6f; /* of the sums of a line a pixel away */
static const float alike = 0.7f;        /* overlap of chords with one shape ... */
static const float one_axis = 0.5f;     /* ... and with one axis, of both together */
static const float drift_m = 0.005f;    /* of the axis, from one row of pixels to the next */
static const float unlike_m = 0.04f;    /* more where chords differ in width */

/* What one line takes from the one beside it: `other` is the chord there that has most in common
 * with c, such a share of both together. */
typedef void take_fn(const rlf_chord_job *job, rlf_chord *c, const rlf_chord *other, float share);

static const rlf_chord *counterpart(const rlf_chord *c, const rlf_chord *of, int32_t count,
                                    float shift, float *best_share)
{
    const rlf_chord *best = NULL;
    *best_share = 0.0f;
    for (int32_t i = 0; i < count; i++) {
        float begin = of[i].begin + shift, end = of[i].end + shift;
        float shared = (end < c->end ? end : c->end) - (begin > c->begin ? begin : c->begin);
        float whole = (end > c->end ? end : c->end) - (begin < c->begin ? begin : c->begin);
        if (of[i].label == c->label && shared > *best_share * whole) {
            *best_share = shared / whole;
            best = &of[i];
        }
    }
    return best;
}

/* One pass over the lines, each taking from the one before. */
static void sweep(const rlf_chord_job *job, int32_t from, int32_t to, int32_t step, take_fn *take)
{
    for (int32_t line = from; line != to; line += step) {
        rlf_chord *chords = &job->chords[(ptrdiff_t)line * RLF_CHORDS_PER_LINE];
        const rlf_chord *before = NULL;
        int32_t count = 0;
        float shift = 0.0f;
        if (line != from) {
            before = &job->chords[(ptrdiff_t)(line - step) * RLF_CHORDS_PER_LINE];
            count = job->counts[line - step];
            shift = rlf_line_origin(job, line - step) - rlf_line_origin(job, line);
        }
        for (int32_t i = 0; i < job->counts[line]; i++) {
            float share;
            const rlf_chord *other = counterpart(&chords[i], before, count, shift, &share);
            take(job, &chords[i], other, share);
        }
    }
}

static void add_moments(rlf_chord_moments *to, const rlf_chord_moments *m, float share)
{
    to->ss += share * m->ss;
    to->hh += share * m->hh;
    to->sh += share * m->sh;
    to->sy += share * m->sy;
    to->hy += share * m->hy;
}

/* Forgets exponentially. */
static void take_shape(const rlf_chord_job *job, rlf_chord *c, const rlf_chord *other, float share)
{
    const float q = pooled_share;
    bool is_every = job->step == 1;
    c->running = c->own;
    if (share > alike) {
        /* a line stands for half of those beside it that are left out */
        float beside = is_every ? q : (0.5f * q + q * q + 0.5f * q * q * q) / (1.0f + q);
        add_moments(&c->running, &other->running, is_every ? q : q * q);
        add_moments(&c->pooled, &other->running, beside);
    }
}

static rlf_chord_middle fuse(rlf_chord_middle a, rlf_chord_middle b)
{
    float weight = a.weight + b.weight;
    float depth = a.weight * a.depth + b.weight * b.depth;
    return (rlf_chord_middle){weight > 0.0f ? depth / weight : 0.0f, weight};
}

static void take_middle(const rlf_chord_job *job, rlf_chord *c, const rlf_chord *other, float share)
{
    rlf_chord_middle predicted = {0.0f, 0.0f};
    if (share > one_axis) {
        float unlike = unlike_m * (1.0f - share), drift2 = (float)job->step * drift_m * drift_m;
        float variance = 1.0f / other->filtered.weight + drift2 + unlike * unlike;
        predicted = (rlf_chord_middle){other->filtered.depth, 1.0f / variance};
    }
    c->filtered = fuse(c->seen, predicted);
    c->beside = fuse(c->beside, predicted);
}

void rlf_chords_pool(const rlf_chord_job *job, int32_t line_count)
{
    for (int32_t line = 0; line < line_count; line++) {
        for (int32_t i = 0; i < job->counts[line]; i++) {
            rlf_chord *c = &job->chords[(ptrdiff_t)line * RLF_CHORDS_PER_LINE + i];
            c->pooled = c->own;
        }
    }
    sweep(job, 0, line_count, 1, take_shape);
    sweep(job, line_count - 1, -1, -1, take_shape);
}

void rlf_chords_align(const rlf_chord_job *job, int32_t row_count)
{
    for (int32_t row = 0; row < row_count; row++) {
        for (int32_t i = 0; i < job->counts[row]; i++) {
            rlf_chord *c = &job->chords[(ptrdiff_t)row * RLF_CHORDS_PER_LINE + i];
            c->seen = rlf_chord_middle_seen(c);
        }
    }
    sweep(job, 0, row_count, 1, take_middle);
    sweep(job, row_count - 1, -1, -1, take_middle);
}
