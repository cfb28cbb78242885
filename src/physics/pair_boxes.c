/* Box against box: separating axes, then the incident face clipped to the reference face
 * (Gottschalk, Lin and Manocha 1996; Ericson 2005, 5.5). */
#include "physics/pair_collide.h"

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

/* The boxes' axes in each other's: c[i][k] = a_i.b_k, and the way between the centres along each.
 */
typedef struct sat_frame {
    const box *a, *b;
    rlf_vec3 way; /* from b to a */
    double c[3][3], abs_c[3][3];
    double along_a[3], along_b[3];
} sat_frame;

static double magnitude(double x)
{
    return x < 0.0 ? -x : x;
}

static sat_frame sat_frame_of(const box *a, const box *b)
{
    sat_frame f = {.a = a, .b = b, .way = rlf_sub(a->centre, b->centre)};
    for (int32_t i = 0; i < 3; i++) {
        f.along_a[i] = rlf_dot(f.way, a->axis[i]);
        f.along_b[i] = rlf_dot(f.way, b->axis[i]);
        for (int32_t k = 0; k < 3; k++) {
            f.c[i][k] = rlf_dot(a->axis[i], b->axis[k]);
            f.abs_c[i][k] = magnitude(f.c[i][k]);
        }
    }
    return f;
}

/* A face gives a whole patch, so an edge pair must be clearly better, a later face slightly. */
static double preference_of(const sat_frame *f, int32_t code)
{
    return code >= 6 ? 0.01 * f->a->half[0] + 1e-4 : (code > 0 ? 1e-6 : 0.0);
}

/* Takes the axis when it is better. */
static bool is_better(const sat_frame *f, double separation, int32_t code, sat_result *best)
{
    if (separation <= best->separation + preference_of(f, code)) {
        return false;
    }
    best->separation = separation;
    best->code = code;
    return true;
}

static void try_faces(const sat_frame *f, sat_result *best)
{
    const double *ha = f->a->half, *hb = f->b->half;
    for (int32_t i = 0; i < 3; i++) {
        double reach =
            ha[i] + hb[0] * f->abs_c[i][0] + hb[1] * f->abs_c[i][1] + hb[2] * f->abs_c[i][2];
        if (is_better(f, magnitude(f->along_a[i]) - reach, i, best)) {
            best->normal = f->along_a[i] < 0.0 ? rlf_neg(f->a->axis[i]) : f->a->axis[i];
        }
    }
    for (int32_t k = 0; k < 3; k++) {
        double reach =
            hb[k] + ha[0] * f->abs_c[0][k] + ha[1] * f->abs_c[1][k] + ha[2] * f->abs_c[2][k];
        if (is_better(f, magnitude(f->along_b[k]) - reach, 3 + k, best)) {
            best->normal = f->along_b[k] < 0.0 ? rlf_neg(f->b->axis[k]) : f->b->axis[k];
        }
    }
}

/* a_i x b_k = c[i1][k] a_i2 - c[i2][k] a_i1, of length sqrt(1 - c[i][k]^2). */
static void try_edges(const sat_frame *f, sat_result *best)
{
    const double *ha = f->a->half, *hb = f->b->half;
    for (int32_t n = 0; n < 9; n++) {
        int32_t i = n / 3, k = n % 3;
        int32_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
        double length2 = 1.0 - f->c[i][k] * f->c[i][k];
        if (length2 < 1e-6) {
            continue;
        }
        double along = f->c[i1][k] * f->along_a[i2] - f->c[i2][k] * f->along_a[i1];
        double reach = ha[i1] * f->abs_c[i2][k] + ha[i2] * f->abs_c[i1][k] +
                       hb[k1] * f->abs_c[i][k2] + hb[k2] * f->abs_c[i][k1];
        double gap = magnitude(along) - reach; /* times the length, which is no more than 1 */
        if (gap < 0.0 && gap <= best->separation + preference_of(f, 6 + n)) {
            continue;
        }
        double scale = 1.0 / sqrt(length2);
        if (is_better(f, gap * scale, 6 + n, best)) {
            rlf_vec3 axis = rlf_cross(f->a->axis[i], f->b->axis[k]);
            best->normal = rlf_scale(axis, along < 0.0 ? -scale : scale);
        }
    }
}

/* Stops at the first kind of axis that shows a gap above `margin`. */
static sat_result separate(const box *a, const box *b, double margin)
{
    sat_result best = {.separation = -1e30};
    sat_frame f = sat_frame_of(a, b);
    try_faces(&f, &best);
    if (best.separation <= margin) {
        try_edges(&f, &best);
    }
    return best;
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

/* Sutherland and Hodgman 1974: keeps the polygon's part with n.p <= d. */
static int32_t clip(const rlf_vec3 *in, int32_t count, rlf_vec3 n, double d, rlf_vec3 *out)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < count; i++) {
        rlf_vec3 p = in[i], q = in[i + 1 < count ? i + 1 : 0];
        double dp = rlf_dot(n, p) - d, dq = rlf_dot(n, q) - d;
        if (dp <= 0.0) {
            out[kept++] = p;
        }
        if ((dp < 0.0 && dq > 0.0) || (dp > 0.0 && dq < 0.0)) {
            out[kept++] = rlf_mad(p, rlf_sub(q, p), dp / (dp - dq));
        }
    }
    return kept;
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
        count = clip(polygon, count, m, rlf_dot(m, ref->centre) + ref->half[axis], clipped);
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
                           pair_point *out, double *out_gap, phys_side *out_side)
{
    box a = box_of(body_a), b = box_of(body_b);
    sat_result sat = separate(&a, &b, margin);
    *out_gap = sat.separation;
    *out_side = side_of(&sat, &a, &b);
    if (sat.separation > margin) {
        return 0;
    }
    if (sat.code >= 6) {
        return edge_contact(&a, &b, &sat, out);
    }
    if (sat.code < 3) {
        return face_contacts(&a, &b, rlf_neg(sat.normal), sat.code, margin, true, out);
    }
    return face_contacts(&b, &a, sat.normal, sat.code - 3, margin, false, out);
}
