/* Chooses the normal method and turns its result to the wanted side. Normals of noisy depth are
 * those of plane windows (kernel/plane_tile.c), then of the few pixels that no plane explains
 * (normals/complete.c). */
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

/* To the camera, or as in eq. 4.3 to the image's plane. */
static void turn(const rlf_normals_job *job)
{
    size_t count = (size_t)job->width * (size_t)job->height;
    for (size_t i = 0; i < count; i++) {
        float facing = job->out[2][i];
        if (job->face_camera) {
            facing =
                job->out[0][i] * job->ray_x[i] + job->out[1][i] * job->ray_y[i] + job->out[2][i];
        }
        float sign = facing > 0.0f ? -1.0f : 1.0f;
        for (int k = 0; k < 3; k++) {
            job->out[k][i] *= sign;
        }
    }
}

void rlf_normals_compute(const rlf_normals_job *job)
{
    switch (job->method) {
    case RLF_NORMALS_SIX_FACES:
    case RLF_NORMALS_FOUR_FACES:
    case RLF_NORMALS_THESIS: rlf_normals_local(job); break;
    case RLF_NORMALS_INVERSE_DEPTH:
        if (job->noise != NULL) {
            rlf_normals_plane(job);
        } else {
            rlf_normals_slope(job);
        }
        break;
    }
    if (!job->face_camera || job->method != RLF_NORMALS_INVERSE_DEPTH) {
        turn(job);
    }
}

rlf_normals_job rlf_normals_job_make(const rlf_reconstruct *stage, const float *depth,
                                     float *const out[3])
{
    const image_grid *grid = &stage->grid;
    rlf_normals_job job = {.method = stage->def.normal_method,
                           .face_camera = stage->def.normals_face_camera,
                           .width = grid->width,
                           .height = grid->height,
                           .ray_x = grid->ray_x,
                           .ray_y = grid->ray_y,
                           .depth = depth,
                           .noise = &stage->def.rig.noise,
                           .out = {out[0], out[1], out[2]},
                           .pool = stage->def.pool};
    return job;
}

void rlf_compute_normals(rlf_normal_method method, bool face_camera, int32_t width, int32_t height,
                         const float *ray_x, const float *ray_y, const float *depth,
                         const rlf_depth_noise *noise, float *out_x, float *out_y, float *out_z)
{
    bool complete = width > 0 && height > 0 && ray_x != NULL && ray_y != NULL && depth != NULL &&
                    out_x != NULL && out_y != NULL && out_z != NULL;
    if (!RLF_ASSERT(complete)) {
        return;
    }
    rlf_normals_job job = {.method = method,
                           .face_camera = face_camera,
                           .width = width,
                           .height = height,
                           .ray_x = ray_x,
                           .ray_y = ray_y,
                           .depth = depth,
                           .noise = noise,
                           .out = {out_x, out_y, out_z}};
    rlf_normals_compute(&job);
}
