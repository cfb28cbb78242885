/* Rounds over the background's pieces. */
#include "surface/standing/standing.h"

#include "surface/background/facing.h"
#include "surface/steps.h"
#include "surface/thickness/thickness.h"

#include <math.h>
#include <string.h>

enum {
    CHANGED = 100, /* pixels that are not as they were fitted make a new round ... */
    PAUSE = 150,   /* ... so many frames after the last one began */
    SETTLED = 60,  /* so do the first frames, in which means get better */
    BESIDE = 2,    /* pixels */
    AT_FIRST = 5   /* steps per frame of the first round */
};

static const float same_m = 0.03f;     /* less is no other depth */
static const float same_share = 0.04f; /* of the depth: so far a mean of a low face moves */
static const float low = 0.3f;         /* cosine between ray and normal: less is a low angle */
static const float step_m = 0.04f;     /* beside one another on one thing */
static const float thinnest_m = 0.02f, thickest_m = 0.6f;

void rlf_standing_reset(rlf_standing *standing)
{
    standing->newest = -1;
    standing->is_round = standing->is_settled = false;
    standing->sheet_version = 0;
    standing->changed = standing->age = standing->round_age = 0;
}

const float *rlf_standing_newest(const rlf_reconstruct *stage)
{
    const rlf_standing *standing = &stage->background.thick;
    bool none = standing->newest < 0 || rlf_sheet_newest(stage) == NULL;
    return none ? NULL : standing->published[standing->newest];
}

static void begin_round(rlf_reconstruct *stage, const rlf_sheet *sheet)
{
    rlf_standing *standing = &stage->background.thick;
    size_t size = (size_t)stage->grid.count * sizeof(float);
    memcpy(standing->depth, sheet->depth, size);
    memset(standing->thickness, 0, size);
    standing->is_round = true;
    standing->step = standing->next_piece = 0;
    standing->round_age = 0;
    standing->is_settled = standing->age >= SETTLED;
}

/* The piece's runs, as those of one region, to work.runs. */
static void make_runs(const rlf_reconstruct *stage, const rlf_block *b, uint8_t piece)
{
    rlf_runs runs = stage->work.runs;
    int32_t count = 0;
    for (int32_t y = 0; y < stage->grid.height; y++) {
        const uint8_t *row = stage->background.thick.piece + (ptrdiff_t)y * stage->grid.width;
        runs.first[y] = count;
        for (int32_t x = b->x0; x < b->x1 && y >= b->y0 && y < b->y1; x++) {
            if (row[x] != piece) {
                continue;
            }
            int32_t begin = x;
            while (x < b->x1 && row[x] == piece) {
                x++;
            }
            runs.run[count++] = (rlf_run){begin, x, 1};
        }
    }
    runs.first[stage->grid.height] = count;
}

/* The piece's pixels are as thick as the box or ball is there. */
static void write_solid(const rlf_reconstruct *stage, int32_t piece,
                        const rlf_standing_solid *solid)
{
    const rlf_standing *standing = &stage->background.thick;
    const rlf_grid *grid = &stage->grid;
    const rlf_rect *w = &standing->window[piece];
    for (int32_t y = w->y0; y < w->y1; y++) {
        for (int32_t x = w->x0; x < w->x1; x++) {
            ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
            if (standing->piece[i] == piece) {
                double ray_x = (double)grid->ray_x[i], ray_y = (double)grid->ray_y[i];
                float deep = rlf_standing_exit(solid, ray_x, ray_y) - standing->depth[i];
                deep = deep < thickest_m ? deep : thickest_m;
                standing->thickness[i] = deep > thinnest_m ? deep : thinnest_m;
            }
        }
    }
}

static void fit_conics(rlf_reconstruct *stage, int32_t piece)
{
    rlf_standing *standing = &stage->background.thick;
    const rlf_grid *grid = &stage->grid;
    const rlf_rect *w = &standing->window[piece];
    int32_t step = rlf_knot_step(grid), x1 = w->x1 + step, y1 = w->y1 + step;
    int32_t x0 = w->x0 > step ? w->x0 - step : 0, y0 = w->y0 > step ? w->y0 - step : 0;
    const rlf_block block = {x0 / step * step, y0 / step * step,
                             x1 < grid->width ? x1 : grid->width,
                             y1 < grid->height ? y1 : grid->height};
    rlf_region region = {.label = piece};
    const rlf_slot slot = {.depth = standing->depth,
                           .thickness = standing->thickness,
                           .regions = &region,
                           .foreground_region_count = 1};
    rlf_chord_job job = rlf_chord_job_make(stage, &slot);
    job.is_of_people = false;
    job.raw = standing->depth;
    job.behind = NULL;
    stage->work.map[1] = 0; /* no plate */
    make_runs(stage, &block, (uint8_t)piece);
    rlf_thickness_fit(&job, &block);
    rlf_thickness_write(&job);
}

static void fit(rlf_reconstruct *stage, const rlf_sheet *sheet, int32_t piece)
{
    rlf_standing_solid solid;
    rlf_standing_find_shape(stage, sheet->normal, piece, &solid);
    if (solid.shape == RLF_STANDING_BOX || solid.shape == RLF_STANDING_BALL) {
        write_solid(stage, piece, &solid);
    } else if (solid.shape == RLF_STANDING_ROUND) {
        fit_conics(stage, piece);
    }
}

/* The back of the pixels beside pixel (x, y), of the nearest that have one and are as deep: depth
 * of it; 0 = there is none. */
static float back_beside(const rlf_reconstruct *stage, int32_t x, int32_t y)
{
    const rlf_standing *standing = &stage->background.thick;
    const rlf_grid *grid = &stage->grid;
    float z = standing->depth[(ptrdiff_t)y * grid->width + x], sum = 0.0f, count = 0.0f;
    for (int32_t r = 1; r <= BESIDE && !(count > 0.0f); r++) {
        for (int32_t dy = -r; dy <= r; dy++) {
            for (int32_t dx = -r; dx <= r; dx++) {
                if (x + dx < 0 || y + dy < 0 || x + dx >= grid->width || y + dy >= grid->height) {
                    continue;
                }
                ptrdiff_t i = (ptrdiff_t)(y + dy) * grid->width + x + dx;
                if (standing->thickness[i] > 0.0f &&
                    rlf_kernel_abs(standing->depth[i] - z) < step_m) {
                    sum += standing->depth[i] + standing->thickness[i];
                    count += 1.0f;
                }
            }
        }
    }
    return count > 0.0f ? sum / count : 0.0f;
}

/* Pixels that were given to no piece, at creases and outlines, are as deep as what is beside them.
 */
static void close_gaps(const rlf_reconstruct *stage)
{
    const rlf_standing *standing = &stage->background.thick;
    const rlf_grid *grid = &stage->grid;
    for (int32_t y = 0; y < grid->height; y++) {
        for (int32_t x = 0; x < grid->width; x++) {
            ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
            if (standing->piece[i] != 0 || !(standing->depth[i] > 0.0f)) {
                continue;
            }
            float back = back_beside(stage, x, y), deep = back - standing->depth[i];
            deep = deep > thinnest_m ? deep : thinnest_m;
            standing->thickness[i] = back > 0.0f ? -deep : 0.0f;
        }
    }
    for (int32_t i = 0; i < grid->count; i++) {
        standing->thickness[i] = rlf_kernel_abs(standing->thickness[i]);
    }
}

static void swap(float **a, float **b)
{
    float *c = *a;
    *a = *b;
    *b = c;
}

static bool is_same(float a, float b)
{
    return rlf_kernel_abs(a - b) < same_m;
}

/* So far pixel i of a face moves, the better its mean is: metres. */
static float drift_at(const rlf_grid *grid, const rlf_sheet *sheet, ptrdiff_t i)
{
    float x = grid->ray_x[i], y = grid->ray_y[i], n[3];
    rlf_read_normal(sheet->normal, i, n);
    bool is_low = -rlf_facing(grid, n, i) < low * sqrtf(x * x + y * y + 1.0f);
    return is_low ? same_share * sheet->depth[i] : 0.0f;
}

/* How thick it is where the front has moved back by `off`: its back stays where it is. A face at a
 * low angle moves by more than it is thick there, and is the same one. */
static float left_of(float deep, float off, float drift)
{
    bool is_behind = deep > 0.0f && off > 0.0f, is_back = off > deep - thinnest_m;
    bool is_other = off >= deep && off > drift;
    float left = is_back ? thinnest_m : deep - off;
    return is_behind && !is_other ? left : 0.0f;
}

/* What is known of the newest sheet. */
static void publish(rlf_reconstruct *stage, const rlf_sheet *sheet)
{
    rlf_standing *standing = &stage->background.thick;
    standing->newest = (standing->newest + 1) % RLF_SHEETS;
    float *out = standing->published[standing->newest];
    int32_t changed = 0;
    for (int32_t i = 0; i < stage->grid.count; i++) {
        float z = sheet->depth[i], was = standing->done_depth[i], deep = standing->done[i];
        bool same = is_same(was, z);
        out[i] = same ? deep : left_of(deep, z - was, drift_at(&stage->grid, sheet, i));
        changed += same ? 0 : 1;
    }
    standing->changed = changed;
    standing->sheet_version = sheet->version;
    standing->publications++;
}

/* The next step of a round. */
static void go_on(rlf_reconstruct *stage, const rlf_sheet *sheet)
{
    rlf_standing *standing = &stage->background.thick;
    if (standing->next_piece == 0) {
        bool is_last = rlf_standing_find_pieces(stage, sheet->normal, standing->step++);
        standing->next_piece = is_last ? 1 : 0;
        if (is_last) {
            rlf_depart_take(stage);
        }
        return;
    }
    int32_t k = standing->next_piece;
    while (k <= standing->piece_count && standing->window[k].x1 == 0) {
        k++;
    }
    standing->next_piece = k + 1;
    if (k <= standing->piece_count) {
        fit(stage, sheet, k);
        return;
    }
    if (k == standing->piece_count + 1) {
        close_gaps(stage);
        return;
    }
    swap(&standing->depth, &standing->done_depth);
    swap(&standing->thickness, &standing->done);
    standing->is_round = false;
    publish(stage, sheet);
}

void rlf_standing_advance(rlf_reconstruct *stage)
{
    rlf_standing *standing = &stage->background.thick;
    const rlf_sheet *sheet = rlf_sheet_newest(stage);
    if (sheet == NULL || standing->depth == NULL) {
        rlf_standing_reset(standing); /* the room is not known, or it is another one */
        return;
    }
    standing->age += standing->age < SETTLED ? 1 : 0;
    standing->round_age += standing->round_age < PAUSE ? 1 : 0;
    bool is_first = standing->newest < 0;
    if (!is_first && sheet->version > standing->sheet_version) {
        publish(stage, sheet);
    }
    bool is_changed = standing->changed >= CHANGED && standing->round_age >= PAUSE;
    bool is_better = standing->age >= SETTLED && !standing->is_settled;
    if (!standing->is_round && (is_first || is_changed || is_better)) {
        begin_round(stage, sheet);
    }
    for (int k = 0; k < (is_first ? AT_FIRST : 1) && standing->is_round; k++) {
        go_on(stage, sheet);
    }
}
