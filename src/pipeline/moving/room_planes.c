/* From the smaller, undistorted picture of a prediction to the grid's pixels: the planes of the
 * four about a ray are continued to it, and the nearest counts. */
#include "pipeline/moving/room_planes.h"

static const float longest = 0.2f; /* share of depth that a plane is continued by */

rlf_result room_planes_open(room_planes *r, size_t pixels)
{
    r->depth = rlf_alloc_array(pixels, sizeof(float));
    bool has_all = r->depth != NULL;
    for (int k = 0; k < 3; k++) {
        r->normal[k] = rlf_alloc_array(pixels, sizeof(float));
        has_all = has_all && r->normal[k] != NULL;
    }
    return has_all ? RLF_OK : RLF_ERROR_MEMORY;
}

void room_planes_close(room_planes *r)
{
    rlf_free(r->depth);
    for (int k = 0; k < 3; k++) {
        rlf_free(r->normal[k]);
    }
    *r = (room_planes){.depth = NULL};
}

typedef struct room_job {
    const room_planes *planes;
    const rlf_prediction *p;
    const rlf_surface *s;
} room_job;

/* Where the plane of the prediction's pixel k meets a ray; 0 = nothing is known there. */
static float plane_depth(const rlf_prediction *p, int32_t k, const float own[2], const float ray[2])
{
    const float z = p->depth[k];
    const float x = p->normal_x[k], y = p->normal_y[k], n = p->normal_z[k];
    const float along = x * ray[0] + y * ray[1] + n;
    const float share = along != 0.0f ? (x * own[0] + y * own[1] + n) / along : 0.0f;
    return share > 1.0f - longest && share < 1.0f + longest ? z * share : z;
}

static void take_pixel(const room_job *job, int32_t i)
{
    const rlf_prediction *p = job->p;
    const rlf_surface *s = job->s;
    const float ray[2] = {s->ray_x[i], s->ray_y[i]};
    const double u = ray[0] * p->camera.fx + p->camera.cx, v = ray[1] * p->camera.fy + p->camera.cy;
    const int32_t width = p->camera.width;
    float z = 0.0f;
    int32_t from = 0;
    if (u > -0.5 && v > -0.5 && u < width - 0.5 && v < p->camera.height - 0.5) {
        const int32_t x = (int32_t)rlf_clamp(u, 0.0, width - 2.0);
        const int32_t y = (int32_t)rlf_clamp(v, 0.0, p->camera.height - 2.0);
        const float step[2] = {(float)(1.0 / p->camera.fx), (float)(1.0 / p->camera.fy)};
        const float first[2] = {(x - (float)p->camera.cx) * step[0],
                                (y - (float)p->camera.cy) * step[1]};
        const int32_t nearest = (int32_t)(v + 0.5) * width + (int32_t)(u + 0.5);
        for (int k = 0; k < 4 && p->depth[nearest] > 0.0f; k++) {
            const int32_t at = (y + k / 2) * width + x + k % 2;
            const float own[2] = {first[0] + (k % 2 ? step[0] : 0.0f),
                                  first[1] + (k / 2 ? step[1] : 0.0f)};
            const float plane = plane_depth(p, at, own, ray);
            from = plane > 0.0f && (plane < z || !(z > 0.0f)) ? at : from;
            z = plane > 0.0f && (plane < z || !(z > 0.0f)) ? plane : z;
        }
    }
    const float *const normal[3] = {p->normal_x, p->normal_y, p->normal_z};
    job->planes->depth[i] = z;
    for (int k = 0; k < 3; k++) {
        job->planes->normal[k][i] = z > 0.0f ? normal[k][from] : 0.0f;
    }
}

static void take_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const room_job *job = context;
    for (int32_t i = begin * job->s->width; i < end * job->s->width; i++) {
        take_pixel(job, i);
    }
}

void room_planes_take(const room_planes *r, const rlf_prediction *p, const rlf_surface *s,
                      rlf_pool *pool)
{
    room_job job = {r, p, s};
    rlf_parallel_for(pool, s->height, 16, take_rows, &job);
}
