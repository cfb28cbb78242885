/* What the lines beside a chord say about its body.
 *
 * Its shape: sums are pooled with those of the neighbours, which count less the farther they are.
 * The depth of its middle: a row's front says less about it than the rows above and below do
 * together. Trunks and limbs have axes, whose depth changes little from row to row. Two sweeps,
 * down and up, carry it from chord to chord as a Kalman filter and smoother do. */
#include "surface/thickness/thickness.h"

static const float pooled_share = 0.6f; /* of the sums of a line a pixel away */
static const float alike = 0.7f;        /* overlap of chords of one body on neighbouring lines */
static const float same_body = 0.8f;    /* overlap, of the narrower chord */
static const float drift_m = 0.005f;    /* of the axis, from one row of pixels to the next */
static const float unlike_m = 0.04f;    /* more where chords differ in width */

/* The chord of the neighbouring line that is most like this one. */
static const rlf_chord *counterpart(const rlf_chord *c, const rlf_chord *of, int32_t count,
                                    float shift)
{
    const rlf_chord *best = NULL;
    float best_share = alike;
    for (int32_t i = 0; i < count; i++) {
        float begin = of[i].begin + shift, end = of[i].end + shift;
        float shared = (end < c->end ? end : c->end) - (begin > c->begin ? begin : c->begin);
        float whole = (end > c->end ? end : c->end) - (begin < c->begin ? begin : c->begin);
        if (of[i].label == c->label && (of[i].apex < of[i].begin) == (c->apex < c->begin) &&
            shared > best_share * whole) {
            best_share = shared / whole;
            best = &of[i];
        }
    }
    return best;
}

static void add_moments(rlf_chord_moments *to, const rlf_chord_moments *m, float share)
{
    to->ss += share * m->ss;
    to->hh += share * m->hh;
    to->sh += share * m->sh;
    to->sy += share * m->sy;
    to->hy += share * m->hy;
}

/* One pass over the lines, each taking from the one before; forgets exponentially. */
static void pool_sweep(const rlf_chord_job *job, int32_t from, int32_t to, int32_t step)
{
    const float q = pooled_share;
    bool is_every = job->step == 1;
    float share = is_every ? q : q * q;
    /* a line stands for half of those beside it that are left out */
    float beside = is_every ? q : (0.5f * q + q * q + 0.5f * q * q * q) / (1.0f + q);
    for (int32_t line = from; line != to; line += step) {
        rlf_chord *chords = &job->chords[(ptrdiff_t)line * RLF_CHORDS_PER_LINE];
        int32_t before = line - step;
        float shift = 0.0f;
        if (line != from) {
            shift = rlf_line_origin(job, before) - rlf_line_origin(job, line);
        }
        for (int32_t i = 0; i < job->counts[line]; i++) {
            rlf_chord *c = &chords[i];
            const rlf_chord *other =
                line == from ? NULL
                             : counterpart(c, &job->chords[(ptrdiff_t)before * RLF_CHORDS_PER_LINE],
                                           job->counts[before], shift);
            c->running = c->own;
            if (other != NULL) {
                add_moments(&c->running, &other->running, share);
                add_moments(&c->pooled, &other->running, beside);
            }
        }
    }
}

void rlf_chords_pool(const rlf_chord_job *job, int32_t line_count)
{
    for (int32_t line = 0; line < line_count; line++) {
        for (int32_t i = 0; i < job->counts[line]; i++) {
            rlf_chord *c = &job->chords[(ptrdiff_t)line * RLF_CHORDS_PER_LINE + i];
            c->pooled = c->own;
        }
    }
    pool_sweep(job, 0, line_count, 1);
    pool_sweep(job, line_count - 1, -1, -1);
}

/* How much alike in width two chords of one body are, 0..1; 0 = they are not of one body. */
static float likeness(const rlf_chord *a, const rlf_chord *b)
{
    float wide = a->end - a->begin, narrow = b->end - b->begin;
    float shared =
        (b->end < a->end ? b->end : a->end) - (b->begin > a->begin ? b->begin : a->begin);
    if (narrow > wide) {
        float swap = wide;
        wide = narrow;
        narrow = swap;
    }
    return a->label == b->label && shared >= same_body * narrow ? narrow / wide : 0.0f;
}

/* What the line before, so many rows away, tells the chord. */
static rlf_chord_middle predict(const rlf_chord *c, const rlf_chord *of, int32_t count,
                                int32_t rows)
{
    float best = 0.0f;
    const rlf_chord *from = NULL;
    for (int32_t i = 0; i < count; i++) {
        float like = likeness(c, &of[i]);
        if (like > best) {
            best = like;
            from = &of[i];
        }
    }
    if (from == NULL) {
        return (rlf_chord_middle){0.0f, 0.0f};
    }
    float unlike = unlike_m * (1.0f - best);
    float variance =
        1.0f / from->filtered.weight + (float)rows * drift_m * drift_m + unlike * unlike;
    return (rlf_chord_middle){from->filtered.depth, 1.0f / variance};
}

static rlf_chord_middle fuse(rlf_chord_middle a, rlf_chord_middle b)
{
    float weight = a.weight + b.weight;
    float depth = a.weight * a.depth + b.weight * b.depth;
    return (rlf_chord_middle){weight > 0.0f ? depth / weight : 0.0f, weight};
}

static void axis_sweep(const rlf_chord_job *job, int32_t from, int32_t to, int32_t step)
{
    const rlf_chord *before = NULL;
    int32_t count = 0;
    for (int32_t row = from; row != to; row += step) {
        rlf_chord *chords = &job->chords[(ptrdiff_t)row * RLF_CHORDS_PER_LINE];
        for (int32_t i = 0; i < job->counts[row]; i++) {
            rlf_chord *c = &chords[i];
            rlf_chord_middle predicted = predict(c, before, count, job->step);
            c->filtered = fuse(c->seen, predicted);
            c->beside = fuse(c->beside, predicted);
        }
        before = chords;
        count = job->counts[row];
    }
}

void rlf_chords_align(const rlf_chord_job *job, int32_t row_count)
{
    for (int32_t row = 0; row < row_count; row++) {
        for (int32_t i = 0; i < job->counts[row]; i++) {
            rlf_chord *c = &job->chords[(ptrdiff_t)row * RLF_CHORDS_PER_LINE + i];
            c->seen = rlf_chord_middle_seen(c);
        }
    }
    axis_sweep(job, 0, row_count, 1);
    axis_sweep(job, row_count - 1, -1, -1);
}
