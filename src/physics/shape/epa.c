/* How deep two convex cores overlap: a polytope of corners of their difference grows from the
 * simplex that holds the origin until its face nearest to the origin is one of the difference
 * itself (van den Bergen 2001, "Proximity queries and penetration depth computation"). */
#include "physics/shape/convex.h"

#define CORNERS_MAX 64
#define FACES_MAX 128
#define EDGES_MAX 96
#define THIN 1e-9      /* m: what is thinner has no volume */
#define IN_LINE 1e-10  /* sine */
#define IN_PLANE 1e-10 /* m: a corner so little above a face's plane does not see it */
/* A face lies on the difference when nothing is farther out by more than this: m, of something
 * curved, which is polished, more, and a share of its distance. */
#define ON_FACE 1e-7
#define ON_CURVED_FACE 2e-5
#define ON_FACE_SHARE 1e-3

#define POLISHES 2
#define APART 1e-4 /* m */

typedef struct epa_face {
    int32_t corner[3]; /* counter-clockwise seen from outside */
    rlf_vec3 normal;
    double distance;
} epa_face;

typedef struct epa_edge {
    int32_t from, to;
} epa_edge;

typedef struct epa_polytope {
    convex_corner corner[CORNERS_MAX];
    epa_face face[FACES_MAX];
    epa_edge edge[EDGES_MAX]; /* around the hole of the faces that were taken away */
    int32_t corner_count, face_count, edge_count;
} epa_polytope;

/* Adds the difference's corner along d when it is off what is there: the point, line or plane of
 * the first corners. */
static bool add_off(epa_polytope *e, const convex_core *a, const convex_core *b, rlf_vec3 d)
{
    const convex_corner corner = convex_difference(a, b, d);
    rlf_vec3 p = rlf_sub(corner.p, e->corner[0].p), off = p;
    if (e->corner_count == 2) {
        rlf_vec3 along = rlf_normalize(rlf_sub(e->corner[1].p, e->corner[0].p));
        off = rlf_mad(p, along, -rlf_dot(p, along));
    } else if (e->corner_count == 3) {
        rlf_vec3 n = rlf_normalize(rlf_cross(rlf_sub(e->corner[1].p, e->corner[0].p),
                                             rlf_sub(e->corner[2].p, e->corner[0].p)));
        off = rlf_scale(n, rlf_dot(p, n));
    }
    if (rlf_dot(off, off) <= THIN * THIN) {
        return false;
    }
    e->corner[e->corner_count++] = corner;
    return true;
}

/* Four corners that are not in a plane, beginning with those of the simplex. */
static bool start(epa_polytope *e, const convex_core *a, const convex_core *b,
                  const convex_simplex *simplex)
{
    e->corner_count = e->face_count = 0;
    for (int32_t i = 0; i < simplex->count; i++) {
        e->corner[e->corner_count++] = simplex->corner[i];
    }
    while (e->corner_count < 4) {
        rlf_vec3 u = {1, 0, 0}, v = {0, 1, 0};
        if (e->corner_count == 2) {
            rlf_vec3 along = rlf_normalize(rlf_sub(e->corner[1].p, e->corner[0].p));
            u = rlf_perpendicular(along);
            v = rlf_cross(along, u);
        } else if (e->corner_count == 3) {
            u = rlf_cross(rlf_sub(e->corner[1].p, e->corner[0].p),
                          rlf_sub(e->corner[2].p, e->corner[0].p));
        }
        if (!add_off(e, a, b, u) && !add_off(e, a, b, rlf_neg(u)) && !add_off(e, a, b, v) &&
            !add_off(e, a, b, rlf_neg(v)) && !add_off(e, a, b, rlf_vec3_make(0, 0, 1)) &&
            !add_off(e, a, b, rlf_vec3_make(0, 0, -1))) {
            return false;
        }
    }
    return true;
}

/* A face whose corners are in a line looks nowhere and is not asked: its neighbours say what it
 * would. */
static void add_face(epa_polytope *e, int32_t i, int32_t j, int32_t k)
{
    rlf_vec3 a = e->corner[i].p, ab = rlf_sub(e->corner[j].p, a), ac = rlf_sub(e->corner[k].p, a);
    rlf_vec3 n = rlf_cross(ab, ac);
    double length = rlf_length(n);
    if (e->face_count < FACES_MAX) {
        epa_face *face = &e->face[e->face_count++];
        *face = (epa_face){{i, j, k}, {0, 0, 0}, 1e30};
        if (length > IN_LINE * rlf_length(ab) * rlf_length(ac)) {
            face->normal = rlf_scale(n, 1.0 / length);
            face->distance = rlf_dot(face->normal, a);
        }
    }
}

static void close_tetrahedron(epa_polytope *e)
{
    rlf_vec3 a = e->corner[0].p;
    rlf_vec3 n = rlf_cross(rlf_sub(e->corner[1].p, a), rlf_sub(e->corner[2].p, a));
    bool is_above = rlf_dot(n, rlf_sub(e->corner[3].p, a)) > 0.0;
    int32_t j = is_above ? 2 : 1, k = is_above ? 1 : 2;
    add_face(e, 0, j, k);
    add_face(e, 0, 3, j);
    add_face(e, 0, k, 3);
    add_face(e, 3, k, j);
}

/* An edge between two faces that go is none of the hole's. False when there is no room. */
static bool open_edge(epa_polytope *e, int32_t from, int32_t to)
{
    for (int32_t i = 0; i < e->edge_count; i++) {
        if (e->edge[i].from == to && e->edge[i].to == from) {
            e->edge[i] = e->edge[--e->edge_count];
            return true;
        }
    }
    if (e->edge_count == EDGES_MAX) {
        return false;
    }
    e->edge[e->edge_count++] = (epa_edge){from, to};
    return true;
}

/* Takes away what the new corner sees and joins the hole to it. */
static bool grow(epa_polytope *e, const convex_corner *corner)
{
    if (e->corner_count == CORNERS_MAX) {
        return false;
    }
    int32_t fresh = e->corner_count++;
    e->corner[fresh] = *corner;
    e->edge_count = 0;
    bool has_room = true;
    for (int32_t i = e->face_count - 1; i >= 0; i--) {
        const epa_face face = e->face[i];
        rlf_vec3 to = rlf_sub(corner->p, e->corner[face.corner[0]].p);
        if (rlf_dot(face.normal, to) > IN_PLANE) {
            for (int32_t k = 0; k < 3; k++) {
                has_room &= open_edge(e, face.corner[k], face.corner[(k + 1) % 3]);
            }
            e->face[i] = e->face[--e->face_count];
        }
    }
    has_room &= e->face_count + e->edge_count <= FACES_MAX;
    for (int32_t i = 0; i < e->edge_count && has_room; i++) {
        add_face(e, e->edge[i].from, e->edge[i].to, fresh);
    }
    return has_room;
}

static epa_face nearest_face(const epa_polytope *e)
{
    int32_t best = 0;
    for (int32_t i = 1; i < e->face_count; i++) {
        best = e->face[i].distance < e->face[best].distance ? i : best;
    }
    return e->face[best];
}

/* The point of the face under the origin, by its shares of the face's area. */
static void tell(const epa_polytope *e, const epa_face *face, convex_gap *out)
{
    const convex_corner *corner[3];
    for (int32_t i = 0; i < 3; i++) {
        corner[i] = &e->corner[face->corner[i]];
    }
    rlf_vec3 foot = rlf_scale(face->normal, face->distance);
    double share[3], sum = 0.0;
    for (int32_t i = 0; i < 3; i++) {
        rlf_vec3 p = corner[(i + 1) % 3]->p, q = corner[(i + 2) % 3]->p;
        rlf_vec3 area = rlf_cross(rlf_sub(q, p), rlf_sub(foot, p));
        share[i] = rlf_max(rlf_dot(face->normal, area), 0.0);
        sum += share[i];
    }
    *out = (convex_gap){.normal = rlf_neg(face->normal), .distance = -face->distance};
    for (int32_t i = 0; i < 3; i++) {
        double weight = sum > 0.0 ? share[i] / sum : 1.0 / 3.0;
        out->on_a = rlf_mad(out->on_a, corner[i]->on_a, weight);
        out->on_b = rlf_mad(out->on_b, corner[i]->on_b, weight);
    }
}

static bool is_curved(const convex_core *core)
{
    return core->shape->type == RLF_SHAPE_CYLINDER;
}

/* Faces of a polytope lie on something curved in a few corners only. Moved apart along the way out
 * that was found, the nearest points tell it anew, nearer to the true one by the share that they
 * are apart of the curvature's radius. */
static void polish(const convex_core *a, const convex_core *b, convex_gap *gap)
{
    convex_core moved = *a;
    rlf_vec3 way = rlf_scale(gap->normal, APART - gap->distance);
    moved.at = rlf_add(a->at, way);
    convex_gap apart;
    convex_simplex simplex;
    if (convex_distance(&moved, b, 1e30, &apart, &simplex)) {
        *gap = apart;
        gap->on_a = rlf_sub(apart.on_a, way);
        gap->distance = apart.distance - rlf_dot(apart.normal, way);
    }
}

bool convex_depth(const convex_core *a, const convex_core *b, const convex_simplex *simplex,
                  convex_gap *out)
{
    epa_polytope e;
    if (!start(&e, a, b, simplex)) {
        return false;
    }
    close_tetrahedron(&e);
    bool is_any_curved = is_curved(a) || is_curved(b);
    double on_face = is_any_curved ? ON_CURVED_FACE : ON_FACE;
    epa_face face = nearest_face(&e);
    while (true) {
        const convex_corner corner = convex_difference(a, b, face.normal);
        double farther = rlf_dot(face.normal, corner.p) - face.distance;
        if (farther <= on_face + ON_FACE_SHARE * face.distance || !grow(&e, &corner)) {
            break;
        }
        const epa_face next = nearest_face(&e);
        if (next.distance < face.distance - THIN) {
            break; /* what grows comes no nearer: rounding made a hole in it */
        }
        face = next;
    }
    tell(&e, &face, out);
    for (int32_t i = 0; i < POLISHES && is_any_curved; i++) {
        polish(a, b, out);
    }
    return true;
}
