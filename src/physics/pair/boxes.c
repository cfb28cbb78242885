/* Box against box: separating axes, then the incident face clipped to the reference face
 * (Gottschalk, Lin and Manocha 1996; Ericson 2005, 5.5). */
#include "physics/pair/collide.h"

typedef struct box {
    rlf_vec3 centre;
    rlf_vec3 axis[3];
    double half[3];
} box;

/* Axis of least penetration, unit, from b to a; code 0..2 face of a, 3..5 face of b, 6..14 edges.
 */
typedef struct sat_result {
    double separation;
    rlf_vec3 normal;
    int32_t code;
} sat_result;

static box box_of(const phys_body *body)
{
    const rlf_mat3 *R = &body->R;
    rlf_vec3 size = body->shape.shape.size;
    box b = {.centre = body->x, .half = {0.5 * size.x, 0.5 * size.y, 0.5 * size.z}};
    for (int32_t i = 0; i < 3; i++) {
        b.axis[i] = rlf_vec3_make(R->m[0][i], R->m[1][i], R->m[2][i]);
    }
    return b;
}

/* A face gives a whole patch, so an edge pair must be clearly better. */
static double edge_gain(double half)
{
    return 0.01 * half + 1e-4;
}

void pair_boxes_load(const phys_body *a, const phys_body *b, double margin, int32_t lane,
                     rlf_sat_pairs *out)
{
    const rlf_vec3 size_a = a->shape.shape.size, size_b = b->shape.shape.size;
    const double half_a[3] = {0.5 * size_a.x, 0.5 * size_a.y, 0.5 * size_a.z};
    const double half_b[3] = {0.5 * size_b.x, 0.5 * size_b.y, 0.5 * size_b.z};
    rlf_vec3 way = rlf_sub(a->x, b->x);
    for (int32_t i = 0; i < 3; i++) {
        for (int32_t k = 0; k < 3; k++) {
            out->axis_a[i][k][lane] = a->R.m[k][i];
            out->axis_b[i][k][lane] = b->R.m[k][i];
        }
        out->half_a[i][lane] = half_a[i];
        out->half_b[i][lane] = half_b[i];
    }
    out->way[0][lane] = way.x;
    out->way[1][lane] = way.y;
    out->way[2][lane] = way.z;
    out->margin[lane] = margin;
    out->edge_gain[lane] = edge_gain(half_a[0]);
}

static sat_result best_face(const box *a, const box *b, const rlf_sat_axes *axes, int32_t lane)
{
    sat_result best = {.separation = axes->gap[lane], .code = (int32_t)axes->code[lane]};
    best.normal = best.code < 3 ? a->axis[best.code] : b->axis[best.code - 3];
    best.normal = axes->sign[lane] < 0.0 ? rlf_neg(best.normal) : best.normal;
    return best;
}

/* Looks at the edges that may be better than the best face: a_i x b_k is of length
 * sqrt(1 - (a_i.b_k)^2). */
static void try_edges(const box *a, const box *b, const rlf_sat_axes *axes, int32_t lane,
                      sat_result *best)
{
    double gain = edge_gain(a->half[0]);
    int32_t edges = (int32_t)axes->edges[lane];
    for (int32_t n = 0; n < 9; n++) {
        double cosine = axes->cosine[n][lane], length2 = 1.0 - cosine * cosine;
        if ((edges >> n & 1) == 0 || length2 < 1e-6) {
            continue;
        }
        double scale = 1.0 / sqrt(length2), separation = axes->edge_gap[n][lane] * scale;
        if (!(separation <= best->separation + gain)) {
            best->separation = separation;
            best->code = 6 + n;
            rlf_vec3 axis = rlf_cross(a->axis[n / 3], b->axis[n % 3]);
            best->normal = rlf_scale(axis, axes->edge_along[n][lane] < 0.0 ? -scale : scale);
        }
    }
}

/* Corner of b farthest along n, but for its axis `skip`, which is left at the middle. */
static rlf_vec3 edge_middle(const box *b, rlf_vec3 n, int32_t skip)
{
    rlf_vec3 p = b->centre;
    for (int32_t i = 0; i < 3; i++) {
        if (i != skip) {
            p = rlf_mad(p, b->axis[i], rlf_dot(b->axis[i], n) < 0 ? -b->half[i] : b->half[i]);
        }
    }
    return p;
}

/* Closest points of the two edges' lines. */
static int32_t edge_contact(const box *a, const box *b, const sat_result *sat, pair_point *out)
{
    int32_t i = (sat->code - 6) / 3, k = (sat->code - 6) % 3;
    rlf_vec3 p = edge_middle(a, rlf_neg(sat->normal), i);
    rlf_vec3 q = edge_middle(b, sat->normal, k);
    rlf_vec3 u = a->axis[i], v = b->axis[k];
    rlf_vec3 d = rlf_sub(p, q);
    double uv = rlf_dot(u, v), ud = rlf_dot(u, d), vd = rlf_dot(v, d);
    double determinant = 1.0 - uv * uv;
    double s = (uv * vd - ud) / determinant;
    double t = (vd - uv * ud) / determinant;
    out->core_a = rlf_mad(p, u, rlf_clamp(s, -a->half[i], a->half[i]));
    out->core_b = rlf_mad(q, v, rlf_clamp(t, -b->half[k], b->half[k]));
    out->normal = sat->normal;
    out->rounding_a = out->rounding_b = 0.0;
    out->separation = rlf_dot(sat->normal, rlf_sub(out->core_a, out->core_b));
    return 1;
}

/* The face of `b` that looks most against n. */
static void incident_face(const box *b, rlf_vec3 n, rlf_vec3 out[4])
{
    int32_t axis = 0;
    double best = 0.0;
    for (int32_t i = 0; i < 3; i++) {
        double d = rlf_dot(b->axis[i], n);
        if (d * d > best) {
            best = d * d;
            axis = i;
        }
    }
    int32_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    double side = rlf_dot(b->axis[axis], n) > 0 ? -b->half[axis] : b->half[axis];
    rlf_vec3 centre = rlf_mad(b->centre, b->axis[axis], side);
    for (int32_t i = 0; i < 4; i++) {
        double su = i == 0 || i == 3 ? -b->half[u] : b->half[u];
        double sv = i < 2 ? -b->half[v] : b->half[v];
        out[i] = rlf_mad(rlf_mad(centre, b->axis[u], su), b->axis[v], sv);
    }
}

/* `ref` owns the face with outward normal n = +-axis[face]. */
static int32_t face_contacts(const box *ref, const box *other, rlf_vec3 n, int32_t face,
                             double margin, bool ref_is_a, pair_point *out)
{
    rlf_vec3 buffers[2][16], *polygon = buffers[0], *clipped = buffers[1];
    incident_face(other, n, polygon);
    int32_t count = 4;
    for (int32_t side = 0; side < 4; side++) {
        int32_t axis = (face + 1 + side / 2) % 3;
        rlf_vec3 m = side % 2 == 0 ? ref->axis[axis] : rlf_neg(ref->axis[axis]);
        count = pair_clip(polygon, count, m, rlf_dot(m, ref->centre) + ref->half[axis], clipped);
        rlf_vec3 *swap = polygon;
        polygon = clipped;
        clipped = swap;
    }
    double offset = rlf_dot(n, ref->centre) + ref->half[face];
    int32_t kept = 0;
    for (int32_t i = 0; i < count; i++) {
        double separation = rlf_dot(n, polygon[i]) - offset;
        if (separation > margin) {
            continue;
        }
        rlf_vec3 on_ref = rlf_mad(polygon[i], n, -separation);
        pair_point *p = &out[kept++];
        p->core_a = ref_is_a ? on_ref : polygon[i];
        p->core_b = ref_is_a ? polygon[i] : on_ref;
        p->rounding_a = p->rounding_b = 0.0;
        p->normal = ref_is_a ? rlf_neg(n) : n;
        p->separation = separation;
    }
    return kept;
}

static phys_side side_of(const sat_result *sat, const box *a, const box *b)
{
    if (sat->code >= 6) {
        return (phys_side){.of = PHYS_SIDE_NONE};
    }
    bool is_of_a = sat->code < 3;
    int32_t axis = sat->code % 3;
    double along = rlf_dot(sat->normal, (is_of_a ? a : b)->axis[axis]);
    return (phys_side){is_of_a ? PHYS_SIDE_OF_A : PHYS_SIDE_OF_B, axis, along < 0.0 ? -1.0 : 1.0};
}

int32_t pair_collide_boxes(const phys_body *body_a, const phys_body *body_b, double margin,
                           const rlf_sat_axes *axes, int32_t lane, pair_point *out, double *out_gap,
                           phys_side *out_side)
{
    *out_gap = axes->gap[lane];
    if (*out_gap > margin) {
        return 0;
    }
    box a = box_of(body_a), b = box_of(body_b);
    sat_result sat = best_face(&a, &b, axes, lane);
    try_edges(&a, &b, axes, lane, &sat);
    *out_gap = sat.separation;
    if (sat.separation > margin) {
        return 0;
    }
    *out_side = side_of(&sat, &a, &b);
    if (sat.code >= 6) {
        return edge_contact(&a, &b, &sat, out);
    }
    if (sat.code < 3) {
        return face_contacts(&a, &b, rlf_neg(sat.normal), sat.code, margin, true, out);
    }
    return face_contacts(&b, &a, sat.normal, sat.code - 3, margin, false, out);
}
