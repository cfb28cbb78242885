/* The back sheet: how the model becomes a published, unchanging sheet. */
#include "surface/steps.h"

#include <string.h>

void rlf_background_reset(rlf_background *background, const rlf_grid *grid)
{
    size_t n = (size_t)grid->count;
    memset(background->mean, 0, n * sizeof *background->mean);
    memset(background->deviation, 0, n * sizeof *background->deviation);
    memset(background->weight, 0, n);
    memset(background->beyond, 0, n);
    memset(background->unknown_age, 0, n);
    memset(background->still_ms, 0, n * sizeof *background->still_ms);
    memset(background->beneath, 0, n * sizeof *background->beneath);
    memset(background->standing, 0, (size_t)grid->height * sizeof *background->standing);
    memset(background->hides, 0, (size_t)grid->height);
    background->frames = 0;
    background->changed = 0;
    background->sheet_age = 0;
    background->state = RLF_BACKGROUND_NONE;
    background->newest = -1;
}

/* The oldest sheet: the surfaces that are still valid refer to younger ones. */
void rlf_background_publish(rlf_reconstruct *stage)
{
    rlf_background *background = &stage->background;
    const rlf_grid *grid = &stage->grid;
    const rlf_sheet *old = background->newest < 0 ? NULL : &background->sheets[background->newest];
    int32_t next = (background->newest + 1) % RLF_SHEETS;
    rlf_sheet *sheet = &background->sheets[next];
    memcpy(sheet->depth, background->mean, (size_t)grid->count * sizeof *sheet->depth);
    rlf_normals_job normals = rlf_normals_job_make(stage, sheet->depth, sheet->normal);
    rlf_normals_compute(&normals);
    rlf_layer_in in = {.layer = RLF_LAYER_BACKGROUND,
                       .method = stage->def.background_segment,
                       .depth = sheet->depth};
    if (old != NULL) {
        in.previous_label = old->label;
        in.previous = old->regions;
        in.previous_count = old->region_count;
    }
    rlf_layer_out out = {sheet->regions, sheet->region_points, 0, 0};
    rlf_layer_segment(stage, &in, &out);
    memset(sheet->label, 0, (size_t)grid->count * sizeof *sheet->label);
    rlf_region_write_labels(stage, &out, sheet->label);
    sheet->region_count = out.region_count;
    sheet->point_count = out.point_count;
    background->newest = next;
    background->changed = 0;
    background->sheet_age = 0;
}

rlf_span rlf_background_span(const uint8_t *foreground, int32_t width)
{
    rlf_span span = {0, width};
    uint64_t eight = 0;
    for (; span.x0 + 8 <= width; span.x0 += 8) {
        memcpy(&eight, foreground + span.x0, sizeof eight);
        if (eight != 0) {
            break;
        }
    }
    while (span.x0 < width && foreground[span.x0] == 0) {
        span.x0++;
    }
    while (span.x1 > span.x0 && foreground[span.x1 - 1] == 0) {
        span.x1--;
    }
    return span;
}

void rlf_background_update(rlf_reconstruct *stage, rlf_slot *slot)
{
    stage->has_components = false;
    switch (stage->def.background_method) {
    case RLF_BACKGROUND_OFF: memset(slot->foreground, 0, (size_t)stage->grid.count); break;
    case RLF_BACKGROUND_AVERAGE: rlf_background_average_update(stage, slot); break;
    case RLF_BACKGROUND_ADAPTIVE: rlf_background_adaptive_update(stage, slot); break;
    }
}
