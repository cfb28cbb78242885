/* Normals at edges of what stands still, by what the means over time lie on.
 *
 * The side of a chair's seat is four pixels high: no window fits it, and the faces beside it, of
 * which each frame chooses one, are the seat's top and its front. That all frames agree on one of
 * them does not make it right. But noise hides in one frame what the means over time show: hardly
 * a pixel about it lies on that face's plane. So where few do, and many more lie on the plane
 * with another normal that is known within some pixels, through the pixel itself, that is what is
 * settled. Every frame asks some of the rows. */
#include "surface/steps.h"
#include "surface/window.h"

#include "kernel/kernel.h"

#include <math.h>
#include <string.h>

enum {
    ABOUT = 2,  /* pixels: these are counted */
    LOOK = 3,   /* pixels: so far other normals are looked for */
    PERIOD = 16 /* frames, from one asking to the next */
};

static const float MOST_ON = 1.0f;       /* pixel on the plane of a normal that is doubted ... */
static const float ALL = 25.0f;          /* pixels about one */
static const float LEAST_MORE = 3.0f;    /* ... more on that of the one that takes its place ... */
static const float LEAST_ON = 4.0f;      /* ... and on this in all */
static const float WEIGHT_FAR = 0.7f;    /* of a pixel that does not touch */
static const float OTHER_FACE = 0.94f;   /* cosine: 20 degrees */
static const float ONE_THING = 0.04f;    /* share of the depth between pixels of one thing */
static const float LEAST_FACING = 0.02f; /* a face may be seen edge-on, not from behind */
static const float MOST_SIGMAS = 3.0f;   /* of the difference of two means */
static const float PLANE_SIGMAS = 0.2f;  /* of one frame: what is alike in all pixels' noise */

typedef struct agree_job {
    const rlf_grid *grid;
    const float *mean, *frames; /* planes: inverse depth over time, and of how many frames */
    const float *depth;
    float *const *normal;
    const uint8_t *foreground, *mark, *overruled;
    rlf_settled *settled;
    rlf_kernel_noise noise;
    int32_t first; /* row */
} agree_job;

static bool is_known(const agree_job *job, ptrdiff_t i)
{
    return job->frames[i] > 0.0f && job->foreground[i] == 0;
}

static float cosine(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* < 0 where it faces the camera. */
static float facing(const agree_job *job, const float normal[3], ptrdiff_t i)
{
    return normal[0] * job->grid->ray_x[i] + normal[1] * job->grid->ray_y[i] + normal[2];
}

/* How many of the pixels about pixel i lie on the plane through it: less, the farther off. It ends
 * when these are `enough`. */
static float count_on(const agree_job *job, ptrdiff_t i, const float normal[3], float enough)
{
    float here = facing(job, normal, i), w = job->mean[i], sum = 0.0f;
    float x = job->grid->ray_x[i], y = job->grid->ray_y[i];
    if (!(here < -LEAST_FACING)) {
        return 0.0f;
    }
    float slant = rlf_kernel_slant(-here, sqrtf(x * x + y * y + 1.0f));
    float gate = MOST_SIGMAS * rlf_kernel_inverse_sigma(job->noise, w) * slant;
    float own = 1.0f / job->frames[i] + PLANE_SIGMAS * PLANE_SIGMAS;
    for (int32_t dy = -ABOUT; dy <= ABOUT && sum < enough; dy++) {
        for (int32_t dx = -ABOUT; dx <= ABOUT; dx++) {
            ptrdiff_t at = i + (ptrdiff_t)dy * job->grid->width + dx;
            if (at == i || !is_known(job, at)) {
                continue;
            }
            float off = job->mean[at] - w * facing(job, normal, at) / here;
            float left = 1.0f - off * off / (gate * gate * (own + 1.0f / job->frames[at]));
            float weight = dx * dx + dy * dy <= 2 ? 1.0f : WEIGHT_FAR;
            sum += left > 0.0f ? weight * left : 0.0f;
        }
    }
    return sum;
}

/* The normal about pixel i on whose plane most pixels lie, if these are at least `most`. */
static bool find_other(const agree_job *job, ptrdiff_t i, const float own[3], float most,
                       float out[3])
{
    bool found = false;
    float z = job->depth[i];
    for (int32_t dy = -LOOK; dy <= LOOK; dy++) {
        for (int32_t dx = -LOOK; dx <= LOOK; dx++) {
            ptrdiff_t at = i + (ptrdiff_t)dy * job->grid->width + dx;
            const float n[3] = {job->normal[0][at], job->normal[1][at], job->normal[2][at]};
            if (!(cosine(n, n) > 0.5f) || cosine(n, own) > OTHER_FACE ||
                !(rlf_kernel_abs(job->depth[at] - z) < ONE_THING * z)) {
                continue;
            }
            float on = count_on(job, i, n, ALL);
            if (on > most) {
                most = on;
                found = true;
                memcpy(out, n, sizeof n);
            }
        }
    }
    return found;
}

static void ask(const agree_job *job, ptrdiff_t i)
{
    rlf_settled *s = &job->settled[i];
    float z = job->depth[i], own[3], other[3];
    if (!is_known(job, i) || !(rlf_kernel_abs(1.0f / job->mean[i] - z) < ONE_THING * z)) {
        return;
    }
    for (int k = 0; k < 3; k++) {
        own[k] = job->overruled[i] != 0 ? s->own[k] : job->normal[k][i];
    }
    float on = count_on(job, i, own, MOST_ON);
    float most = on + LEAST_MORE > LEAST_ON ? on + LEAST_MORE : LEAST_ON;
    if (on < MOST_ON && find_other(job, i, own, most, other)) {
        memcpy(s->normal, other, sizeof s->normal);
        s->depth = z;
        s->votes = RLF_SETTLE_MOST_VOTES;
    }
}

static void agree_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const agree_job *job = context;
    int32_t width = job->grid->width;
    for (int32_t k = begin; k < end; k++) {
        int32_t y = job->first + k * PERIOD;
        if (y < LOOK || y + LOOK >= job->grid->height) {
            continue;
        }
        ptrdiff_t row = (ptrdiff_t)y * width;
        const uint8_t *mark = job->mark + row;
        for (int32_t x = LOOK; (x = rlf_kernel_next_mark(mark, x, width)) < width - LOOK; x++) {
            if (job->foreground[row + x] == 0) {
                ask(job, row + x);
            }
        }
    }
}

void rlf_settle_agree(rlf_reconstruct *stage, const rlf_slot *slot)
{
    rlf_steady *steady = &stage->steady;
    const agree_job job = {.grid = &stage->grid,
                           .mean = steady->mean,
                           .frames = steady->frames,
                           .depth = slot->depth,
                           .normal = slot->normal,
                           .foreground = slot->foreground,
                           .mark = steady->mark,
                           .overruled = steady->overruled,
                           .settled = steady->settled,
                           .noise = rlf_kernel_noise_make(&stage->def.rig.noise),
                           .first = steady->next_row};
    steady->next_row = (steady->next_row + 1) % PERIOD;
    int32_t rows = (stage->grid.height - job.first + PERIOD - 1) / PERIOD;
    rlf_parallel_for(stage->def.pool, rows, 1, agree_rows, (void *)&job);
}
