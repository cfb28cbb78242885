/* Depth of a frame, step by step. Each may be switched off. */
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <string.h>

/* ---- point cloud ---- */

typedef struct read_job {
    const rlf_reconstruct *stage;
    const rlf_frame *frame;
    rlf_kernel_range range;
    float *depth;
    uint8_t *reason;
} read_job;

static void read_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const read_job *job = context;
    const rlf_frame *frame = job->frame;
    const image_grid *grid = &job->stage->grid;
    for (int32_t y = begin; y < end; y++) {
        ptrdiff_t skip = (ptrdiff_t)y * grid->factor * frame->depth_stride;
        float *depth = job->depth + (ptrdiff_t)y * grid->width;
        uint8_t *reason = job->reason + (ptrdiff_t)y * grid->width;
        if (frame->depth_u16 != NULL) {
            const void *row = (const char *)frame->depth_u16 + skip;
            rlf_kernel_depth_row_u16(row, grid->factor, grid->width, job->range, depth, reason);
        } else {
            const void *row = (const char *)frame->depth_f32 + skip;
            rlf_kernel_depth_row_f32(row, grid->factor, grid->width, job->range, depth, reason);
        }
        rlf_kernel_lens_row(grid->has_ray + (ptrdiff_t)y * grid->width, grid->width, depth, reason);
    }
}

/* Thesis 4.1, eq. 4.1: keeps every factor-th pixel, in metres, with a reason for each one without
 * depth. The point itself is depth times the pixel's ray. */
static void read_depth(const rlf_reconstruct *stage, const rlf_frame *frame, float *raw,
                       uint8_t *reason)
{
    double units = frame->depth_u16 != NULL ? frame->depth_units_per_metre : 1.0;
    read_job job = {
        stage,
        frame,
        {(float)stage->def.depth_min_m, (float)stage->def.depth_max_m, (float)(1.0 / units)},
        raw,
        reason};
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, read_rows, &job);
}

/* ---- mixed pixels ---- */

typedef struct flying_job {
    const rlf_reconstruct *stage;
    const float *raw;
    float *depth;
    uint8_t *reason;
} flying_job;

/* Row y + step as seen; zeros beyond the image. */
static const float *row_at(const flying_job *job, int32_t y, int32_t step)
{
    const image_grid *grid = &job->stage->grid;
    int32_t row = y + step;
    bool inside = row >= 0 && row < grid->height;
    return inside ? job->raw + (ptrdiff_t)row * grid->width : job->stage->work.zeros;
}

/* Of the blocks in which something has moved. */
static void drop_half_way(const flying_job *job, int32_t y)
{
    const rlf_reconstruct *stage = job->stage;
    const float *const rows[5] = {row_at(job, y, -2), row_at(job, y, -1), row_at(job, y, 0),
                                  row_at(job, y, 1), row_at(job, y, 2)};
    ptrdiff_t offset = (ptrdiff_t)y * stage->grid.width;
    int32_t first = 2, last = stage->grid.width - 2;
    for (int32_t x = 0; x < last;) {
        rlf_span moving = temporal_next_moving(stage, x, y);
        int32_t begin = moving.x0 > first ? moving.x0 : first, end = rlf_least(moving.x1, last);
        if (begin < end) {
            rlf_kernel_half_way_row(rows, begin, end, job->depth + offset, job->reason + offset);
        }
        x = moving.x1;
    }
}

static void flying_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const flying_job *job = context;
    const image_grid *grid = &job->stage->grid;
    for (int32_t y = begin; y < end; y++) {
        const float *const rows[3] = {row_at(job, y, -1), row_at(job, y, 0), row_at(job, y, 1)};
        ptrdiff_t offset = (ptrdiff_t)y * grid->width;
        rlf_kernel_flying_row(rows, grid->width, job->depth + offset, job->reason + offset);
        drop_half_way(job, y);
    }
}

/* Takes mixed pixels off depth edges, row by row: single ones everywhere, lines of them where
 * something has moved lately. At an edge that rests they are the same in every frame and little
 * off; what would be filled there instead is no truer, and the background would change with it. */
static void remove_flying(const rlf_reconstruct *stage, const float *raw, float *depth,
                          uint8_t *reason)
{
    flying_job job = {stage, raw, depth, reason};
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, flying_rows, &job);
}

/* ---- the steps in their order ---- */

void depth_read_frame(rlf_reconstruct *stage, const rlf_frame *frame, float *raw, float *kept,
                      uint8_t *reason)
{
    read_depth(stage, frame, raw, reason);
    if (stage->def.background_method == RLF_BACKGROUND_ADAPTIVE ||
        stage->def.background_method == RLF_BACKGROUND_GIVEN) {
        rlf_ego_motion_watch(stage, raw);
    }
    rlf_stage_add_time(stage, RLF_SURFACE_READ);
    if (stage->def.enable_flying_removal) {
        remove_flying(stage, raw, kept, reason);
        rlf_stage_add_time(stage, RLF_SURFACE_FLYING);
    } else {
        memcpy(kept, raw, (size_t)stage->grid.count * sizeof *kept);
    }
}

void depth_track_thin(rlf_reconstruct *stage, const float *kept, const rlf_slot *slot)
{
    const thin_in in = {.grid = &stage->grid,
                        .noise = &stage->def.rig.noise,
                        .before = stage->previous,
                        .dt = rlf_stage_elapsed_s(stage, slot),
                        .depth = kept};
    if (stage->thin.expected != NULL) {
        thin_track(&in, &stage->thin);
    }
}

void depth_average(rlf_reconstruct *stage, const float *raw, float *kept, uint8_t *reason)
{
    if (stage->def.enable_steadying) {
        if (stage->def.enable_hold) {
            temporal_recall(stage, raw, kept, reason);
        }
        temporal_mean(stage, kept, reason);
        rlf_stage_add_time(stage, RLF_SURFACE_STEADY);
    }
}

void depth_fill(rlf_reconstruct *stage, const rlf_frame *frame, const float *kept, rlf_slot *slot,
                uint8_t *was_seen)
{
    if (!stage->def.enable_fill) {
        rlf_kernel_has_row(slot->depth, stage->grid.count, was_seen);
        return;
    }
    rlf_shadow_learn(stage, kept);
    rlf_color_guide_start(stage, frame);
    rlf_fill_holes(stage, slot, was_seen);
    rlf_color_guide_learn(stage);
    rlf_stage_add_time(stage, RLF_SURFACE_FILL);
}
