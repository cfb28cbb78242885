/* Pixels that a plane has moved off their own surface.
 *
 * A window across a low step, as of an arm before a trunk, has a plane too: a steep one, whose
 * slant explains a residual that noise would not. It moves what is beside the step to between the
 * two surfaces, where nothing is. But there the pixel is alone: those about it are at the depth
 * that it was seen at. Where something has moved lately, and no mean over time says better, such a
 * pixel goes back to where it was seen, and has no normal of its own. */
#include "surface/steps.h"

#include "kernel/kernel.h"

enum { LEAST_BESIDE = 2 };

/* Of the depth: off its surface, as flying_row.c has it; at the same depth. */
static const float far_share = 0.012f, far_m = 0.004f;
static const float near_share = 0.008f, near_m = 0.0025f;

typedef struct oversmooth_job {
    const rlf_reconstruct *stage;
    const float *seen;
    float *smooth;
    float *const *normal;
} oversmooth_job;

/* Of the eight about pixel i. */
static int32_t count_near(const oversmooth_job *job, ptrdiff_t i, float z, float most)
{
    ptrdiff_t width = job->stage->grid.width;
    int32_t count = 0;
    for (ptrdiff_t row = i - width; row <= i + width; row += width) {
        for (ptrdiff_t n = row - 1; n <= row + 1; n++) {
            count += n != i && rlf_kernel_abs(job->seen[n] - z) < most ? 1 : 0;
        }
    }
    return count;
}

static void look_at_pixel(const oversmooth_job *job, ptrdiff_t i)
{
    float seen = job->seen[i], most = near_share * seen + near_m;
    int32_t beside = count_near(job, i, seen, most);
    if (beside >= LEAST_BESIDE && beside > count_near(job, i, job->smooth[i], most)) {
        job->smooth[i] = seen;
        for (int32_t k = 0; k < 3; k++) {
            job->normal[k][i] = 0.0f;
        }
    }
}

/* Pixels of a row, `count` of them from x on. */
static void look_at_run(const oversmooth_job *job, int32_t x, int32_t y, int32_t count)
{
    ptrdiff_t first = (ptrdiff_t)y * job->stage->grid.width + x;
    uint8_t moved[RLF_PART];
    rlf_kernel_moved_row(job->seen + first, job->smooth + first, far_share, far_m, count, moved);
    for (int32_t k = 0; (k = rlf_kernel_next_mark(moved, k, count)) < count; k++) {
        look_at_pixel(job, first + k);
    }
}

static void look_at_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const oversmooth_job *job = context;
    const image_grid *grid = &job->stage->grid;
    int32_t first = begin > 1 ? begin : 1, last = rlf_least(end, grid->height - 1);
    for (int32_t y = first; y < last; y++) {
        for (int32_t x = 0; x < grid->width;) {
            rlf_span moving = temporal_next_moving(job->stage, x, y);
            int32_t x0 = moving.x0 > 1 ? moving.x0 : 1, x1 = rlf_least(moving.x1, grid->width - 1);
            for (; x0 < x1; x0 += RLF_PART) {
                look_at_run(job, x0, y, x1 - x0 < RLF_PART ? x1 - x0 : RLF_PART);
            }
            x = moving.x1;
        }
    }
}

void oversmooth_undo(const rlf_reconstruct *stage, const float *seen, float *smooth,
                     float *const normal[3])
{
    oversmooth_job job = {stage, seen, smooth, normal};
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, look_at_rows, &job);
}
