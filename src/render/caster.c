/* Contact darkening and shadows of bodies. */
#include "render/caster.h"

#define REACH_MARGIN 1.001f /* rounding */
#define NEAREST_M 0.1       /* bodies around the camera would darken everything or nothing */

/* ---- bodies --------------------------------------------------------------------------------- */

static rlf_vec3 half_of_hull(const rlf_hull *hull)
{
    rlf_vec3 half = {0, 0, 0};
    for (int32_t i = 0; hull != NULL && i < hull->vertex_count; i++) {
        rlf_vec3 v = hull->vertices[i];
        half.x = rlf_max(half.x, v.x < 0.0 ? -v.x : v.x);
        half.y = rlf_max(half.y, v.y < 0.0 ? -v.y : v.y);
        half.z = rlf_max(half.z, v.z < 0.0 ? -v.z : v.z);
    }
    return half;
}

/* Inner box and rounding. A box is rounded a little so that its shadow's edge can be soft; a
 * cylinder's more, so as to fill no corners that are not there. */
static void set_shape(const rlf_shape *shape, caster *out)
{
    double r = shape->radius;
    rlf_vec3 half = rlf_scale(shape->size, 0.5);
    double share = 0.3; /* of the least half extent that is rounding */
    switch (shape->type) {
    case RLF_SHAPE_BOX: break;
    case RLF_SHAPE_SPHERE:
        half = rlf_vec3_make(r, r, r);
        share = 1.0;
        break;
    case RLF_SHAPE_CAPSULE:
        half = rlf_vec3_make(r, 0.5 * shape->height + r, r);
        share = 1.0;
        break;
    case RLF_SHAPE_CYLINDER:
        half = rlf_vec3_make(r, 0.5 * shape->height, r);
        share = 0.6;
        break;
    case RLF_SHAPE_HULL: half = half_of_hull(shape->hull); break;
    }
    double least = rlf_min(half.x, rlf_min(half.y, half.z));
    double round = share * least;
    double size = (half.x + half.y + half.z) / 3.0;
    out->half[0] = (float)(half.x - round);
    out->half[1] = (float)(half.y - round);
    out->half[2] = (float)(half.z - round);
    out->round = (float)round;
    out->crease = shape->type == RLF_SHAPE_HULL ? 0.0f : 1.0f;
    out->penumbra = (float)(CASTER_PENUMBRA * least);
    out->near_m = (float)(CASTER_NEAR * size);
    out->length_m = (float)(CASTER_LENGTH * size);
    out->radius = (float)rlf_shape_radius(shape);
}

/* Index of the vertex that is farthest along a direction. */
static int32_t farthest(const rlf_hull *hull, rlf_vec3 along)
{
    int32_t best = 0;
    for (int32_t i = 1; i < hull->vertex_count; i++) {
        const rlf_vec3 step = rlf_sub(hull->vertices[i], hull->vertices[best]);
        best = rlf_dot(step, along) > 0.0 ? i : best;
    }
    return best;
}

/* The outline of a hull across the light, through vertices that are farthest in CASTER_EDGES
 * directions; l is to the light, body frame. */
static void set_outline(const rlf_hull *hull, const rlf_mat3 *R, rlf_vec3 l, caster *out)
{
    const rlf_vec3 aside = l.x * l.x < 0.5 ? rlf_vec3_make(1, 0, 0) : rlf_vec3_make(0, 1, 0);
    const rlf_vec3 across = rlf_normalize(rlf_cross(aside, l));
    const rlf_vec3 down = rlf_cross(l, across);
    int32_t corner[CASTER_EDGES + 1];
    for (int k = 0; k <= CASTER_EDGES; k++) {
        const double turn = 2.0 * RLF_PI * (k % CASTER_EDGES) / CASTER_EDGES;
        corner[k] = farthest(hull, rlf_mad(rlf_scale(across, rlf_cos(turn)), down, rlf_sin(turn)));
    }
    for (int k = 0; k < CASTER_EDGES; k++) {
        const rlf_vec3 from = hull->vertices[corner[k]];
        rlf_vec3 n = rlf_cross(rlf_sub(hull->vertices[corner[k + 1]], from), l);
        const double length = rlf_length(n);
        if (length > 1e-6) { /* else they are before each other */
            float *edge = out->edge[out->edge_count++];
            n = rlf_scale(n, 1.0 / length);
            caster_to_floats(rlf_mat3_mul_vec(R, n), edge);
            edge[3] = (float)rlf_dot(n, from);
        }
    }
}

bool caster_make(const rlf_body_state *body, const rlf_pose *T_picture_world, rlf_vec3 to_light,
                 caster *out)
{
    rlf_pose T = rlf_pose_mul(T_picture_world, &body->T_world_body);
    rlf_mat3 R = rlf_quat_to_mat3(rlf_quat_normalize(T.q));
    *out = (caster){.center = {(float)T.p.x, (float)T.p.y, (float)T.p.z}};
    const rlf_vec3 l = to_light;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            out->axis[i][k] = (float)R.m[k][i];
        }
        out->light[i] = (float)(i == 0 ? l.x : (i == 1 ? l.y : l.z));
        out->to_light[i] = (float)(R.m[0][i] * l.x + R.m[1][i] * l.y + R.m[2][i] * l.z);
    }
    set_shape(&body->shape, out);
    if (out->crease == 0.0f && body->shape.hull != NULL && body->shape.hull->vertex_count > 0) {
        const float *to = out->to_light;
        set_outline(body->shape.hull, &R, caster_from_floats(to), out);
    }
    const float *half = out->half;
    float corner = sqrtf(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]);
    out->reach = REACH_MARGIN * (corner + out->round);
    bool is_good = rlf_vec3_is_finite(T.p) && out->near_m > 0.0f && out->near_m < 1e6f &&
                   T.p.z >= NEAREST_M && out->radius < 1e6f && out->half[0] - out->half[0] == 0.0f;
    out->near_m = is_good ? out->near_m : 0.0f;
    return is_good;
}

/* ---- reach ---------------------------------------------------------------------------------- */

bool caster_reach(const caster *c, const rlf_camera *camera, rlf_vec3 to_light, pixel_rect *out)
{
    rlf_vec3 center = {(double)c->center[0], (double)c->center[1], (double)c->center[2]};
    rlf_vec3 end = rlf_mad(center, to_light, -(double)c->length_m);
    double edge = 0.5 * (double)c->penumbra;
    double wide = (double)c->radius + edge + 0.5 * CASTER_SPREAD * (double)c->length_m;
    double near_reach = (double)c->radius + rlf_max((double)c->near_m, edge);
    pixel_rect far_end;
    (void)pixel_rect_of_ball(camera, center, near_reach, out);
    (void)pixel_rect_of_ball(camera, end, wide, &far_end);
    out->x0 = far_end.x0 < out->x0 ? far_end.x0 : out->x0;
    out->y0 = far_end.y0 < out->y0 ? far_end.y0 : out->y0;
    out->x1 = far_end.x1 > out->x1 ? far_end.x1 : out->x1;
    out->y1 = far_end.y1 > out->y1 ? far_end.y1 : out->y1;
    return out->x0 < out->x1 && out->y0 < out->y1;
}

/* Square of the distance from v (picture camera frame, from the centre) to the inner box. */
RLF_KERNEL_PART float distance2_of_box(const caster *c, float x, float y, float z)
{
    float sum = 0.0f;
    for (int k = 0; k < 3; k++) {
        float q = c->axis[k][0] * x + c->axis[k][1] * y + c->axis[k][2] * z;
        float beyond = (q < 0.0f ? -q : q) - c->half[k];
        beyond = beyond > 0.0f ? beyond : 0.0f;
        sum += beyond * beyond;
    }
    return sum;
}

/* True when a ball about a point, from the centre, may be in the shadow; `square` of its distance.
 */
RLF_KERNEL_PART int32_t may_be_in_shadow(const caster *c, float x, float y, float z, float square,
                                         float radius)
{
    float behind = -(x * c->light[0] + y * c->light[1] + z * c->light[2]);
    float deepest = behind + radius + c->reach; /* the body's own depth counts too */
    float wide = c->reach + radius + 0.5f * (c->penumbra + (float)CASTER_SPREAD * deepest);
    return (deepest > 0.0f ? 1 : 0) & (behind - radius < c->length_m + c->reach ? 1 : 0) &
           (square - behind * behind < wide * wide ? 1 : 0);
}

int32_t caster_may_take(const caster *c, const float p[3], float radius)
{
    float x = p[0] - c->center[0];
    float y = p[1] - c->center[1];
    float z = p[2] - c->center[2];
    float square = x * x + y * y + z * z;
    float near_reach = c->round + c->near_m + radius;
    float sphere_reach = c->reach + c->near_m + radius;
    bool is_near_it = square < sphere_reach * sphere_reach &&
                      distance2_of_box(c, x, y, z) < near_reach * near_reach;
    return (is_near_it ? CASTER_TAKES_AMBIENT : 0) +
           may_be_in_shadow(c, x, y, z, square, radius) * CASTER_TAKES_DIRECT;
}

RLF_KERNEL_PART void take_balls(const caster caster_here, const float *restrict x,
                                const float *restrict y, const float *restrict z,
                                const float *restrict radius, int32_t *restrict out)
{
    const caster c = caster_here;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < CASTER_LANES; i++) {
        float px = x[i] - c.center[0];
        float py = y[i] - c.center[1];
        float pz = z[i] - c.center[2];
        float near_reach = c.round + c.near_m + radius[i];
        int32_t is_near_it = distance2_of_box(&c, px, py, pz) < near_reach * near_reach ? 1 : 0;
        int32_t is_in_shadow =
            may_be_in_shadow(&c, px, py, pz, px * px + py * py + pz * pz, radius[i]);
        out[i] = is_near_it * CASTER_TAKES_AMBIENT + is_in_shadow * CASTER_TAKES_DIRECT;
    }
}

RLF_KERNEL void caster_may_take_balls(const caster *c, const caster_balls *balls, int32_t count,
                                      int32_t *restrict out)
{
    for (int32_t i = 0; i < count; i += CASTER_LANES) {
        take_balls(*c, balls->x + i, balls->y + i, balls->z + i, balls->radius + i, out + i);
    }
}

static float distance2(const caster *a, const caster *b)
{
    float sum = 0.0f;
    for (int k = 0; k < 3; k++) {
        float step = a->center[k] - b->center[k];
        sum += step * step;
    }
    return sum;
}

/* Caster i, `away2` from the body, if it is among the nearest so far. */
static void add_choice(int32_t i, float away2, caster_choice *c)
{
    int32_t place = c->count < CASTER_BODIES ? c->count++ : CASTER_BODIES;
    for (; place > 0 && away2 < c->away2[place - 1]; place--) {
        if (place < CASTER_BODIES) {
            c->away2[place] = c->away2[place - 1];
            c->chosen[place] = c->chosen[place - 1];
        }
    }
    if (place < CASTER_BODIES) {
        c->away2[place] = away2;
        c->chosen[place] = i;
    }
}

int32_t caster_choose(const caster *casters, int32_t count, int32_t index,
                      int32_t out[CASTER_BODIES])
{
    const caster *own = &casters[index];
    caster_choice choice = {.count = 0};
    for (int32_t i = 0; i < count; i++) {
        const caster *other = &casters[i];
        if (i != index && other->near_m > 0.0f &&
            caster_may_take(other, own->center, own->radius) != CASTER_TAKES_NOTHING) {
            add_choice(i, distance2(own, other), &choice);
        }
    }
    for (int32_t i = 0; i < choice.count; i++) {
        out[i] = choice.chosen[i];
    }
    return choice.count;
}

static bool takes_any(const int32_t takes[CASTER_LANES])
{
    int32_t any = 0;
    for (int32_t i = 0; i < CASTER_LANES; i++) {
        any |= takes[i];
    }
    return any != CASTER_TAKES_NOTHING;
}

/* Up to CASTER_LANES bodies. */
static void choose_lanes(const caster *casters, int32_t count, const int32_t *index, int32_t bodies,
                         caster_choice *out)
{
    float ball[4][CASTER_LANES] = {{0}};
    const caster_balls balls = {ball[0], ball[1], ball[2], ball[3]};
    for (int32_t k = 0; k < bodies; k++) {
        const caster *own = &casters[index[k]];
        for (int i = 0; i < 3; i++) {
            ball[i][k] = own->center[i];
        }
        ball[3][k] = own->radius;
        out[k].count = 0;
    }
    for (int32_t i = 0; i < count; i++) {
        int32_t takes[CASTER_LANES] = {0};
        if (casters[i].near_m > 0.0f) {
            caster_may_take_balls(&casters[i], &balls, CASTER_LANES, takes);
        }
        for (int32_t k = 0; takes_any(takes) && k < bodies; k++) {
            if (takes[k] != CASTER_TAKES_NOTHING && index[k] != i) {
                add_choice(i, distance2(&casters[index[k]], &casters[i]), &out[k]);
            }
        }
    }
}

void caster_choose_many(const caster *casters, int32_t count, const int32_t *index, int32_t bodies,
                        caster_choice *out)
{
    for (int32_t first = 0; first < bodies; first += CASTER_LANES) {
        const int32_t left = bodies - first;
        choose_lanes(casters, count, index + first, left < CASTER_LANES ? left : CASTER_LANES,
                     out + first);
    }
}

/* ---- light ---------------------------------------------------------------------------------- */

RLF_KERNEL_PART float limit(float x, float low, float high)
{
    x = x > low ? x : low;
    return x < high ? x : high;
}

/* A pixel's ray, and its point in the body's frame. */
typedef struct site {
    float ray_x, ray_y;
    float p[3], q[3]; /* from the body's centre: picture camera frame, body frame */
} site;

RLF_KERNEL_PART site site_at(const caster *c, float ray_x, float ray_y, float z)
{
    site s = {ray_x,
              ray_y,
              {ray_x * z - c->center[0], ray_y * z - c->center[1], z - c->center[2]},
              {0, 0, 0}};
    for (int k = 0; k < 3; k++) {
        s.q[k] = c->axis[k][0] * s.p[0] + c->axis[k][1] * s.p[1] + c->axis[k][2] * s.p[2];
    }
    return s;
}

/* Surfaces that the camera sees face it, so one with the body behind it does not face the body. */
RLF_KERNEL_PART float facing_of(const site *s, float z)
{
    float behind = -(s->p[0] * s->ray_x + s->p[1] * s->ray_y + s->p[2]);
    behind = behind > 0.0f ? behind : 0.0f;
    float square = (s->p[0] * s->p[0] + s->p[1] * s->p[1] + s->p[2] * s->p[2]) *
                   (s->ray_x * s->ray_x + s->ray_y * s->ray_y + 1.0f);
    float facing = 1.0f - behind * behind / (square + 1e-12f);
    return z > 0.0f ? facing : 0.0f;
}

/* Where a body touches a surface half of the sky is hidden from it, whichever way it faces. */
RLF_KERNEL_PART float creased(const caster *c, float facing, float close, float z)
{
    const float square = close * close;
    const float fourth = square * square;
    return z > 0.0f ? facing + c->crease * (1.0f - facing) * fourth * fourth : 0.0f;
}

/* False when no point is within `reach` of the centre. */
RLF_KERNEL_PART bool is_near(const float center[3], const float *restrict ray_x,
                             const float *restrict ray_y, const float *restrict z, float reach)
{
    const float most = reach * reach;
    int32_t any = 0;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < CASTER_LANES; i++) {
        float x = ray_x[i] * z[i] - center[0];
        float y = ray_y[i] * z[i] - center[1];
        float w = z[i] - center[2];
        any |= (x * x + y * y + w * w < most ? 1 : 0) & (z[i] > 0.0f ? 1 : 0);
    }
    return any != 0;
}

/* False when no point is where the shadow of a ball, of radius `reach` and with the caster's
 * penumbra, may be. */
RLF_KERNEL_PART bool is_behind(const caster *c, const float to_light[3],
                               const float *restrict ray_x, const float *restrict ray_y,
                               const float *restrict z, float reach)
{
    const float near_wide = reach + 0.5f * c->penumbra;
    const float length = c->length_m + reach;
    int32_t any = 0;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < CASTER_LANES; i++) {
        float x = ray_x[i] * z[i] - c->center[0];
        float y = ray_y[i] * z[i] - c->center[1];
        float w = z[i] - c->center[2];
        float behind = -(x * to_light[0] + y * to_light[1] + w * to_light[2]);
        float wide = near_wide + 0.5f * (float)CASTER_SPREAD * (behind + reach);
        float across2 = x * x + y * y + w * w - behind * behind;
        any |= (behind > -reach ? 1 : 0) & (behind < length ? 1 : 0) &
               (across2 < wide * wide ? 1 : 0) & (z[i] > 0.0f ? 1 : 0);
    }
    return any != 0;
}

/* How far points are beyond a hull's outline, at least: far within it for other bodies. */
RLF_KERNEL_PART void find_beyond(const caster *c, const float *restrict ray_x,
                                 const float *restrict ray_y, const float *restrict z,
                                 float *restrict out)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < CASTER_LANES; i++) {
        out[i] = -1e6f;
    }
    for (int32_t k = 0; k < c->edge_count; k++) {
        const float *e = c->edge[k];
        const float ex = e[0];
        const float ey = e[1];
        const float ez = e[2];
        const float least = e[3] + ex * c->center[0] + ey * c->center[1] + ez * c->center[2];
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < CASTER_LANES; i++) {
            const float beyond = (ex * ray_x[i] + ey * ray_y[i] + ez) * z[i] - least;
            out[i] = beyond > out[i] ? beyond : out[i];
        }
    }
}

/* The distance to the rounded box darkens what is near. */
RLF_KERNEL_PART void take_ambient(const caster caster_here, const float *restrict ray_x,
                                  const float *restrict ray_y, const float *restrict z,
                                  const float *restrict beyond, float share, float *restrict left)
{
    const caster c = caster_here;
    const float per_near = 1.0f / c.near_m;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < CASTER_LANES; i++) {
        site s = site_at(&c, ray_x[i], ray_y[i], z[i]);
        float x = s.q[0] - limit(s.q[0], -c.half[0], c.half[0]);
        float y = s.q[1] - limit(s.q[1], -c.half[1], c.half[1]);
        float w = s.q[2] - limit(s.q[2], -c.half[2], c.half[2]);
        float gap = sqrtf(x * x + y * y + w * w) - c.round;
        gap = beyond[i] > gap ? beyond[i] : gap;
        float close = 1.0f - (gap > 0.0f ? gap : 0.0f) * per_near;
        close = close > 0.0f ? close : 0.0f;
        left[i] *= 1.0f - share * close * close * creased(&c, facing_of(&s, z[i]), close, z[i]);
    }
}

/* The ray to the light passes the inner box at a least distance, found by projecting from the one
 * to the other and back: both are convex. */
RLF_KERNEL_PART void take_direct(const caster caster_here, const float *restrict ray_x,
                                 const float *restrict ray_y, const float *restrict z,
                                 const float *restrict beyond, float share, float *restrict left)
{
    const caster c = caster_here;
    const float lx = c.to_light[0];
    const float ly = c.to_light[1];
    const float lz = c.to_light[2];
    const float per_length = 1.0f / c.length_m;
    const float per_penumbra = 1.0f / c.penumbra;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < CASTER_LANES; i++) {
        site s = site_at(&c, ray_x[i], ray_y[i], z[i]);
        float t = -(s.q[0] * lx + s.q[1] * ly + s.q[2] * lz);
        t = t > 0.0f ? t : 0.0f;
        float x = limit(s.q[0] + t * lx, -c.half[0], c.half[0]);
        float y = limit(s.q[1] + t * ly, -c.half[1], c.half[1]);
        float w = limit(s.q[2] + t * lz, -c.half[2], c.half[2]);
        t = (x - s.q[0]) * lx + (y - s.q[1]) * ly + (w - s.q[2]) * lz;
        t = t > 0.0f ? t : 0.0f;
        x = s.q[0] + t * lx;
        y = s.q[1] + t * ly;
        w = s.q[2] + t * lz;
        x -= limit(x, -c.half[0], c.half[0]);
        y -= limit(y, -c.half[1], c.half[1]);
        w -= limit(w, -c.half[2], c.half[2]);
        float pass = sqrtf(x * x + y * y + w * w) - c.round;
        pass = beyond[i] > pass ? beyond[i] : pass;
        float width = c.penumbra + (float)CASTER_SPREAD * t;
        float hidden = limit(0.5f - pass / width, 0.0f, 1.0f);
        float fade = 1.0f - t * per_length;
        fade = fade > 0.0f ? fade : 0.0f;
        hidden *= fade * limit(t * per_penumbra, 0.0f, 1.0f); /* none before the body */
        left[i] *= 1.0f - share * hidden * facing_of(&s, z[i]);
    }
}

RLF_KERNEL void caster_take_ambient(const caster *c, const caster_points *p, float share,
                                    float *left)
{
    const float reach = c->reach + c->near_m;
    float beyond[CASTER_LANES];
    for (int32_t i = 0; i < p->count; i += CASTER_LANES) {
        if (is_near(c->center, p->x + i, p->y + i, p->z + i, reach)) {
            find_beyond(c, p->x + i, p->y + i, p->z + i, beyond);
            take_ambient(*c, p->x + i, p->y + i, p->z + i, beyond, share, left + i);
        }
    }
}

RLF_KERNEL void caster_take_direct(const caster *c, const caster_points *p, float share,
                                   float *left)
{
    float beyond[CASTER_LANES];
    for (int32_t i = 0; i < p->count; i += CASTER_LANES) {
        if (is_behind(c, c->light, p->x + i, p->y + i, p->z + i, c->reach)) {
            find_beyond(c, p->x + i, p->y + i, p->z + i, beyond);
            take_direct(*c, p->x + i, p->y + i, p->z + i, beyond, share, left + i);
        }
    }
}
