/* Builds the unit meshes of the body shapes. */
#include "render/shape_mesh.h"

static int32_t add_vertex(shape_mesh_set *set, rlf_vec3 p, double shift, rlf_vec3 normal,
                          const double uv[2])
{
    shape_vertex *v = &set->vertices[set->vertex_count];
    v->position[0] = (float)p.x;
    v->position[1] = (float)p.y;
    v->position[2] = (float)p.z;
    v->shift = (float)shift;
    v->normal[0] = (float)normal.x;
    v->normal[1] = (float)normal.y;
    v->normal[2] = (float)normal.z;
    v->uv[0] = (float)uv[0];
    v->uv[1] = (float)uv[1];
    return set->vertex_count++;
}

static void add_triangle(shape_mesh_set *set, int32_t a, int32_t b, int32_t c)
{
    set->indices[set->index_count++] = (uint16_t)a;
    set->indices[set->index_count++] = (uint16_t)b;
    set->indices[set->index_count++] = (uint16_t)c;
}

static double component(rlf_vec3 v, int axis)
{
    return axis == 0 ? v.x : (axis == 1 ? v.y : v.z);
}

static rlf_vec3 axis_vector(int axis, double length)
{
    return rlf_vec3_make(axis == 0 ? length : 0.0, axis == 1 ? length : 0.0,
                         axis == 2 ? length : 0.0);
}

/* Unit cube around the origin; each face has the whole texture. */
static void build_box(shape_mesh_set *set)
{
    for (int face = 0; face < 6; face++) {
        int axis = face / 2;
        rlf_vec3 normal = axis_vector(axis, face % 2 == 0 ? 1.0 : -1.0);
        rlf_vec3 right = axis_vector((axis + 1) % 3, 1.0);
        rlf_vec3 up = rlf_cross(normal, right);
        int32_t corner[4];
        for (int i = 0; i < 4; i++) {
            double s = (i == 1 || i == 2) ? 1.0 : 0.0;
            double t = i >= 2 ? 1.0 : 0.0;
            rlf_vec3 p = rlf_scale(normal, 0.5);
            p = rlf_mad(rlf_mad(p, right, s - 0.5), up, t - 0.5);
            corner[i] = add_vertex(set, p, 0.0, normal, (const double[2]){s, 1.0 - t});
        }
        add_triangle(set, corner[0], corner[1], corner[2]);
        add_triangle(set, corner[0], corner[2], corner[3]);
    }
}

/* One ring of a body of revolution about y. */
typedef struct ring {
    double radius, y;
    double shift;
    double normal_radial, normal_y;
    double v;
} ring;

static int32_t add_ring(shape_mesh_set *set, const ring *r)
{
    int32_t first = set->vertex_count;
    for (int i = 0; i <= set->slices; i++) {
        /* The seam's two columns must be the same points to the bit. */
        double angle = 2.0 * RLF_PI * (i % set->slices) / set->slices;
        double c = rlf_cos(angle);
        double s = rlf_sin(angle);
        rlf_vec3 p = rlf_vec3_make(r->radius * c, r->y, r->radius * s);
        rlf_vec3 n = rlf_vec3_make(r->normal_radial * c, r->normal_y, r->normal_radial * s);
        add_vertex(set, p, r->shift, n, (const double[2]){(double)i / set->slices, r->v});
    }
    return first;
}

/* Joins two rings, `high` having the larger y. A ring that is a pole leaves out its triangles
 * without area. */
static void join_rings(shape_mesh_set *set, int32_t low, int32_t high, bool low_is_pole,
                       bool high_is_pole)
{
    for (int32_t i = 0; i < set->slices; i++) {
        if (!high_is_pole) {
            add_triangle(set, low + i, high + i, high + i + 1);
        }
        if (!low_is_pole) {
            add_triangle(set, low + i, high + i + 1, low + i + 1);
        }
    }
}

/* Unit sphere; as a capsule its equator is doubled, and the halves shift apart. */
static void build_sphere(shape_mesh_set *set, bool is_capsule)
{
    int32_t previous = -1;
    int rings = set->stacks + (is_capsule ? 2 : 1);
    for (int i = 0; i < rings; i++) {
        bool is_upper = is_capsule && i > set->stacks / 2;
        int stack = is_upper ? i - 1 : i;
        double angle = RLF_PI * stack / set->stacks;
        bool is_pole = stack == 0 || stack == set->stacks;
        double radial = is_pole ? 0.0 : rlf_sin(angle);
        double y = -rlf_cos(angle);
        double shift = is_capsule ? (is_upper ? 1.0 : -1.0) : 0.0;
        ring r = {radial, y, shift, radial, y, (double)i / (rings - 1)};
        int32_t current = add_ring(set, &r);
        if (previous >= 0) {
            join_rings(set, previous, current, i == 1, is_pole);
        }
        previous = current;
    }
}

/* Flat disc of a cylinder at y = side / 2. */
static void build_disc(shape_mesh_set *set, double side)
{
    rlf_vec3 normal = rlf_vec3_make(0, side, 0);
    int32_t centre =
        add_vertex(set, rlf_vec3_make(0, 0.5 * side, 0), 0.0, normal, (const double[2]){0.5, 0.5});
    int32_t first = set->vertex_count;
    for (int i = 0; i <= set->slices; i++) {
        double angle = 2.0 * RLF_PI * (i % set->slices) / set->slices;
        rlf_vec3 p = rlf_vec3_make(rlf_cos(angle), 0.5 * side, rlf_sin(angle));
        const double uv[2] = {0.5 + 0.5 * p.x, 0.5 + 0.5 * p.z};
        add_vertex(set, p, 0.0, normal, uv);
    }
    for (int32_t i = 0; i < set->slices; i++) {
        if (side > 0.0) {
            add_triangle(set, centre, first + i + 1, first + i);
        } else {
            add_triangle(set, centre, first + i, first + i + 1);
        }
    }
}

/* Radius 1, height 1 around the origin. */
static void build_cylinder(shape_mesh_set *set)
{
    int32_t low = add_ring(set, &(ring){1.0, -0.5, 0.0, 1.0, 0.0, 0.0});
    int32_t high = add_ring(set, &(ring){1.0, 0.5, 0.0, 1.0, 0.0, 1.0});
    join_rings(set, low, high, false, false);
    build_disc(set, -1.0);
    build_disc(set, 1.0);
}

static void build_all(shape_mesh_set *out, int32_t slices, int32_t stacks)
{
    out->slices = slices;
    out->stacks = stacks;
    out->vertex_count = 0;
    out->index_count = 0;
    for (int type = 0; type < SHAPE_MESH_UNIT_COUNT; type++) {
        shape_mesh_range *range = &out->range[type];
        range->first_index = out->index_count;
        range->first_vertex = out->vertex_count;
        if (type == RLF_SHAPE_BOX) {
            build_box(out);
        } else if (type == RLF_SHAPE_CYLINDER) {
            build_cylinder(out);
        } else {
            build_sphere(out, type == RLF_SHAPE_CAPSULE);
        }
        range->index_count = out->index_count - range->first_index;
        range->vertex_count = out->vertex_count - range->first_vertex;
    }
}

void shape_mesh_set_build(shape_mesh_set *out)
{
    build_all(out, SHAPE_MESH_SLICES, SHAPE_MESH_STACKS);
}

void shape_mesh_set_build_coarse(shape_mesh_set *out)
{
    build_all(out, SHAPE_MESH_SLICES / 2, SHAPE_MESH_STACKS / 2);
}

shape_mesh_scale shape_mesh_scale_of(const rlf_shape *shape)
{
    double r = shape->radius;
    shape_mesh_scale s = {{1.0, 1.0, 1.0}, 0.0};
    switch (shape->type) {
    case RLF_SHAPE_BOX: s.scale = shape->size; break;
    case RLF_SHAPE_SPHERE: s.scale = rlf_vec3_make(r, r, r); break;
    case RLF_SHAPE_CAPSULE:
        s.scale = rlf_vec3_make(r, r, r);
        s.half_height = 0.5 * shape->height;
        break;
    case RLF_SHAPE_CYLINDER: s.scale = rlf_vec3_make(r, shape->height, r); break;
    case RLF_SHAPE_HULL: break;
    }
    return s;
}

bool shape_mesh_hull_triangle(const rlf_hull *hull, int32_t triangle, double radius,
                              shape_vertex out[3])
{
    const int32_t *corner = &hull->triangles[3 * (size_t)triangle];
    rlf_vec3 p[3] = {hull->vertices[corner[0]], hull->vertices[corner[1]],
                     hull->vertices[corner[2]]};
    rlf_vec3 normal = rlf_normalize(rlf_cross(rlf_sub(p[1], p[0]), rlf_sub(p[2], p[0])));
    if (!(rlf_dot(normal, normal) > 0.0) || !(radius > 0.0)) {
        return false;
    }
    int axis = 0;
    for (int i = 1; i < 3; i++) {
        double a = component(normal, axis);
        double b = component(normal, i);
        axis = b * b > a * a ? i : axis;
    }
    for (int i = 0; i < 3; i++) {
        shape_vertex *v = &out[i];
        v->position[0] = (float)p[i].x;
        v->position[1] = (float)p[i].y;
        v->position[2] = (float)p[i].z;
        v->shift = 0.0f;
        v->normal[0] = (float)normal.x;
        v->normal[1] = (float)normal.y;
        v->normal[2] = (float)normal.z;
        v->uv[0] = (float)(0.5 + 0.5 * component(p[i], (axis + 1) % 3) / radius);
        v->uv[1] = (float)(0.5 + 0.5 * component(p[i], (axis + 2) % 3) / radius);
    }
    return true;
}
