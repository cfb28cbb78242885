/* Steadies depth that does not change: a gated mean per pixel over time (kernel/steady_row.c). */
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <string.h>

/* Noise that is left after the planes' averaging is well within 1.25 sigma; without it within 3. */
static const float smoothed_gate = 1.25f, raw_gate = 3.0f;
static const float most_frames = 16.0f;

typedef struct steady_job {
    const rlf_reconstruct *stage;
    rlf_slot *slot;
    rlf_kernel_steady params;
    bool has_normals;
} steady_job;

static void steady_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const steady_job *job = context;
    const rlf_grid *grid = &job->stage->grid;
    for (int32_t y = begin; y < end; y++) {
        ptrdiff_t row = (ptrdiff_t)y * grid->width;
        const rlf_slot *slot = job->slot;
        rlf_kernel_steady_in in = {
            {0}, grid->ray_x + row, grid->ray_y + row, slot->reason + row, grid->width};
        for (int k = 0; k < 3; k++) {
            const float *normal = job->has_normals ? slot->normal[k] : job->stage->work.zero_plane;
            in.normal[k] = normal + row;
        }
        rlf_kernel_steady_row(&job->params, &in, slot->depth + row, job->stage->steady.mean + row,
                              job->stage->steady.frames + row);
    }
}

void rlf_steady_update(const rlf_reconstruct *stage, rlf_slot *slot)
{
    bool smooth = stage->def.enable_smoothing;
    steady_job job = {stage,
                      slot,
                      {rlf_kernel_noise_make(&stage->def.rig.noise),
                       smooth ? smoothed_gate : raw_gate, most_frames},
                      smooth};
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, steady_rows, &job);
}

void rlf_steady_reset(rlf_steady *steady, int32_t count)
{
    if (steady->frames != NULL) {
        memset(steady->frames, 0, (size_t)count * sizeof *steady->frames);
        memset(steady->mean, 0, (size_t)count * sizeof *steady->mean);
    }
}
