/* From camera space to screen triangles: near clipping, projection, culling and plane equations. */
#include "render/soft/soft.h"

#include <string.h>

rlf_result soft_scene_reserve(soft_scene *scene, int32_t triangle_count)
{
    if (triangle_count <= scene->triangle_capacity) {
        return RLF_OK;
    }
    int32_t capacity = triangle_count + triangle_count / 2;
    soft_triangle *triangles = rlf_alloc_array((size_t)capacity, sizeof(*triangles));
    if (triangles == NULL) {
        return RLF_ERROR_MEMORY;
    }
    if (scene->triangles != NULL) {
        memcpy(triangles, scene->triangles,
               (size_t)scene->triangle_count * sizeof(*scene->triangles));
        rlf_free(scene->triangles);
    }
    scene->triangles = triangles;
    scene->triangle_capacity = capacity;
    return RLF_OK;
}

/* A corner in the picture: 1/z and attribute/z are linear there (Heckbert and Moreton 1991). */
typedef struct screen_corner {
    double x, y, inverse_z;
    double attribute[SOFT_ATTRIBUTES];
} screen_corner;

static bool project(const rlf_camera *camera, const soft_corner *c, screen_corner *out)
{
    out->inverse_z = 1.0 / c->p.z;
    if (camera->distortion_model == RLF_DISTORTION_NONE) {
        out->x = camera->fx * c->p.x * out->inverse_z + camera->cx;
        out->y = camera->fy * c->p.y * out->inverse_z + camera->cy;
    } else if (!rlf_camera_project(camera, c->p, &out->x, &out->y)) {
        return false;
    }
    for (int i = 0; i < SOFT_ATTRIBUTES; i++) {
        out->attribute[i] = c->attribute[i] * out->inverse_z;
    }
    return true;
}

/* The point where the edge from `in` (before the near plane) to `out` meets the plane. Both
 * triangles of an edge call it in this order, so they get the same point to the bit. */
static soft_corner cut_edge(const soft_corner *in, const soft_corner *out)
{
    double t = (in->p.z - SOFT_NEAR_Z) / (in->p.z - out->p.z);
    soft_corner c;
    c.p = rlf_mad(in->p, rlf_sub(out->p, in->p), t);
    c.p.z = SOFT_NEAR_Z;
    for (int i = 0; i < SOFT_ATTRIBUTES; i++) {
        c.attribute[i] = in->attribute[i] + (float)t * (out->attribute[i] - in->attribute[i]);
    }
    return c;
}

/* Sutherland and Hodgman 1974 against one plane; 0, 3 or 4 corners. */
static int clip_near(const soft_corner in[3], soft_corner out[4])
{
    int count = 0;
    for (int i = 0; i < 3; i++) {
        const soft_corner *a = &in[i];
        const soft_corner *b = &in[(i + 1) % 3];
        bool a_is_in = a->p.z >= SOFT_NEAR_Z;
        bool b_is_in = b->p.z >= SOFT_NEAR_Z;
        if (a_is_in) {
            out[count++] = *a;
        }
        if (a_is_in != b_is_in) {
            out[count++] = a_is_in ? cut_edge(a, b) : cut_edge(b, a);
        }
    }
    return count;
}

static bool is_before(const screen_corner *a, const screen_corner *b)
{
    return a->y < b->y || (a->y == b->y && a->x < b->x);
}

static void sort_corners(screen_corner c[3])
{
    for (int i = 0; i < 3; i++) {
        int a = i == 1 ? 1 : 0; /* compare 0-1, 1-2, 0-1 */
        if (is_before(&c[a + 1], &c[a])) {
            screen_corner swap = c[a];
            c[a] = c[a + 1];
            c[a + 1] = swap;
        }
    }
}

/* Plane through three values at the sorted corners; `area` is twice the signed area. */
static soft_plane plane_through(const screen_corner c[3], const double value[3], double area)
{
    double dx1 = c[1].x - c[0].x;
    double dy1 = c[1].y - c[0].y;
    double dx2 = c[2].x - c[0].x;
    double dy2 = c[2].y - c[0].y;
    double v1 = value[1] - value[0];
    double v2 = value[2] - value[0];
    soft_plane plane = {(float)value[0], (float)((v1 * dy2 - v2 * dy1) / area),
                        (float)((v2 * dx1 - v1 * dx2) / area)};
    return plane;
}

/* Level edges have no rows of their own and need no slope. */
static double slope_of(const screen_corner *upper, const screen_corner *lower)
{
    double dy = lower->y - upper->y;
    return dy > 0.0 ? (lower->x - upper->x) / dy : 0.0;
}

static double area_of(const screen_corner c[3])
{
    return (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[2].x - c[0].x) * (c[1].y - c[0].y);
}

/* Rows or columns from floor(low) - 1 to ceil(high) + 1 within 0..size. */
static int32_t first_cell(double low, int32_t size)
{
    return (int32_t)rlf_clamp(low - 1.0, 0.0, size);
}
static int32_t end_cell(double high, int32_t size)
{
    return (int32_t)rlf_clamp(high + 2.0, 0.0, size);
}

static void add_screen_triangle(soft *s, screen_corner c[3], int32_t body_index)
{
    /* Counter-clockwise to the eye is negative where y points down. Slivers hit no sample. */
    double facing = area_of(c);
    if (!(facing < -1e-4) || !rlf_is_finite(facing)) {
        return;
    }
    double left = rlf_min(c[0].x, rlf_min(c[1].x, c[2].x));
    double right = rlf_max(c[0].x, rlf_max(c[1].x, c[2].x));
    sort_corners(c);
    if (right < -0.5 || left > s->camera.width || c[2].y < -0.5 || c[0].y > s->camera.height) {
        return;
    }
    soft_triangle *t = &s->scene.triangles[s->scene.triangle_count++];
    double area = area_of(c);
    double values[3];
    for (int i = 0; i < 3; i++) {
        t->x[i] = c[i].x;
        t->y[i] = c[i].y;
        values[i] = c[i].inverse_z;
    }
    t->slope[0] = slope_of(&c[0], &c[1]);
    t->slope[1] = slope_of(&c[1], &c[2]);
    t->slope[2] = slope_of(&c[0], &c[2]);
    t->inverse_z = plane_through(c, values, area);
    t->inverse_z_min = (float)rlf_min(values[0], rlf_min(values[1], values[2]));
    t->inverse_z_max = (float)rlf_max(values[0], rlf_max(values[1], values[2]));
    for (int k = 0; k < SOFT_ATTRIBUTES; k++) {
        for (int i = 0; i < 3; i++) {
            values[i] = c[i].attribute[k];
        }
        t->attribute[k] = plane_through(c, values, area);
    }
    t->y_begin = first_cell(c[0].y, s->camera.height);
    t->y_end = end_cell(c[2].y, s->camera.height);
    t->body = body_index;
    soft_body *body = &s->scene.bodies[body_index];
    int32_t x0 = first_cell(left, s->camera.width);
    int32_t x1 = end_cell(right, s->camera.width);
    body->x0 = x0 < body->x0 ? x0 : body->x0;
    body->x1 = x1 > body->x1 ? x1 : body->x1;
    body->y0 = t->y_begin < body->y0 ? t->y_begin : body->y0;
    body->y1 = t->y_end > body->y1 ? t->y_end : body->y1;
}

void soft_scene_add_triangle(soft *s, const soft_corner corners[3], int32_t body)
{
    soft_corner clipped[4];
    int count = clip_near(corners, clipped);
    screen_corner screen[4];
    for (int i = 0; i < count; i++) {
        if (!project(&s->camera, &clipped[i], &screen[i])) {
            return;
        }
    }
    for (int i = 2; i < count; i++) {
        screen_corner fan[3] = {screen[0], screen[i - 1], screen[i]};
        add_screen_triangle(s, fan, body);
    }
}
