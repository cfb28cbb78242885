/* Normals of noisy depth: plane windows (kernel/plane_tile.c), then the few pixels that no plane
 * explains (normals/complete.c). */
#include "surface/steps.h"

#include "kernel/kernel.h"

static void plane_bands(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const rlf_normals_job *job = context;
    for (int32_t band = begin; band < end; band++) {
        for (int32_t x = 0; x < job->width; x += RLF_KERNEL_TILE_WIDTH) {
            int32_t y = band * RLF_KERNEL_TILE_HEIGHT;
            int32_t x1 = x + RLF_KERNEL_TILE_WIDTH;
            int32_t y1 = y + RLF_KERNEL_TILE_HEIGHT;
            rlf_kernel_tile tile = {job->width,
                                    job->height,
                                    x,
                                    y,
                                    x1 < job->width ? x1 : job->width,
                                    y1 < job->height ? y1 : job->height,
                                    job->depth,
                                    job->ray_x,
                                    job->ray_y,
                                    job->frames,
                                    job->lasting,
                                    rlf_kernel_noise_make(job->noise),
                                    job->out[0],
                                    job->out[1],
                                    job->out[2],
                                    job->smooth};
            rlf_kernel_plane_tile(&tile);
        }
    }
}

void rlf_normals_plane_fit(const rlf_normals_job *job)
{
    rlf_normals_job copy = *job;
    int32_t bands = (job->height + RLF_KERNEL_TILE_HEIGHT - 1) / RLF_KERNEL_TILE_HEIGHT;
    rlf_parallel_for(job->pool, bands, 1, plane_bands, &copy);
}

void rlf_normals_plane(const rlf_normals_job *job)
{
    rlf_normals_plane_fit(job);
    rlf_normals_plane_complete(job);
}
