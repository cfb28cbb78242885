/* Things on a table are regions of their own, those that touch as well, and stay what they are. */

#include "seen_view.h"
#include "created.h"
#include "test.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 320, HEIGHT = 240, COUNT = WIDTH * HEIGHT, TABLE = 1, THINGS = 6 };

/* On the table: x to the right, y up from it, z away from the camera. */
typedef struct box {
    rlf_vec3 centre, half;
    double yaw;
} box;

/* The second box touches the first with an edge, and so does the can the ball. */
static const box boxes[2] = {{{0.0, 0.06, 0.0}, {0.09, 0.06, 0.06}, 0.0},
                             {{0.162, 0.10, -0.01}, {0.06, 0.10, 0.045}, 0.5}};
static const rlf_vec3 can = {-0.25, 0.12, 0.02}; /* its axis and height */
static const rlf_vec3 ball = {-0.18, 0.06, 0.09};
static const rlf_vec3 bowl = {0.0, 0.07, -0.22}; /* lower half of a sphere, open above */
static const double can_radius = 0.04, ball_radius = 0.06, bowl_radius = 0.07;

typedef struct scene {
    seen_view view;
    uint8_t truth[COUNT];
} scene;

/* Nearest way t along from + t way into a box; 0 = past it. */
static double hit_box(const box *b, rlf_vec3 from, rlf_vec3 way)
{
    double c = cos(b->yaw), s = sin(b->yaw), near, far;
    const rlf_aabb upright = {rlf_neg(b->half), b->half};
    const rlf_vec3 d = rlf_sub(from, b->centre);
    const rlf_vec3 p = {c * d.x - s * d.z, d.y, s * d.x + c * d.z};
    const rlf_vec3 w = {c * way.x - s * way.z, way.y, s * way.x + c * way.z};
    return box_ray(&upright, p, w, &near, &far) ? near : 0.0;
}

static double hit_can(rlf_vec3 from, rlf_vec3 way)
{
    double x = from.x - can.x, z = from.z - can.z;
    double a = way.x * way.x + way.z * way.z, b = x * way.x + z * way.z;
    double root = b * b - a * (x * x + z * z - can_radius * can_radius);
    double side = root > 0.0 ? (-b - sqrt(root)) / a : 0.0;
    double lid = (can.y - from.y) / way.y, u = x + lid * way.x, v = z + lid * way.z;
    if (u * u + v * v < can_radius * can_radius) {
        return lid;
    }
    return side > 0.0 && from.y + side * way.y < can.y ? side : 0.0;
}

static double hit_ball(rlf_vec3 from, rlf_vec3 way)
{
    double near, far;
    return sphere_ray(ball, ball_radius, from, way, &near, &far) ? near : 0.0;
}

static double hit_bowl(rlf_vec3 from, rlf_vec3 way)
{
    double sides[2];
    if (!sphere_ray(bowl, bowl_radius, from, way, &sides[0], &sides[1])) {
        return 0.0;
    }
    for (int k = 0; k < 2; k++) {
        if (sides[k] > 0.0 && from.y + sides[k] * way.y < bowl.y) {
            return sides[k];
        }
    }
    return 0.0;
}

static void draw(scene *s)
{
    const double pitch = 0.75;
    const rlf_vec3 eye = {0.0, 0.75, -0.75}, down = {0.0, -cos(pitch), -sin(pitch)};
    const rlf_vec3 ahead = {0.0, -sin(pitch), cos(pitch)};
    for (int i = 0; i < COUNT; i++) {
        rlf_vec3 way = rlf_add(ahead, rlf_scale(down, s->view.ray_y[i]));
        way.x += s->view.ray_x[i];
        const double t[THINGS] = {way.y < 0.0 ? -eye.y / way.y : 0.0,
                                  hit_box(&boxes[0], eye, way),
                                  hit_box(&boxes[1], eye, way),
                                  hit_can(eye, way),
                                  hit_ball(eye, way),
                                  hit_bowl(eye, way)};
        s->view.truth[i] = 0.0f;
        s->truth[i] = 0;
        for (int k = 0; k < THINGS; k++) {
            if (t[k] > 0.0 && (s->truth[i] == 0 || t[k] < (double)s->view.truth[i])) {
                s->view.truth[i] = (float)t[k];
                s->truth[i] = (uint8_t)(TABLE + k);
            }
        }
        s->view.truth[i] = s->view.truth[i] < 3.0f ? s->view.truth[i] : 0.0f;
    }
}

static void see(scene *s)
{
    for (int i = 0; i < COUNT; i++) {
        float z = s->view.truth[i];
        s->view.seen[i] = z > 0.0f ? seen_view_noisy(&s->view, z) : 0.0f;
    }
}

static int set_up(void **state)
{
    static scene s;
    seen_view_create(&s.view, analytic_rig(WIDTH, HEIGHT), 5);
    draw(&s);
    *state = &s;
    return 0;
}

static int begin_noise(void **state)
{
    scene *s = *state;
    s->view.random = (analytic_random){5};
    return 0;
}

static rlf_reconstruct *make_stage(const scene *s, rlf_pool *pool)
{
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &s->view.rig);
    def.pool = pool;
    return stage_of(&def);
}

/* Overlap of a thing with the region that fits it best, over their union; *out_label is its. */
static double best_overlap(const scene *s, const rlf_surface *surface, int thing,
                           int32_t *out_label)
{
    double best = 0.0;
    for (int32_t r = 0; r < surface->region_count; r++) {
        int32_t label = surface->regions[r].label, both = 0, either = 0;
        for (int i = 0; i < COUNT; i++) {
            bool is_thing = s->truth[i] == thing && s->view.truth[i] > 0.0f;
            both += is_thing && surface->label[i] == label ? 1 : 0;
            either += is_thing || surface->label[i] == label ? 1 : 0;
        }
        if (both > best * either) {
            best = (double)both / either;
            *out_label = label;
        }
    }
    return best;
}

static void check_things(const scene *s, const rlf_surface *surface, double least)
{
    int32_t label[THINGS + 1] = {0};
    for (int k = TABLE; k < TABLE + THINGS; k++) {
        double overlap = best_overlap(s, surface, k, &label[k]);
        if (overlap < least) {
            fail_msg("thing %d: overlap %.3f", k, overlap);
        }
        for (int other = TABLE; other < k; other++) {
            assert_int_not_equal(label[k], label[other]);
        }
    }
}

TEST_CASE(things_are_regions)
{
    scene *s = *state;
    rlf_reconstruct *stage = make_stage(s, NULL);
    for (int f = 0; f < 12; f++) {
        see(s);
        const rlf_surface *surface = seen_view_process(&s->view, stage, f);
        if (f == 0 || f > 4) {
            check_things(s, surface, 0.8);
        }
    }
    rlf_reconstruct_destroy(&stage);
}

/* Only what is beside another thing may go over to it. */
TEST_CASE(labels_stay)
{
    static int32_t before[COUNT];
    scene *s = *state;
    rlf_reconstruct *stage = make_stage(s, NULL);
    int32_t regions = 0;
    for (int f = 0; f < 64; f++) {
        see(s);
        const rlf_surface *surface = seen_view_process(&s->view, stage, f);
        int32_t changed = 0;
        for (int i = 0; i < COUNT; i++) {
            changed += f > 4 && before[i] != surface->label[i] ? 1 : 0;
            before[i] = surface->label[i];
        }
        regions = f == 4 ? surface->region_count : regions;
        assert_true(changed < COUNT / 200);
        assert_true(f < 4 || surface->region_count == regions);
    }
    rlf_reconstruct_destroy(&stage);
}

TEST_CASE(threads_make_no_difference)
{
    static int32_t label[COUNT];
    scene *s = *state;
    rlf_pool *pool = pool_of(3);
    rlf_reconstruct *stage[2] = {make_stage(s, NULL), make_stage(s, pool)};
    for (int f = 0; f < 8; f++) {
        see(s);
        memcpy(label, seen_view_process(&s->view, stage[0], f)->label, sizeof label);
        assert_memory_equal(label, seen_view_process(&s->view, stage[1], f)->label, sizeof label);
    }
    rlf_reconstruct_destroy(&stage[0]);
    rlf_reconstruct_destroy(&stage[1]);
    rlf_pool_destroy(&pool);
}

TEST_CASE(a_reset_forgets)
{
    static int32_t label[COUNT];
    scene *s = *state;
    rlf_reconstruct *stage[2] = {make_stage(s, NULL), make_stage(s, NULL)};
    for (int f = 0; f < 6; f++) {
        see(s);
        seen_view_process(&s->view, stage[1], f);
    }
    rlf_reconstruct_reset(stage[1]);
    for (int f = 0; f < 6; f++) {
        see(s);
        const rlf_surface *first = seen_view_process(&s->view, stage[0], f);
        memcpy(label, first->label, sizeof label);
        const rlf_surface *again = seen_view_process(&s->view, stage[1], f);
        assert_int_equal(first->region_count, again->region_count);
        int32_t shift = again->regions[0].label - first->regions[0].label;
        for (int i = 0; i < COUNT; i++) {
            assert_int_equal(label[i] > 0 ? label[i] + shift : 0, again->label[i]);
        }
    }
    rlf_reconstruct_destroy(&stage[0]);
    rlf_reconstruct_destroy(&stage[1]);
}

TEST_GROUP(set_up, seen_view_destroy)
TEST_EACH(begin_noise, NULL)
