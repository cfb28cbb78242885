/* Everything the stage will ever need, allocated once and as one: large enough for large pages. */
#include "surface/stage.h"

#include "base/guard.h"
#include "surface/objects/objects.h"
#include "surface/past/past.h"
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
    size_t tiles = (size_t)rlf_sheet_tiles(&stage->grid);
    background->row_changes = take(stage, tiles * RLF_SHEET_TILE, sizeof(int32_t));
    background->changes = take(stage, tiles, sizeof(int32_t));
    background->age = take(stage, tiles, 1);
    background->is_better = take(stage, tiles, 1);
    background->version = take(stage, tiles, sizeof(int32_t));
    for (int i = 0; i < RLF_SHEETS; i++) {
        rlf_sheet *sheet = &background->sheets[i];
        sheet->depth = take(stage, n, sizeof(float));
        for (int k = 0; k < 3; k++) {
            sheet->normal[k] = take(stage, n, sizeof(float));
        }
        sheet->label = take(stage, n, sizeof(int32_t));
        sheet->regions = take(stage, (size_t)stage->def.region_capacity, sizeof(rlf_region));
        if (stage->def.keep_region_points) {
            sheet->region_points = take(stage, n, sizeof(int32_t));
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
        for (int k = 0; k < RLF_SHEETS; k++) {
            state->published[k] = take(stage, n, sizeof(float));
        }
    }
}

static void take_work(rlf_reconstruct *stage)
{
    rlf_work *work = &stage->work;
    size_t n = (size_t)stage->grid.count;
    size_t padded = n + (size_t)stage->grid.height * RLF_CHORD_PAD;
    for (int k = 0; k < 2; k++) {
        work->depth[k] = take(stage, padded, sizeof(float));
        work->sum[k] = take(stage, padded, sizeof(float));
        work->mask[k] = take(stage, n, 1);
        work->vote[k] = take(stage, n + 1, sizeof(int32_t));
    }
    for (int k = 0; k < 6; k++) {
        work->crop[k] = take(stage, rlf_sheet_crop_size(), sizeof(float));
    }
    work->seen = take(stage, n, sizeof(float));
    work->color = take(stage, n, sizeof(uint32_t));
    work->links = take(stage, n, 1);
    work->component = take(stage, padded, sizeof(int32_t));
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

static void take_past(rlf_reconstruct *stage)
{
    if (stage->def.enable_coast && stage->def.enable_thickness && stage->def.enable_velocity) {
        rlf_past *past = &stage->past;
        size_t n = (size_t)stage->grid.count;
        past->is_ahead = take(stage, n / 8 + 1, 1);
        past->ahead = take(stage, n, sizeof *past->ahead);
        past->ahead_ticks = take(stage, n, 1);
        past->ahead_pixel = take(stage, n, sizeof *past->ahead_pixel);
        past->ahead_from = take(stage, n, sizeof *past->ahead_from);
        past->lost_ticks = take(stage, n, 1);
        past->lost_from = take(stage, n, sizeof *past->lost_from);
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
    if (rlf_settle_is_wanted(&stage->def)) {
        stage->steady.settled = take(stage, (size_t)stage->grid.count, sizeof(rlf_settled));
        stage->steady.mark = take(stage, (size_t)stage->grid.count, 1);
        stage->steady.overruled = take(stage, (size_t)stage->grid.count, 1);
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
    take_past(stage);
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
