/* Heads: they tell where the middle of the trunk below is.
 *
 * A trunk seen from the side shows one flank, which says little about how far away the other one
 * is, and an arm hides a part of it. But bodies are mirror images of themselves: the middle of the
 * head, which is round and seen whole, lies in the plane between the two flanks. A head is what a
 * region begins with at its top, as wide as heads are, above a neck that is narrower. Rows are
 * taken for level: under a camera that is tilted aside nothing is a head. */
#include "surface/thickness/thickness.h"
#include "surface/thickness/torso.h"

enum { HEADS = 16 };

/* Metres. Heads and necks of adults and children, with hair: 13 to 25 cm below the top is where a
 * neck is narrowest. */
static const float head_from = 0.06f, head_to = 0.2f, neck_from = 0.13f, neck_to = 0.25f;
static const float narrowest_head = 0.11f, widest_head = 0.28f, narrowest_neck = 0.06f;
/* Where it is broadest and longest, with no nose. */
static const float brow_from = 0.07f, brow_to = 0.12f;
static const float neck_share = 0.85f;     /* of the head's width, at most */
static const float shoulder_share = 0.75f; /* of the row above: a shoulder hides the neck */
/* Of the trunk: rows below the neck, width, middle from that of the neck, flank from the head's. */
static const float trunk_from = 0.05f, trunk_to = 0.6f;
static const float narrowest_trunk = 0.15f, widest_trunk = 0.32f, aside_m = 0.12f;
static const float least_trunk = 0.1f; /* so much of its height is as wide as that */
static const float least_half = 0.04f, most_half = 0.22f;
static const float told_error_m = 0.02f;
static const float told_share = 8.0f; /* lines that cross a trunk otherwise are not told */

typedef struct neck {
    int32_t label, line;
    float x, height; /* metres; height is along the image's columns, downwards */
    float top;       /* height of the head's top */
    float brow;      /* how wide the head is there, as a ray's x; 0 = not seen */
    float depth;     /* of the head's middle ... */
    float ray_x;     /* ... and its ray */
} neck;

static float width_of(const rlf_chord *c)
{
    return (c->end - c->begin) * c->metres;
}

static float height_of(const rlf_chord_job *job, int32_t row, const rlf_chord *c)
{
    const rlf_grid *grid = &job->stage->grid;
    rlf_line line = rlf_line_at(job, row);
    ptrdiff_t i = (ptrdiff_t)line.y * grid->width + line.x + c->part[0].begin;
    return grid->ray_y[i] / c->inverse;
}

static float middle_of(const rlf_chord_job *job, const rlf_chord *c)
{
    return ((float)job->x0 + 0.5f * (c->begin + c->end)) * c->metres;
}

/* The chord of the next row that goes on with this one; NULL = none. */
static const rlf_chord *below(const rlf_chord_job *job, int32_t row, int32_t rows,
                              const rlf_chord *c)
{
    const rlf_chord *best = NULL;
    float most = 0.0f;
    for (int32_t i = 0; row + 1 < rows && i < job->counts[row + 1]; i++) {
        const rlf_chord *o = &job->chords[(ptrdiff_t)(row + 1) * RLF_CHORDS_PER_LINE + i];
        float shared =
            (o->end < c->end ? o->end : c->end) - (o->begin > c->begin ? o->begin : c->begin);
        if (o->label == c->label && shared > most) {
            most = shared;
            best = o;
        }
    }
    return best;
}

/* Whether the chord, the first of its label, is the top of a head. */
static bool find_neck(const rlf_chord_job *job, int32_t row, int32_t rows, const rlf_chord *c,
                      neck *out)
{
    float top = height_of(job, row, c), head = 0.0f, least = widest_head;
    rlf_chord_middle middle = {0.0f, 0.0f};
    float rays = 0.0f, rows_of_head = 0.0f, brow = 0.0f, rows_of_brow = 0.0f;
    *out = (neck){.label = c->label, .line = -1, .top = top};
    for (; c != NULL; row++) {
        float width = width_of(c), height = height_of(job, row, c) - top;
        if (height > neck_to) {
            break;
        }
        head = height < head_to && width > head ? width : head;
        if (height > neck_from && width < least) {
            least = width;
            out->line = row;
            out->x = middle_of(job, c);
            out->height = top + height;
        }
        if (height > head_from && height < head_to) {
            middle.depth += c->seen.weight * c->seen.depth;
            middle.weight += c->seen.weight;
            rays += middle_of(job, c) * c->inverse;
            rows_of_head += 1.0f;
        }
        if (height > brow_from && height < brow_to) {
            brow += width * c->inverse;
            rows_of_brow += 1.0f;
        }
        const rlf_chord *next = below(job, row, rows, c);
        bool is_hidden = height > neck_from && next != NULL &&
                         next->end - next->begin < shoulder_share * (c->end - c->begin);
        c = is_hidden ? NULL : next;
    }
    const rlf_camera *camera = &job->stage->grid.camera;
    out->ray_x = rays / rows_of_head - (float)(camera->cx / camera->fx);
    out->brow = rows_of_brow > 0.0f ? brow / rows_of_brow : 0.0f;
    out->depth = middle.weight > 0.0f ? middle.depth / middle.weight : 0.0f;
    return out->line >= 0 && middle.weight > 0.0f && head > narrowest_head && head < widest_head &&
           least > narrowest_neck && least < neck_share * head;
}

static bool is_trunk(const rlf_chord_job *job, const neck *n, int32_t row, const rlf_chord *c)
{
    float width = width_of(c), half = n->depth - 1.0f / c->inverse;
    float aside = middle_of(job, c) - n->x, height = height_of(job, row, c) - n->height;
    return c->label == n->label && height > trunk_from && height < trunk_to &&
           width > narrowest_trunk && width < widest_trunk && aside < aside_m && aside > -aside_m &&
           half > least_half && half < most_half;
}

/* Whether what hangs below the neck is as wide as a trunk: below a hand's wrist comes an arm. */
static bool has_trunk(const rlf_chord_job *job, const neck *n, int32_t rows)
{
    float height = 0.0f;
    for (int32_t row = n->line; row < rows && height < least_trunk; row++) {
        for (int32_t i = 0; i < job->counts[row]; i++) {
            const rlf_chord *c = &job->chords[(ptrdiff_t)row * RLF_CHORDS_PER_LINE + i];
            float aside = middle_of(job, c) - n->x;
            if (c->label == n->label && width_of(c) > narrowest_trunk && aside < aside_m &&
                aside > -aside_m) {
                height += (float)job->step * c->metres;
                break;
            }
        }
    }
    return height >= least_trunk;
}

static void tell_trunk(const rlf_chord_job *job, const neck *n, int32_t rows)
{
    for (int32_t row = n->line; row < rows; row++) {
        for (int32_t i = 0; i < job->counts[row]; i++) {
            rlf_chord *c = &job->chords[(ptrdiff_t)row * RLF_CHORDS_PER_LINE + i];
            if (is_trunk(job, n, row, c)) {
                c->beside = (rlf_chord_middle){n->depth, 1.0f / (told_error_m * told_error_m)};
                c->share = told_share;
            }
        }
    }
}

void rlf_chords_head(const rlf_chord_job *job, int32_t rows)
{
    int32_t labels[HEADS], count = 0;
    for (int32_t row = 0; row < rows; row++) {
        for (int32_t i = 0; i < job->counts[row]; i++) {
            const rlf_chord *c = &job->chords[(ptrdiff_t)row * RLF_CHORDS_PER_LINE + i];
            int32_t k = 0;
            while (k < count && labels[k] != c->label) {
                k++;
            }
            if (k < count || count == HEADS) {
                continue;
            }
            labels[count++] = c->label;
            neck found;
            if (find_neck(job, row, rows, c, &found) && has_trunk(job, &found, rows)) {
                tell_trunk(job, &found, rows);
                const rlf_vec3 head = {(double)found.ray_x * (double)found.depth, (double)found.top,
                                       (double)found.depth};
                rlf_torso_follow(job, found.label, head, (double)found.brow);
            }
        }
    }
}
