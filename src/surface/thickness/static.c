/* How thick static things are: the background, piece by piece.
 *
 * Nobody sees the back of a chair that stands. But a round front bends, and a box shows two faces:
 * both say where the back is. What touches along a concave crease is two things (Stein, Schoeler,
 * Papon, Woergoetter 2014: object partitioning using local convexity): so a background falls into
 * locally convex pieces. Flat ones say nothing about their backs. One of the others is fitted per
 * frame, and a round over all of them is published as a whole. */
#include "surface/thickness/thickness.h"

#include "surface/steps.h"

#include <string.h>

enum {
    FIRST_ROUNDS = 2, /* the means get better in the meantime; then only what changes counts */
    CHANGED = 100,    /* pixels that are not as they were fitted */
    PAUSE = 60,       /* frames from one round's begin to the next one's */
    AT_FIRST = 5      /* steps per frame of the first round */
};

static const float same_m = 0.03f; /* less is no other depth */

void static_reset(static_thickness *state)
{
    state->newest = -1;
    state->is_round = false;
    state->rounds = state->changed = state->image_version = 0;
}

const float *static_newest(const rlf_reconstruct *stage)
{
    const static_thickness *state = &stage->background.thick;
    bool none = state->newest < 0 || background_image_newest(stage) == NULL;
    return none ? NULL : state->published[state->newest];
}

static void begin_round(rlf_reconstruct *stage, const background_image *image)
{
    static_thickness *state = &stage->background.thick;
    size_t size = (size_t)stage->grid.count * sizeof(float);
    memcpy(state->depth, image->depth, size);
    memset(state->thickness, 0, size);
    state->is_round = true;
    state->step = state->next_piece = state->round_age = 0;
    state->rounds += state->rounds < FIRST_ROUNDS ? 1 : 0;
}

/* The piece's runs, as those of one region, to work.runs. */
static void make_runs(rlf_reconstruct *stage, int32_t piece)
{
    const uint8_t *pieces = stage->background.thick.piece;
    int32_t *number = stage->work.component;
    for (int32_t i = 0; i < stage->grid.count; i++) {
        number[i] = pieces[i] == piece;
    }
    rlf_runs_find(stage, number);
}

static void fit_box(const rlf_reconstruct *stage, int32_t piece, const static_box *box)
{
    const static_thickness *state = &stage->background.thick;
    const image_grid *grid = &stage->grid;
    const rlf_rect *w = &state->window[piece];
    for (int32_t y = w->y0; y < w->y1; y++) {
        for (int32_t x = w->x0; x < w->x1; x++) {
            ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
            if (state->piece[i] == piece) {
                const rlf_vec3 ray = {grid->ray_x[i], grid->ray_y[i], 1.0};
                state->thickness[i] =
                    (float)rlf_clamp(static_box_exit(box, ray) - (double)state->depth[i],
                                     RLF_THINNEST_M, RLF_THICKEST_M);
            }
        }
    }
}

static void fit_conics(rlf_reconstruct *stage, int32_t piece)
{
    static_thickness *state = &stage->background.thick;
    const rlf_rect *w = &state->window[piece];
    rlf_region region = {.label = piece, .x0 = w->x0, .y0 = w->y0, .x1 = w->x1, .y1 = w->y1};
    const rlf_slot slot = {.depth = state->depth,
                           .thickness = state->thickness,
                           .regions = &region,
                           .foreground_region_count = 1};
    rlf_chord_job job = rlf_chord_job_make(stage, &slot, state->depth);
    const rlf_rect block = rlf_block_of(&stage->grid, &region, job.step);
    job.is_of_people = false;
    job.behind = NULL;
    stage->work.map[1] = 0; /* no plate */
    make_runs(stage, piece);
    rlf_thickness_fit(&job, &block);
    rlf_thickness_write(&job);
}

static void fit(rlf_reconstruct *stage, const background_image *image, int32_t piece)
{
    static_box box;
    switch (static_find_shape(stage, image->normal, piece, &box)) {
    case STATIC_BOX: fit_box(stage, piece, &box); break;
    case STATIC_ROUND: fit_conics(stage, piece); break;
    default: break;
    }
}

static void swap(float **a, float **b)
{
    float *c = *a;
    *a = *b;
    *b = c;
}

/* What is known of the newest image: a front that has moved back leaves the back where it is. */
static void publish(rlf_reconstruct *stage, const background_image *image)
{
    static_thickness *state = &stage->background.thick;
    state->newest = (state->newest + 1) % BACKGROUND_IMAGES;
    float *out = state->published[state->newest];
    state->changed = 0;
    for (int32_t i = 0; i < stage->grid.count; i++) {
        float off = image->depth[i] - state->done_depth[i], deep = state->done[i];
        bool is_same = rlf_kernel_abs(off)<same_m, is_left = off> 0.0f && off < deep;
        float left = deep - off > RLF_THINNEST_M ? deep - off : RLF_THINNEST_M;
        out[i] = is_same ? deep : is_left ? left : 0.0f;
        state->changed += is_same ? 0 : 1;
    }
    state->image_version = image->version;
    state->publications++;
}

/* The next step of a round. */
static void go_on(rlf_reconstruct *stage, const background_image *image)
{
    static_thickness *state = &stage->background.thick;
    if (state->next_piece == 0) {
        if (static_find_pieces(stage, image->normal, state->step++)) {
            state->next_piece = 1;
            rlf_depart_take(stage);
        }
        return;
    }
    int32_t k = state->next_piece;
    while (k <= state->piece_count && state->window[k].x1 == 0) {
        k++;
    }
    state->next_piece = k + 1;
    if (k <= state->piece_count) {
        fit(stage, image, k);
        return;
    }
    swap(&state->depth, &state->done_depth);
    swap(&state->thickness, &state->done);
    state->is_round = false;
    publish(stage, image);
}

void static_advance(rlf_reconstruct *stage)
{
    static_thickness *state = &stage->background.thick;
    const background_image *image = background_image_newest(stage);
    if (image == NULL || state->depth == NULL) {
        static_reset(state); /* the room is not known, or it is another one */
        return;
    }
    bool is_first = state->newest < 0;
    if (!is_first && image->version > state->image_version) {
        publish(stage, image);
    }
    state->round_age++;
    bool is_due =
        state->round_age >= PAUSE && (state->changed >= CHANGED || state->rounds < FIRST_ROUNDS);
    if (!state->is_round && (is_first || is_due)) {
        begin_round(stage, image);
    }
    for (int k = 0; k < (is_first ? AT_FIRST : 1) && state->is_round; k++) {
        go_on(stage, image);
    }
}

bool static_is_wanted(const rlf_reconstruct_def *def)
{
    return def->enable_thickness && def->background_method != RLF_BACKGROUND_OFF &&
           def->background_method != RLF_BACKGROUND_GIVEN;
}

void static_allocate(static_thickness *state, rlf_arena *arena, const rlf_reconstruct_def *def,
                     const image_grid *grid)
{
    size_t n = (size_t)grid->count;
    arena_next_owner(arena);
    if (static_is_wanted(def)) {
        state->depth = arena_take(arena, n, sizeof(float));
        state->thickness = arena_take(arena, n, sizeof(float));
        state->done_depth = arena_take(arena, n, sizeof(float));
        state->done = arena_take(arena, n, sizeof(float));
        state->piece = arena_take(arena, n, 1);
        state->smooth = arena_lend(arena, n, sizeof(float));
        state->before = arena_lend(arena, n, 1);
        for (int k = 0; k < BACKGROUND_IMAGES; k++) {
            state->published[k] = arena_take(arena, n, sizeof(float));
        }
    }
}
