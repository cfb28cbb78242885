/* Any convex shape against any other: the direction in which they are nearest, or least deep, then
 * all points in which their faces touch along it. */
#include "physics/pair/collide.h"
#include "physics/shape/convex.h"

/* Cosines: a face that looks more aside than this touches with an edge or a corner alone; two edges
 * that are not as parallel cross in a point; a cylinder as level rolls about its axis. */
#define FACING 0.9
#define PARALLEL 0.999
/* The other body's face is the reference only where it looks clearly better along the normal. */
#define PREFERENCE 1e-3

/* The two faces of a touch, the reference and the one that is cut to it. */
typedef struct touching {
    rlf_vec3 normal; /* from b to a */
    double margin;
    const pair_face *reference, *incident;
    bool is_reference_a;
    pair_point *out;
    int32_t count;
} touching;

static void add(touching *t, rlf_vec3 on_reference, rlf_vec3 on_incident)
{
    pair_point p = {.core_a = t->is_reference_a ? on_reference : on_incident,
                    .core_b = t->is_reference_a ? on_incident : on_reference,
                    .normal = t->normal};
    const pair_face *a = t->is_reference_a ? t->reference : t->incident;
    const pair_face *b = t->is_reference_a ? t->incident : t->reference;
    p.rounding_a = a->rounding;
    p.rounding_b = b->rounding;
    p.separation = rlf_dot(p.normal, rlf_sub(p.core_a, p.core_b)) - p.rounding_a - p.rounding_b;
    if (p.separation <= t->margin) {
        t->out[t->count++] = p;
    }
}

/* The incident face's part before the reference polygon. Two convex faces leave no more corners
 * than they have together; where corners lie in a line rounding may add half as many in a cut. */
static void touch_polygon(touching *t)
{
    const pair_face *r = t->reference;
    rlf_vec3 buffers[2][3 * PAIR_FACE_MAX];
    int32_t count = t->incident->count, now = 0;
    for (int32_t i = 0; i < count; i++) {
        buffers[0][i] = t->incident->corner[i];
    }
    for (int32_t i = 0; i < r->count && count <= 2 * PAIR_FACE_MAX; i++) {
        rlf_vec3 p = r->corner[i], q = r->corner[i + 1 < r->count ? i + 1 : 0];
        rlf_vec3 side = rlf_cross(rlf_sub(q, p), r->normal);
        count = pair_clip(buffers[now], count, side, rlf_dot(side, p), buffers[1 - now]);
        now = 1 - now;
    }
    double slope = rlf_dot(r->normal, t->normal);
    for (int32_t i = 0; i < count; i++) {
        rlf_vec3 p = buffers[now][i];
        double height = rlf_dot(r->normal, rlf_sub(r->corner[0], p));
        add(t, rlf_mad(p, t->normal, height / slope), p);
    }
}

/* Where an edge runs along another. */
static void touch_edge(touching *t)
{
    const pair_face *r = t->reference, *o = t->incident;
    rlf_vec3 way = rlf_sub(r->corner[1], r->corner[0]), other = rlf_sub(o->corner[1], o->corner[0]);
    double length2 = rlf_dot(way, way), along = rlf_dot(way, other);
    if (along * along < PARALLEL * PARALLEL * length2 * rlf_dot(other, other)) {
        return;
    }
    for (int32_t i = 0; i < 2; i++) {
        double place = rlf_dot(way, rlf_sub(o->corner[i], r->corner[0])) / length2;
        double inside = rlf_clamp(place, 0.0, 1.0);
        rlf_vec3 p = rlf_mad(o->corner[i], other, (inside - place) * length2 / along);
        add(t, rlf_mad(r->corner[0], way, inside), p);
    }
}

static void touch_faces(touching *t, const pair_face *a, const pair_face *b)
{
    double facing_a = a->count > 2 ? -rlf_dot(a->normal, t->normal) : 0.0;
    double facing_b = b->count > 2 ? rlf_dot(b->normal, t->normal) : 0.0;
    t->is_reference_a = facing_b <= facing_a + PREFERENCE;
    t->reference = t->is_reference_a ? a : b;
    t->incident = t->is_reference_a ? b : a;
    if (t->incident->count < 2) {
        return;
    }
    if (rlf_max(facing_a, facing_b) > FACING) {
        touch_polygon(t);
    } else if (a->count == 2 && b->count == 2) {
        touch_edge(t);
    }
}

/* From a core to where a face of that body has its corners: to the axis of what rolls. */
static double inward_of(const phys_body *body, const pair_face *face)
{
    return face->count == 2 ? face->rounding - convex_rounding(&body->shape.shape) : 0.0;
}

/* The nearest points themselves. */
static void add_nearest(touching *t, const convex_gap *gap, const phys_body *a, const phys_body *b,
                        const pair_face *face_a, const pair_face *face_b)
{
    double in_a = inward_of(a, face_a), in_b = inward_of(b, face_b);
    pair_point *p = &t->out[t->count++];
    p->core_a = rlf_mad(rlf_add(gap->on_a, a->x), gap->normal, in_a);
    p->core_b = rlf_mad(rlf_add(gap->on_b, a->x), gap->normal, -in_b);
    p->normal = gap->normal;
    p->rounding_a = in_a + convex_rounding(&a->shape.shape);
    p->rounding_b = in_b + convex_rounding(&b->shape.shape);
    p->separation =
        rlf_dot(p->normal, rlf_sub(p->core_a, p->core_b)) - p->rounding_a - p->rounding_b;
}

int32_t pair_collide_convex(const phys_body *a, const phys_body *b, double margin, pair_point *out,
                            double *out_gap)
{
    rlf_vec3 between = rlf_sub(b->x, a->x);
    *out_gap = rlf_length(between) - a->shape.radius - b->shape.radius;
    if (*out_gap > margin) {
        return 0;
    }
    const convex_core core_a = {&a->shape.shape, a->R, {0, 0, 0}};
    const convex_core core_b = {&b->shape.shape, b->R, between};
    double rounding = convex_rounding(&a->shape.shape) + convex_rounding(&b->shape.shape);
    convex_gap gap;
    convex_simplex simplex;
    if (!convex_distance(&core_a, &core_b, margin + rounding, &gap, &simplex) &&
        !convex_depth(&core_a, &core_b, &simplex, &gap)) {
        return 0;
    }
    *out_gap = gap.distance - rounding;
    if (*out_gap > margin) {
        return 0;
    }
    pair_face face_a, face_b;
    pair_face_of(a, rlf_neg(gap.normal), &face_a);
    pair_face_of(b, gap.normal, &face_b);
    touching t = {.normal = gap.normal, .margin = margin, .out = out};
    touch_faces(&t, &face_a, &face_b);
    add_nearest(&t, &gap, a, b, &face_a, &face_b);
    return t.count;
}
