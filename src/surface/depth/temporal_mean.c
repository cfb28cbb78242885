/* The mean over time of depth that does not change, gated per pixel (kernel/steady_row.c). */
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <string.h>

static const float most_frames = 32.0f;

typedef struct mean_job {
    const rlf_reconstruct *stage;
    float *depth;
    const uint8_t *reason;
    int8_t *lag; /* plane */
} mean_job;

static void lag_row(const mean_job *job, int32_t y)
{
    const rlf_reconstruct *stage = job->stage;
    const image_grid *grid = &stage->grid;
    ptrdiff_t row = (ptrdiff_t)y * grid->width;
    rlf_kernel_lag_in in = {{0},
                            grid->ray_x + row,
                            grid->ray_y + row,
                            job->depth + row,
                            stage->temporal.mean + row,
                            stage->temporal.frames + row};
    for (int k = 0; k < 3; k++) {
        in.normal[k] =
            (stage->previous != NULL ? stage->previous->normal[k] : stage->work.zero_plane) + row;
    }
    rlf_kernel_lag_row(rlf_kernel_noise_make(&stage->def.rig.noise), &in, grid->width,
                       job->lag + row);
}

static void mean_row(const mean_job *job, int32_t y)
{
    const image_grid *grid = &job->stage->grid;
    const int8_t *outside = (const int8_t *)job->stage->work.zeros;
    ptrdiff_t row = (ptrdiff_t)y * grid->width;
    const int8_t *lag = job->lag + row;
    rlf_kernel_steady_in in = {{y > 0 ? lag - grid->width : outside, lag,
                                y + 1 < grid->height ? lag + grid->width : outside},
                               job->reason + row,
                               most_frames,
                               grid->width};
    rlf_kernel_steady_row(&in, job->depth + row, job->stage->temporal.mean + row,
                          job->stage->temporal.frames + row);
}

/* Lags of the rows that the chunks beside these rows need as well, while no depth is another yet.
 */
static void lag_outer_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    lag_row(context, begin);
    if (end - 1 > begin) {
        lag_row(context, end - 1);
    }
}

/* What a row's lags were found from is near at hand when it is averaged. */
static void mean_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    for (int32_t y = begin; y < end; y++) {
        if (y + 1 < end - 1) {
            lag_row(context, y + 1);
        }
        mean_row(context, y);
    }
}

void temporal_mean(rlf_reconstruct *stage, float *depth, const uint8_t *reason)
{
    mean_job job = {stage, depth, reason, stage->temporal.lag};
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, lag_outer_rows, &job);
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, mean_rows, &job);
    stage->temporal.age += stage->temporal.age < 255 ? 1 : 0;
}

void temporal_allocate(temporal *state, rlf_arena *arena, const rlf_reconstruct_def *def,
                       const image_grid *grid)
{
    size_t n = (size_t)grid->count;
    arena_next_owner(arena);
    if (def->enable_steadying) {
        state->mean = arena_take(arena, n, sizeof(float));
        state->frames = arena_take(arena, n, sizeof(float));
        state->calm = arena_take(arena, n, 1);
        state->restless = arena_take(arena, n, 1);
        state->change = arena_lend(arena, n, 1);
        state->lag = arena_lend(arena, n, 1);
    }
}

void temporal_reset(temporal *state, const image_grid *grid)
{
    size_t n = (size_t)grid->count;
    if (state->frames != NULL) {
        memset(state->frames, 0, n * sizeof *state->frames);
        memset(state->mean, 0, n * sizeof *state->mean);
        memset(state->calm, RLF_TEMPORAL_CALM, n); /* until something moves */
        memset(state->restless, 0, n);
        state->age = 0;
    }
}
