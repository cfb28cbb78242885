/* Takes mixed pixels off depth edges, row by row: single ones everywhere, lines of them where
 * something has moved lately. At an edge that rests they are the same in every frame and little
 * off; what would be filled there instead is no truer, and the background would change with it. */
#include "surface/depth/depth.h"
#include "surface/steps.h"

#include "kernel/kernel.h"

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

void flying_remove(const rlf_reconstruct *stage, const float *raw, float *depth, uint8_t *reason)
{
    flying_job job = {stage, raw, depth, reason};
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, flying_rows, &job);
}
