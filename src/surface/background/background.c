/* The background, by the method that the settings name; AVERAGE is here.
 *
 * AVERAGE (thesis 4.4.1): the first frames are averaged into a background that never changes, and
 * what differs from it by more than a threshold is foreground. The mean is over the valid samples
 * of a pixel. Where the background is missing, the difference does not exist (the thesis's
 * comparison with NaN is false): such a pixel is not foreground. ADAPTIVE: see adaptive.c.
 *
 * Any model is emptied, asked, and given up when it shows another room here. */
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <string.h>

void rlf_background_reset(rlf_background *background, const image_grid *grid)
{
    size_t n = (size_t)grid->count;
    memset(background->mean, 0, n * sizeof *background->mean);
    memset(background->deviation, 0, n * sizeof *background->deviation);
    memset(background->weight, 0, n);
    memset(background->beyond, 0, n);
    memset(background->absent, 0, n);
    memset(background->unknown_age, 0, n);
    memset(background->still_ms, 0, n * sizeof *background->still_ms);
    memset(background->beneath, 0, n * sizeof *background->beneath);
    memset(background->standing, 0, (size_t)grid->height * sizeof *background->standing);
    if (background->depart.thing != NULL) {
        memset(background->depart.thing, 0, n);
        memset(background->depart.left, 0, n);
    }
    background->frames = 0;
    memset(background->changes, 0,
           (size_t)background_image_tiles(grid) * sizeof *background->changes);
    memset(background->age, 0, (size_t)background_image_tiles(grid));
    memset(background->is_better, 0, (size_t)background_image_tiles(grid));
    background->changed = 0;
    background->image_age = 0;
    background->is_drafting = false;
    background->is_made = false;
    background->object_steps = 0;
    background->next_version++; /* newer than that of an image that was never published: 0 */
    background->state = RLF_BACKGROUND_NONE;
    background->newest = -1;
    background->is_stale = false;
    background->other_frames = 0;
}

float rlf_background_gate(const rlf_reconstruct_def *def, float z)
{
    float scaled = (float)(def->foreground_sigmas * rlf_depth_noise_sigma(&def->rig.noise, z));
    return scaled > (float)def->foreground_min_m ? scaled : (float)def->foreground_min_m;
}

void background_put(rlf_reconstruct *stage, int32_t i, float z, uint8_t weight)
{
    rlf_background *background = &stage->background;
    const int32_t width = stage->grid.width;
    background->mean[i] = z;
    background->deviation[i] = 0.0f;
    background->weight[i] = weight;
    background->beyond[i] = 0;
    background_image_changed(background, &stage->grid, i % width, i / width, 1);
}

void background_clear_front(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    memset(slot->foreground, 0, (size_t)stage->grid.count);
    memset(stage->work.front, 0, (size_t)stage->grid.height * sizeof *stage->work.front);
}

rlf_span rlf_background_span(const uint8_t *foreground, int32_t width)
{
    rlf_span span = {rlf_kernel_next_mark(foreground, 0, width), width};
    while (span.x1 > span.x0 && foreground[span.x1 - 1] == 0) {
        span.x1--;
    }
    return span;
}

/* ---- another room ---- */

enum {
    SAMPLES = 32,      /* of a row of the picture: so many pixels tell whether it is another room */
    FRAMES = 3,        /* in a row */
    CHANGED_OF_10 = 6, /* of the pixels with depth and a known background, so many tenths differ */
    EITHER_OF_10 = 1   /* and at least so many are nearer, and as many farther */
};

typedef struct tally {
    int32_t known, nearer, farther;
} tally;

static tally count(const rlf_reconstruct *stage, const float *depth)
{
    const image_grid *grid = &stage->grid;
    const float *mean = stage->background.mean;
    tally sum = {0, 0, 0};
    int32_t step = grid->width > SAMPLES ? grid->width / SAMPLES : 1;
    for (int32_t y = step / 2; y < grid->height; y += step) {
        for (int32_t x = step / 2; x < grid->width; x += step) {
            int32_t i = y * grid->width + x;
            if (!(depth[i] > 0.0f) || !(mean[i] > 0.0f)) {
                continue;
            }
            float gate = rlf_background_gate(&stage->def, depth[i]);
            sum.known++;
            sum.nearer += depth[i] < mean[i] - gate ? 1 : 0;
            sum.farther += depth[i] > mean[i] + gate ? 1 : 0;
        }
    }
    return sum;
}

/* A thing that comes or goes changes pixels in one direction: it is nearer than the background, or
 * the background is seen where it was. Where the recording was cut or the camera was moved, the
 * room is nearer in some places and farther in others, nearly everywhere, from then on. */
bool rlf_background_is_cut(rlf_reconstruct *stage, const float *depth)
{
    tally sum = count(stage, depth);
    int32_t fewest = sum.nearer < sum.farther ? sum.nearer : sum.farther;
    bool other = sum.known > 0 && 10 * (sum.nearer + sum.farther) >= CHANGED_OF_10 * sum.known &&
                 10 * fewest >= EITHER_OF_10 * sum.known;
    stage->background.other_frames = other ? stage->background.other_frames + 1 : 0;
    return stage->background.other_frames >= FRAMES;
}

/* ---- AVERAGE ---- */

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

/* ---- a frame ---- */

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
