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

/* ---- exact inverse-depth normals (kernel/slope_row.c) of a whole grid or of one pixel ---- */

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

/* ---- any method ---- */

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
