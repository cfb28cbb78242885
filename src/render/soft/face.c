/* From camera space to screen faces: near clipping, projection, culling and plane equations. */
#include "render/soft/passes.h"

#include "render/soft/soft.h"

#include <string.h>

/* Every worker lists the faces of its rows. */
static rlf_result reserve_lists(soft *s, int32_t capacity)
{
    for (int32_t i = 0; i < s->worker_count; i++) {
        soft_group *group = &s->workers[i];
        rlf_free(group->list);
        rlf_free(group->ends);
        group->list = rlf_alloc_array((size_t)capacity, sizeof(*group->list));
        group->ends = rlf_alloc_array((size_t)capacity, sizeof(*group->ends));
        if (group->list == NULL || group->ends == NULL) {
            return RLF_ERROR_MEMORY;
        }
    }
    return RLF_OK;
}

rlf_result soft_scene_reserve(soft *s, int32_t face_count)
{
    soft_scene *scene = &s->scene;
    if (face_count <= scene->face_capacity) {
        return RLF_OK;
    }
    int32_t capacity = face_count + face_count / 2;
    soft_face *faces = rlf_alloc_array((size_t)capacity, sizeof(*faces));
    if (faces == NULL) {
        return RLF_ERROR_MEMORY;
    }
    if (scene->faces != NULL) {
        memcpy(faces, scene->faces, (size_t)scene->face_count * sizeof(*scene->faces));
        rlf_free(scene->faces);
    }
    scene->faces = faces;
    scene->face_capacity = capacity;
    return reserve_lists(s, capacity);
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

/* Plane through three values at three corners; `area` is twice the signed area. */
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

/* From the upper to the lower end (of a level one, from the left): both faces of an edge work out
 * the same line to the bit. */
static void set_edge(soft_face *f, int e, const screen_corner *a, const screen_corner *b)
{
    bool is_down = a->y < b->y || (a->y == b->y && a->x < b->x);
    const screen_corner *upper = is_down ? a : b;
    const screen_corner *lower = is_down ? b : a;
    double dy = lower->y - upper->y;
    f->edge[e] = (soft_edge){.x = upper->x,
                             .y = upper->y,
                             .end = lower->y,
                             .slope = dy > 0.0 ? (lower->x - upper->x) / dy : 0.0};
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

static double range_of(const screen_corner *c, int count, bool is_y, double *out_high)
{
    double low = is_y ? c[0].y : c[0].x;
    *out_high = low;
    for (int i = 1; i < count; i++) {
        low = rlf_min(low, is_y ? c[i].y : c[i].x);
        *out_high = rlf_max(*out_high, is_y ? c[i].y : c[i].x);
    }
    return low;
}

/* The face's planes; its first three corners span it. */
static void set_planes(soft_face *f, const screen_corner *c, int count, rlf_vec3 to_light)
{
    double area = area_of(c);
    double values[3] = {c[0].inverse_z, c[1].inverse_z, c[2].inverse_z};
    f->origin_x = (float)c[0].x;
    f->origin_y = (float)c[0].y;
    f->inverse_z = plane_through(c, values, area);
    double low = values[0];
    double high = values[0];
    for (int i = 1; i < count; i++) {
        low = rlf_min(low, c[i].inverse_z);
        high = rlf_max(high, c[i].inverse_z);
    }
    f->is_lit = false;
    for (int i = 0; i < count; i++) {
        const double *n = c[i].attribute + SOFT_NORMAL;
        const double facing = n[0] * to_light.x + n[1] * to_light.y + n[2] * to_light.z;
        f->is_lit = f->is_lit || facing > 1e-4 * c[i].inverse_z;
    }
    f->inverse_z_min = (float)low;
    f->inverse_z_max = (float)high;
    for (int k = 0; k < SOFT_ATTRIBUTES; k++) {
        for (int i = 0; i < 3; i++) {
            values[i] = c[i].attribute[k];
        }
        f->attribute[k] = plane_through(c, values, area);
    }
}

static void add_screen_face(soft *s, const screen_corner *c, int count, int32_t body_index)
{
    /* Counter-clockwise to the eye is negative where y points down. Slivers hit no sample. */
    double facing = area_of(c);
    if (!(facing < -1e-4) || !rlf_is_finite(facing)) {
        return;
    }
    double right, bottom;
    double left = range_of(c, count, false, &right);
    double top = range_of(c, count, true, &bottom);
    if (right < -0.5 || left > s->camera.width || bottom < -0.5 || top > s->camera.height) {
        return;
    }
    soft_face *f = &s->scene.faces[s->scene.face_count++];
    for (int e = 0; e < SOFT_CORNERS; e++) {
        /* A triangle's fourth edge is a point: level. */
        set_edge(f, e, &c[e < count ? e : 0], &c[e + 1 < count ? e + 1 : 0]);
    }
    set_planes(f, c, count, s->to_light);
    f->y_begin = first_cell(top, s->camera.height);
    f->y_end = end_cell(bottom, s->camera.height);
    f->body = body_index;
    f->skin = 0;
    soft_body *body = &s->scene.bodies[body_index];
    body->y0 = f->y_begin < body->y0 ? f->y_begin : body->y0;
    body->y1 = f->y_end > body->y1 ? f->y_end : body->y1;
}

static void add_triangle(soft *s, const soft_corner corners[3], int32_t body)
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
        const screen_corner fan[3] = {screen[0], screen[i - 1], screen[i]};
        add_screen_face(s, fan, 3, body);
    }
}

/* A lens bends a face, and the near plane may cut it: then it goes as two triangles. */
static bool is_simple(const soft *s, const soft_corner *corners, int32_t count)
{
    bool is_before = s->camera.distortion_model == RLF_DISTORTION_NONE;
    for (int32_t i = 0; i < count; i++) {
        is_before = is_before && corners[i].p.z >= SOFT_NEAR_Z;
    }
    return is_before;
}

void soft_scene_add_face(soft *s, const soft_corner *corners, int32_t corner_count, int32_t body)
{
    if (corner_count < 4 || !is_simple(s, corners, corner_count)) {
        for (int32_t i = 2; i < corner_count; i++) {
            const soft_corner fan[3] = {corners[0], corners[i - 1], corners[i]};
            add_triangle(s, fan, body);
        }
        return;
    }
    screen_corner screen[SOFT_CORNERS];
    for (int i = 0; i < SOFT_CORNERS; i++) {
        (void)project(&s->camera, &corners[i], &screen[i]);
    }
    add_screen_face(s, screen, SOFT_CORNERS, body);
}
