/* A view made ready: a plane per pixel, and the least depth about it. */
#include "map/volume.h"

#include <string.h>

typedef struct view_job {
    rlf_map *map;
    const rlf_map_view *view;
} view_job;

/* The normals of one row: the caller's, or found from the depth. */
static void plane_row(const view_job *job, int32_t y, float *scratch)
{
    rlf_map *map = job->map;
    const int32_t width = map->pinhole.width, height = map->pinhole.height;
    const ptrdiff_t at = (ptrdiff_t)y * width;
    const ptrdiff_t above = (ptrdiff_t)(y < 2 ? 0 : y - 2) * width;
    const ptrdiff_t below = (ptrdiff_t)(y + 2 < height ? y + 2 : height - 1) * width;
    const rlf_map_view *view = job->view;
    const rlf_fuse_row row = {
        .depth = map->clean + at,
        .above = map->clean + above,
        .below = map->clean + below,
        .ray_x = map->ray_x + at,
        .ray_y = map->ray_y + at,
        .ray_x_above = map->ray_x + above,
        .ray_y_above = map->ray_y + above,
        .ray_x_below = map->ray_x + below,
        .ray_y_below = map->ray_y + below,
        .is_static = view->is_static != NULL ? view->is_static + at : NULL,
        .noise = rlf_kernel_noise_make(&map->def.rig.noise),
    };
    const float *nx = scratch, *ny = scratch + width, *nz = scratch + 2 * (ptrdiff_t)width;
    if (view->normal_x != NULL) {
        nx = view->normal_x + at;
        ny = view->normal_y + at;
        nz = view->normal_z + at;
    } else {
        rlf_kernel_fuse_normals(&row, width, scratch, scratch + width,
                                scratch + 2 * (ptrdiff_t)width);
    }
    rlf_kernel_fuse_planes(&row, nx, ny, nz, width, map->planes + at);
}

/* Rows of depth without NaN, infinities and rays that are none, and the least of three of them. */
static void clean_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const view_job *job = context;
    const rlf_map *map = job->map;
    const int32_t width = map->pinhole.width;
    (void)worker;
    for (int32_t y = begin; y < end; y++) {
        const ptrdiff_t at = (ptrdiff_t)y * width;
        const float *depth = job->view->depth + at;
        float *clean = map->clean + at;
        for (int32_t x = 0; x < width; x++) {
            bool is_depth = (depth[x] > 0.0f) & (depth[x] < 1000.0f);
            clean[x] = is_depth ? depth[x] : 0.0f;
        }
        rlf_kernel_fuse_least_row(clean, width, map->row_least + at);
    }
}

static void fill_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const view_job *job = context;
    const rlf_map *map = job->map;
    const int32_t width = map->pinhole.width, height = map->pinhole.height;
    float *scratch = map->scratch + 3 * (ptrdiff_t)width * worker;
    for (int32_t y = begin; y < end; y++) {
        const ptrdiff_t at = (ptrdiff_t)y * width;
        plane_row(job, y, scratch);
        if (y == 0 || y + 1 == height) {
            memset(map->least + at, 0, (size_t)width * sizeof(float));
            continue;
        }
        const float *middle = map->row_least + at;
        rlf_kernel_fuse_least(middle - width, middle, middle + width, width, map->least + at);
    }
}

void map_view_prepare(rlf_map *map, const rlf_map_view *view)
{
    view_job job = {.map = map, .view = view};
    rlf_parallel_for(map->def.pool, map->pinhole.height, 16, clean_rows, &job);
    rlf_parallel_for(map->def.pool, map->pinhole.height, 16, fill_rows, &job);
}
