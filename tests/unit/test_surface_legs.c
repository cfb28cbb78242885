/* The solid of a leg against itself, and the filter that follows legs against legs that are known:
 * seen from the side while they walk, one behind the other, and from the front while they stand. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "surface/thickness/legs.h"

static const double frame_s = 1.0 / 30.0;

/* Its right shoulder is to the camera's right when the angle is 0. */
static rlf_torso usual(double angle)
{
    double of_leg[RLF_LEG_UNKNOWNS];
    rlf_torso t = {.label = 1, .head = {0.1, -0.4, 2.8}};
    t.side_x = rlf_cos(angle);
    t.side_z = rlf_sin(angle);
    rlf_torso_usual(t.unknown, t.doubt);
    for (int leg = 0; leg < 2; leg++) {
        rlf_leg_usual(&t, leg == 0 ? -1.0 : 1.0, t.leg[leg].unknown, of_leg);
    }
    return t;
}

/* Puts knee and ankle so that the thigh is turned ahead, and the knee bent, by angles. */
static void put(rlf_torso *t, int leg, double ahead, double bent)
{
    double *u = t->leg[leg].unknown;
    rlf_vec3 hip = rlf_leg_shape_of(t, leg).part[RLF_THIGH].begin;
    u[RLF_LEG_KNEE] = u[RLF_LEG_ANKLE] = hip.x;
    u[RLF_LEG_KNEE + 1] = hip.y + 0.41 * rlf_cos(ahead);
    u[RLF_LEG_KNEE + 2] = hip.z + 0.41 * rlf_sin(ahead);
    u[RLF_LEG_ANKLE + 1] = u[RLF_LEG_KNEE + 1] + 0.4 * rlf_cos(ahead - bent);
    u[RLF_LEG_ANKLE + 2] = u[RLF_LEG_KNEE + 2] + 0.4 * rlf_sin(ahead - bent);
}

static void walk(rlf_torso *t, double s)
{
    for (int leg = 0; leg < 2; leg++) {
        double phase = 2.0 * RLF_PI * 0.9 * s + RLF_PI * leg;
        put(t, leg, 0.42 * rlf_sin(phase), 0.35 + 0.3 * rlf_cos(phase));
    }
}

static rlf_vec3 camera_of(const rlf_torso *t)
{
    return rlf_torso_place(t, rlf_vec3_make(0.0, 0.0, 0.0));
}

/* Both legs' axes of a torso. */
static rlf_kernel_legs legs_of(const rlf_torso *t)
{
    const rlf_leg_shape shape[2] = {rlf_leg_shape_of(t, 0), rlf_leg_shape_of(t, 1)};
    return rlf_legs_of(shape, camera_of(t));
}

static rlf_torso_cut cut_by_ray(const rlf_torso *t, const rlf_leg_part *part, double x, double y)
{
    const rlf_kernel_limb limb = rlf_leg_limb(part, camera_of(t));
    rlf_kernel_ray_lanes rays;
    rlf_kernel_cuts cuts;
    rlf_torso_begin_rays(t, &rays);
    rlf_torso_add_ray(t, x, y, &rays);
    rlf_torso_close_rays(&rays);
    rlf_kernel_cut_limb(&limb, &rays, 0, rays.count, &cuts);
    return (rlf_torso_cut){cuts.enter[0], cuts.leave[0]};
}

/* Depth at which the ray meets the legs first; 0 = nowhere. */
static double meet(const rlf_torso *t, double x, double y, int *leg)
{
    double first = 1e9;
    for (int k = 0; k < 2; k++) {
        rlf_leg_shape shape = rlf_leg_shape_of(t, k);
        for (int part = 0; part < RLF_LEG_PARTS; part++) {
            rlf_torso_cut cut = cut_by_ray(t, &shape.part[part], x, y);
            if (cut.enter < cut.leave && cut.enter < first) {
                first = cut.enter;
                *leg = k;
            }
        }
    }
    return first < 1e9 ? first : 0.0;
}

static void places_are_points(void **state)
{
    (void)state;
    const rlf_torso t = usual(0.7);
    const rlf_vec3 p = {0.3, 0.5, 2.5};
    assert_true(rlf_length(rlf_sub(rlf_torso_point(&t, rlf_torso_place(&t, p)), p)) < 1e-12);
}

static void rays_end_on_the_surface(void **state)
{
    (void)state;
    int hits = 0;
    for (int i = 0; i < 12; i++) {
        rlf_torso t = usual(0.5 * i);
        walk(&t, 0.1 * i);
        for (double y = 0.17; y < 0.5; y += 0.01) {
            for (double x = -0.2; x < 0.3; x += 0.005) {
                int leg = 0;
                double z = meet(&t, x, y, &leg);
                if (z > 0.0) {
                    rlf_kernel_nearest nearest;
                    rlf_kernel_places places;
                    const rlf_kernel_legs legs = legs_of(&t);
                    rlf_vec3 p = rlf_torso_place(&t, rlf_vec3_make(z * x, z * y, z));
                    hits++;
                    rlf_places_read(&p, 1, &places);
                    rlf_kernel_find_nearest(legs.axis, 2 * RLF_LEG_PARTS, &places, &nearest);
                    assert_true(fabs(nearest.distance[0]) < 0.006);
                    assert_true((int)nearest.axis[0] / RLF_LEG_PARTS == leg);
                }
            }
        }
    }
    assert_true(hits > 2000);
}

/* Of one place and the part. */
static rlf_kernel_touches touch_at(const rlf_torso *t, int part, rlf_vec3 p)
{
    const rlf_kernel_legs legs = legs_of(t);
    rlf_kernel_places places;
    rlf_kernel_touches out;
    double axis[RLF_KERNEL_RAY_LANES];
    for (int i = 0; i < RLF_KERNEL_RAY_LANES; i++) {
        axis[i] = part;
    }
    rlf_places_read(&p, 1, &places);
    rlf_kernel_touch_legs(&legs, &places, axis, &out);
    return out;
}

static void slopes_are_derivatives(void **state)
{
    (void)state;
    const double step = 1e-6;
    for (int i = 0; i < 300; i++) {
        rlf_torso t = usual(0.3);
        walk(&t, 0.05 * i);
        t.leg[0].unknown[RLF_LEG_TOES] = 0.1;
        rlf_leg_shape shape = rlf_leg_shape_of(&t, 0);
        const rlf_leg_part *s = &shape.part[i % RLF_LEG_PARTS];
        rlf_vec3 middle = rlf_mad(s->begin, rlf_sub(s->end, s->begin), 0.1 + 0.0026 * i);
        rlf_vec3 toward = rlf_normalize(rlf_sub(camera_of(&t), middle));
        rlf_vec3 p = rlf_mad(middle, toward, 0.08);
        p.x += 0.03;
        const rlf_kernel_touches here = touch_at(&t, i % RLF_LEG_PARTS, p);
        for (int k = 0; k < RLF_LEG_UNKNOWNS; k++) {
            rlf_torso moved = t;
            moved.leg[0].unknown[k] += step;
            const rlf_kernel_touches there = touch_at(&moved, i % RLF_LEG_PARTS, p);
            double found = (there.distance[0] - here.distance[0]) / step;
            /* the radius changes along a part: little, and not in the slopes */
            assert_true(fabs(found - here.slope[k][0]) < 0.07);
        }
    }
}

enum { MOST = 1200 };

/* What the camera sees of the legs below the crotch, every 2 cm; of one of them nothing. */
static rlf_torso_points see(const rlf_torso *t, int unseen, rlf_vec3 out[MOST])
{
    rlf_torso_points points = {.p = out, .area_m2 = 0.02 * 0.02};
    for (double y = 0.47; y < 1.5; y += 0.02) {
        for (double x = -0.6; x < 0.7 && points.count < MOST; x += 0.02) {
            int leg = 0;
            double rx = x / t->head.z, ry = y / t->head.z, z = meet(t, rx, ry, &leg);
            if (z > 0.0 && leg != unseen) {
                out[points.count++] = rlf_torso_place(t, rlf_vec3_make(z * rx, z * ry, z));
            }
        }
    }
    return points;
}

/* Of knee and ankle, metres. */
static double joints_differ(const rlf_leg *a, const rlf_leg *b)
{
    double sum = 0.0;
    for (int joint = 0; joint < 2; joint++) {
        double square = 0.0;
        for (int k = 3 * joint; k < 3 * joint + 3; k++) {
            square += (a->unknown[k] - b->unknown[k]) * (a->unknown[k] - b->unknown[k]);
        }
        sum += 0.5 * sqrt(square);
    }
    return sum;
}

/* From the side the near leg hides the far one in part, and now and then for a fifth of a second
 * it is not seen at all. */
static void a_hidden_leg_is_where_it_went(void **state)
{
    (void)state;
    static rlf_vec3 seen[MOST];
    rlf_torso real = usual(0.5 * RLF_PI), found = usual(0.5 * RLF_PI);
    const int far = camera_of(&real).x < 0.0 ? 1 : 0;
    double near = 0.0, visible = 0.0, hidden = 0.0;
    for (int i = 0; i < 140; i++) {
        bool is_hidden = i % 40 >= 34;
        walk(&real, i * frame_s);
        rlf_torso_points points = see(&real, is_hidden ? far : -1, seen);
        rlf_legs_follow(&found, &points, i == 0 ? 0.0 : frame_s);
        double off = i < 20 ? 0.0 : joints_differ(&real.leg[far], &found.leg[far]);
        near += i < 20 ? 0.0 : joints_differ(&real.leg[1 - far], &found.leg[1 - far]);
        hidden += is_hidden ? off : 0.0;
        visible += is_hidden ? 0.0 : off;
    }
    assert_true(near < 120 * 0.01 && visible < 102 * 0.02 && hidden < 18 * 0.1);
}

/* From the front the toes are seen, and say where the heels are. */
static void toes_tell_the_heels(void **state)
{
    (void)state;
    static rlf_vec3 seen[MOST];
    for (int turned = 0; turned < 2; turned++) {
        rlf_torso real = usual(0.0), found = usual(0.0);
        put(&real, 0, 0.1, 0.2);
        put(&real, 1, -0.1, 0.1);
        real.leg[0].unknown[RLF_LEG_TOES] = 0.2;
        real.facing = turned == 0 ? -1.0 : 1.0; /* to the camera, and away */
        for (int i = 0; i < 20; i++) {
            rlf_torso_points points = see(&real, -1, seen);
            rlf_legs_follow(&found, &points, i == 0 ? 0.0 : frame_s);
        }
        for (int leg = 0; leg < 2; leg++) {
            rlf_leg_part a = rlf_leg_shape_of(&real, leg).part[RLF_FOOT];
            rlf_leg_part b = rlf_leg_shape_of(&found, leg).part[RLF_FOOT];
            assert_true(rlf_length(rlf_sub(a.begin, b.begin)) < 0.01);
            assert_true(rlf_length(rlf_sub(a.end, b.end)) < 0.01);
        }
    }
}

/* Where rows of the picture enter and leave the legs below the crotch, to a millimetre. */
static void add_rim(const rlf_torso *t, rlf_vec3 out[MOST], rlf_torso_points *points)
{
    points->rim = out;
    for (double y = 0.55; y < 1.3; y += 0.02) {
        double before = 0.0;
        for (double x = -0.3; x < 0.5; x += 0.001) {
            int leg = 0;
            double rx = x / t->head.z, ry = y / t->head.z, z = meet(t, rx, ry, &leg);
            if ((z > 0.0) != (before > 0.0)) {
                double at = z > 0.0 ? z : before;
                out[points->rim_count++] = rlf_torso_place(t, rlf_vec3_make(at * rx, at * ry, at));
            }
            before = z;
        }
    }
}

/* Slender legs and stout ones, that hang ahead of the trunk or behind it. */
static void outlines_tell_how_thick_legs_are(void **state)
{
    (void)state;
    static const double radius[2][3] = {{0.08, 0.055, 0.042}, {0.115, 0.085, 0.056}};
    static rlf_vec3 seen[MOST], rim[MOST];
    for (int build = 0; build < 2; build++) {
        rlf_torso real = usual(0.0), found = usual(0.0);
        for (int leg = 0; leg < 2; leg++) {
            memcpy(&real.leg[leg].unknown[RLF_LEG_RADIUS], radius[build], sizeof radius[build]);
            real.leg[leg].unknown[RLF_LEG_HIP] = build == 0 ? 0.03 : -0.03;
            put(&real, leg, 0.05, 0.1);
        }
        rlf_torso_points points = see(&real, -1, seen);
        add_rim(&real, rim, &points);
        for (int i = 0; i < 30; i++) {
            rlf_legs_follow(&found, &points, i == 0 ? 0.0 : frame_s);
        }
        for (int joint = 0; joint < 3; joint++) {
            double off = found.leg[0].unknown[RLF_LEG_RADIUS + joint] - radius[build][joint];
            assert_true(fabs(off) < 0.004);
        }
        double ahead = real.leg[0].unknown[RLF_LEG_HIP] - found.leg[0].unknown[RLF_LEG_HIP];
        assert_true(fabs(ahead) < 0.01);
    }
}

/* A leg of which nothing is seen for long may be anywhere. */
static void what_is_not_seen_is_not_known(void **state)
{
    (void)state;
    static rlf_vec3 seen[MOST];
    rlf_torso real = usual(0.0), found = usual(0.0);
    rlf_torso_points points = see(&real, -1, seen);
    rlf_legs_follow(&found, &points, 0.0);
    double at_first = found.leg[0].doubt[RLF_LEG_ANKLE + 2][RLF_LEG_ANKLE + 2];
    points.count = 0;
    for (int i = 0; i < 60; i++) {
        rlf_legs_follow(&found, &points, frame_s);
    }
    double later = found.leg[0].doubt[RLF_LEG_ANKLE + 2][RLF_LEG_ANKLE + 2];
    assert_true(sqrt(at_first) < 0.03 && sqrt(later) > 0.1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(places_are_points),
        cmocka_unit_test(rays_end_on_the_surface),
        cmocka_unit_test(slopes_are_derivatives),
        cmocka_unit_test(a_hidden_leg_is_where_it_went),
        cmocka_unit_test(toes_tell_the_heels),
        cmocka_unit_test(what_is_not_seen_is_not_known),
        cmocka_unit_test(outlines_tell_how_thick_legs_are),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
