/* Takes mixed pixels off depth edges, row by row. */
#include "surface/steps.h"

#include "kernel/kernel.h"

typedef struct flying_job {
    const rlf_reconstruct *stage;
    const float *raw;
    float *depth;
    uint8_t *reason;
} flying_job;

static void flying_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const flying_job *job = context;
    const rlf_grid *grid = &job->stage->grid;
    for (int32_t y = begin; y < end; y++) {
        const float *at = job->raw + (ptrdiff_t)y * grid->width;
        const float *const rows[3] = {y > 0 ? at - grid->width : job->stage->work.zeros, at,
                                      y + 1 < grid->height ? at + grid->width
                                                           : job->stage->work.zeros};
        ptrdiff_t offset = (ptrdiff_t)y * grid->width;
        rlf_kernel_flying_row(rows, grid->width, job->depth + offset, job->reason + offset);
    }
}

void rlf_flying_remove(const rlf_reconstruct *stage, const float *raw, float *depth,
                       uint8_t *reason)
{
    flying_job job = {stage, raw, depth, reason};
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, flying_rows, &job);
}
