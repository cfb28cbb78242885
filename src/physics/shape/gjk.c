/* Distance of two convex cores: the origin's nearest point in their difference, searched with a
 * simplex of its corners (Gilbert, Johnson and Keerthi 1988). */
#include "physics/shape/convex.h"

#define STEPS_MAX 64
#define TOUCH2 1e-18  /* m^2: nearer than that they touch */
#define PROGRESS 1e-8 /* of the distance: what a further corner must gain */

/* Keeps those corners of `from` whose places are listed. */
static void keep(convex_simplex *s, const convex_simplex *from, int32_t count,
                 const int32_t *places, const double *weights)
{
    convex_simplex kept = {.count = count};
    for (int32_t i = 0; i < count; i++) {
        kept.corner[i] = from->corner[places[i]];
        kept.weight[i] = weights[i];
    }
    *s = kept;
}

static void nearest_of_edge(convex_simplex *s, const convex_simplex *from, int32_t i, int32_t k)
{
    rlf_vec3 a = from->corner[i].p, ab = rlf_sub(from->corner[k].p, a);
    double along = -rlf_dot(a, ab), length2 = rlf_dot(ab, ab);
    const int32_t places[2] = {i, k}, last[1] = {k};
    if (along <= 0.0 || length2 == 0.0) {
        keep(s, from, 1, places, (const double[1]){1.0});
    } else if (along >= length2) {
        keep(s, from, 1, last, (const double[1]){1.0});
    } else {
        double t = along / length2;
        keep(s, from, 2, places, (const double[2]){1.0 - t, t});
    }
}

/* Ericson 2005, 5.1.5, with the origin as the point. */
static void nearest_of_triangle(convex_simplex *s, const convex_simplex *from, int32_t i, int32_t j,
                                int32_t k)
{
    rlf_vec3 a = from->corner[i].p, b = from->corner[j].p, c = from->corner[k].p;
    rlf_vec3 ab = rlf_sub(b, a), ac = rlf_sub(c, a);
    double d1 = -rlf_dot(ab, a), d2 = -rlf_dot(ac, a);
    double d3 = -rlf_dot(ab, b), d4 = -rlf_dot(ac, b);
    double d5 = -rlf_dot(ab, c), d6 = -rlf_dot(ac, c);
    double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
        nearest_of_edge(s, from, i, j);
    } else if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
        nearest_of_edge(s, from, i, k);
    } else if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
        nearest_of_edge(s, from, j, k);
    } else if (d1 <= 0.0 && d2 <= 0.0) {
        keep(s, from, 1, (const int32_t[1]){i}, (const double[1]){1.0});
    } else if (d3 >= 0.0 && d4 <= d3) {
        keep(s, from, 1, (const int32_t[1]){j}, (const double[1]){1.0});
    } else if (d6 >= 0.0 && d5 <= d6) {
        keep(s, from, 1, (const int32_t[1]){k}, (const double[1]){1.0});
    } else {
        double scale = 1.0 / (va + vb + vc);
        keep(s, from, 3, (const int32_t[3]){i, j, k},
             (const double[3]){va * scale, vb * scale, vc * scale});
    }
}

static rlf_vec3 nearest_point(const convex_simplex *s)
{
    rlf_vec3 p = {0, 0, 0};
    for (int32_t i = 0; i < s->count; i++) {
        p = rlf_mad(p, s->corner[i].p, s->weight[i]);
    }
    return p;
}

/* The nearest of the faces that have the origin on their outer side; all four corners stay when
 * none has. A tetrahedron without volume holds nothing. */
static void nearest_of_tetrahedron(convex_simplex *s)
{
    static const int32_t FACES[4][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 3, 2, 0}};
    const convex_simplex from = *s;
    double best = -1.0;
    for (int32_t i = 0; i < 4; i++) {
        rlf_vec3 a = from.corner[FACES[i][0]].p;
        rlf_vec3 n = rlf_cross(rlf_sub(from.corner[FACES[i][1]].p, a),
                               rlf_sub(from.corner[FACES[i][2]].p, a));
        double origin = -rlf_dot(n, a), other = rlf_dot(n, rlf_sub(from.corner[FACES[i][3]].p, a));
        bool is_flat = other * other <= TOUCH2 * rlf_dot(n, n);
        if (origin * other > 0.0 && !is_flat) {
            continue;
        }
        convex_simplex face;
        nearest_of_triangle(&face, &from, FACES[i][0], FACES[i][1], FACES[i][2]);
        rlf_vec3 p = nearest_point(&face);
        double distance2 = rlf_dot(p, p);
        if (best < 0.0 || distance2 < best) {
            best = distance2;
            *s = face;
        }
    }
}

static void keep_nearest(convex_simplex *s)
{
    const convex_simplex from = *s;
    switch (s->count) {
    case 1: s->weight[0] = 1.0; break;
    case 2: nearest_of_edge(s, &from, 0, 1); break;
    case 3: nearest_of_triangle(s, &from, 0, 1, 2); break;
    default: nearest_of_tetrahedron(s); break;
    }
}

static bool has_corner(const convex_simplex *s, rlf_vec3 p)
{
    for (int32_t i = 0; i < s->count; i++) {
        rlf_vec3 d = rlf_sub(s->corner[i].p, p);
        if (rlf_dot(d, d) <= TOUCH2) {
            return true;
        }
    }
    return false;
}

static void tell(const convex_simplex *s, rlf_vec3 way, convex_gap *out)
{
    *out = (convex_gap){.distance = rlf_length(way)};
    for (int32_t i = 0; i < s->count; i++) {
        out->on_a = rlf_mad(out->on_a, s->corner[i].on_a, s->weight[i]);
        out->on_b = rlf_mad(out->on_b, s->corner[i].on_b, s->weight[i]);
    }
    out->normal = rlf_scale(way, 1.0 / out->distance);
}

bool convex_distance(const convex_core *a, const convex_core *b, double enough, convex_gap *out,
                     convex_simplex *simplex)
{
    rlf_vec3 between = rlf_sub(b->at, a->at);
    *simplex = (convex_simplex){.count = 1};
    simplex->corner[0] = convex_difference(a, b, between);
    simplex->weight[0] = 1.0;
    rlf_vec3 way = simplex->corner[0].p; /* from the origin to what is nearest so far */
    bool is_far = false;
    double along = 0.0;
    for (int32_t i = 0; i < STEPS_MAX; i++) {
        double distance2 = rlf_dot(way, way);
        if (distance2 <= TOUCH2) {
            return false;
        }
        convex_corner corner = convex_difference(a, b, rlf_neg(way));
        along = rlf_dot(way, corner.p); /* nothing is nearer than along / distance */
        is_far = along > 0.0 && along * along > enough * enough * distance2;
        if (is_far || distance2 - along <= PROGRESS * distance2 || has_corner(simplex, corner.p)) {
            break;
        }
        convex_simplex next = *simplex;
        next.corner[next.count++] = corner;
        keep_nearest(&next);
        rlf_vec3 nearer = nearest_point(&next);
        bool is_inside = next.count == 4;
        if (!is_inside && rlf_dot(nearer, nearer) >= distance2) {
            break; /* rounding */
        }
        *simplex = next;
        way = nearer;
        if (is_inside) {
            return false;
        }
    }
    tell(simplex, way, out);
    out->distance = is_far ? along / out->distance : out->distance;
    return true;
}

rlf_vec3 convex_nearest_of_triangle(const rlf_vec3 corner[3])
{
    convex_simplex all = {.count = 3}, nearest;
    for (int32_t i = 0; i < 3; i++) {
        all.corner[i].p = corner[i];
    }
    nearest_of_triangle(&nearest, &all, 0, 1, 2);
    return nearest_point(&nearest);
}
