/* How the background's model becomes a published, unchanging image, a few tiles at a time.
 *
 * A draft is the oldest image, which no valid surface refers to. Tiles whose pixels were replaced
 * are made anew from the model, the most changed first, so many per frame that no frame costs much
 * more than another; a thing that leaves is published at once. A tile is made once more when
 * most of what is new in it has been seen, and when the means of that have got much better. */
#include "surface/depth_step.h"
#include "surface/objects/objects.h"
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <string.h>

enum {
    MARGIN = 12, /* pixels around a tile that its normals depend on; even */
    CROP = BACKGROUND_TILE + 2 * MARGIN,
    PARTS = 24,            /* of the tiles are made per frame, one ... */
    PARTS_URGENT = 5,      /* ... or, when a thing has left, one of so many */
    CHANGES = 30,          /* replaced pixels that make a new image ... */
    FRAMES = 10,           /* ... after at least this many frames */
    CHANGES_URGENT = 400,  /* replaced pixels that make one at once: a thing has left */
    FRAMES_LONG = 30,      /* after this many any change does */
    SHOWN_FRAMES = FRAMES, /* so many show what the first few did not, beside outlines ... */
    REFINED_FRAMES = 40    /* ... and so many make a mean much better */
};

const background_image *background_image_newest(const rlf_reconstruct *stage)
{
    const rlf_background *background = &stage->background;
    bool none = background->newest < 0 || background->is_stale;
    return none ? NULL : &background->images[background->newest];
}

/* The oldest one, which no valid surface refers to. */
static background_image *draft_of(rlf_background *background)
{
    return &background->images[(background->newest + 1) % BACKGROUND_IMAGES];
}

static int32_t tile_columns(const image_grid *grid)
{
    return (grid->width + BACKGROUND_TILE - 1) / BACKGROUND_TILE;
}

size_t background_image_crop_size(void)
{
    return (size_t)CROP * CROP;
}

void background_image_changed(rlf_background *background, const image_grid *grid, int32_t x,
                              int32_t y, int32_t count)
{
    background->changes[y / BACKGROUND_TILE * tile_columns(grid) + x / BACKGROUND_TILE] += count;
    background->changed += count;
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

static rlf_rect tile_at(const image_grid *grid, int32_t tile)
{
    int32_t x0 = tile % tile_columns(grid) * BACKGROUND_TILE;
    int32_t y0 = tile / tile_columns(grid) * BACKGROUND_TILE;
    return (rlf_rect){x0, y0, rlf_least(x0 + BACKGROUND_TILE, grid->width),
                      rlf_least(y0 + BACKGROUND_TILE, grid->height)};
}

static rlf_rect widen(const image_grid *grid, rlf_rect r)
{
    return (rlf_rect){r.x0 > MARGIN ? r.x0 - MARGIN : 0, r.y0 > MARGIN ? r.y0 - MARGIN : 0,
                      rlf_least(r.x1 + MARGIN, grid->width),
                      rlf_least(r.y1 + MARGIN, grid->height)};
}

/* Copies r between planes of parts of the image. */
static void copy_part(rlf_rect r, const float *from, rlf_rect of_from, float *to, rlf_rect of_to)
{
    for (int32_t y = r.y0; y < r.y1; y++) {
        memcpy(to + (ptrdiff_t)(y - of_to.y0) * (of_to.x1 - of_to.x0) + r.x0 - of_to.x0,
               from + (ptrdiff_t)(y - of_from.y0) * (of_from.x1 - of_from.x0) + r.x0 - of_from.x0,
               (size_t)(r.x1 - r.x0) * sizeof *to);
    }
}

static void tile_is_made(rlf_background *background, int32_t tile)
{
    const bool is_new = background->changes[tile] >= CHANGES;
    background->version[tile] = background->next_version;
    background->changed -= background->changes[tile];
    background->changes[tile] = 0;
    background->is_better[tile] = 0;
    background->age[tile] = is_new ? 0 : background->age[tile];
}

/* The image's depth of pixel i, as far as it is the model's still. */
static bool is_of_model(const rlf_reconstruct *stage, const float *depth, int32_t i)
{
    float z = stage->background.mean[i];
    float gate = rlf_background_gate(&stage->def, z);
    return z > 0.0f && depth[i] > 0.0f && rlf_kernel_abs(depth[i] - z) <= gate;
}

/* What the frame, or the image before, knows of pixels that the model does not. */
typedef struct edges {
    const rlf_reconstruct *stage;
    const rlf_slot *slot;
    const background_image *old; /* NULL = none */
    depth_step step;
} edges;

static void take_normal(float *const from[3], int32_t i, float *const to[3])
{
    float square = from[0][i] * from[0][i] + from[1][i] * from[1][i] + from[2][i] * from[2][i];
    for (int k = 0; k < 3 && square > 0.5f; k++) {
        to[k][i] = from[k][i];
    }
}

/* The model's mean does not tell on which side of a contour a pixel is: it is of whatever was seen
 * first. What frames agree on does, where this frame agrees, too. Or something hides the pixel, the
 * image before showed that side, and the model is not newer than the votes. */
static bool is_on_side(const edges *e, const rlf_vote *vote, int32_t i)
{
    if (e->slot->foreground[i] == 0) {
        return !depth_step_between(&e->step, e->slot->depth[i], vote->depth);
    }
    return e->old != NULL && !depth_step_between(&e->step, e->old->depth[i], vote->depth) &&
           e->stage->background.weight[i] >= vote->count;
}

/* What a frame knows of edges, the model's depth alone does not tell: creases are sharp there, and
 * sides that nothing was seen of have their normals. What frames agree on comes first, and what
 * something hides keeps what it had. */
static void sharpen_pixel(const edges *e, int32_t i, background_image *image)
{
    const rlf_vote *vote = vote_at(e->stage, i);
    if (vote != NULL && depth_step_between(&e->step, image->depth[i], vote->depth)) {
        bool is_on = image->depth[i] > 0.0f && is_on_side(e, vote, i);
        image->depth[i] = is_on ? vote->depth : image->depth[i];
        vote = is_on ? vote : NULL;
    }
    if (vote != NULL) {
        for (int k = 0; k < 3; k++) {
            image->normal[k][i] = vote->normal[k];
        }
    } else if (e->slot->foreground[i] == 0 && is_of_model(e->stage, e->slot->depth, i)) {
        take_normal(e->slot->normal, i, image->normal);
    } else if (e->old != NULL && is_of_model(e->stage, e->old->depth, i)) {
        take_normal(e->old->normal, i, image->normal);
    }
}

static void sharpen(const rlf_reconstruct *stage, const rlf_slot *slot, background_image *image,
                    rlf_rect r)
{
    const rlf_reconstruct_def *def = &stage->def;
    if (slot == NULL || !def->enable_smoothing || !def->enable_edge_normals ||
        def->normal_method != RLF_NORMALS_INVERSE_DEPTH || !def->normals_face_camera) {
        return; /* the frame has no such normals, or not yet */
    }
    const edges e = {stage, slot, background_image_newest(stage),
                     depth_step_make(&def->rig.noise, stage->grid.camera.fx)};
    for (int32_t y = r.y0; y < r.y1; y++) {
        for (int32_t x = r.x0; x < r.x1; x++) {
            sharpen_pixel(&e, y * stage->grid.width + x, image);
        }
    }
}

/* What has left is no background. */
static void clear_left(const rlf_reconstruct *stage, background_image *image, rlf_rect r)
{
    const uint8_t *left = stage->background.depart.left;
    for (int32_t y = r.y0; y < r.y1 && left != NULL; y++) {
        int32_t row = y * stage->grid.width;
        for (int32_t x = r.x0; (x = rlf_kernel_next_mark(left + row, x, r.x1)) < r.x1; x++) {
            image->depth[row + x] = 0.0f;
            for (int k = 0; k < 3; k++) {
                image->normal[k][row + x] = 0.0f;
            }
        }
    }
}

/* A tile from the model; its normals are those of a part of the image that holds all they depend
 * on.
 */
static void make_tile(rlf_reconstruct *stage, const rlf_slot *slot, background_image *image,
                      int32_t tile)
{
    const image_grid *grid = &stage->grid;
    const rlf_rect r = tile_at(grid, tile), wide = widen(grid, r);
    const rlf_rect whole = {0, 0, grid->width, grid->height};
    float *const *crop = stage->background.crop;
    const float *const from[3] = {stage->background.mean, grid->ray_x, grid->ray_y};
    for (int k = 0; k < 3; k++) {
        copy_part(wide, from[k], whole, crop[k], wide);
    }
    rlf_normals_job job = rlf_normals_job_make(stage, crop[0], crop + 3);
    job.width = wide.x1 - wide.x0;
    job.height = wide.y1 - wide.y0;
    job.ray_x = crop[1];
    job.ray_y = crop[2];
    job.pool = NULL;
    rlf_normals_compute(&job);
    copy_part(r, stage->background.mean, whole, image->depth, whole);
    for (int k = 0; k < 3; k++) {
        copy_part(r, crop[3 + k], wide, image->normal[k], whole);
    }
    sharpen(stage, slot, image, r);
    clear_left(stage, image, r);
    tile_is_made(&stage->background, tile);
}

/* Brings the oldest image up to the newest. */
static void begin_draft(rlf_reconstruct *stage)
{
    rlf_background *background = &stage->background;
    const image_grid *grid = &stage->grid;
    const background_image *newest = &background->images[background->newest];
    background_image *draft = draft_of(background);
    for (int32_t tile = 0; tile < background_image_tiles(grid); tile++) {
        if (background->version[tile] > draft->version) {
            const rlf_rect r = tile_at(grid, tile), whole = {0, 0, grid->width, grid->height};
            copy_part(r, newest->depth, whole, draft->depth, whole);
            for (int k = 0; k < 3; k++) {
                copy_part(r, newest->normal[k], whole, draft->normal[k], whole);
            }
        }
    }
    background->is_drafting = true;
}

/* How much a tile needs to be made: its replaced pixels, or that its means are better. Once for
 * each image, where somebody walks about there is no end of changes; but what has left is in none.
 */
static int32_t need_of(const rlf_background *background, int32_t tile)
{
    bool is_made = background->version[tile] == background->next_version;
    const int32_t need = 2 * background->changes[tile] + background->is_better[tile];
    return is_made && !background->depart.is_urgent ? 0 : need;
}

/* The tile that needs it most; -1 = none. */
static int32_t next_tile(const rlf_background *background, int32_t tiles)
{
    int32_t best = -1, most = 0;
    for (int32_t tile = 0; tile < tiles; tile++) {
        int32_t need = need_of(background, tile);
        best = need > most ? tile : best;
        most = need > most ? need : most;
    }
    return best;
}

/* The draft as a layer that is segmented. */
static rlf_layer_in draft_layer(rlf_reconstruct *stage)
{
    rlf_background *background = &stage->background;
    const background_image *old = background_image_newest(stage);
    const background_image *image = draft_of(background);
    rlf_layer_in in = {.layer = RLF_LAYER_BACKGROUND,
                       .method = stage->def.background_segment,
                       .depth = image->depth,
                       .normal = image->normal,
                       .steps_done = background->object_steps,
                       .kept = image->label};
    if (old != NULL) {
        in.previous_label = old->label;
        in.previous = old->regions;
        in.previous_count = old->region_count;
    } else if (stage->previous != NULL && stage->objects != NULL) {
        in.previous_label = stage->previous->label;
        in.previous = stage->previous->regions;
        in.previous_count = stage->previous->foreground_region_first;
    }
    return in;
}

/* Regions of the finished draft; from now on it is the newest. */
static void finish(rlf_reconstruct *stage)
{
    rlf_background *background = &stage->background;
    background_image *image = draft_of(background);
    const rlf_layer_in in = draft_layer(stage);
    rlf_layer_out out = {image->regions, image->region_points, 0, 0};
    rlf_layer_segment(stage, &in, &out);
    memset(image->label, 0, (size_t)stage->grid.count * sizeof *image->label);
    rlf_region_write_labels(stage, &out, image->label);
    image->region_count = out.region_count;
    image->point_count = out.point_count;
    image->version = background->next_version++;
    background->newest = (background->newest + 1) % BACKGROUND_IMAGES;
    background->image_age = 0;
    background->is_drafting = false;
    background->is_made = false;
    background->object_steps = 0;
    background->is_stale = false;
}

/* The regions of a draft whose tiles are made: each step takes a frame. True when this frame did
 * one. */
static bool finish_in_steps(rlf_reconstruct *stage, bool urgent)
{
    rlf_background *background = &stage->background;
    if (!background->is_made || urgent) {
        return false;
    }
    if (background->object_steps == RLF_OBJECT_STEPS) {
        finish(stage);
    } else {
        const rlf_layer_in in = draft_layer(stage);
        rlf_objects_step(stage, &in);
        background->object_steps++;
    }
    return true;
}

void background_image_publish(rlf_reconstruct *stage, const rlf_slot *slot)
{
    rlf_background *background = &stage->background;
    for (int32_t tile = 0; tile < background_image_tiles(&stage->grid); tile++) {
        make_tile(stage, slot, draft_of(background), tile);
        background->age[tile] = 0;
    }
    finish(stage);
}

/* Counts the frames; true when a draft is to be begun. */
static bool is_due(rlf_background *background, int32_t tiles)
{
    bool better = false;
    for (int32_t tile = 0; tile < tiles; tile++) {
        background->age[tile] += background->age[tile] < UINT8_MAX ? 1 : 0;
        int32_t age = background->age[tile];
        background->is_better[tile] |= age == SHOWN_FRAMES || age == REFINED_FRAMES;
        better = better || background->is_better[tile] != 0;
    }
    background->image_age++;
    return better || (background->changed >= CHANGES && background->image_age >= FRAMES) ||
           (background->changed > 0 && background->image_age >= FRAMES_LONG);
}

void background_image_advance(rlf_reconstruct *stage, const rlf_slot *slot)
{
    rlf_background *background = &stage->background;
    int32_t tiles = background_image_tiles(&stage->grid);
    if (background_image_newest(stage) == NULL) {
        background_image_publish(stage, slot);
        return;
    }
    bool due = is_due(background, tiles);
    bool urgent = background->depart.is_urgent || background->changed >= CHANGES_URGENT;
    if (!background->is_drafting && !urgent && !due) {
        return;
    }
    if (finish_in_steps(stage, urgent)) {
        return;
    }
    if (!background->is_drafting) {
        begin_draft(stage);
    }
    background->object_steps = 0; /* tiles change */
    background_image *draft = draft_of(background);
    int32_t most = 1 + tiles / (urgent ? PARTS_URGENT : PARTS);
    most = background->depart.is_urgent ? tiles : most;
    int32_t tile = next_tile(background, tiles);
    for (int32_t made = 0; made < most && tile >= 0; made++) {
        make_tile(stage, slot, draft, tile);
        tile = next_tile(background, tiles);
    }
    background->is_made = tile < 0 && stage->objects != NULL;
    if (urgent || (tile < 0 && !background->is_made)) {
        finish(stage);
    }
}
