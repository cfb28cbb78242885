/* Which pixels are on a support plane. A plane goes on behind what stands on it: it is looked for
 * within the rows and columns between its patches. */
#include "surface/objects/objects.h"

#include "kernel/kernel.h"

#include <string.h>

static const float ON_SIGMAS = 3.0f;     /* off the plane ... */
static const float WAS_SIGMAS = 4.0f;    /* ... where the image before showed it */
static const float LEAST_COSINE = 0.77f; /* 40 degrees, between a pixel's normal and the plane's */

/* Sets the bits of a line of patches between the first and the last that has them. */
static void span_line(const uint32_t *from, uint32_t *to, int32_t count, int32_t step)
{
    uint32_t before = 0, after = 0;
    for (int32_t k = 0; k < count; k++) {
        before |= from[k * step];
        to[k * step] = before;
    }
    for (int32_t k = count - 1; k >= 0; k--) {
        after |= from[k * step];
        to[k * step] &= after;
    }
}

/* objects.near: patches of a plane, those between them, and one more all around. */
static void find_near(rlf_objects *o)
{
    uint32_t *across = o->scratch[0], *down = o->scratch[1];
    for (int32_t k = 0; k < o->width * o->height; k++) {
        o->near[k] = o->patch[k].plane_id > 0 ? 1u << (o->patch[k].plane_id - 1) : 0;
    }
    for (int32_t y = 0; y < o->height; y++) {
        span_line(o->near + y * o->width, across + y * o->width, o->width, 1);
    }
    for (int32_t x = 0; x < o->width; x++) {
        span_line(o->near + x, down + x, o->height, o->width);
    }
    for (int32_t k = 0; k < o->width * o->height; k++) {
        across[k] &= down[k];
    }
    for (int32_t y = 0; y < o->height; y++) {
        for (int32_t x = 0; x < o->width; x++) {
            uint32_t bits = 0;
            for (int32_t v = y > 0 ? y - 1 : 0; v <= y + 1 && v < o->height; v++) {
                for (int32_t u = x > 0 ? x - 1 : 0; u <= x + 1 && u < o->width; u++) {
                    bits |= across[v * o->width + u];
                }
            }
            o->near[y * o->width + x] = bits;
        }
    }
}

/* How far a plane is bent at a patch: as at the patch, or as at those beside it. */
static float bend_at(const rlf_objects *o, int32_t k, int32_t id)
{
    double sum = 0.0, count = 0.0;
    int32_t x = k % o->width, y = k / o->width;
    if (o->patch[k].plane_id == id) {
        return (float)o->patch[k].off;
    }
    for (int32_t v = y > 0 ? y - 1 : 0; v <= y + 1 && v < o->height; v++) {
        for (int32_t u = x > 0 ? x - 1 : 0; u <= x + 1 && u < o->width; u++) {
            const rlf_patch *p = &o->patch[v * o->width + u];
            sum += p->plane_id == id ? p->off : 0.0;
            count += p->plane_id == id ? 1.0 : 0.0;
        }
    }
    return (float)(count > 0.0 ? sum / count : 0.0);
}

typedef struct float_plane {
    float a, b, c, size;
} float_plane;

/* Pixels of a row, and the best plane of each so far; `least`: how far off it is at most. */
typedef struct pixel_run {
    const float *depth, *normal[3], *ray_x, *ray_y;
    uint8_t before[RLF_PART]; /* plane of the image before */
    int32_t count;
    float w[RLF_PART], sigma[RLF_PART], least[RLF_PART];
    int32_t best[RLF_PART];
} pixel_run;

RLF_KERNEL_PART void start_run(pixel_run *run, rlf_kernel_noise noise)
{
    const float *restrict depth = run->depth;
    for (int32_t i = 0; i < run->count; i++) {
        float w = 1.0f / depth[i];
        run->w[i] = w;
        run->sigma[i] = rlf_kernel_inverse_sigma(noise, w);
        run->least[i] = WAS_SIGMAS * run->sigma[i];
        run->best[i] = 0;
    }
}

/* Pixels of the run take plane `id` where they are nearer to it, and face its way. */
RLF_KERNEL_PART void try_plane(pixel_run *run, const float_plane *p, float bend, int32_t id)
{
    const float *restrict nx = run->normal[0], *restrict ny = run->normal[1];
    const float *restrict nz = run->normal[2];
    const float *restrict ray_x = run->ray_x, *restrict ray_y = run->ray_y;
    const float_plane plane = *p;
    for (int32_t i = 0; i < run->count; i++) {
        float off =
            rlf_kernel_abs(run->w[i] - plane.a * ray_x[i] - plane.b * ray_y[i] - plane.c - bend);
        off += run->before[i] == id ? 0.0f : (WAS_SIGMAS - ON_SIGMAS) * run->sigma[i];
        float cosine = -(nx[i] * plane.a + ny[i] * plane.b + nz[i] * plane.c);
        int32_t has_normal = (nx[i] != 0.0f) | (ny[i] != 0.0f) | (nz[i] != 0.0f);
        int32_t is_facing = (has_normal == 0) | (cosine >= LEAST_COSINE * plane.size);
        int32_t is_on = (off <= run->least[i]) & is_facing;
        run->best[i] = is_on != 0 ? id : run->best[i];
        run->least[i] = is_on != 0 ? off : run->least[i];
    }
}

/* The plane of `bits` that each pixel is on; 0 = of none. */
RLF_KERNEL static void mark_run(pixel_run *run, rlf_kernel_noise noise, const float_plane *planes,
                                uint32_t bits, const float *bend, uint8_t *restrict support)
{
    start_run(run, noise);
    for (int32_t k = 0; bits >> k != 0; k++) {
        if ((bits >> k & 1) != 0) {
            try_plane(run, &planes[k], bend[k], k + 1);
        }
    }
    for (int32_t i = 0; i < run->count; i++) {
        support[i] = (uint8_t)(run->depth[i] > 0.0f ? run->best[i] : 0);
    }
}

typedef struct mark_job {
    rlf_reconstruct *stage;
    const rlf_layer_in *in;
    float_plane planes[RLF_SUPPORTS];
} mark_job;

/* Of `count` pixels from `at` on. */
static void mark_part(const mark_job *job, ptrdiff_t at, int32_t count, uint32_t bits,
                      const float *bend)
{
    const image_grid *grid = &job->stage->grid;
    const rlf_layer_in *in = job->in;
    uint8_t *support = job->stage->objects->support + at;
    if (bits == 0) {
        memset(support, 0, (size_t)count);
        return;
    }
    pixel_run run;
    run.depth = in->depth + at;
    for (int k = 0; k < 3; k++) {
        run.normal[k] = in->normal[k] + at;
    }
    run.ray_x = grid->ray_x + at;
    run.ray_y = grid->ray_y + at;
    memcpy(run.before, support, (size_t)count);
    run.count = count;
    mark_run(&run, rlf_kernel_noise_make(&job->stage->def.rig.noise), job->planes, bits, bend,
             support);
}

static void mark_patch(const mark_job *job, int32_t k)
{
    const rlf_objects *o = job->stage->objects;
    const image_grid *grid = &job->stage->grid;
    int32_t x0 = k % o->width * o->side, y0 = k / o->width * o->side;
    int32_t x1 = x0 + o->side < grid->width ? x0 + o->side : grid->width;
    int32_t y1 = y0 + o->side < grid->height ? y0 + o->side : grid->height;
    float bend[RLF_SUPPORTS];
    for (int32_t p = 0; p < o->count && o->near[k] != 0; p++) {
        bend[p] = o->near[k] >> p & 1 ? bend_at(o, k, p + 1) : 0.0f;
    }
    for (int32_t y = y0; y < y1; y++) {
        for (int32_t x = x0; x < x1; x += RLF_PART) {
            ptrdiff_t at = (ptrdiff_t)y * grid->width + x;
            mark_part(job, at, x + RLF_PART < x1 ? RLF_PART : x1 - x, o->near[k], bend);
        }
    }
}

static void mark_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const mark_job *job = context;
    int32_t width = job->stage->objects->width;
    for (int32_t k = begin * width; k < end * width; k++) {
        mark_patch(job, k);
    }
}

void rlf_supports_mark(rlf_reconstruct *stage, const rlf_layer_in *in)
{
    rlf_objects *o = stage->objects;
    mark_job job = {.stage = stage, .in = in};
    for (int32_t k = 0; k < o->count; k++) {
        const rlf_support_plane *p = &o->plane[k];
        job.planes[k] = (float_plane){(float)p->a, (float)p->b, (float)p->c,
                                      (float)sqrt(p->a * p->a + p->b * p->b + p->c * p->c)};
    }
    find_near(o);
    rlf_parallel_for(stage->def.pool, o->height, RLF_PATCH_GRAIN, mark_rows, &job);
}
