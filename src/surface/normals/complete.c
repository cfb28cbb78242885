/* Normals of the few pixels that have none yet: from their neighbours, and where these have none
 * either from their own differences.
 *
 * What a neighbour has was seen; what it was given here is a guess. A guess that is handed on from
 * pixel to pixel in the order of the rows makes faces grow to the right and downwards. So what is
 * found in a band is kept aside until the band is done; only pixels about which nothing was seen
 * take others' guesses. */
#include "surface/steps.h"

#include "kernel/kernel.h"

enum {
    BAND_ROWS = 16,
    MOST_ASIDE = 2048 /* pixels of a band; of what is beyond, the next ones know */
};

typedef struct found {
    ptrdiff_t i;
    float normal[3];
} found;

/* Normals of a band that are not in the image yet. */
typedef struct aside {
    found pixel[MOST_ASIDE];
    int32_t count;
} aside;

static bool is_without(const rlf_normals_job *job, ptrdiff_t i)
{
    return job->out[0][i] == 0.0f && job->out[1][i] == 0.0f && job->out[2][i] == 0.0f;
}

static void write_normal(const rlf_normals_job *job, ptrdiff_t i, const float normal[3])
{
    for (int k = 0; k < 3; k++) {
        job->out[k][i] = normal[k];
    }
}

/* False when nothing was seen about the pixel. */
static bool complete_pixel(const rlf_normals_job *job, int32_t x, int32_t y, aside *to)
{
    found f = {.i = (ptrdiff_t)y * job->width + x};
    if (!rlf_normals_near_pixel(job, x, y, f.normal)) {
        return false;
    }
    if (to->count < MOST_ASIDE) {
        to->pixel[to->count++] = f;
    } else {
        write_normal(job, f.i, f.normal);
    }
    return true;
}

/* Takes guesses as well. */
static void complete_rest(const rlf_normals_job *job, int32_t x, int32_t y)
{
    float normal[3];
    if (rlf_normals_near_pixel(job, x, y, normal)) {
        write_normal(job, (ptrdiff_t)y * job->width + x, normal);
    } else {
        rlf_normals_slope_pixel(job, x, y);
    }
}

/* 1 where there is a depth and no normal, else 0. */
RLF_KERNEL static void find_bare(const float *restrict depth, const float *restrict normal_z,
                                 int32_t count, uint8_t *restrict bare)
{
    for (int32_t i = 0; i < count; i++) {
        float z = depth[i], n = normal_z[i];
        bool is_bare = (z > 0.0f) & (n == 0.0f);
        bare[i] = is_bare ? 1 : 0;
    }
}

/* How many pixels still have none. `to` is NULL when these are to be completed by all means. */
static int32_t complete_row(const rlf_normals_job *job, int32_t y, aside *to)
{
    enum { SPAN = 512 };
    ptrdiff_t row = (ptrdiff_t)y * job->width;
    int32_t left = 0;
    for (int32_t begin = 0; begin < job->width; begin += SPAN) {
        uint8_t bare[SPAN];
        int32_t count = begin + SPAN < job->width ? SPAN : job->width - begin;
        find_bare(job->filled + row + begin, job->out[2] + row + begin, count, bare);
        for (int32_t k = 0; (k = rlf_kernel_next_mark(bare, k, count)) < count; k++) {
            int32_t x = begin + k;
            if (!is_without(job, row + x)) {
                continue;
            }
            if (to == NULL) {
                complete_rest(job, x, y);
            } else if (!complete_pixel(job, x, y, to)) {
                left++;
            }
        }
    }
    return left;
}

/* Completes every second band of rows. The bands between them rest meanwhile, so no two threads
 * meet and the order is the same for any number of them. */
typedef struct completion {
    const rlf_normals_job *job;
    int32_t parity;
} completion;

static void complete_band(const rlf_normals_job *job, int32_t y0, int32_t y1)
{
    aside kept;
    kept.count = 0;
    int32_t left = 0;
    for (int32_t y = y0; y < y1; y++) {
        left += complete_row(job, y, &kept);
    }
    for (int32_t k = 0; k < kept.count; k++) {
        write_normal(job, kept.pixel[k].i, kept.pixel[k].normal);
    }
    for (int32_t y = y0; y < y1 && left > 0; y++) {
        complete_row(job, y, NULL);
    }
}

static void complete_bands(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const completion *c = context;
    for (int32_t pair = begin; pair < end; pair++) {
        int32_t y0 = (2 * pair + c->parity) * BAND_ROWS;
        int32_t y1 = y0 + BAND_ROWS < c->job->height ? y0 + BAND_ROWS : c->job->height;
        complete_band(c->job, y0, y1);
    }
}

void rlf_normals_plane_complete(const rlf_normals_job *job)
{
    rlf_normals_job copy = *job;
    copy.filled = job->filled != NULL ? job->filled : job->depth;
    copy.depth = copy.filled;
    int32_t pairs = (job->height + 2 * BAND_ROWS - 1) / (2 * BAND_ROWS);
    for (int32_t parity = 0; parity < 2; parity++) {
        completion c = {&copy, parity};
        rlf_parallel_for(job->pool, pairs, 1, complete_bands, &c);
    }
}
