/* Boxes halved at the median of their triangles' middles: the tree is balanced, its nodes lie in
 * the order of a walk through it. */
#include "known/mesh.h"

#include <string.h>

#define LEAF_MAX 4   /* triangles */
#define DEPTH_MAX 24 /* 4 * 2^24 triangles */

typedef struct triangle {
    rlf_vec3 corner, edge[2];
} triangle;

/* A leaf has triangles first .. first + count; others (count 0) have a child right behind them and
 * one at `first`. */
typedef struct node {
    rlf_aabb box;
    int32_t first, count;
} node;

struct known_mesh {
    uint64_t id;
    triangle *triangles;
    node *nodes;
    int32_t node_count;
};

/* ---- making --------------------------------------------------------------------------------- */

static double component(rlf_vec3 v, int axis)
{
    return axis == 0 ? v.x : (axis == 1 ? v.y : v.z);
}

static rlf_vec3 middle(const triangle *t)
{
    return rlf_mad(t->corner, rlf_add(t->edge[0], t->edge[1]), 1.0 / 3.0);
}

static rlf_aabb box_of(const triangle *t, int32_t count)
{
    rlf_aabb box = {t[0].corner, t[0].corner};
    for (int32_t i = 0; i < count; i++) {
        rlf_aabb_extend(&box, t[i].corner);
        rlf_aabb_extend(&box, rlf_add(t[i].corner, t[i].edge[0]));
        rlf_aabb_extend(&box, rlf_add(t[i].corner, t[i].edge[1]));
    }
    return box;
}

/* Puts the `half` triangles with the lowest middles first (Hoare 1961). */
static void split(triangle *t, int32_t count, int32_t half, int axis)
{
    int32_t low = 0, high = count - 1;
    while (low < high) {
        double pivot = component(middle(&t[(low + high) / 2]), axis);
        int32_t i = low, j = high;
        while (i <= j) {
            while (component(middle(&t[i]), axis) < pivot) {
                i++;
            }
            while (component(middle(&t[j]), axis) > pivot) {
                j--;
            }
            if (i <= j) {
                triangle swap = t[i];
                t[i++] = t[j];
                t[j--] = swap;
            }
        }
        low = half > j ? i : low;
        high = half < i ? j : high;
    }
}

static int longest_axis(const rlf_aabb *box)
{
    rlf_vec3 size = rlf_sub(box->max, box->min);
    int axis = size.y > size.x ? 1 : 0;
    return size.z > component(size, axis) ? 2 : axis;
}

/* Depth is the logarithm of the count. */
static void build(known_mesh *mesh, int32_t first, int32_t count)
{
    node *n = &mesh->nodes[mesh->node_count++];
    triangle *t = mesh->triangles + first;
    *n = (node){box_of(t, count), first, count};
    if (count <= LEAF_MAX) {
        return;
    }
    split(t, count, count / 2, longest_axis(&n->box));
    n->count = 0;
    build(mesh, first, count / 2);
    n->first = mesh->node_count;
    build(mesh, first + count / 2, count - count / 2);
}

static rlf_vec3 vertex(const rlf_model *model, int32_t index)
{
    const float *p = model->vertices[model->triangles[index]].position;
    return rlf_vec3_make((double)p[0], (double)p[1], (double)p[2]);
}

rlf_result known_mesh_create(const rlf_model *model, known_mesh **out)
{
    *out = NULL;
    known_mesh *mesh = rlf_alloc(sizeof(*mesh));
    if (mesh == NULL) {
        return RLF_ERROR_MEMORY;
    }
    size_t count = (size_t)model->triangle_count;
    memset(mesh, 0, sizeof(*mesh));
    mesh->id = model->id;
    mesh->triangles = rlf_alloc_array(count + 1, sizeof(*mesh->triangles));
    mesh->nodes = rlf_alloc_array(2 * count + 1, sizeof(*mesh->nodes));
    if (mesh->triangles == NULL || mesh->nodes == NULL) {
        known_mesh_destroy(&mesh);
        return RLF_ERROR_MEMORY;
    }
    for (int32_t i = 0; i < model->triangle_count; i++) {
        rlf_vec3 corner = vertex(model, 3 * i);
        mesh->triangles[i] = (triangle){
            corner,
            {rlf_sub(vertex(model, 3 * i + 1), corner), rlf_sub(vertex(model, 3 * i + 2), corner)}};
    }
    if (count > 0) {
        build(mesh, 0, model->triangle_count);
    }
    *out = mesh;
    return RLF_OK;
}

void known_mesh_destroy(known_mesh **mesh)
{
    if (*mesh != NULL) {
        rlf_free((*mesh)->triangles);
        rlf_free((*mesh)->nodes);
        rlf_free(*mesh);
        *mesh = NULL;
    }
}

uint64_t known_mesh_id(const known_mesh *mesh)
{
    return mesh->id;
}

/* ---- rays ----------------------------------------------------------------------------------- */

/* A ray and what it has met so far: enter > leave means nothing. */
typedef struct cast {
    rlf_vec3 origin, direction;
    double enter, leave;
} cast;

/* Narrows low .. high to where the ray is between two planes. */
static bool clip(double origin, double direction, double a, double b, double *low, double *high)
{
    if (direction == 0.0) {
        return origin >= a && origin <= b;
    }
    double p = (a - origin) / direction, q = (b - origin) / direction;
    *low = rlf_max(*low, rlf_min(p, q));
    *high = rlf_min(*high, rlf_max(p, q));
    return *low <= *high;
}

/* The ray meets a box where it may meet something nearer or farther than so far. */
static bool may_meet(const cast *c, const rlf_aabb *box)
{
    double low = 0.0, high = 1e300;
    return clip(c->origin.x, c->direction.x, box->min.x, box->max.x, &low, &high) &&
           clip(c->origin.y, c->direction.y, box->min.y, box->max.y, &low, &high) &&
           clip(c->origin.z, c->direction.z, box->min.z, box->max.z, &low, &high) &&
           (low < c->enter || high > c->leave);
}

static void meet(cast *c, const triangle *t)
{
    rlf_vec3 across = rlf_cross(c->direction, t->edge[1]);
    double volume = rlf_dot(t->edge[0], across);
    if (volume == 0.0) {
        return;
    }
    rlf_vec3 from = rlf_sub(c->origin, t->corner);
    rlf_vec3 up = rlf_cross(from, t->edge[0]);
    double u = rlf_dot(from, across) / volume;
    double v = rlf_dot(c->direction, up) / volume;
    double at = rlf_dot(t->edge[1], up) / volume;
    if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && at > 0.0) {
        c->enter = rlf_min(c->enter, at);
        c->leave = rlf_max(c->leave, at);
    }
}

bool known_mesh_cast(const known_mesh *mesh, rlf_vec3 origin, rlf_vec3 direction, double *out_enter,
                     double *out_leave)
{
    cast c = {origin, direction, 1e300, 0.0};
    int32_t waiting[DEPTH_MAX + 1];
    int32_t count = 0;
    for (int32_t i = mesh->node_count > 0 ? 0 : -1; i >= 0;) {
        const node *n = &mesh->nodes[i];
        bool is_met = may_meet(&c, &n->box);
        for (int32_t k = 0; is_met && k < n->count; k++) {
            meet(&c, &mesh->triangles[n->first + k]);
        }
        if (is_met && n->count == 0) {
            waiting[count++] = n->first;
            i++;
        } else {
            i = count > 0 ? waiting[--count] : -1;
        }
    }
    *out_enter = c.enter;
    *out_leave = c.leave;
    return c.leave > 0.0;
}
