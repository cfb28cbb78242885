/* Normals of noisy depth: plane windows (kernel/plane_tile.c), then the few pixels that no plane
 * explains from their neighbours, and the rest from their own differences. */
#include "surface/steps.h"

#include "kernel/kernel.h"

static void plane_bands(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const rlf_normals_job *job = context;
    for (int32_t band = begin; band < end; band++) {
        for (int32_t x = 0; x < job->width; x += RLF_KERNEL_TILE) {
            int32_t y = band * RLF_KERNEL_TILE;
            int32_t x1 = x + RLF_KERNEL_TILE;
            int32_t y1 = y + RLF_KERNEL_TILE;
            rlf_kernel_tile tile = {job->width,
                                    job->height,
                                    x,
                                    y,
                                    x1 < job->width ? x1 : job->width,
                                    y1 < job->height ? y1 : job->height,
                                    job->depth,
                                    job->ray_x,
                                    job->ray_y,
                                    rlf_kernel_noise_make(job->noise),
                                    job->out[0],
                                    job->out[1],
                                    job->out[2],
                                    job->smooth};
            rlf_kernel_plane_tile(&tile);
        }
    }
}

static bool has_normal(const rlf_normals_job *job, ptrdiff_t i)
{
    return job->out[0][i] != 0.0f || job->out[1][i] != 0.0f || job->out[2][i] != 0.0f;
}

/* Mean of the normals within two pixels at the same depth, weighted by inverse squared distance. */
static bool from_neighbours(const rlf_normals_job *job, int32_t x, int32_t y)
{
    ptrdiff_t i = (ptrdiff_t)y * job->width + x;
    float z = job->filled[i];
    rlf_vec3 sum = {0, 0, 0};
    for (int32_t dy = -2; dy <= 2; dy++) {
        for (int32_t dx = -2; dx <= 2; dx++) {
            int32_t nx = x + dx, ny = y + dy;
            if (nx < 0 || ny < 0 || nx >= job->width || ny >= job->height || (dx == 0 && dy == 0)) {
                continue;
            }
            ptrdiff_t n = (ptrdiff_t)ny * job->width + nx;
            if (!(job->filled[n] > 0.0f) || !has_normal(job, n) ||
                rlf_kernel_abs(job->filled[n] - z) > 0.02f * z) {
                continue;
            }
            rlf_vec3 normal = {job->out[0][n], job->out[1][n], job->out[2][n]};
            sum = rlf_mad(sum, normal, 1.0 / (dx * dx + dy * dy));
        }
    }
    rlf_vec3 mean = rlf_normalize(sum);
    rlf_vec3 ray = {job->ray_x[i], job->ray_y[i], 1.0};
    if (!(rlf_dot(mean, ray) < 0.0)) {
        return false;
    }
    job->out[0][i] = (float)mean.x;
    job->out[1][i] = (float)mean.y;
    job->out[2][i] = (float)mean.z;
    return true;
}

/* In raster order on one thread: a pixel may use one that was completed before it. */
static void complete_pixels(const rlf_normals_job *job)
{
    for (int32_t y = 0; y < job->height; y++) {
        for (int32_t x = 0; x < job->width; x++) {
            ptrdiff_t i = (ptrdiff_t)y * job->width + x;
            if (job->filled[i] > 0.0f && !has_normal(job, i) && !from_neighbours(job, x, y)) {
                rlf_normals_slope_pixel(job, x, y);
            }
        }
    }
}

void rlf_normals_plane_fit(const rlf_normals_job *job)
{
    rlf_normals_job copy = *job;
    int32_t bands = (job->height + RLF_KERNEL_TILE - 1) / RLF_KERNEL_TILE;
    rlf_parallel_for(job->pool, bands, 1, plane_bands, &copy);
}

void rlf_normals_plane_complete(const rlf_normals_job *job)
{
    rlf_normals_job copy = *job;
    copy.filled = job->filled != NULL ? job->filled : job->depth;
    copy.depth = copy.filled;
    complete_pixels(&copy);
}

void rlf_normals_plane(const rlf_normals_job *job)
{
    rlf_normals_plane_fit(job);
    rlf_normals_plane_complete(job);
}
