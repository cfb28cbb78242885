/* Which pixels are on a support plane. A plane goes on behind what stands on it: it is looked for
 * within the rows and columns between its patches. */
#include "surface/objects/objects.h"

#include "kernel/kernel.h"

static const float ON_SIGMAS = 3.0f;     /* off the plane ... */
static const float WAS_SIGMAS = 4.0f;    /* ... where the sheet before showed it */
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

/* The plane of `bits` that pixel i is on; 0 = of none. */
static uint8_t support_of(const rlf_reconstruct *stage, const rlf_layer_in *in,
                          const float_plane *planes, uint32_t bits, const float *bend, int32_t i)
{
    const rlf_grid *grid = &stage->grid;
    float w = 1.0f / in->depth[i];
    float sigma = rlf_kernel_inverse_sigma(rlf_kernel_noise_make(&stage->def.rig.noise), w);
    float least = WAS_SIGMAS * sigma;
    int32_t best = 0, before = stage->objects->support[i];
    for (int32_t k = 0; bits != 0; k++, bits >>= 1) {
        const float_plane *p = &planes[k];
        float off =
            rlf_kernel_abs(w - p->a * grid->ray_x[i] - p->b * grid->ray_y[i] - p->c - bend[k]);
        off += before == k + 1 ? 0.0f : (WAS_SIGMAS - ON_SIGMAS) * sigma;
        if ((bits & 1) == 0 || off > least) {
            continue;
        }
        float cosine =
            -(in->normal[0][i] * p->a + in->normal[1][i] * p->b + in->normal[2][i] * p->c);
        bool has_normal =
            in->normal[0][i] != 0.0f || in->normal[1][i] != 0.0f || in->normal[2][i] != 0.0f;
        if (!has_normal || cosine >= LEAST_COSINE * p->size) {
            best = k + 1;
            least = off;
        }
    }
    return (uint8_t)best;
}

typedef struct mark_job {
    rlf_reconstruct *stage;
    const rlf_layer_in *in;
    float_plane planes[RLF_SUPPORTS];
} mark_job;

static void mark_patch(const mark_job *job, int32_t k)
{
    const rlf_objects *o = job->stage->objects;
    const rlf_grid *grid = &job->stage->grid;
    int32_t x0 = k % o->width * o->side, y0 = k / o->width * o->side;
    int32_t x1 = x0 + o->side < grid->width ? x0 + o->side : grid->width;
    int32_t y1 = y0 + o->side < grid->height ? y0 + o->side : grid->height;
    float bend[RLF_SUPPORTS];
    for (int32_t p = 0; p < o->count && o->near[k] != 0; p++) {
        bend[p] = o->near[k] >> p & 1 ? bend_at(o, k, p + 1) : 0.0f;
    }
    for (int32_t y = y0; y < y1; y++) {
        for (int32_t i = y * grid->width + x0; i < y * grid->width + x1; i++) {
            o->support[i] = job->in->depth[i] > 0.0f && o->near[k] != 0
                                ? support_of(job->stage, job->in, job->planes, o->near[k], bend, i)
                                : 0;
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
