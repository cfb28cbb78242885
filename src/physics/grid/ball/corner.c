/* The nearest place of a convex corner.
 *
 * Where two or three seen faces meet, their planes say where the edge and the corner are to a
 * fraction of a pixel, also where the pixels beside the edge are wrong. A ball touches the solid
 * behind all of them where that comes nearest to its centre: on a face, on an edge or in the
 * corner. */
#include "physics/grid/ball/ball.h"

#define TRIES 4         /* planes that are looked for */
#define BESIDE_PX 2     /* of the place that is touched the faces are seen, steps */
#define INSIDE_M 1e-6   /* rounding, metres */
#define INDEPENDENT 0.1 /* least sine of an angle between planes that meet */

static double height_over(const patch_plane *plane, rlf_vec3 p)
{
    return rlf_dot(plane->normal, rlf_sub(p, plane->point));
}

/* Whether two faces bend away from each other: each is seen below the other's plane. */
static bool is_convex(const patch_plane *a, const patch_plane *b)
{
    return rlf_dot(a->normal, b->normal) < APART_COS && height_over(a, b->point) < 0.0 &&
           height_over(b, a->point) < 0.0;
}

static void find_faces(const grid_patch *p, const patch_mean *face, patch_corner *out)
{
    rlf_vec3 tried[TRIES] = {face->normal};
    out->faces[0] = (patch_plane){face->normal, face->point, 0.0};
    out->count = 1;
    for (int32_t i = 1; i < TRIES && out->count < CORNER_FACES; i++) {
        patch_plane *plane = &out->faces[out->count];
        if (!plane_find(p, p->samples[p->nearest].point, GRID_THIN_M, tried, i, plane)) {
            return;
        }
        tried[i] = plane->normal;
        bool is_part = true;
        for (int32_t k = 0; k < out->count; k++) {
            is_part = is_part && is_convex(&out->faces[k], plane);
        }
        out->count += is_part;
    }
}

/* The place on all faces of the set that is nearest to c. False where there is none. */
static bool meet(const patch_corner *corner, const int32_t *set, int32_t count, rlf_vec3 c,
                 rlf_vec3 *out)
{
    const patch_plane *a = &corner->faces[set[0]], *b = &corner->faces[set[count > 1]];
    double up_a = -height_over(a, c), up_b = -height_over(b, c);
    if (count == 1) {
        *out = rlf_mad(c, a->normal, up_a);
        return true;
    }
    double cosine = rlf_dot(a->normal, b->normal), sine2 = 1.0 - cosine * cosine;
    rlf_vec3 along = rlf_cross(a->normal, b->normal);
    if (sine2 < INDEPENDENT * INDEPENDENT) {
        return false;
    }
    *out = rlf_mad(c, a->normal, (up_a - cosine * up_b) / sine2);
    *out = rlf_mad(*out, b->normal, (up_b - cosine * up_a) / sine2);
    if (count == 2) {
        return true;
    }
    const patch_plane *third = &corner->faces[set[2]];
    double slope = rlf_dot(third->normal, along);
    *out = rlf_mad(*out, along, -height_over(third, *out) / slope);
    return slope > INDEPENDENT || slope < -INDEPENDENT;
}

/* The faces of a subset of three, by its bits. */
static int32_t list_faces(uint32_t bits, int32_t *set)
{
    int32_t count = 0;
    for (int32_t i = 0; i < CORNER_FACES; i++) {
        if ((bits >> i & 1u) != 0) {
            set[count++] = i;
        }
    }
    return count;
}

static bool is_behind_all(const patch_corner *corner, rlf_vec3 q)
{
    for (int32_t i = 0; i < corner->count; i++) {
        if (height_over(&corner->faces[i], q) > INSIDE_M) {
            return false;
        }
    }
    return true;
}

/* The nearest place and the faces on which it is, as bits; none where `centre` is inside. */
static uint32_t project(const patch_corner *corner, rlf_vec3 centre, rlf_vec3 *out)
{
    double best2 = 1e30;
    uint32_t best = 0;
    *out = centre;
    if (is_behind_all(corner, centre)) {
        return 0;
    }
    for (uint32_t bits = 1; bits < 1u << corner->count; bits++) {
        int32_t set[CORNER_FACES];
        rlf_vec3 q;
        if (meet(corner, set, list_faces(bits, set), centre, &q) && is_behind_all(corner, q)) {
            rlf_vec3 d = rlf_sub(q, centre);
            best = rlf_dot(d, d) < best2 ? bits : best;
            *out = best == bits ? q : *out;
            best2 = rlf_min(best2, rlf_dot(d, d));
        }
    }
    return best;
}

/* Where the pixels near a place show a face: how far along an edge before and behind the place. */
typedef struct seen_span {
    double from, to;
    bool is_any;
} seen_span;

static seen_span span_of(const grid_patch *p, const patch_plane *face, rlf_vec3 q,
                         const double at[2], rlf_vec3 along)
{
    seen_span span = {0.0, 0.0, false};
    double beside = BESIDE_PX * p->step + 0.5;
    for (int32_t i = 0; i < p->count; i++) {
        const patch_sample *s = &p->samples[i];
        double du = s->cell.x - at[0], dv = s->cell.y - at[1];
        if (du <= beside && du >= -beside && dv <= beside && dv >= -beside &&
            plane_holds(face, s)) {
            double t = rlf_dot(along, rlf_sub(s->point, q));
            span.from = span.is_any ? rlf_min(span.from, t) : t;
            span.to = span.is_any ? rlf_max(span.to, t) : t;
            span.is_any = true;
        }
    }
    return span;
}

/* Whether the faces of the set are seen beside q, and two of them on both sides of it along their
 * edge. The first face alone is none: the ball is beyond its end. */
static bool is_seen(const grid_patch *p, const patch_corner *corner, uint32_t bits, rlf_vec3 q)
{
    const rlf_grid *grid = p->job->query->grid;
    int32_t set[CORNER_FACES], count = list_faces(bits, set);
    double at[2], from = 0.0, to = 0.0;
    if (bits < 2 || !(q.z > 0.0) || !grid->project(grid->project_context, q, &at[0], &at[1])) {
        return false;
    }
    rlf_vec3 along = rlf_cross(corner->faces[set[0]].normal, corner->faces[set[count > 1]].normal);
    for (int32_t i = 0; i < count; i++) {
        seen_span span = span_of(p, &corner->faces[set[i]], q, at, along);
        if (!span.is_any) {
            return false;
        }
        from = rlf_min(from, span.from);
        to = rlf_max(to, span.to);
    }
    return count != 2 || (from < 0.0 && to > 0.0);
}

bool corner_find(const grid_patch *p, const patch_mean *face, patch_corner *out)
{
    rlf_vec3 q;
    find_faces(p, face, out);
    uint32_t on = out->count > 1 ? project(out, p->centre, &q) : 0;
    if (on == 0 || !is_seen(p, out, on, q)) {
        out->count = 0;
    }
    return out->count > 1;
}

rlf_vec3 corner_nearest(const patch_corner *corner, rlf_vec3 centre)
{
    rlf_vec3 q;
    (void)project(corner, centre, &q);
    return q;
}
