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

typedef struct normal_sum {
    float x, y, z;
} normal_sum;

/* Sum of the normals at the same depth, weighted by inverse squared distance. Missing ones are 0.
 * Inlined, so that the whole window's bounds and weights are constants. */
static inline normal_sum add_window(const rlf_normals_job *job, ptrdiff_t i, int32_t x0, int32_t x1,
                                    int32_t y0, int32_t y1)
{
    static const float nearness[9] = {0.0f, 1.0f, 0.5f, 0.0f, 0.25f, 0.2f, 0.0f, 0.0f, 0.125f};
    normal_sum sum = {0.0f, 0.0f, 0.0f};
    float z = job->filled[i];
    float most = 0.02f * z;
    for (int32_t dy = y0; dy <= y1; dy++) {
        ptrdiff_t row = i + (ptrdiff_t)dy * job->width;
        for (int32_t dx = x0; dx <= x1; dx++) {
            bool same = rlf_kernel_abs(job->filled[row + dx] - z) <= most;
            float weight = same ? nearness[dx * dx + dy * dy] : 0.0f;
            sum.x += weight * job->out[0][row + dx];
            sum.y += weight * job->out[1][row + dx];
            sum.z += weight * job->out[2][row + dx];
        }
    }
    return sum;
}

static normal_sum add_cut_window(const rlf_normals_job *job, ptrdiff_t i, int32_t x, int32_t y)
{
    int32_t right = job->width - 1 - x, down = job->height - 1 - y;
    return add_window(job, i, x < 2 ? -x : -2, right < 2 ? right : 2, y < 2 ? -y : -2,
                      down < 2 ? down : 2);
}

/* Mean of the normals within two pixels at the same depth. */
static bool from_neighbours(const rlf_normals_job *job, int32_t x, int32_t y)
{
    ptrdiff_t i = (ptrdiff_t)y * job->width + x;
    bool whole = x >= 2 && y >= 2 && x + 2 < job->width && y + 2 < job->height;
    normal_sum sum = whole ? add_window(job, i, -2, 2, -2, 2) : add_cut_window(job, i, x, y);
    rlf_vec3 mean = rlf_normalize(rlf_vec3_make(sum.x, sum.y, sum.z));
    rlf_vec3 ray = {job->ray_x[i], job->ray_y[i], 1.0};
    if (!(rlf_dot(mean, ray) < 0.0)) {
        return false;
    }
    job->out[0][i] = (float)mean.x;
    job->out[1][i] = (float)mean.y;
    job->out[2][i] = (float)mean.z;
    return true;
}

static int32_t is_without(const rlf_normals_job *job, ptrdiff_t i)
{
    int32_t none = (job->out[0][i] == 0.0f) & (job->out[1][i] == 0.0f) & (job->out[2][i] == 0.0f);
    return none & (job->filled[i] > 0.0f);
}

static void complete_span(const rlf_normals_job *job, int32_t y, int32_t begin, int32_t end)
{
    for (int32_t x = begin; x < end; x++) {
        bool missing = is_without(job, (ptrdiff_t)y * job->width + x);
        if (missing && !from_neighbours(job, x, y)) {
            rlf_normals_slope_pixel(job, x, y);
        }
    }
}

/* Most spans have nothing to do, which is found without a branch. */
static void complete_row(const rlf_normals_job *job, int32_t y)
{
    enum { SPAN = 32 };
    ptrdiff_t row = (ptrdiff_t)y * job->width;
    for (int32_t begin = 0; begin < job->width; begin += SPAN) {
        int32_t end = begin + SPAN < job->width ? begin + SPAN : job->width;
        int32_t missing = 0;
        for (int32_t x = begin; x < end; x++) {
            missing += is_without(job, row + x);
        }
        if (missing > 0) {
            complete_span(job, y, begin, end);
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
