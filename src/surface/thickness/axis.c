/* Where the middles of bodies are.
 *
 * A row's front says less about the depth of its middle than the rows above and below do together:
 * trunks and limbs have axes, whose depth changes little from row to row. Two sweeps, down and up,
 * carry it from chord to chord as a Kalman filter and smoother do. */
#include "surface/thickness/thickness.h"

static const float same_body = 0.8f; /* overlap, of the narrower chord */
static const float drift_m = 0.005f; /* of the axis, from one row of pixels to the next */
static const float unlike_m = 0.04f; /* more where chords differ in width */

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
static rlf_chord_middle hear(const rlf_chord *c, const rlf_chord *of, int32_t count, int32_t rows)
{
    float best = 0.0f;
    const rlf_chord *teller = NULL;
    for (int32_t i = 0; i < count; i++) {
        float alike = likeness(c, &of[i]);
        if (alike > best) {
            best = alike;
            teller = &of[i];
        }
    }
    if (teller == NULL) {
        return (rlf_chord_middle){0.0f, 0.0f};
    }
    float unlike = unlike_m * (1.0f - best);
    float variance = 1.0f / teller->told.weight + (float)rows * drift_m * drift_m + unlike * unlike;
    return (rlf_chord_middle){teller->told.depth, 1.0f / variance};
}

static rlf_chord_middle unite(rlf_chord_middle a, rlf_chord_middle b)
{
    float weight = a.weight + b.weight;
    float depth = a.weight * a.depth + b.weight * b.depth;
    return (rlf_chord_middle){weight > 0.0f ? depth / weight : 0.0f, weight};
}

static void sweep(const rlf_chord_job *job, int32_t from, int32_t to, int32_t step)
{
    const rlf_chord *before = NULL;
    int32_t count = 0;
    for (int32_t row = from; row != to; row += step) {
        rlf_chord *chords = &job->chords[(ptrdiff_t)row * RLF_CHORDS_PER_LINE];
        for (int32_t i = 0; i < job->counts[row]; i++) {
            rlf_chord *c = &chords[i];
            rlf_chord_middle heard = hear(c, before, count, job->step);
            c->told = unite(c->seen, heard);
            c->beside = unite(c->beside, heard);
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
    sweep(job, 0, row_count, 1);
    sweep(job, row_count - 1, -1, -1);
}
