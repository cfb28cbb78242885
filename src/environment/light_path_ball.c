/* All rays from a body to the light at once: a ball that is moved to the light. Where all that is
 * seen around its way is behind it no ray loses light, and none need be followed. */
#include "environment/light.h"

#define ENDLESS 1e9f   /* no bounds yet */
#define MARGIN 1.0001f /* of depth: rounding along a ray */
#define STEPS_MOST 16  /* pieces of the way: each as long as the ball is wide, or longer */
#define LEAST_Z 0.05f  /* metres: a ball nearer than this may be anywhere in the image */

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

static meeting meet(const rlf_surface *surface, const depth_tiles *tiles, const bounds *b, float z)
{
    const int32_t x0 = within(b->x0, surface->width);
    const int32_t y0 = within(b->y0, surface->height);
    const int32_t x1 = within(b->x1, surface->width);
    const int32_t y1 = within(b->y1, surface->height);
    if (x0 >= x1 || y0 >= y1) {
        return OUTSIDE;
    }
    for (int32_t row = y0 / DEPTH_TILE; row * DEPTH_TILE < y1; row++) {
        const float *nearest = tiles->nearest + row * tiles->columns;
        for (int32_t column = x0 / DEPTH_TILE; column * DEPTH_TILE < x1; column++) {
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

bool light_path_may_lose(const rlf_surface *surface, const depth_tiles *tiles,
                         const light_path_ball *ball, const float to_light[3])
{
    const float radius = ball->radius;
    const float reach = (float)LIGHT_PATH_REACH_M;
    const float step = most(2.0f * radius, reach / STEPS_MOST);
    float p[3];
    float next[3];
    move(ball->center, to_light, 0.0f, p);
    for (float at = 0.0f; at < reach; at += step) {
        bounds b = {ENDLESS, ENDLESS, -ENDLESS, -ENDLESS};
        move(ball->center, to_light, at + step, next);
        if (!(least(p[2], next[2]) > radius + LEAST_Z)) {
            return true; /* at the camera */
        }
        add_ball(&surface->camera, p, radius, &b);
        add_ball(&surface->camera, next, radius, &b);
        const meeting here = meet(surface, tiles, &b, MARGIN * (most(p[2], next[2]) + radius));
        if (here != MEETS_NOTHING) {
            return here == MEETS_SOMETHING; /* a ray that has left the image never comes back */
        }
        move(next, to_light, 0.0f, p);
    }
    return false;
}
