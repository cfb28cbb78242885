/* Normals of noisy depth: plane windows (kernel/plane_tile.c), then the few pixels that no plane
 * explains from their neighbours, and the rest from their own differences. */
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
                                    rlf_kernel_noise_make(job->noise),
                                    job->out[0],
                                    job->out[1],
                                    job->out[2],
                                    job->smooth};
            rlf_kernel_plane_tile(&tile);
        }
    }
}

static bool is_without(const rlf_normals_job *job, ptrdiff_t i)
{
    return job->out[0][i] == 0.0f && job->out[1][i] == 0.0f && job->out[2][i] == 0.0f;
}

static void complete_row(const rlf_normals_job *job, int32_t y)
{
    enum { SPAN = 512 };
    ptrdiff_t row = (ptrdiff_t)y * job->width;
    for (int32_t begin = 0; begin < job->width; begin += SPAN) {
        uint8_t bare[SPAN];
        int32_t count = begin + SPAN < job->width ? SPAN : job->width - begin;
        rlf_kernel_bare_row(job->filled + row + begin, job->out[2] + row + begin, count, bare);
        for (int32_t k = 0; (k = rlf_kernel_next_mark(bare, k, count)) < count; k++) {
            int32_t x = begin + k;
            if (is_without(job, row + x) && !rlf_normals_near_pixel(job, x, y)) {
                rlf_normals_slope_pixel(job, x, y);
            }
        }
    }
}

/* Completes every second band of rows, in raster order within a band: a pixel may use one that was
 * completed before it. The bands between them rest meanwhile, so no two threads meet and the order
 * is the same for any number of them. */
typedef struct completion {
    const rlf_normals_job *job;
    int32_t parity;
} completion;

enum { BAND_ROWS = 16 };

static void complete_bands(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const completion *c = context;
    for (int32_t pair = begin; pair < end; pair++) {
        int32_t y0 = (2 * pair + c->parity) * BAND_ROWS;
        int32_t y1 = y0 + BAND_ROWS < c->job->height ? y0 + BAND_ROWS : c->job->height;
        for (int32_t y = y0; y < y1; y++) {
            complete_row(c->job, y);
        }
    }
}

static void complete_pixels(const rlf_normals_job *job)
{
    int32_t pairs = (job->height + 2 * BAND_ROWS - 1) / (2 * BAND_ROWS);
    for (int32_t parity = 0; parity < 2; parity++) {
        completion c = {job, parity};
        rlf_parallel_for(job->pool, pairs, 1, complete_bands, &c);
    }
}

void rlf_normals_plane_fit(const rlf_normals_job *job)
{
    rlf_normals_job copy = *job;
    int32_t bands = (job->height + RLF_KERNEL_TILE_HEIGHT - 1) / RLF_KERNEL_TILE_HEIGHT;
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
