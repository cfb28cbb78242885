/* All rays from a body to the light at once: a ball that is moved to the light. Where all that is
 * seen around its way is behind it no ray loses light, and none need be followed. */
#include "real_shade.h"
#include "real_shade_ray.h"

#include "kernel/kernel.h"

enum { TILE = REAL_SHADE_TILE };

#define NOTHING 1e9f   /* depth where nothing is seen */
#define MARGIN 1.0001f /* of depth: rounding along a ray */
#define STEPS_MOST 16  /* pieces of the way: each as long as the ball is wide, or longer */
#define LEAST_Z 0.05f  /* metres: a ball nearer than this may be anywhere in the image */

/* ---- what is seen --------------------------------------------------------------------------- */

RLF_KERNEL_PART void take_nearer(const float *restrict depth, const float *restrict back,
                                 int32_t count, float *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        float front = depth[i] > 0.0f ? depth[i] : NOTHING;
        float behind = back[i] > 0.0f ? back[i] : NOTHING;
        float here = front < behind ? front : behind;
        out[i] = here < out[i] ? here : out[i];
    }
}

RLF_KERNEL_PART void take_front(const float *restrict depth, const float *restrict back,
                                int32_t count, float *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        float behind = back[i];
        out[i] = depth[i] > 0.0f ? depth[i] : behind;
    }
}

/* Rows of pixels from these on; front NULL = not wanted. */
typedef struct sheets {
    const float *depth, *back;
    float *front;
} sheets;

/* Nearest of a row of tiles: `lines` rows of pixels. */
RLF_KERNEL static void find_nearest(const sheets *from, int32_t width, int32_t lines,
                                    float *restrict out)
{
    enum { BLOCK = 64 * TILE };
    for (int32_t x0 = 0; x0 < width; x0 += BLOCK) {
        const int32_t count = width - x0 < BLOCK ? width - x0 : BLOCK;
        float nearest[BLOCK];
        for (int32_t i = 0; i < BLOCK; i++) {
            nearest[i] = NOTHING;
        }
        for (int32_t y = 0; y < lines; y++) {
            const ptrdiff_t first = (ptrdiff_t)y * width + x0;
            take_nearer(from->depth + first, from->back + first, count, nearest);
            if (from->front != NULL) {
                take_front(from->depth + first, from->back + first, count, from->front + first);
            }
        }
        for (int32_t i = 0; i < count; i += TILE) {
            float least = nearest[i];
            for (int32_t k = 1; k < TILE; k++) {
                least = nearest[i + k] < least ? nearest[i + k] : least;
            }
            out[(x0 + i) / TILE] = least;
        }
    }
}

rlf_result real_shade_grid_create(int32_t width, int32_t height, real_shade_grid *out)
{
    out->columns = (width + TILE - 1) / TILE;
    out->rows = (height + TILE - 1) / TILE;
    out->nearest = rlf_alloc_array((size_t)out->columns * (size_t)out->rows, sizeof(float));
    return out->nearest != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

void real_shade_grid_destroy(real_shade_grid *grid)
{
    rlf_free(grid->nearest);
    grid->nearest = NULL;
}

typedef struct grid_job {
    const rlf_surface *surface;
    real_shade_grid *grid;
    float *front;
} grid_job;

static void update_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const grid_job *job = context;
    const rlf_surface *surface = job->surface;
    (void)worker;
    const float *back =
        surface->background_depth != NULL ? surface->background_depth : surface->depth;
    for (int32_t row = begin; row < end; row++) {
        const int32_t y = row * TILE;
        const int32_t left = surface->height - y;
        const ptrdiff_t first = (ptrdiff_t)y * surface->width;
        const sheets from = {surface->depth + first, back + first,
                             job->front != NULL ? job->front + first : NULL};
        find_nearest(&from, surface->width, left < TILE ? left : TILE,
                     job->grid->nearest + row * job->grid->columns);
    }
}

void real_shade_grid_update(real_shade_grid *grid, const rlf_surface *surface, rlf_pool *pool,
                            float *front)
{
    grid_job job = {surface, grid, front};
    rlf_parallel_for(pool, grid->rows, 8, update_rows, &job);
    float nearest = NOTHING;
    for (int32_t i = 0; i < grid->columns * grid->rows; i++) {
        nearest = grid->nearest[i] < nearest ? grid->nearest[i] : nearest;
    }
    grid->least = nearest < NOTHING ? nearest : 0.0f;
}

/* ---- the way -------------------------------------------------------------------------------- */

/* Pixels x0 <= x < x1, y0 <= y < y1. */
typedef struct bounds {
    float x0, y0, x1, y1;
} bounds;

static float least(float a, float b)
{
    return a < b ? a : b;
}

static float most(float a, float b)
{
    return a > b ? a : b;
}

/* Widens the bounds by where a ball is seen; its depth is at least LEAST_Z. */
static void add_ball(const rlf_camera *k, const float p[3], float radius, bounds *b)
{
    const float near_z = 1.0f / (p[2] - radius);
    const float far_z = 1.0f / (p[2] + radius);
    const float fx = (float)k->fx;
    const float fy = (float)k->fy;
    const float left = fx * (p[0] - radius);
    const float right = fx * (p[0] + radius);
    const float top = fy * (p[1] - radius);
    const float bottom = fy * (p[1] + radius);
    b->x0 = least(b->x0, least(left * near_z, left * far_z) + (float)k->cx - 1.0f);
    b->y0 = least(b->y0, least(top * near_z, top * far_z) + (float)k->cy - 1.0f);
    b->x1 = most(b->x1, most(right * near_z, right * far_z) + (float)k->cx + 2.0f);
    b->y1 = most(b->y1, most(bottom * near_z, bottom * far_z) + (float)k->cy + 2.0f);
}

static int32_t within(float x, int32_t size)
{
    return (int32_t)least(most(x, 0.0f), (float)size);
}

/* What a piece of the way meets. */
typedef enum meeting { MEETS_NOTHING, MEETS_SOMETHING, OUTSIDE } meeting;

static meeting meet(const real_shade_world *world, const bounds *b, float z)
{
    const int32_t x0 = within(b->x0, world->surface->width);
    const int32_t y0 = within(b->y0, world->surface->height);
    const int32_t x1 = within(b->x1, world->surface->width);
    const int32_t y1 = within(b->y1, world->surface->height);
    if (x0 >= x1 || y0 >= y1) {
        return OUTSIDE;
    }
    for (int32_t row = y0 / TILE; row * TILE < y1; row++) {
        const float *nearest = world->grid->nearest + row * world->grid->columns;
        for (int32_t column = x0 / TILE; column * TILE < x1; column++) {
            if (nearest[column] < z) {
                return MEETS_SOMETHING;
            }
        }
    }
    return MEETS_NOTHING;
}

static void move(const float from[3], const float to_light[3], float length, float out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = from[i] + length * to_light[i];
    }
}

bool real_shade_may_lose(const real_shade_world *world, const float center[3], float radius,
                         const float to_light[3])
{
    const float reach = (float)REAL_SHADE_REACH_M;
    const float step = most(2.0f * radius, reach / STEPS_MOST);
    float p[3];
    float next[3];
    move(center, to_light, 0.0f, p);
    for (float at = 0.0f; at < reach; at += step) {
        bounds b = {NOTHING, NOTHING, -NOTHING, -NOTHING};
        move(center, to_light, at + step, next);
        if (!(least(p[2], next[2]) > radius + LEAST_Z)) {
            return true; /* at the camera */
        }
        add_ball(&world->surface->camera, p, radius, &b);
        add_ball(&world->surface->camera, next, radius, &b);
        const meeting here = meet(world, &b, MARGIN * (most(p[2], next[2]) + radius));
        if (here != MEETS_NOTHING) {
            return here == MEETS_SOMETHING; /* a ray that has left the image never comes back */
        }
        move(next, to_light, 0.0f, p);
    }
    return false;
}
