/* Cuts lines of pixels into chords.
 *
 * A piece is a run of pixels without a step in depth. It ends where the body ends (what is beside
 * it lies behind), or where something nearer hides its end. A piece that no single conic explains
 * is two bodies that touch: it is cut at its sharpest crease. Pieces on both sides of something
 * nearer are one chord when their depths agree. */
#include "surface/thickness/thickness.h"

#include <string.h>

enum { PIECES = 48, CREASE_ARM = 3, LEAST_SPLIT = 8, MOST_SPLITS = 8, MOST_HIDDEN = 200 };

static const float crease_jump_m = 0.15f;
static const float crease_least = 1.0f; /* sum of the slopes on both sides */
static const float rim_slope = 0.5f;    /* a side as steep as this ends at the crease */
static const float link_jump_m = 0.12f, link_gap_m = 0.2f;
static const float one_body = 4.0f; /* variance of a conic's rest, of what noise explains */

typedef enum piece_end { END, HIDDEN, BORDER } piece_end;

typedef struct piece {
    int32_t begin, end;
    int32_t label;
    piece_end ends[2];
    int32_t reach[2]; /* HIDDEN: steps that the nearer thing covers */
    bool linked, measured;
    rlf_chord chord; /* measured: of this piece alone */
} piece;

typedef struct pieces {
    const rlf_chord_job *job;
    const rlf_line *line;
    int32_t count;
    piece item[PIECES];
} pieces;

static ptrdiff_t pixel(const rlf_line *line, int32_t k)
{
    return line->base + k * line->stride;
}

static float front_at(const pieces *p, int32_t k)
{
    return p->job->front[pixel(p->line, k)];
}

/* How the piece ends at its pixel k, towards `side` (0 = back along the line, 1 = on). */
static void look_beside(const pieces *p, piece *s, int32_t side)
{
    const image_grid *grid = &p->job->stage->grid;
    int32_t k = side == 0 ? s->begin : s->end - 1, step = side == 0 ? -1 : 1;
    float nearer = front_at(p, k) - RLF_BODY_STEP_M;
    int32_t x = p->line->x + k * p->line->dx, y = p->line->y + k * p->line->dy;
    for (s->reach[side] = 0; s->reach[side] < MOST_HIDDEN; s->reach[side]++) {
        x += step * p->line->dx;
        y += step * p->line->dy;
        if (x < 0 || y < 0 || x >= grid->width || y >= grid->height) {
            s->ends[side] = BORDER;
            return;
        }
        float z = p->job->slot->depth[(ptrdiff_t)y * grid->width + x];
        if (!(z > 0.0f && z < nearer)) {
            break;
        }
    }
    s->ends[side] = s->reach[side] > 0 ? HIDDEN : END;
}

static void set_ends(const piece *s, int32_t side, rlf_chord *chord)
{
    /* Where something hides the end it lies anywhere behind it: in the middle, give or take. */
    const float pixel_blur = 1.0f, uniform_blur = 0.29f;
    float hidden = s->ends[side] == HIDDEN ? (float)s->reach[side] : 0.0f;
    chord->blur[side] = pixel_blur + uniform_blur * hidden;
    chord->covered[side] = 0.5f * hidden;
    if (side == 0) {
        chord->begin = (float)s->begin - 0.5f - 0.5f * hidden;
    } else {
        chord->end = (float)s->end - 0.5f + 0.5f * hidden;
    }
}

/* The chord of `count` pieces; false when nothing can be said about it. */
static bool make_chord(const pieces *p, const piece *const *piece_list, int32_t count,
                       rlf_chord *out)
{
    const piece *first = piece_list[0], *last = piece_list[count - 1];
    if (first->ends[0] == BORDER && last->ends[1] == BORDER) {
        return false;
    }
    set_ends(first, 0, out);
    set_ends(last, 1, out);
    float length = out->end - out->begin;
    if (first->ends[0] == BORDER) { /* as long again, give or take */
        out->begin -= length;
        out->blur[0] = 0.5f * length;
    }
    if (last->ends[1] == BORDER) {
        out->end += length;
        out->blur[1] = 0.5f * length;
    }
    out->label = first->label;
    out->part_count = count;
    for (int32_t i = 0; i < count; i++) {
        out->part[i] = (rlf_chord_part){piece_list[i]->begin, piece_list[i]->end};
    }
    return rlf_chord_measure(p->job, p->line, out);
}

/* How much deeper pixel k lies than what is beside it, as the sum of the slopes. */
static float crease_at(const pieces *p, int32_t k, float slope[2])
{
    float z = front_at(p, k), before = front_at(p, k - CREASE_ARM),
          after = front_at(p, k + CREASE_ARM);
    float run = z * p->line->angle * (float)CREASE_ARM;
    if (rlf_kernel_abs(before - z) > crease_jump_m || rlf_kernel_abs(after - z) > crease_jump_m) {
        return 0.0f;
    }
    slope[0] = (z - before) / run;
    slope[1] = (z - after) / run;
    return slope[0] + slope[1];
}

/* Pixel of the sharpest crease at which one side or both end; -1 = none. */
static int32_t find_crease(const pieces *p, const piece *s, bool rim[2])
{
    float best = crease_least, slope[2] = {0.0f, 0.0f};
    int32_t at = -1;
    rim[0] = rim[1] = false;
    for (int32_t k = s->begin + CREASE_ARM; k < s->end - CREASE_ARM; k++) {
        float sharp = crease_at(p, k, slope);
        if (sharp > best && (slope[0] > rim_slope || slope[1] > rim_slope)) {
            best = sharp;
            at = k;
            rim[0] = slope[0] > rim_slope;
            rim[1] = slope[1] > rim_slope;
        }
    }
    return at;
}

static bool is_one_body(const pieces *p, piece *s)
{
    const piece *alone = s;
    s->measured = make_chord(p, &alone, 1, &s->chord);
    if (s->end - s->begin < LEAST_SPLIT || !s->measured) {
        return true;
    }
    float sigma = rlf_kernel_sigma(p->job->noise, front_at(p, (s->begin + s->end) / 2));
    float explained = sigma * sigma + RLF_SHAPE_ERROR_M * RLF_SHAPE_ERROR_M;
    return rlf_chord_solve(&s->chord, &s->chord.own).variance < one_body * explained;
}

/* Cuts piece i in two if it is two bodies. A side that does not fall towards the crease goes on
 * behind the other. */
static bool split(pieces *p, int32_t i, int32_t splits)
{
    bool rim[2];
    piece *s = &p->item[i];
    if (is_one_body(p, s) || p->count == PIECES || splits == MOST_SPLITS) {
        return false;
    }
    int32_t at = find_crease(p, s, rim);
    if (at < 0) {
        return false;
    }
    memmove(s + 1, s, (size_t)(p->count - i) * sizeof *s);
    p->count++;
    s[0].end = s[1].begin = at + 1;
    s[0].ends[1] = rim[0] ? END : HIDDEN;
    s[0].reach[1] = rim[0] ? 0 : s[1].end - s[1].begin;
    s[1].ends[0] = rim[1] ? END : HIDDEN;
    s[1].reach[0] = rim[1] ? 0 : s[0].end - s[0].begin;
    return true;
}

/* The piece at which `from` comes out again behind what hides it; -1 = none. */
static int32_t next_part(const pieces *p, int32_t from)
{
    const piece *s = &p->item[from];
    if (s->ends[1] != HIDDEN) {
        return -1;
    }
    float z = front_at(p, s->end - 1);
    int32_t covered = s->end + s->reach[1];
    for (int32_t i = from + 1; i < p->count && p->item[i].begin <= covered; i++) {
        const piece *next = &p->item[i];
        float step = front_at(p, next->begin) - z;
        float gap = (float)(next->begin - s->end) * p->line->angle * z;
        if (next->ends[0] == HIDDEN && next->label == s->label && !next->linked &&
            rlf_kernel_abs(step) < link_jump_m && gap < link_gap_m) {
            return i;
        }
        if (step > RLF_BODY_STEP_M) {
            return -1;
        }
        covered = next->end > covered ? next->end : covered;
    }
    return -1;
}

static bool take_chord(const pieces *p, const piece *const *chain, int32_t count, rlf_chord *out)
{
    if (count > 1) {
        return make_chord(p, chain, count, out);
    }
    *out = chain[0]->chord;
    return chain[0]->measured;
}

/* Makes chords of all pieces found so far. */
static int32_t finish(pieces *p, rlf_chord *out, int32_t out_count)
{
    for (int32_t i = 0, splits = 0; i < p->count; i++) {
        if (split(p, i, splits)) {
            splits++;
            i--; /* its first half again */
        }
    }
    for (int32_t i = 0; i < p->count; i++) {
        const piece *chain[RLF_CHORD_PARTS];
        int32_t count = 0;
        for (int32_t k = p->item[i].linked ? -1 : i; k >= 0 && count < RLF_CHORD_PARTS;
             k = next_part(p, k)) {
            p->item[k].linked = true;
            chain[count++] = &p->item[k];
        }
        if (count > 0 && out_count < RLF_CHORDS_PER_LINE) {
            out_count += take_chord(p, chain, count, &out[out_count]) ? 1 : 0;
        }
    }
    p->count = 0;
    return out_count;
}

/* First pixel behind the piece that begins at k. */
static int32_t piece_end_from(const rlf_chord_job *job, const rlf_line *line, int32_t k)
{
    ptrdiff_t i = pixel(line, k);
    int32_t label = job->label[i];
    float z = job->front[i];
    for (k++; k < line->count; k++) {
        i += line->stride;
        float next = job->front[i];
        if (rlf_kernel_abs(next - z) > RLF_BODY_STEP_M || job->label[i] != label) {
            break;
        }
        z = next;
    }
    return k;
}

/* Steps from pixel (x, y) of the block, whose square nothing is in, to the next square. */
static int32_t steps_out(const rlf_line *line, int32_t x, int32_t y)
{
    const int32_t side = RLF_CHORD_SQUARE;
    int32_t across = line->dx > 0 ? side - x % side : side;
    int32_t along = line->dy > 0 ? side - y % side : (line->dy < 0 ? y % side + 1 : side);
    return across < along ? across : along;
}

static int32_t skip_empty(const rlf_chord_job *job, const rlf_line *line, int32_t k)
{
    while (k < line->count) {
        int32_t x = line->x + k * line->dx - job->x0, y = line->y + k * line->dy - job->y0;
        ptrdiff_t row = (ptrdiff_t)(y / RLF_CHORD_SQUARE) * job->square_pitch;
        if (job->squares[row + x / RLF_CHORD_SQUARE] == 0) {
            k += steps_out(line, x, y);
        } else if (job->front[pixel(line, k)] > 0.0f) {
            return k;
        } else {
            k++;
        }
    }
    return line->count;
}

int32_t rlf_chords_cut(const rlf_chord_job *job, const rlf_line *line, rlf_chord *out)
{
    pieces p;
    p.job = job;
    p.line = line;
    p.count = 0;
    int32_t out_count = 0;
    for (int32_t k = skip_empty(job, line, 0); k < line->count; k = skip_empty(job, line, k)) {
        if (p.count == PIECES) {
            out_count = finish(&p, out, out_count);
        }
        piece *s = &p.item[p.count++];
        s->linked = s->measured = false;
        s->label = job->label[pixel(line, k)];
        s->begin = k;
        s->end = k = piece_end_from(job, line, k);
        look_beside(&p, s, 0);
        look_beside(&p, s, 1);
    }
    return finish(&p, out, out_count);
}
