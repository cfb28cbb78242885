/* Bones are capsules of elliptic section with pads at the palm's side. Lengths of segments:
 * Alexander and Viktor 2010; breadth and depth of fingers: NASA-STD-3000; both vary from person to
 * person. */
#include "eval/hands/another.h"

#include <stdlib.h>
#include <string.h>

#define N (ANOTHER_WIDTH * ANOTHER_HEIGHT)
#define FOCAL 365.0
#define USUAL_M 0.190
#define WALL_M 2.6
#define THICK_M 0.018f /* what is known of a foreground's, where nothing else says */
#define FLATTER 0.82   /* a finger's depth of its breadth */
#define PAD_M 0.0022   /* by which a pad stands out */

struct another_view {
    rlf_surface surface;
    float depth[N], clean[N], ray_x[N], ray_y[N], nx[N], ny[N], nz[N];
    float back[N], back_normal[3][N], thickness[N], velocity[3][N];
    uint8_t foreground[N];
    rlf_vec3 up; /* camera frame */
    rlf_rig rig;
};

static const rlf_vec3 roots[5] = {{0.024, 0.022, -0.014},
                                  {0.027, 0.094, -0.002},
                                  {0.005, 0.097, 0.0},
                                  {-0.015, 0.092, -0.001},
                                  {-0.033, 0.082, -0.004}};
static const double lengths[5][3] = {{0.045, 0.034, 0.024},
                                     {0.041, 0.024, 0.0175},
                                     {0.046, 0.028, 0.0185},
                                     {0.042, 0.027, 0.0185},
                                     {0.033, 0.019, 0.017}};
static const double halves[5] = {0.0115, 0.0092, 0.0094, 0.0087, 0.0077};

another_view *another_view_create(void)
{
    another_view *v = calloc(1, sizeof(*v));
    if (v == NULL) {
        return NULL;
    }
    for (int i = 0; i < N; i++) {
        v->ray_x[i] = (float)((i % ANOTHER_WIDTH - 255.5) / FOCAL);
        v->ray_y[i] = (float)((i / ANOTHER_WIDTH - 211.5) / FOCAL);
    }
    rlf_surface *s = &v->surface;
    s->width = s->camera.width = ANOTHER_WIDTH;
    s->height = s->camera.height = ANOTHER_HEIGHT;
    s->scale_factor = 1;
    s->camera.fx = s->camera.fy = FOCAL;
    s->camera.cx = 255.5;
    s->camera.cy = 211.5;
    s->noise = (rlf_depth_noise){.c0 = 0.0005, .c1 = 0.0, .c2 = 0.0015};
    s->depth = v->depth;
    s->foreground = v->foreground;
    s->ray_x = v->ray_x;
    s->ray_y = v->ray_y;
    s->normal_x = v->nx;
    s->normal_y = v->ny;
    s->normal_z = v->nz;
    s->background_depth = v->back;
    s->background_normal_x = v->back_normal[0];
    s->background_normal_y = v->back_normal[1];
    s->background_normal_z = v->back_normal[2];
    s->background_state = RLF_BACKGROUND_READY;
    s->background_version = 1;
    s->thickness = v->thickness;
    s->velocity_x = v->velocity[0];
    s->velocity_y = v->velocity[1];
    s->velocity_z = v->velocity[2];
    const another_plane wall = {{0, 0, -1}, -WALL_M, {0, 0, WALL_M}, 10.0};
    another_view_room(v, &wall, 1, rlf_vec3_make(0, -1, 0));
    return v;
}

void another_view_room(another_view *v, const another_plane *planes, int32_t count, rlf_vec3 up)
{
    v->up = up;
    for (int i = 0; i < N; i++) {
        const rlf_vec3 ray = {(double)v->ray_x[i], (double)v->ray_y[i], 1.0};
        v->back[i] = 0.0f;
        v->thickness[i] = THICK_M;
        for (int32_t k = 0; k < count; k++) {
            const another_plane *p = &planes[k];
            const double z = eval_plane_depth(p->normal, p->offset, ray);
            const bool is_on = rlf_length(rlf_sub(rlf_scale(ray, z), p->middle)) < p->radius;
            if (z > 0.0 && is_on && (v->back[i] == 0.0f || (float)z < v->back[i])) {
                v->back[i] = (float)z;
                v->back_normal[0][i] = (float)p->normal.x;
                v->back_normal[1][i] = (float)p->normal.y;
                v->back_normal[2][i] = (float)p->normal.z;
            }
        }
    }
}

void another_view_flow(another_view *v, rlf_vec3 velocity)
{
    for (int i = 0; i < N; i++) {
        const bool is_there = v->foreground[i] != 0;
        v->velocity[0][i] = is_there ? (float)velocity.x : 0.0f;
        v->velocity[1][i] = is_there ? (float)velocity.y : 0.0f;
        v->velocity[2][i] = is_there ? (float)velocity.z : 0.0f;
    }
}

const rlf_rig *another_view_rig(another_view *v)
{
    v->rig = rlf_rig_default();
    v->rig.depth = v->surface.camera;
    v->rig.depth_min_m = 0.3;
    v->rig.depth_max_m = 4.5;
    v->rig.noise = v->surface.noise;
    return &v->rig;
}

void another_view_destroy(another_view *view)
{
    free(view);
}

/* Where a ray from the camera meets a ball, and one along a cylinder's axis y; 0 = nowhere. */
static double meet(rlf_vec3 o, rlf_vec3 d, double r, bool is_ball)
{
    const double flat = is_ball ? 1.0 : 0.0;
    const double a = d.x * d.x + d.z * d.z + flat * d.y * d.y;
    const double b = o.x * d.x + o.z * d.z + flat * o.y * d.y;
    const double c = o.x * o.x + o.z * o.z + flat * o.y * o.y - r * r;
    const double root = b * b - a * c;
    return root > 0.0 && a > 1e-12 ? (-b - sqrt(root)) / a : 0.0;
}

/* A capsule from a to b, half as broad as `half` across `side`, and flatter across both. */
static void put(another_view *v, rlf_vec3 a, rlf_vec3 b, rlf_vec3 side, double half, double flatter)
{
    const double length = rlf_length(rlf_sub(b, a));
    const rlf_vec3 y = rlf_scale(rlf_sub(b, a), 1.0 / rlf_max(length, 1e-6));
    rlf_vec3 x = rlf_mad(side, y, -rlf_dot(side, y));
    x = rlf_length(x) > 1e-3 ? rlf_normalize(x) : rlf_perpendicular(y);
    const rlf_vec3 z = rlf_cross(x, y),
                   o = {-rlf_dot(a, x), -rlf_dot(a, y), -rlf_dot(a, z) / flatter};
    double from[2] = {1e9, 1e9}, to[2] = {-1e9, -1e9};
    for (int k = 0; k < 2; k++) {
        const rlf_vec3 p = k == 0 ? a : b;
        const double near = rlf_max(p.z - half, 0.1), at[2] = {p.x, p.y}, mid[2] = {255.5, 211.5};
        for (int i = 0; i < 2; i++) {
            from[i] = rlf_min(from[i], mid[i] + FOCAL * (at[i] - half) / near - 12.0);
            to[i] = rlf_max(to[i], mid[i] + FOCAL * (at[i] + half) / near + 12.0);
        }
    }
    const int x0 = (int)rlf_clamp(from[0], 0.0, ANOTHER_WIDTH),
              y0 = (int)rlf_clamp(from[1], 0.0, ANOTHER_HEIGHT);
    for (int row = y0; row < (int)rlf_clamp(to[1], 0.0, ANOTHER_HEIGHT); row++) {
        for (int col = x0; col < (int)rlf_clamp(to[0], 0.0, ANOTHER_WIDTH); col++) {
            const int i = row * ANOTHER_WIDTH + col;
            const rlf_vec3 ray = {(double)v->ray_x[i], (double)v->ray_y[i], 1.0};
            const rlf_vec3 d = {rlf_dot(ray, x), rlf_dot(ray, y), rlf_dot(ray, z) / flatter};
            double t = meet(o, d, half, false);
            const double along = o.y + t * d.y;
            if (t <= 0.0 || along < 0.0 || along > length) {
                const rlf_vec3 end = {o.x, o.y - length, o.z};
                const double ta = meet(o, d, half, true), tb = meet(end, d, half, true);
                t = ta > 0.0 && (tb <= 0.0 || ta < tb) ? ta : tb;
            }
            if (t > 0.05 && (v->clean[i] <= 0.0f || (float)t < v->clean[i])) {
                v->clean[i] = (float)t;
                v->foreground[i] = 1;
            }
        }
    }
}

/* A bone in the frame of a left hand of the usual size. */
typedef struct bone {
    rlf_vec3 from, to, palmar; /* palmar: unit, to the palm's side */
    double half;               /* of its breadth */
} bone;

static void place_digit(const another_hand *h, const another_grip *grip, int digit, bone out[3])
{
    const double aside = grip->aside[digit];
    rlf_vec3 at = roots[digit], way = {rlf_sin(aside), rlf_cos(aside), 0.0};
    rlf_vec3 palmar = {0, 0, -1};
    if (digit == 0) { /* it stands out of the palm and bends across it */
        way = rlf_normalize(rlf_vec3_make(rlf_sin(aside), rlf_cos(aside), -grip->bend[0][0]));
        palmar = rlf_normalize(rlf_vec3_make(-0.8 * rlf_cos(aside), 0.5 * rlf_sin(aside), -0.55));
        palmar = rlf_normalize(rlf_mad(palmar, way, -rlf_dot(palmar, way)));
    }
    for (int k = 0; k < 3; k++) {
        const double bend = digit == 0 && k == 0 ? 0.0 : grip->bend[digit][k];
        const double c = rlf_cos(bend), sn = rlf_sin(bend);
        const rlf_vec3 next = rlf_add(rlf_scale(way, c), rlf_scale(palmar, sn));
        palmar = rlf_sub(rlf_scale(palmar, c), rlf_scale(way, sn));
        way = next;
        const double half =
            halves[digit] * h->breadth * (digit == 0 && k == 0 ? 1.35 : 1.0 - 0.08 * k);
        const double reach = lengths[digit][k] * h->finger[digit] - (k == 2 ? half : 0.0);
        out[k] = (bone){at, rlf_mad(at, way, reach), palmar, half};
        at = out[k].to;
    }
}

/* A finger or the thumb with its pads. */
static void put_digit(another_view *v, another_hand *h, int digit)
{
    const double s = h->length / USUAL_M, side = h->is_left ? 1.0 : -1.0;
    bone bones[3];
    place_digit(h, &h->grip, digit, bones);
    for (int k = 0; k < 3; k++) {
        const bone *b = &bones[k];
        const rlf_vec3 middle = rlf_scale(rlf_add(b->from, b->to), 0.5);
        const rlf_vec3 across = rlf_cross(rlf_sub(b->to, b->from), b->palmar);
        rlf_vec3 place[4] = {b->from, b->to, rlf_mad(middle, b->palmar, PAD_M), across};
        for (int i = 0; i < 4; i++) {
            place[i] = rlf_vec3_make(side * s * place[i].x, s * place[i].y, s * place[i].z);
            place[i] = i < 3 ? rlf_transform(&h->T_camera_hand, place[i])
                             : rlf_rotate(h->T_camera_hand.q, place[i]);
        }
        put(v, place[0], place[1], place[3], s * b->half, FLATTER);
        put(v, place[2], rlf_mad(place[2], rlf_sub(place[1], place[0]), 0.12), place[3],
            0.92 * s * b->half, FLATTER);
        h->tip[digit] = place[1];
    }
}

rlf_vec3 another_hand_tip(const another_hand *h, const another_grip *grip, int32_t digit)
{
    const double s = h->length / USUAL_M, side = h->is_left ? s : -s;
    bone bones[3];
    place_digit(h, grip, digit, bones);
    return rlf_vec3_make(side * bones[2].to.x, s * bones[2].to.y, s * bones[2].to.z);
}

double another_hand_distance(const another_hand *h, const another_grip *grip, int32_t digit,
                             const rlf_shape *shape, const rlf_pose *T_hand_body)
{
    const double s = h->length / USUAL_M, side = h->is_left ? s : -s;
    double least = 1e9;
    bone bones[3];
    place_digit(h, grip, digit, bones);
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i <= 8; i++) {
            rlf_vec3 gradient,
                p = rlf_mad(bones[k].from, rlf_sub(bones[k].to, bones[k].from), i / 8.0);
            p = rlf_vec3_make(side * p.x, s * p.y, s * p.z);
            p = rlf_transform_inverse(T_hand_body, p);
            const double far =
                rlf_shape_distance(shape, p, &gradient) - s * FLATTER * bones[k].half;
            least = rlf_min(least, far);
        }
    }
    return least;
}

static double gap_of(const another_hand *h, const another_grip *grip)
{
    bone thumb[3], index[3];
    place_digit(h, grip, 0, thumb);
    place_digit(h, grip, 1, index);
    const double gap =
        rlf_length(rlf_sub(thumb[2].to, index[2].to)) - FLATTER * (thumb[2].half + index[2].half);
    return gap > 0.0 ? gap : -gap;
}

/* Small turns of thumb and index until their tips meet. */
static void close_pinch(const another_hand *h, another_grip *grip)
{
    double step = 0.1, *const angle[6] = {&grip->aside[0],   &grip->bend[0][0], &grip->bend[0][1],
                                          &grip->bend[0][2], &grip->bend[1][0], &grip->bend[1][1]};
    for (int n = 0; n < 60; n++) {
        bool is_better = false;
        for (int k = 0; k < 12; k++) {
            const double before = gap_of(h, grip), by = k % 2 == 0 ? step : -step;
            *angle[k / 2] += by;
            if (gap_of(h, grip) < before) {
                is_better = true;
            } else {
                *angle[k / 2] -= by;
            }
        }
        step *= is_better ? 1.0 : 0.5;
    }
}

/* From a to b in the hand's frame of the usual size. */
static void put_part(another_view *v, const another_hand *h, const double p[8])
{
    const double s = h->length / USUAL_M, side = h->is_left ? s : -s;
    const rlf_vec3 a =
        rlf_transform(&h->T_camera_hand, rlf_vec3_make(side * p[0], s * p[1], s * p[2]));
    const rlf_vec3 b =
        rlf_transform(&h->T_camera_hand, rlf_vec3_make(side * p[3], s * p[4], s * p[5]));
    put(v, a, b, rlf_rotate(h->T_camera_hand.q, rlf_vec3_make(1, 0, 0)), p[6] * s * h->breadth,
        p[7]);
}

static const double palm[7][8] = {{0.012, 0.020, -0.001, 0.025, 0.088, -0.003, 0.0135, 0.95},
                                  {0.004, 0.020, 0.000, 0.005, 0.090, -0.002, 0.0140, 1.0},
                                  {-0.006, 0.020, -0.001, -0.014, 0.085, -0.003, 0.0135, 1.0},
                                  {-0.014, 0.020, -0.003, -0.031, 0.076, -0.006, 0.0125, 1.0},
                                  {-0.021, 0.022, -0.012, -0.028, 0.055, -0.012, 0.0130, 0.9},
                                  {0.014, 0.018, -0.012, 0.026, 0.044, -0.016, 0.0150, 0.9},
                                  {0.0, 0.004, 0.0, 0.0, 0.020, 0.0, 0.0290, 0.68}};

void another_hand_cones(const another_hand *h, another_cone out[ANOTHER_CONES])
{
    const double s = h->length / USUAL_M, side = h->is_left ? s : -s;
    for (int k = 0; k < 6; k++) {
        const double *p = palm[k];
        out[k].a = rlf_vec3_make(side * p[0], s * p[1], s * p[2]);
        out[k].b = rlf_vec3_make(side * p[3], s * p[4], s * p[5]);
        out[k].radius = p[6] * s * h->breadth;
    }
    for (int digit = 0; digit < 5; digit++) {
        bone bones[3];
        place_digit(h, &h->grip, digit, bones);
        for (int k = 0; k < 3; k++) {
            another_cone *c = &out[6 + 3 * digit + k];
            c->a = rlf_vec3_make(side * bones[k].from.x, s * bones[k].from.y, s * bones[k].from.z);
            c->b = rlf_vec3_make(side * bones[k].to.x, s * bones[k].to.y, s * bones[k].to.z);
            c->radius = FLATTER * s * bones[k].half;
        }
    }
    for (int k = 0; k < ANOTHER_CONES; k++) {
        out[k].a = rlf_transform(&h->T_camera_hand, out[k].a);
        out[k].b = rlf_transform(&h->T_camera_hand, out[k].b);
    }
}

static void put_all(another_view *v, another_hand *h)
{
    for (int k = 0; k < 7; k++) {
        put_part(v, h, palm[k]);
    }
    for (int digit = 0; digit < 5; digit++) {
        put_digit(v, h, digit);
    }
    const double s = h->length / USUAL_M;
    const rlf_vec3 wrist = h->T_camera_hand.p,
                   x = rlf_rotate(h->T_camera_hand.q, rlf_vec3_make(1, 0, 0));
    const rlf_vec3 fore = rlf_sub(h->elbow, wrist);
    put(v, wrist, rlf_mad(wrist, fore, 0.5), x, 0.030 * s, 0.72);
    put(v, rlf_mad(wrist, fore, 0.4), h->elbow, x, 0.041 * s, 0.85);
    if (h->has_sleeve) {
        put(v, rlf_mad(wrist, fore, 0.25), h->elbow, x, 0.049 * s, 0.9);
    }
    put(v, h->elbow, h->shoulder, x, 0.052, 0.95);
    h->palm = rlf_transform(&h->T_camera_hand, rlf_vec3_make(0.0, 0.052 * s, -0.003 * s));
}

/* Noise of the sensor, edges that mix both sides, and gaps. */
static void sense(another_view *v, eval_random *r)
{
    for (int i = 0; i < N; i++) {
        float z = v->clean[i];
        const int right = i + 1 < N ? i + 1 : i,
                  below = i + ANOTHER_WIDTH < N ? i + ANOTHER_WIDTH : i;
        const float far = v->clean[right] > v->clean[below] ? v->clean[right] : v->clean[below];
        const bool is_edge = v->foreground[i] != 0 && far > z + 0.05f;
        const double chance = eval_random_range(r, 0.0, 1.0);
        double noise = -2.0;
        for (int k = 0; k < 4; k++) {
            noise += eval_random_range(r, 0.0, 1.0);
        }
        z += (float)(1.73 * noise * rlf_depth_noise_sigma(&v->surface.noise, (double)z));
        z += is_edge && chance < 0.4 ? 0.03f : 0.0f;
        const bool is_gap = (is_edge && chance > 0.75) || chance > 0.995 || v->clean[i] <= 0.0f;
        v->depth[i] = is_gap ? 0.0f : z;
        v->foreground[i] = v->foreground[i] != 0 && v->depth[i] > 0.0f;
    }
    for (int i = ANOTHER_WIDTH + 1; i < N - ANOTHER_WIDTH - 1; i++) {
        const double dx = ((double)v->clean[i + 1] - (double)v->clean[i - 1]) * 0.5;
        const double dy =
            ((double)v->clean[i + ANOTHER_WIDTH] - (double)v->clean[i - ANOTHER_WIDTH]) * 0.5;
        const double pixel = (double)v->clean[i] / FOCAL;
        const rlf_vec3 n = rlf_normalize(rlf_vec3_make(dx / pixel, dy / pixel, -1.0));
        v->nx[i] = (float)n.x;
        v->ny[i] = (float)n.y;
        v->nz[i] = (float)n.z;
    }
}

/* Chest and head of whoever has these hands. */
static void put_person(another_view *v, rlf_vec3 chest)
{
    const rlf_vec3 x = {1, 0, 0};
    put(v, chest, rlf_mad(chest, v->up, -0.6), x, 0.17, 0.6);
    put(v, rlf_mad(chest, v->up, 0.48), rlf_mad(chest, v->up, 0.37), x, 0.08, 1.0);
}

const rlf_surface *another_view_show(another_view *v, another_hand *hands, int32_t count,
                                     eval_random *r, int64_t time_ns)
{
    memcpy(v->clean, v->back, sizeof(v->clean));
    memset(v->foreground, 0, sizeof(v->foreground));
    if (count > 0) {
        put_person(v, hands[0].chest);
    }
    for (int32_t k = 0; k < count; k++) {
        put_all(v, &hands[k]);
    }
    sense(v, r);
    v->surface.time_ns = time_ns;
    v->surface.sequence++;
    return &v->surface;
}

void another_hand_draw_lots(another_hand *h, eval_random *r)
{
    static const double sizes[5] = {0.165, 0.176, 0.186, 0.196, 0.206};
    memset(h, 0, sizeof(*h));
    h->length = sizes[(int)eval_random_range(r, 0.0, 5.0)];
    h->is_left = eval_random_range(r, 0.0, 1.0) < 0.5;
    h->has_sleeve = eval_random_range(r, 0.0, 1.0) < 0.6;
    h->breadth = eval_random_range(r, 0.93, 1.08);
    for (int k = 0; k < 5; k++) {
        h->finger[k] = eval_random_range(r, 0.94, 1.06);
    }
}

another_grip another_grip_draw_lots(const another_hand *hand, rlf_gesture gesture, eval_random *r)
{
    static const double fingers[5][2][3] = {{{0.40, 0.55, 0.35}, {0.50, 0.60, 0.40}},
                                            {{0.05, 0.10, 0.05}, {0.08, 0.12, 0.08}},
                                            {{1.30, 1.65, 0.90}, {1.40, 1.70, 0.90}},
                                            {{0.95, 0.75, 0.35}, {0.35, 0.40, 0.20}},
                                            {{0.05, 0.10, 0.05}, {1.35, 1.70, 0.90}}};
    static const double thumbs[5][4] = {{0.70, 0.45, 0.25, 0.25},
                                        {0.85, 0.25, 0.05, 0.05},
                                        {0.45, 0.95, 0.75, 0.95},
                                        {0.62, 0.92, 0.28, 0.40},
                                        {0.45, 0.95, 0.75, 0.95}};
    another_grip g = {.gesture = gesture};
    const double spread = gesture == RLF_GESTURE_OPEN ? eval_random_range(r, 0.0, 0.16) : 0.03;
    for (int digit = 1; digit < 5; digit++) {
        for (int k = 0; k < 3; k++) {
            g.bend[digit][k] = fingers[gesture][digit > 1][k] + eval_random_range(r, -0.10, 0.10);
        }
        g.aside[digit] = spread * (2.0 - digit) + eval_random_range(r, -0.03, 0.03);
    }
    g.aside[0] = thumbs[gesture][0] + eval_random_range(r, -0.06, 0.06);
    for (int k = 0; k < 3; k++) {
        g.bend[0][k] = thumbs[gesture][k + 1] + eval_random_range(r, -0.06, 0.06);
    }
    if (gesture == RLF_GESTURE_PINCH) {
        close_pinch(hand, &g);
    }
    return g;
}

another_grip another_grip_mix(const another_grip *a, const another_grip *b, double share)
{
    another_grip g = {.gesture = share >= 1.0 ? b->gesture : RLF_GESTURE_NONE};
    for (int digit = 0; digit < 5; digit++) {
        g.aside[digit] = a->aside[digit] + share * (b->aside[digit] - a->aside[digit]);
        for (int k = 0; k < 3; k++) {
            g.bend[digit][k] = a->bend[digit][k] + share * (b->bend[digit][k] - a->bend[digit][k]);
        }
    }
    return g;
}
