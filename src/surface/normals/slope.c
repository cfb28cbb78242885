/* Exact inverse-depth normals (kernel/slope_row.c) of a whole grid or of one pixel. */
#include "surface/steps.h"

#include "kernel/kernel.h"

enum { STRIP = 256, INVERSE_ROWS = RLF_WINDOW_SIDE, RAY_ROWS = 3 };

/* The rows about one, a strip of columns of each. */
typedef struct strip {
    float inverse[INVERSE_ROWS][STRIP + 4];
    float ray_x[RAY_ROWS][STRIP + 4], ray_y[RAY_ROWS][STRIP + 4];
    int32_t x0, count;
} strip;

static void load_span(const rlf_normals_job *job, const float *plane, const strip *s, int32_t y,
                      float *out)
{
    for (int32_t k = 0; k < s->count + 4; k++) {
        out[k] = 0.0f;
    }
    if (y < 0 || y >= job->height) {
        return;
    }
    int32_t first = s->x0 - 2;
    int32_t begin = first < 0 ? -first : 0;
    int32_t end = first + s->count + 4 > job->width ? job->width - first : s->count + 4;
    const float *row = plane + (ptrdiff_t)y * job->width + first;
    for (int32_t k = begin; k < end; k++) {
        out[k] = row[k];
    }
}

static void slope_strip(const rlf_normals_job *job, strip *s, int32_t y)
{
    rlf_kernel_slope_in in = {.count = s->count};
    for (int32_t k = 0; k < INVERSE_ROWS; k++) {
        float depth[STRIP + 4];
        load_span(job, job->depth, s, y - INVERSE_ROWS / 2 + k, depth);
        rlf_kernel_inverse_row(depth, s->count + 4, s->inverse[k]);
        in.inverse[k] = s->inverse[k] + 2;
    }
    for (int32_t k = 0; k < RAY_ROWS; k++) {
        load_span(job, job->ray_x, s, y - RAY_ROWS / 2 + k, s->ray_x[k]);
        load_span(job, job->ray_y, s, y - RAY_ROWS / 2 + k, s->ray_y[k]);
        in.ray_x[k] = s->ray_x[k] + 2;
        in.ray_y[k] = s->ray_y[k] + 2;
    }
    ptrdiff_t offset = (ptrdiff_t)y * job->width + s->x0;
    rlf_kernel_slope_row(&in, job->out[0] + offset, job->out[1] + offset, job->out[2] + offset);
}

static void slope_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const rlf_normals_job *job = context;
    for (int32_t y = begin; y < end; y++) {
        strip s;
        for (s.x0 = 0; s.x0 < job->width; s.x0 += STRIP) {
            s.count = job->width - s.x0 < STRIP ? job->width - s.x0 : STRIP;
            slope_strip(job, &s, y);
        }
    }
}

void rlf_normals_slope(const rlf_normals_job *job)
{
    rlf_normals_job copy = *job;
    rlf_parallel_for(job->pool, job->height, RLF_ROW_GRAIN, slope_rows, &copy);
}

void rlf_normals_slope_pixel(const rlf_normals_job *job, int32_t x, int32_t y)
{
    strip s;
    s.x0 = x;
    s.count = 1;
    slope_strip(job, &s, y);
}
