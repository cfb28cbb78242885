#include "physics/pair/collide.h"

/* A cylinder touches with its cap, an edge of its side, or, about level, with the axis that lies
 * beneath it: cosines to its axis. */
#define CAP 0.7
#define LEVEL 0.02
#define RIM_CORNERS 8
/* What is so near a face's plane is a corner of it: share of the hull's radius. */
#define IN_PLANE 1e-4

static void to_world(const phys_body *body, pair_face *face)
{
    for (int32_t i = 0; i < face->count; i++) {
        face->corner[i] = rlf_add(body->x, rlf_mat3_mul_vec(&body->R, face->corner[i]));
    }
    face->normal = rlf_mat3_mul_vec(&body->R, face->normal);
}

static void face_of_box(rlf_vec3 size, rlf_vec3 out, pair_face *face)
{
    const double half[3] = {0.5 * size.x, 0.5 * size.y, 0.5 * size.z};
    const double along[3] = {out.x, out.y, out.z};
    int32_t axis = along[0] * along[0] > along[1] * along[1] ? 0 : 1;
    axis = along[axis] * along[axis] > along[2] * along[2] ? axis : 2;
    double side = along[axis] < 0.0 ? -1.0 : 1.0;
    int32_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    face->count = 4;
    for (int32_t i = 0; i < 4; i++) {
        double p[3];
        p[axis] = side * half[axis];
        p[u] = (i == 0 || i == 3 ? -side : side) * half[u];
        p[v] = i < 2 ? -half[v] : half[v];
        face->corner[i] = rlf_vec3_make(p[0], p[1], p[2]);
    }
    face->normal = rlf_vec3_make(axis == 0 ? side : 0, axis == 1 ? side : 0, axis == 2 ? side : 0);
}

/* The corners run around the axis from where `out` leans to, so that one of them is outermost. */
static void cap_of_cylinder(const rlf_shape *s, rlf_vec3 lean, double side, pair_face *face)
{
    face->normal = rlf_vec3_make(0, side, 0);
    face->count = RIM_CORNERS;
    for (int32_t i = 0; i < RIM_CORNERS; i++) {
        double angle = -side * i * (2.0 * RLF_PI / RIM_CORNERS);
        double c = s->radius * rlf_cos(angle), n = s->radius * rlf_sin(angle);
        face->corner[i] =
            rlf_vec3_make(c * lean.x - n * lean.z, side * 0.5 * s->height, n * lean.x + c * lean.z);
    }
}

static void face_of_tube(const rlf_shape *s, rlf_vec3 out, pair_face *face)
{
    bool is_capsule = s->type == RLF_SHAPE_CAPSULE;
    bool is_level = out.y < LEVEL && out.y > -LEVEL;
    rlf_vec3 lean = rlf_normalize(rlf_vec3_make(out.x, 0, out.z));
    lean = rlf_dot(lean, lean) > 0.0 ? lean : rlf_vec3_make(1, 0, 0);
    if (out.y > CAP || out.y < -CAP) {
        if (!is_capsule) {
            cap_of_cylinder(s, lean, out.y < 0.0 ? -1.0 : 1.0, face);
        }
        return;
    }
    face->rounding = is_capsule || is_level ? s->radius : 0.0;
    rlf_vec3 aside = rlf_scale(lean, s->radius - face->rounding);
    for (int32_t i = 0; i < 2; i++) {
        face->corner[i] = rlf_vec3_make(aside.x, (i - 0.5) * s->height, aside.z);
    }
    face->count = 2;
}

/* Grows with the angle from u towards v, from 0 to 4. */
static double pseudo_angle(double u, double v)
{
    double sum = (u < 0.0 ? -u : u) + (v < 0.0 ? -v : v);
    double part = sum > 0.0 ? v / sum : 0.0;
    return u < 0.0 ? 2.0 - part : (v < 0.0 ? 4.0 + part : part);
}

/* Orders the corners about their middle, counter-clockwise seen from where n points to. */
static void sort_corners(rlf_vec3 *corner, int32_t count, rlf_vec3 n)
{
    double angle[PHYS_POINTS_MAX];
    rlf_vec3 middle = {0, 0, 0}, u = rlf_perpendicular(n), v = rlf_cross(n, u);
    for (int32_t i = 0; i < count; i++) {
        middle = rlf_mad(middle, corner[i], 1.0 / count);
    }
    for (int32_t i = 0; i < count; i++) {
        rlf_vec3 p = corner[i], d = rlf_sub(p, middle);
        double a = pseudo_angle(rlf_dot(d, u), rlf_dot(d, v));
        int32_t k = i;
        for (; k > 0 && angle[k - 1] > a; k--) {
            corner[k] = corner[k - 1];
            angle[k] = angle[k - 1];
        }
        corner[k] = p;
        angle[k] = a;
    }
}

static void face_of_hull(const phys_shape *s, rlf_vec3 out, pair_face *face)
{
    const rlf_hull *hull = s->shape.hull;
    const phys_plane *best = &s->planes[0];
    for (int32_t i = 1; i < s->plane_count; i++) {
        const phys_plane *plane = &s->planes[i];
        best = rlf_dot(plane->normal, out) > rlf_dot(best->normal, out) ? plane : best;
    }
    rlf_vec3 corner[PHYS_POINTS_MAX];
    int32_t count = 0;
    for (int32_t i = 0; i < hull->vertex_count && count < PHYS_POINTS_MAX; i++) {
        double depth = best->offset - rlf_dot(best->normal, hull->vertices[i]);
        if (depth < IN_PLANE * s->radius) {
            corner[count++] = hull->vertices[i];
        }
    }
    sort_corners(corner, count, best->normal);
    int32_t kept = count < PAIR_FACE_MAX ? count : PAIR_FACE_MAX;
    for (int32_t i = 0; i < kept; i++) {
        face->corner[i] = corner[i * count / kept];
    }
    face->count = kept;
    face->normal = best->normal;
}

void pair_face_of(const phys_body *body, rlf_vec3 out, pair_face *face)
{
    rlf_vec3 local = phys_to_frame(&body->R, out);
    face->count = 0;
    face->normal = local;
    face->rounding = 0.0;
    switch (body->shape.shape.type) {
    case RLF_SHAPE_BOX: face_of_box(body->shape.shape.size, local, face); break;
    case RLF_SHAPE_SPHERE: break;
    case RLF_SHAPE_CAPSULE:
    case RLF_SHAPE_CYLINDER: face_of_tube(&body->shape.shape, local, face); break;
    case RLF_SHAPE_HULL: face_of_hull(&body->shape, local, face); break;
    }
    to_world(body, face);
}
