/* Wider planes for rough sensors.
 *
 * Structured light errs by a hundredth of a far surface's depth, and alike in neighbouring pixels:
 * a plane through the ten pixels of kernel/plane_tile.c is degrees off, whole walls ripple. So the
 * same planes are found in the picture at half and at a quarter of its resolution, where they are
 * as many pixels wide, that is 20 and 40 of the picture's, and as before no window reaches across
 * what noise does not explain. A pixel takes the widest that agrees with its own. (Windows that
 * grow with the noise: Holzer et al. 2012, section III-C; here the residuals decide as well.) */
#include "surface/steps.h"

#include "kernel/plane_window.h"

/* Standard deviation of the slope of a plane through 10x10 pixels, in those of one pixel's depth
 * per pixel: sqrt(12) / (10 * 10). */
static const double tilt_per_sigma = 0.0346;

/* A sensor is rough when that makes more than 1.15 degrees at 2 m. */
static const double most_tilt = 0.02, rough_at = 2.0;

bool rlf_wide_is_wanted(const rlf_reconstruct_def *def, const image_grid *grid)
{
    const rlf_depth_noise *noise = &def->rig.noise;
    double sigma = noise->c0 + rough_at * (noise->c1 + rough_at * noise->c2);
    return def->enable_wide_planes && def->enable_smoothing &&
           tilt_per_sigma * grid->camera.fx * sigma > most_tilt * rough_at;
}

void rlf_wide_fill_rays(const float *ray_x, const float *ray_y, int32_t width, rlf_wide *out)
{
    for (int32_t y = 0; y < out->height; y++) {
        for (int32_t x = 0; x < out->width; x++) {
            ptrdiff_t i = (ptrdiff_t)2 * y * width + 2 * x, below = i + width;
            ptrdiff_t k = (ptrdiff_t)y * out->width + x;
            out->ray_x[k] = 0.25f * ((ray_x[i] + ray_x[i + 1]) + (ray_x[below] + ray_x[below + 1]));
            out->ray_y[k] = 0.25f * ((ray_y[i] + ray_y[i + 1]) + (ray_y[below] + ray_y[below + 1]));
        }
    }
}

typedef struct wide_job {
    const rlf_normals_job *whole;
    const rlf_wide *half;
    rlf_kernel_noise noise;
    float tilt; /* of `whole`: tilt_per_sigma, per metre at a depth of 1 m */
} wide_job;

static void halve_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const wide_job *job = context;
    const rlf_wide *half = job->half;
    for (int32_t y = begin; y < end; y++) {
        const float *upper = job->whole->depth + (ptrdiff_t)2 * y * job->whole->width;
        rlf_kernel_halve_row(job->noise, upper, upper + job->whole->width, half->width,
                             half->depth + (ptrdiff_t)y * half->width);
        const float *frames = job->whole->frames + (ptrdiff_t)2 * y * job->whole->width;
        rlf_kernel_halve_frames(frames, frames + job->whole->width, half->width,
                                half->frames + (ptrdiff_t)y * half->width);
    }
}

static void invert_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const rlf_wide *half = ((const wide_job *)context)->half;
    ptrdiff_t i = (ptrdiff_t)begin * half->width;
    rlf_kernel_invert_planes(half->smooth + i, half->ray_x + i, half->ray_y + i,
                             (end - begin) * half->width, half->normal[0] + i, half->normal[1] + i,
                             half->normal[2] + i);
}

static void speak_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const wide_job *job = context;
    const rlf_normals_job *whole = job->whole;
    const rlf_wide *half = job->half;
    for (int32_t y = begin; y < end; y++) {
        int32_t beside = y / 2 + (y % 2 != 0 ? 1 : -1);
        beside = beside < 0 ? 0 : beside < half->height ? beside : half->height - 1;
        ptrdiff_t i = (ptrdiff_t)y * whole->width, k = (ptrdiff_t)(y / 2) * half->width;
        ptrdiff_t b = (ptrdiff_t)beside * half->width;
        float *const *plane = half->normal;
        const rlf_kernel_wide in = {.depth = whole->depth + i,
                                    .ray_x = whole->ray_x + i,
                                    .ray_y = whole->ray_y + i,
                                    .frames = whole->frames + i,
                                    .half_frames = half->frames + k,
                                    .half_width = half->width,
                                    .plane = {plane[0] + k, plane[1] + k, plane[2] + k},
                                    .beside = {plane[0] + b, plane[1] + b, plane[2] + b},
                                    .half_ray_x = half->ray_x + k,
                                    .half_ray_y = half->ray_y + k,
                                    .noise = job->noise,
                                    .lasting = whole->lasting,
                                    .tilt = job->tilt};
        float *const normal[3] = {whole->out[0] + i, whole->out[1] + i, whole->out[2] + i};
        rlf_kernel_wide_row(&in, normal, whole->smooth + i);
    }
}

/* Planes of `whole`, which has its own, at half the resolution and less. */
static void widen(const rlf_normals_job *whole, const rlf_wide *half, int32_t levels, double focal)
{
    wide_job job = {.whole = whole,
                    .half = half,
                    .noise = rlf_kernel_noise_make(whole->noise),
                    .tilt = (float)(tilt_per_sigma * focal)};
    rlf_parallel_for(whole->pool, half->height, RLF_ROW_GRAIN, halve_rows, &job);
    rlf_normals_job wide = *whole;
    wide.width = half->width;
    wide.height = half->height;
    wide.ray_x = half->ray_x;
    wide.ray_y = half->ray_y;
    wide.depth = half->depth;
    wide.frames = half->frames;
    wide.smooth = half->smooth;
    for (int k = 0; k < 3; k++) {
        wide.out[k] = half->normal[k];
    }
    rlf_normals_plane_fit(&wide);
    if (levels > 1) {
        widen(&wide, half + 1, levels - 1, 0.5 * focal);
    }
    rlf_parallel_for(whole->pool, half->height, RLF_ROW_GRAIN, invert_rows, &job);
    rlf_parallel_for(whole->pool, 2 * half->height, RLF_ROW_GRAIN, speak_rows, &job);
}

void rlf_normals_widen(const rlf_reconstruct *stage, const rlf_normals_job *job)
{
    if (stage->normals.wide[0].depth != NULL) {
        widen(job, stage->normals.wide, RLF_WIDE_LEVELS, stage->grid.camera.fx);
    }
}
