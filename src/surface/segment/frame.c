/* Regions of both layers of a frame: those of the background's image, and the foreground's own. */
#include "surface/steps.h"

#include <string.h>

/* Puts the background's regions first, so that the foreground's follow. */
static void copy_background_regions(const background_image *image, rlf_slot *slot)
{
    slot->foreground_region_first = image == NULL ? 0 : image->region_count;
    if (image == NULL) {
        return;
    }
    memcpy(slot->regions, image->regions, (size_t)image->region_count * sizeof *slot->regions);
    if (slot->region_points != NULL) {
        memcpy(slot->region_points, image->region_points,
               (size_t)image->point_count * sizeof *slot->region_points);
    }
}

static rlf_layer_in front_layer(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    const rlf_slot *before = stage->previous;
    bool off = stage->def.background_method == RLF_BACKGROUND_OFF;
    rlf_layer_in in = {.layer = RLF_LAYER_FOREGROUND,
                       .method = stage->def.foreground_segment,
                       .depth = slot->depth,
                       .mask = off ? NULL : slot->foreground,
                       .spans = off ? NULL : stage->work.front,
                       .has_components = stage->has_components,
                       .component_count = stage->component_count};
    if (before != NULL) {
        in.previous_label = before->label;
        in.previous_mask = off ? NULL : before->foreground;
        in.previous = before->regions + before->foreground_region_first;
        in.previous_count = before->foreground_region_count;
        in.elapsed_ns = rlf_stage_elapsed_ns(stage, slot);
    }
    return in;
}

/* What belongs to no region is noise. */
static void drop_pieces(const rlf_reconstruct *stage, rlf_slot *slot)
{
    const rlf_runs *runs = &stage->work.runs;
    for (int32_t y = 0; y < stage->grid.height; y++) {
        uint8_t *row = slot->foreground + (ptrdiff_t)y * stage->grid.width;
        for (int32_t r = runs->first[y]; r < runs->first[y + 1]; r++) {
            const rlf_run *run = &runs->run[r];
            if (run->component <= 0) {
                memset(row + run->x0, 0, (size_t)(run->x1 - run->x0));
            }
        }
    }
}

static rlf_layer_out segment_front(rlf_reconstruct *stage, rlf_slot *slot)
{
    const background_image *image = background_image_newest(stage);
    int32_t offset = image == NULL ? 0 : image->point_count;
    rlf_layer_in in = front_layer(stage, slot);
    rlf_layer_out out = {slot->regions + slot->foreground_region_first,
                         slot->region_points == NULL ? NULL : slot->region_points + offset, 0, 0};
    rlf_layer_segment(stage, &in, &out);
    for (int32_t r = 0; r < out.region_count && out.points != NULL; r++) {
        out.regions[r].first_point += offset;
    }
    if (in.method == RLF_SEGMENT_NOISE && in.mask != NULL) {
        if (out.points == NULL) { /* lists are complete already */
            rlf_region_adopt(stage, slot->depth, &out);
        }
        drop_pieces(stage, slot);
    }
    return out;
}

typedef struct label_job {
    const rlf_reconstruct *stage;
    const int32_t *background;
    rlf_slot *slot;
    int32_t valid[RLF_IMAGE_SIZE_MAX / RLF_ROW_GRAIN]; /* per chunk */
} label_job;

static void label_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    label_job *job = context;
    const rlf_slot *slot = job->slot;
    int32_t width = job->stage->grid.width;
    ptrdiff_t at = (ptrdiff_t)begin * width;
    job->valid[begin / RLF_ROW_GRAIN] =
        rlf_kernel_label_row(slot->depth + at, slot->foreground + at, job->background + at,
                             (end - begin) * width, slot->label + at);
}

/* Labels where the front sheet shows the background, and how much it shows. */
static void label_background(rlf_reconstruct *stage, rlf_slot *slot)
{
    const background_image *image = background_image_newest(stage);
    label_job job = {.stage = stage,
                     .background = image != NULL ? image->label : stage->work.zero_labels,
                     .slot = slot};
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, label_rows, &job);
    slot->surface.valid_count = 0;
    for (int32_t y = 0; y < stage->grid.height; y += RLF_ROW_GRAIN) {
        slot->surface.valid_count += job.valid[y / RLF_ROW_GRAIN];
    }
}

/* While the background is learnt, what is seen is taken to be it: regions from the first frame on.
 */
static void segment_first(rlf_reconstruct *stage, rlf_slot *slot)
{
    const rlf_slot *before = stage->previous;
    rlf_layer_in in = {.layer = RLF_LAYER_BACKGROUND,
                       .method = stage->def.background_segment,
                       .depth = slot->depth,
                       .normal = slot->normal};
    if (before != NULL) {
        in.previous_label = before->label;
        in.previous = before->regions;
        in.previous_count = before->foreground_region_first;
        in.elapsed_ns = rlf_stage_elapsed_ns(stage, slot);
    }
    rlf_layer_out out = {slot->regions, slot->region_points, 0, 0};
    rlf_layer_segment(stage, &in, &out);
    slot->foreground_region_first = out.region_count;
    rlf_region_write_labels(stage, &out, slot->label);
    /* The steps that follow read the runs as the foreground's, and there is none. */
    memset(stage->work.runs.first, 0,
           (size_t)(stage->grid.height + 1) * sizeof *stage->work.runs.first);
}

void segment_frame(rlf_reconstruct *stage, rlf_slot *slot)
{
    copy_background_regions(background_image_newest(stage), slot);
    bool off = stage->def.background_method == RLF_BACKGROUND_OFF;
    bool has_front = off || stage->background.state == RLF_BACKGROUND_READY;
    rlf_layer_out out = {NULL, NULL, 0, 0};
    if (has_front) {
        out = segment_front(stage, slot);
    }
    slot->foreground_region_count = out.region_count;
    label_background(stage, slot);
    if (has_front) {
        rlf_region_write_labels(stage, &out, slot->label);
    } else if (stage->objects != NULL) {
        segment_first(stage, slot);
    }
    rlf_stage_add_time(stage, RLF_SURFACE_SEGMENT);
}
