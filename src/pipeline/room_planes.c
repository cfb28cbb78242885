/* From the smaller, undistorted picture of a prediction to the grid's pixels. */
#include "pipeline/room_planes.h"

static const float step_share = 0.02f; /* of depth: more between two pixels is a step */

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

/* Depth between the four pixels about (u, v): 1 / z is linear on planes. */
static float depth_at(const rlf_prediction *p, float u, float v, int32_t x, int32_t y)
{
    const float *at = p->depth + (ptrdiff_t)y * p->camera.width + x;
    const float z[4] = {at[0], at[1], at[p->camera.width], at[p->camera.width + 1]};
    float low = z[0], high = z[0];
    for (int k = 1; k < 4; k++) {
        low = z[k] < low ? z[k] : low;
        high = z[k] > high ? z[k] : high;
    }
    if (low > 0.0f && high - low < step_share * low) {
        const float a = u - (float)x, b = v - (float)y;
        const float top = (1.0f - a) / z[0] + a / z[1], bottom = (1.0f - a) / z[2] + a / z[3];
        return 1.0f / ((1.0f - b) * top + b * bottom);
    }
    if (!(at[(v - (float)y < 0.5f ? 0 : p->camera.width) + (u - (float)x < 0.5f ? 0 : 1)] > 0.0f)) {
        return 0.0f;
    }
    for (int k = 0; k < 4; k++) {
        low = z[k] > 0.0f && (z[k] < low || !(low > 0.0f)) ? z[k] : low;
    }
    return low;
}

static void take_pixel(const room_job *job, int32_t i)
{
    const rlf_prediction *p = job->p;
    const rlf_surface *s = job->s;
    const float u = (float)(s->ray_x[i] * p->camera.fx + p->camera.cx);
    const float v = (float)(s->ray_y[i] * p->camera.fy + p->camera.cy);
    float z = 0.0f;
    int32_t nearest = -1;
    if (u > -0.5f && v > -0.5f && u < (float)p->camera.width - 0.5f &&
        v < (float)p->camera.height - 0.5f) {
        const float x = rlf_clamp(u, 0.0, p->camera.width - 1.001);
        const float y = rlf_clamp(v, 0.0, p->camera.height - 1.001);
        z = depth_at(p, x, y, (int32_t)x, (int32_t)y);
        nearest = (int32_t)(y + 0.5f) * p->camera.width + (int32_t)(x + 0.5f);
    }
    const float *const from[3] = {p->normal_x, p->normal_y, p->normal_z};
    job->planes->depth[i] = z;
    for (int k = 0; k < 3; k++) {
        job->planes->normal[k][i] = z > 0.0f ? from[k][nearest] : 0.0f;
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
