/* Point cloud (thesis 4.1, eq. 4.1): keeps every factor-th pixel, in metres, with a reason for each
 * one without depth. The point itself is depth times the pixel's ray. */
#include "surface/depth/depth.h"

#include "kernel/kernel.h"

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

void depth_read(const rlf_reconstruct *stage, const rlf_frame *frame, float *raw, uint8_t *reason)
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
