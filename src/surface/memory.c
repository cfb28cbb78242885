/* All memory that the stage will ever need, module by module. */
#include "surface/objects/objects.h"
#include "surface/steps.h"

#include <string.h>

/* The rays of the kept pixels: eq. 4.1 without the factor z, undistorted, once per source. */
static void fill_rays(const image_grid *grid, float *ray_x, float *ray_y, uint8_t *has_ray)
{
    for (int32_t y = 0; y < grid->height; y++) {
        for (int32_t x = 0; x < grid->width; x++) {
            int32_t i = y * grid->width + x;
            rlf_vec3 ray;
            bool inside = rlf_camera_unproject(&grid->camera, x, y, &ray);
            has_ray[i] = inside;
            ray_x[i] = inside ? (float)ray.x : 0.0f;
            ray_y[i] = inside ? (float)ray.y : 0.0f;
        }
    }
}

static void take_grid(image_grid *grid, rlf_arena *arena)
{
    size_t n = (size_t)grid->count;
    float *ray_x = arena_take(arena, n, sizeof(float));
    float *ray_y = arena_take(arena, n, sizeof(float));
    uint8_t *has_ray = arena_take(arena, n, 1);
    if (has_ray != NULL) {
        fill_rays(grid, ray_x, ray_y, has_ray);
    }
    grid->ray_x = ray_x;
    grid->ray_y = ray_y;
    grid->has_ray = has_ray;
}

static void take_slot(rlf_slot *slot, rlf_arena *arena, const rlf_reconstruct_def *def,
                      const image_grid *grid)
{
    size_t n = (size_t)grid->count;
    slot->depth = arena_take(arena, n, sizeof(float));
    slot->thickness = arena_take(arena, n, sizeof(float));
    for (int k = 0; k < 3; k++) {
        slot->normal[k] = arena_take(arena, n, sizeof(float));
        slot->velocity[k] = arena_take(arena, n, sizeof(float));
    }
    slot->label = arena_take(arena, n, sizeof(int32_t));
    slot->moved = arena_take(arena, (size_t)grid->height, sizeof(rlf_span));
    slot->thick = arena_take(arena, (size_t)grid->height, sizeof(rlf_span));
    slot->reason = arena_take(arena, n, 1);
    slot->foreground = arena_take(arena, n, 1);
    slot->regions = arena_take(arena, 2 * (size_t)def->region_capacity, sizeof(rlf_region));
    if (def->keep_region_points) {
        slot->region_points = arena_take(arena, 2 * n, sizeof(int32_t));
    }
}

/* What more than one module goes on with. */
static void take_work(rlf_work *work, rlf_arena *arena, const rlf_reconstruct_def *def,
                      const image_grid *grid)
{
    size_t n = (size_t)grid->count, width = (size_t)grid->width;
    work->raw = arena_take(arena, n, sizeof(float));
    work->kept = arena_take(arena, n, sizeof(float));
    work->was_seen = arena_take(arena, n, 1);
    for (int k = 0; k < 2; k++) {
        work->vote[k] = arena_take(arena, n + 1, sizeof(int32_t));
    }
    work->links = arena_take(arena, n, 1);
    work->component = arena_take(arena, n, sizeof(int32_t));
    work->front = arena_take(arena, (size_t)grid->height, sizeof(rlf_span));
    work->runs.run = arena_take(arena, n, sizeof(rlf_run));
    work->runs.first = arena_take(arena, (size_t)grid->height + 1, sizeof(int32_t));
    work->parent = arena_take(arena, n + 1, sizeof(int32_t));
    work->size = arena_take(arena, n + 1, sizeof(int32_t));
    work->map = arena_take(arena, n + 1, sizeof(int32_t));
    work->zero_plane = arena_take(arena, n, sizeof(float));
    work->zero_labels = arena_take(arena, n, sizeof(int32_t));
    work->region_sums = arena_take(arena, (size_t)def->region_capacity + 1, sizeof(rlf_region_sum));
    work->zeros = arena_take(arena, width, sizeof(float));
    work->ones = arena_take(arena, width, 1);
    work->missing = arena_take(arena, width, 1);
    if (work->missing != NULL) {
        memset(work->ones, 1, width);
        memset(work->missing, RLF_SEEN_MISSING, width);
    }
    arena_next_owner(arena);
    work->found = arena_lend(arena, n, sizeof(float));
    arena_next_owner(arena);
    work->bits = arena_lend(arena, n, 1);
}

static void take_all(void *context)
{
    rlf_reconstruct *stage = context;
    rlf_arena *arena = &stage->arena;
    const rlf_reconstruct_def *def = &stage->def;
    const image_grid *grid = &stage->grid;
    take_grid(&stage->grid, arena);
    for (int i = 0; i < RLF_RECONSTRUCT_SURFACES; i++) {
        take_slot(&stage->ring[i], arena, def, grid);
    }
    if (def->background_method == RLF_BACKGROUND_GIVEN) {
        take_slot(&stage->carried, arena, def, grid);
    }
    background_allocate(&stage->background, arena, def, grid);
    static_allocate(&stage->background.thick, arena, def, grid);
    temporal_allocate(&stage->temporal, arena, def, grid);
    normals_allocate(&stage->normals, arena, def, grid);
    tracks_allocate(&stage->tracks, arena, def);
    stage->objects = objects_allocate(arena, def, grid);
    thin_allocate(&stage->thin, arena, def, grid);
    color_guide_allocate(&stage->guide, arena, def, grid);
    velocity_allocate(&stage->velocity, arena, grid);
    chords_allocate(&stage->chords, arena, def, grid);
    take_work(&stage->work, arena, def, grid);
}

bool rlf_stage_allocate(rlf_reconstruct *stage)
{
    return arena_create(&stage->arena, take_all, stage);
}

void rlf_stage_release(rlf_reconstruct *stage)
{
    arena_destroy(&stage->arena);
}
