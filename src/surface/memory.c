/* Everything the stage will ever need, allocated once and as one: large enough for large pages. */
#include "surface/stage.h"

#include "base/guard.h"
#include "surface/objects/objects.h"
#include "surface/steps.h"
#include "surface/thickness/thickness.h"
#include "surface/velocity/velocity.h"

#include <string.h>

/* Blocks begin on pages of their own, each some lines of cache further into its page than the one
 * before: planes are read side by side, and the same place of all of them must not meet the same
 * few sets of the first cache. */
#define PAGE 4096
#define LINE 64
#define LINES_APART 5

/* Without memory yet, only counts what will be needed and returns NULL. What lies between two
 * blocks is guarded. */
static void *take(rlf_reconstruct *stage, size_t count, size_t size)
{
    rlf_arena *arena = &stage->arena;
    size_t begin = (arena->used + PAGE - 1) / PAGE * PAGE +
                   (size_t)(arena->blocks++ * LINES_APART) % (PAGE / LINE) * LINE;
    size_t end = begin + (count * size + LINE - 1) / LINE * LINE;
    size_t before = arena->used;
    arena->used = end + LINE;
    if (arena->memory == NULL) {
        return NULL;
    }
    rlf_guard(arena->memory + before, begin - before);
    rlf_guard(arena->memory + end, LINE);
    return arena->memory + begin;
}

/* The same from what owners of scratch share. Where memory is guarded each has its own. */
static void *lend(rlf_reconstruct *stage, size_t count, size_t size)
{
    rlf_arena *arena = &stage->arena;
#ifdef RLF_GUARDS_MEMORY
    return take(stage, count, size);
#endif
    size_t begin = (arena->shared_used + PAGE - 1) / PAGE * PAGE +
                   (size_t)(arena->blocks++ * LINES_APART) % (PAGE / LINE) * LINE;
    arena->shared_used = begin + (count * size + LINE - 1) / LINE * LINE + LINE;
    if (arena->shared_size < arena->shared_used) {
        arena->shared_size = arena->shared_used;
    }
    return arena->memory == NULL ? NULL : arena->shared + begin;
}

static void take_grid(rlf_reconstruct *stage)
{
    rlf_grid *grid = &stage->grid;
    size_t n = (size_t)grid->count;
    float *ray_x = take(stage, n, sizeof(float));
    float *ray_y = take(stage, n, sizeof(float));
    uint8_t *has_ray = take(stage, n, 1);
    if (has_ray != NULL) {
        rlf_grid_fill_rays(grid, ray_x, ray_y, has_ray);
    }
    grid->ray_x = ray_x;
    grid->ray_y = ray_y;
    grid->has_ray = has_ray;
}

static void take_slot(rlf_reconstruct *stage, rlf_slot *slot)
{
    size_t n = (size_t)stage->grid.count;
    slot->depth = take(stage, n, sizeof(float));
    slot->thickness = take(stage, n, sizeof(float));
    for (int k = 0; k < 3; k++) {
        slot->normal[k] = take(stage, n, sizeof(float));
        slot->velocity[k] = take(stage, n, sizeof(float));
    }
    slot->label = take(stage, n, sizeof(int32_t));
    slot->moved = take(stage, (size_t)stage->grid.height, sizeof(rlf_span));
    slot->thick = take(stage, (size_t)stage->grid.height, sizeof(rlf_span));
    slot->reason = take(stage, n, 1);
    slot->foreground = take(stage, n, 1);
    slot->regions = take(stage, 2 * (size_t)stage->def.region_capacity, sizeof(rlf_region));
    if (stage->def.keep_region_points) {
        slot->region_points = take(stage, 2 * n, sizeof(int32_t));
    }
}

static void take_background(rlf_reconstruct *stage)
{
    rlf_background *background = &stage->background;
    size_t n = (size_t)stage->grid.count;
    background->mean = take(stage, n, sizeof(float));
    background->deviation = take(stage, n, sizeof(float));
    background->weight = take(stage, n, 1);
    background->beyond = take(stage, n, 1);
    background->absent = take(stage, n, 1);
    background->unknown_age = take(stage, n, 1);
    background->still = take(stage, n, sizeof(float));
    background->still_ms = take(stage, n, sizeof(uint16_t));
    background->beneath = take(stage, n, sizeof(float));
    background->standing = take(stage, (size_t)stage->grid.height, sizeof(rlf_span));
    background->color = take(stage, n, sizeof(uint32_t));
    background->hides = take(stage, (size_t)stage->grid.height, 1);
    size_t tiles = (size_t)background_image_tiles(&stage->grid);
    background->row_changes = take(stage, tiles * BACKGROUND_TILE, sizeof(int32_t));
    background->changes = take(stage, tiles, sizeof(int32_t));
    background->age = take(stage, tiles, 1);
    background->is_better = take(stage, tiles, 1);
    background->version = take(stage, tiles, sizeof(int32_t));
    for (int i = 0; i < BACKGROUND_IMAGES; i++) {
        background_image *image = &background->images[i];
        image->depth = take(stage, n, sizeof(float));
        for (int k = 0; k < 3; k++) {
            image->normal[k] = take(stage, n, sizeof(float));
        }
        image->label = take(stage, n, sizeof(int32_t));
        image->regions = take(stage, (size_t)stage->def.region_capacity, sizeof(rlf_region));
        if (stage->def.keep_region_points) {
            image->region_points = take(stage, n, sizeof(int32_t));
        }
    }
}

static void take_static(rlf_reconstruct *stage)
{
    static_thickness *state = &stage->background.thick;
    size_t n = (size_t)stage->grid.count;
    if (stage->def.enable_thickness && stage->def.background_method != RLF_BACKGROUND_OFF) {
        state->depth = take(stage, n, sizeof(float));
        state->thickness = take(stage, n, sizeof(float));
        state->done_depth = take(stage, n, sizeof(float));
        state->done = take(stage, n, sizeof(float));
        state->piece = take(stage, n, 1);
        stage->background.depart.thing = take(stage, n, 1);
        stage->background.depart.depth = take(stage, n, sizeof(float));
        stage->background.depart.left = take(stage, n, 1);
        for (int k = 0; k < BACKGROUND_IMAGES; k++) {
            state->published[k] = take(stage, n, sizeof(float));
        }
    }
}

static void take_work(rlf_reconstruct *stage)
{
    rlf_work *work = &stage->work;
    size_t n = (size_t)stage->grid.count;
    size_t padded = n + (size_t)stage->grid.height * RLF_CHORD_PAD;
    work->raw = take(stage, n, sizeof(float));
    work->kept = take(stage, n, sizeof(float));
    work->was_seen = take(stage, n, 1);
    work->covered = take(stage, n, 1);
    for (int k = 0; k < 2; k++) {
        work->vote[k] = take(stage, n + 1, sizeof(int32_t));
    }
    for (int k = 0; k < 6; k++) {
        work->crop[k] = take(stage, background_image_crop_size(), sizeof(float));
    }
    work->seen = take(stage, n, sizeof(float));
    work->color = take(stage, n, sizeof(uint32_t));
    work->links = take(stage, n, 1);
    work->component = take(stage, n, sizeof(int32_t));
    work->front = take(stage, (size_t)stage->grid.height, sizeof(rlf_span));
    work->runs.run = take(stage, n, sizeof(rlf_run));
    work->runs.first = take(stage, (size_t)stage->grid.height + 1, sizeof(int32_t));
    work->parent = take(stage, n + 1, sizeof(int32_t));
    work->size = take(stage, n + 1, sizeof(int32_t));
    work->map = take(stage, n + 1, sizeof(int32_t));
    work->zeros = take(stage, (size_t)stage->grid.width, sizeof(float));
    work->zero_plane = take(stage, n, sizeof(float));
    work->zero_labels = take(stage, n, sizeof(int32_t));
    work->region_sums = take(stage, (size_t)stage->def.region_capacity + 1, sizeof(rlf_region_sum));
    work->heirs = take(stage, 4 * (size_t)stage->def.region_capacity, sizeof(int32_t));
    work->cells = take(stage, rlf_cell_capacity(&stage->grid), sizeof(rlf_cell));
    work->ones = take(stage, (size_t)stage->grid.width, 1);
    work->missing = take(stage, (size_t)stage->grid.width, 1);
    if (work->missing != NULL) {
        memset(work->ones, 1, (size_t)stage->grid.width);
        memset(work->missing, RLF_SEEN_MISSING, (size_t)stage->grid.width);
    }
    if (stage->def.enable_thickness) {
        size_t lines = (size_t)(stage->grid.width + stage->grid.height);
        work->blocks = take(stage, (size_t)stage->def.region_capacity, sizeof(rlf_block));
        for (int k = 0; k < 6; k++) {
            work->solid[k] = take(stage, padded, sizeof(float));
        }
        work->knot = take(stage, padded, sizeof(float));
        work->chords = take(stage, lines * RLF_CHORDS_PER_LINE, sizeof(rlf_chord));
        size_t columns = (size_t)stage->grid.width / RLF_CHORD_SQUARE + 1;
        work->squares =
            take(stage, columns * ((size_t)stage->grid.height / RLF_CHORD_SQUARE + 1), 1);
    }
}

/* Of the depth and its normals. */
static void lend_depth(rlf_reconstruct *stage)
{
    rlf_scratch *scratch = &stage->scratch;
    size_t n = (size_t)stage->grid.count;
    scratch->thin.visited = lend(stage, n, 1);
    stage->arena.shared_used = 0;
    scratch->temporal.change = lend(stage, n, 1);
    scratch->temporal.lag = lend(stage, n, 1);
    stage->arena.shared_used = 0;
    scratch->fill.found = lend(stage, n, sizeof(float));
    stage->arena.shared_used = 0;
    scratch->crease.bent = lend(stage, n, 1);
    stage->arena.shared_used = 0;
    for (int k = 0; k < 3; k++) {
        scratch->contour.normal[k] = lend(stage, n, sizeof(float));
    }
    scratch->contour.mark = lend(stage, n, 1);
    scratch->contour.front = lend(stage, n, 1);
    stage->arena.shared_used = 0;
    scratch->layered.front = lend(stage, n, sizeof(float));
    stage->arena.shared_used = 0;
}

static void lend_scratch(rlf_reconstruct *stage)
{
    rlf_scratch *scratch = &stage->scratch;
    size_t n = (size_t)stage->grid.count;
    size_t padded = n + (size_t)stage->grid.height * RLF_CHORD_PAD;
    lend_depth(stage);
    scratch->background.seen = lend(stage, n, 1);
    scratch->background.lost = lend(stage, n, 1);
    stage->arena.shared_used = 0;
    scratch->hidden.empty = lend(stage, n, 1);
    scratch->hidden.up = lend(stage, n, sizeof(int32_t));
    stage->arena.shared_used = 0;
    scratch->segment.bits = lend(stage, n, 1);
    stage->arena.shared_used = 0;
    scratch->velocity.is_steady = lend(stage, n, 1);
    scratch->velocity.is_rim = lend(stage, n, 1);
    stage->arena.shared_used = 0;
    scratch->chords.front = lend(stage, padded, sizeof(float));
    scratch->chords.inverse = lend(stage, padded, sizeof(float));
    scratch->chords.thickness = lend(stage, padded, sizeof(float));
    scratch->chords.label = lend(stage, padded, sizeof(int32_t));
    stage->arena.shared_used = 0;
    scratch->pieces.smooth = lend(stage, n, sizeof(float));
    scratch->pieces.before = lend(stage, n, 1);
    stage->arena.shared_used = 0;
}

void rlf_stage_spoil(rlf_reconstruct *stage)
{
    if (stage->arena.is_spoiled && stage->arena.shared != NULL) {
        memset(stage->arena.shared, 0xa5, stage->arena.shared_size);
    }
}

static void take_objects(rlf_reconstruct *stage)
{
    if (stage->def.background_segment != RLF_SEGMENT_OBJECTS ||
        stage->def.background_method == RLF_BACKGROUND_OFF) {
        return;
    }
    rlf_objects o = rlf_objects_layout(&stage->grid);
    size_t n = (size_t)stage->grid.count, patches = (size_t)(o.width * o.height);
    rlf_objects *objects = take(stage, 1, sizeof *objects);
    o.patch = take(stage, patches, sizeof *o.patch);
    o.near = take(stage, patches, sizeof *o.near);
    o.scratch[0] = take(stage, patches, sizeof *o.scratch[0]);
    o.scratch[1] = take(stage, patches, sizeof *o.scratch[1]);
    o.queue = take(stage, patches, sizeof *o.queue);
    o.sum = take(stage, RLF_OBJECTS_SUMMED, sizeof *o.sum);
    o.border = take(stage, RLF_BORDERS, sizeof *o.border);
    o.support = take(stage, n, 1);
    o.links = take(stage, n, 1);
    o.distance = take(stage, n, 1);
    if (objects != NULL) {
        *objects = o;
    }
    stage->objects = objects;
}

static void take_family(rlf_reconstruct *stage)
{
    rlf_family *family = &stage->family;
    family->capacity = 2 * stage->def.region_capacity;
    family->kin = take(stage, (size_t)family->capacity, sizeof *family->kin);
    family->origin = take(stage, (size_t)stage->def.region_capacity, sizeof *family->origin);
}

static void take_thin(rlf_reconstruct *stage)
{
    if (stage->def.enable_coast && stage->def.enable_thickness && stage->def.enable_velocity) {
        thin *state = &stage->thin;
        size_t n = (size_t)stage->grid.count;
        state->patch = take(stage, SLAB_PATCH, sizeof *state->patch);
        state->expected = take(stage, n, sizeof *state->expected);
        state->expected_pixel = take(stage, n, sizeof *state->expected_pixel);
        state->lost_ticks = take(stage, n, 1);
        state->lost_from = take(stage, n, sizeof *state->lost_from);
    }
}

static void take_steady(rlf_reconstruct *stage)
{
    if (stage->def.enable_steadying) {
        stage->steady.mean = take(stage, (size_t)stage->grid.count, sizeof(float));
        stage->steady.frames = take(stage, (size_t)stage->grid.count, sizeof(float));
        stage->steady.calm = take(stage, (size_t)stage->grid.count, 1);
        stage->steady.restless = take(stage, (size_t)stage->grid.count, 1);
    }
    if (vote_is_wanted(&stage->def)) {
        stage->steady.votes = take(stage, (size_t)stage->grid.count, sizeof(rlf_vote));
        stage->steady.watch = take(stage, (size_t)stage->grid.count, 1);
        stage->steady.outvoted = take(stage, (size_t)stage->grid.count, 1);
    }
}

static void take_wide(rlf_reconstruct *stage)
{
    const rlf_grid *grid = &stage->grid;
    const float *ray_x = grid->ray_x, *ray_y = grid->ray_y;
    int32_t width = grid->width, height = grid->height;
    for (int level = 0; level < RLF_WIDE_LEVELS && rlf_wide_is_wanted(&stage->def, grid); level++) {
        rlf_wide *wide = &stage->wide[level];
        wide->width = width / 2;
        wide->height = height / 2;
        size_t n = (size_t)wide->width * (size_t)wide->height;
        float **const planes[] = {&wide->ray_x,     &wide->ray_y,     &wide->depth,
                                  &wide->smooth,    &wide->normal[0], &wide->normal[1],
                                  &wide->normal[2], &wide->frames};
        for (size_t k = 0; k < sizeof planes / sizeof planes[0]; k++) {
            *planes[k] = take(stage, n, sizeof(float));
        }
        if (wide->ray_x != NULL) {
            rlf_wide_fill_rays(ray_x, ray_y, width, wide);
        }
        ray_x = wide->ray_x;
        ray_y = wide->ray_y;
        width = wide->width;
        height = wide->height;
    }
}

static void take_color_side(rlf_reconstruct *stage)
{
    const rlf_reconstruct_def *def = &stage->def;
    if (def->enable_color_sides && def->enable_fill && def->rig.has_color) {
        stage->side.parts = (stage->grid.height + RLF_ROW_GRAIN - 1) / RLF_ROW_GRAIN;
        stage->side.part = take(stage, (size_t)stage->side.parts, sizeof *stage->side.part);
    }
}

static void take_all(rlf_reconstruct *stage)
{
    stage->arena.used = 0;
    stage->arena.blocks = 0;
    if (stage->arena.memory != NULL) {
        stage->arena.shared = take(stage, stage->arena.shared_size, 1);
    }
    lend_scratch(stage);
    if (stage->arena.memory == NULL) {
        take(stage, stage->arena.shared_size, 1);
    }
    take_grid(stage);
    for (int i = 0; i < RLF_RECONSTRUCT_SURFACES; i++) {
        take_slot(stage, &stage->ring[i]);
    }
    take_background(stage);
    take_static(stage);
    take_steady(stage);
    take_wide(stage);
    take_family(stage);
    take_objects(stage);
    take_thin(stage);
    take_color_side(stage);
    take_work(stage);
}

bool rlf_stage_allocate(rlf_reconstruct *stage)
{
    take_all(stage);
    stage->arena.memory = rlf_alloc(stage->arena.used);
    if (stage->arena.memory != NULL) {
        take_all(stage);
    }
    return stage->arena.memory != NULL;
}

void rlf_stage_release(rlf_reconstruct *stage)
{
    if (stage->arena.memory != NULL) {
        rlf_unguard(stage->arena.memory, stage->arena.used);
    }
    rlf_free(stage->arena.memory);
    stage->arena.memory = NULL;
}
