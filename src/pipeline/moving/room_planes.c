/* From the smaller, undistorted picture of a prediction to the grid's pixels: the planes of the
 * four about a ray are continued to it, and the nearest counts.
 *
 * One over the depth at which a ray (x, y, 1) meets a plane is linear in x and y. */
#include "pipeline/moving/moving.h"

#define GRAIN 16 /* rows */

enum { LANES = 16 };

static const float longest = 0.2f; /* share of depth that a plane is continued by */

/* One over the depth at a ray: x, y and 1 times these; and at the pixel's own ray. All 0 where
 * nothing is known. */
struct room_plane {
    float x, y, one, own;
};

static void fill_tables(room_planes *r, const rlf_camera *lens, const rlf_camera *p)
{
    const int32_t none = p->width * p->height;
    for (int32_t i = 0; i < lens->width * lens->height; i++) {
        rlf_vec3 ray;
        const bool has_ray = rlf_camera_unproject(lens, i % lens->width, i / lens->width, &ray);
        /* In single precision, as the surface has its rays. */
        const double u = (double)(float)ray.x * p->fx + p->cx;
        const double v = (double)(float)ray.y * p->fy + p->cy;
        const bool is_in = has_ray && u > -0.5 && v > -0.5 && u < p->width - 0.5 &&
                           v < p->height - 0.5 && p->width > 1 && p->height > 1;
        const int32_t x = is_in ? (int32_t)rlf_clamp(u, 0.0, p->width - 2.0) : 0;
        const int32_t y = is_in ? (int32_t)rlf_clamp(v, 0.0, p->height - 2.0) : 0;
        r->first[i] = is_in ? y * p->width + x : 0;
        r->nearest[i] = is_in ? (int32_t)(v + 0.5) * p->width + (int32_t)(u + 0.5) : none;
    }
}

rlf_result room_planes_open(room_planes *r, const rlf_camera *lens, const rlf_camera *predicted)
{
    const size_t pixels = (size_t)lens->width * (size_t)lens->height;
    const size_t planes = (size_t)predicted->width * (size_t)(predicted->height + 1) + 2;
    r->depth = rlf_alloc_array(pixels, sizeof(float));
    r->first = rlf_alloc_array(pixels, sizeof(int32_t));
    r->nearest = rlf_alloc_array(pixels, sizeof(int32_t));
    r->planes = rlf_alloc_array(planes, sizeof(*r->planes));
    bool has_all = r->depth != NULL && r->first != NULL && r->nearest != NULL && r->planes != NULL;
    for (int k = 0; k < 3; k++) {
        r->normal[k] = rlf_alloc_array(pixels, sizeof(float));
        has_all = has_all && r->normal[k] != NULL;
    }
    if (has_all) {
        fill_tables(r, lens, predicted);
    }
    return has_all ? RLF_OK : RLF_ERROR_MEMORY;
}

void room_planes_close(room_planes *r)
{
    rlf_free(r->depth);
    rlf_free(r->first);
    rlf_free(r->nearest);
    rlf_free(r->planes);
    for (int k = 0; k < 3; k++) {
        rlf_free(r->normal[k]);
    }
    *r = (room_planes){.depth = NULL};
}

static void make_planes(const room_planes *r, const rlf_prediction *p)
{
    const float fx = (float)p->camera.fx, fy = (float)p->camera.fy;
    for (int32_t y = 0, i = 0; y < p->camera.height; y++) {
        const float ray_y = ((float)y - (float)p->camera.cy) / fy;
        for (int32_t x = 0; x < p->camera.width; x++, i++) {
            const float ray_x = ((float)x - (float)p->camera.cx) / fx;
            const float nx = p->normal_x[i], ny = p->normal_y[i], n = p->normal_z[i];
            const float offset = p->depth[i] * (nx * ray_x + ny * ray_y + n);
            const float scale = offset != 0.0f ? 1.0f / offset : 0.0f;
            r->planes[i] = (struct room_plane){nx * scale, ny * scale, n * scale,
                                               p->depth[i] > 0.0f ? 1.0f / p->depth[i] : 0.0f};
        }
    }
}

typedef struct room_job {
    const room_planes *planes;
    const rlf_prediction *p;
    const rlf_surface *s;
} room_job;

/* Of `count` pixels from `begin` on: one over the nearest depth, and whose plane that is. */
static void find_nearest(const room_job *job, int32_t begin, int32_t count, float *restrict inverse,
                         int32_t *restrict from)
{
    const room_planes *r = job->planes;
    const float *ray_x = job->s->ray_x + begin, *ray_y = job->s->ray_y + begin;
    const int32_t *first = r->first + begin;
    for (int32_t i = 0; i < count; i++) {
        inverse[i] = 0.0f;
        from[i] = 0;
    }
    for (int32_t k = 0; k < 4; k++) {
        const int32_t step = k / 2 * job->p->camera.width + k % 2;
        float x[LANES], y[LANES], one[LANES], own[LANES];
        int32_t at[LANES];
        for (int32_t i = 0; i < count; i++) {
            const struct room_plane *plane = &r->planes[first[i] + step];
            at[i] = first[i] + step;
            x[i] = plane->x;
            y[i] = plane->y;
            one[i] = plane->one;
            own[i] = plane->own;
        }
        for (int32_t i = 0; i < count; i++) {
            const float there = x[i] * ray_x[i] + y[i] * ray_y[i] + one[i];
            /* A number, not a choice: that would not be vectorised. */
            const int32_t is_near =
                (there * (1.0f + longest) > own[i]) & (there * (1.0f - longest) < own[i]);
            const float near = (float)is_near, before = inverse[i];
            const float w = near * there + (1.0f - near) * own[i];
            const int32_t is_nearer = w > before;
            from[i] += is_nearer * (at[i] - from[i]);
            inverse[i] = w > before ? w : before;
        }
    }
}

static void take_pixels(const room_job *job, int32_t begin, int32_t count)
{
    const room_planes *r = job->planes;
    const rlf_prediction *p = job->p;
    const float *const normal[3] = {p->normal_x, p->normal_y, p->normal_z};
    float inverse[LANES], is_known[LANES];
    int32_t from[LANES];
    find_nearest(job, begin, count, inverse, from);
    for (int32_t i = 0; i < count; i++) {
        is_known[i] = r->planes[r->nearest[begin + i]].own > 0.0f ? 1.0f : 0.0f;
        r->depth[begin + i] = is_known[i] / (inverse[i] > 0.0f ? inverse[i] : 1.0f);
    }
    for (int k = 0; k < 3; k++) {
        for (int32_t i = 0; i < count; i++) {
            r->normal[k][begin + i] = is_known[i] * normal[k][from[i]];
        }
    }
}

static void take_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const room_job *job = context;
    const int32_t last = end * job->s->width;
    int32_t i = begin * job->s->width;
    for (; i + LANES <= last; i += LANES) {
        take_pixels(job, i, LANES);
    }
    take_pixels(job, i, last - i);
}

void room_planes_take(const room_planes *r, const rlf_prediction *p, const rlf_surface *s,
                      rlf_pool *pool)
{
    room_job job = {r, p, s};
    make_planes(r, p);
    rlf_parallel_for(pool, s->height, GRAIN, take_rows, &job);
}
