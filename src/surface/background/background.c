/* The background, by the method that the settings name; AVERAGE is here.
 *
 * AVERAGE (thesis 4.4.1): the first frames are averaged into a background that never changes, and
 * what differs from it by more than a threshold is foreground. The mean is over the valid samples
 * of a pixel. Where the background is missing, the difference does not exist (the thesis's
 * comparison with NaN is false): such a pixel is not foreground. ADAPTIVE: see adaptive.c. */
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <string.h>

static void add_frame(rlf_background *background, const float *depth, int32_t count)
{
    for (int32_t i = 0; i < count; i++) {
        background->mean[i] += depth[i];
        background->weight[i] = (uint8_t)(background->weight[i] + (depth[i] > 0.0f ? 1 : 0));
    }
    background->frames++;
}

static void divide(rlf_background *background, int32_t count)
{
    for (int32_t i = 0; i < count; i++) {
        int32_t n = background->weight[i];
        background->mean[i] = n > 0 ? background->mean[i] / (float)n : 0.0f;
    }
}

static void update_average(rlf_reconstruct *stage, rlf_slot *slot)
{
    rlf_background *background = &stage->background;
    int32_t count = stage->grid.count;
    if (stage->sight.shows_more) {
        rlf_background_reset(background, &stage->grid);
    }
    if (background->state != RLF_BACKGROUND_READY) {
        background->state = RLF_BACKGROUND_LEARNING;
        memset(slot->foreground, 0, (size_t)count);
        add_frame(background, slot->depth, count);
        if (background->frames == stage->def.background_frames) {
            divide(background, count);
            background->state = RLF_BACKGROUND_READY;
            background_image_publish(stage, NULL);
        }
        return;
    }
    float threshold = (float)stage->def.foreground_threshold_m;
    for (int32_t i = 0; i < count; i++) {
        float z = slot->depth[i], behind = background->mean[i];
        bool differs = rlf_kernel_abs(z - behind) > threshold;
        slot->foreground[i] = z > 0.0f && behind > 0.0f && differs;
    }
    for (int32_t y = 0; y < stage->grid.height; y++) {
        int32_t width = stage->grid.width;
        stage->work.front[y] = rlf_background_span(slot->foreground + (ptrdiff_t)y * width, width);
    }
}

/* What is known stays as it is. */
static void keep(rlf_reconstruct *stage, const rlf_slot *slot)
{
    rlf_background *background = &stage->background;
    if (background->state == RLF_BACKGROUND_NONE &&
        stage->def.background_method != RLF_BACKGROUND_OFF) {
        background->state = RLF_BACKGROUND_LEARNING;
    }
    background_clear_front(stage, slot);
}

void rlf_background_update(rlf_reconstruct *stage, const float *kept, rlf_slot *slot)
{
    stage->has_components = false;
    if (stage->sight.is_blind && stage->def.background_method != RLF_BACKGROUND_GIVEN) {
        keep(stage, slot);
        return;
    }
    switch (stage->def.background_method) {
    case RLF_BACKGROUND_OFF: memset(slot->foreground, 0, (size_t)stage->grid.count); break;
    case RLF_BACKGROUND_AVERAGE: update_average(stage, slot); break;
    case RLF_BACKGROUND_ADAPTIVE: rlf_background_adaptive_update(stage, kept, slot); break;
    case RLF_BACKGROUND_GIVEN: background_given_update(stage, slot); break;
    }
}

static void take_image(background_image *image, rlf_arena *arena, const rlf_reconstruct_def *def,
                       size_t n)
{
    image->depth = arena_take(arena, n, sizeof(float));
    for (int k = 0; k < 3; k++) {
        image->normal[k] = arena_take(arena, n, sizeof(float));
    }
    image->label = arena_take(arena, n, sizeof(int32_t));
    image->regions = arena_take(arena, (size_t)def->region_capacity, sizeof(rlf_region));
    if (def->keep_region_points) {
        image->region_points = arena_take(arena, n, sizeof(int32_t));
    }
}

void background_allocate(rlf_background *background, rlf_arena *arena,
                         const rlf_reconstruct_def *def, const image_grid *grid)
{
    size_t n = (size_t)grid->count;
    background->mean = arena_take(arena, n, sizeof(float));
    background->deviation = arena_take(arena, n, sizeof(float));
    background->weight = arena_take(arena, n, 1);
    background->beyond = arena_take(arena, n, 1);
    background->absent = arena_take(arena, n, 1);
    background->unknown_age = arena_take(arena, n, 1);
    background->still = arena_take(arena, n, sizeof(float));
    background->still_ms = arena_take(arena, n, sizeof(uint16_t));
    background->beneath = arena_take(arena, n, sizeof(float));
    background->standing = arena_take(arena, (size_t)grid->height, sizeof(rlf_span));
    size_t tiles = (size_t)background_image_tiles(grid);
    background->row_changes = arena_take(arena, tiles * BACKGROUND_TILE, sizeof(int32_t));
    background->changes = arena_take(arena, tiles, sizeof(int32_t));
    background->age = arena_take(arena, tiles, 1);
    background->is_better = arena_take(arena, tiles, 1);
    background->version = arena_take(arena, tiles, sizeof(int32_t));
    background->covered = arena_take(arena, n, 1);
    for (int k = 0; k < 6; k++) {
        background->crop[k] = arena_take(arena, background_image_crop_size(), sizeof(float));
    }
    arena_next_owner(arena);
    background->seen = arena_lend(arena, n, 1);
    background->up = arena_lend(arena, n, sizeof(int32_t));
    if (static_is_wanted(def)) {
        background->depart.thing = arena_take(arena, n, 1);
        background->depart.depth = arena_take(arena, n, sizeof(float));
        background->depart.left = arena_take(arena, n, 1);
    }
    for (int i = 0; i < BACKGROUND_IMAGES; i++) {
        take_image(&background->images[i], arena, def, n);
    }
}
