/* The solid of a torso against itself, and the filter that fits it against a torso that is known:
 * seen from the side with an arm before it, and while it turns. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "surface/thickness/torso.h"

static rlf_torso usual(double angle)
{
    rlf_torso t = {.label = 1, .head = {0.2, -0.5, 2.6}};
    t.side_x = rlf_cos(angle);
    t.side_z = rlf_sin(angle);
    rlf_torso_usual(t.unknown, t.doubt);
    return t;
}

/* One whose every unknown is off the usual by about a deviation. */
static rlf_torso other(double angle)
{
    rlf_torso t = usual(angle);
    for (int k = 0; k < RLF_TORSO_UNKNOWNS; k++) {
        t.unknown[k] += (k % 2 == 0 ? 0.8 : -0.6) * sqrt(t.doubt[k][k]);
    }
    t.unknown[RLF_TORSO_TURN] = 0.0;
    return t;
}

/* Of the trunk, and of the shoulders; enter > leave where it misses. */
static void cut_by_ray(const rlf_torso *t, double x, double y, rlf_torso_cut out[2])
{
    rlf_kernel_ray_lanes rays;
    rlf_kernel_cuts cuts[2];
    rlf_torso_begin_rays(t, &rays);
    rlf_torso_add_ray(t, x, y, &rays);
    rlf_torso_close_rays(&rays);
    rlf_torso_cut_rays(t, &rays, &cuts[0]);
    out[0] = (rlf_torso_cut){cuts[0].enter[0], cuts[0].leave[0]};
    out[1] = (rlf_torso_cut){1.0, 0.0};
    if (rlf_torso_cut_shoulders(t, &rays, &cuts[1])) {
        out[1] = (rlf_torso_cut){cuts[1].enter[0], cuts[1].leave[0]};
    }
}

/* Of one place; how far it was moved only if it is on the rim. */
typedef struct touch {
    double distance, slope[RLF_TORSO_UNKNOWNS], moved_m;
} touch;

static bool keep_first(const rlf_kernel_touches *all, touch *out)
{
    out->distance = all->distance[0];
    for (int k = 0; k < RLF_TORSO_UNKNOWNS; k++) {
        out->slope[k] = all->slope[k][0];
    }
    return all->is_any[0] > 0.0;
}

static bool touch_at(const rlf_torso *t, rlf_vec3 p, touch *out)
{
    rlf_kernel_touches all;
    rlf_torso_touch(t, &p, 1, &all);
    return keep_first(&all, out);
}

static bool touch_rim(const rlf_torso *t, rlf_vec3 p, touch *out)
{
    rlf_kernel_touches all;
    double moved_m[RLF_KERNEL_RAYS];
    rlf_torso_touch_rim(t, &p, 1, &all, moved_m);
    out->moved_m = moved_m[0];
    return keep_first(&all, out);
}

/* First of its parts on the ray; false when it misses both. */
static bool hit(const rlf_torso *t, double x, double y, double *enter, double *leave)
{
    rlf_torso_cut cut[2];
    cut_by_ray(t, x, y, cut);
    bool has[2] = {cut[0].enter < cut[0].leave, cut[1].enter < cut[1].leave};
    int k = has[1] && (!has[0] || cut[1].enter < cut[0].enter) ? 1 : 0;
    *enter = cut[k].enter;
    *leave = cut[k].leave;
    return has[k];
}

static void rays_end_on_the_surface(void **state)
{
    (void)state;
    int hits = 0;
    for (int turn = 0; turn < 12; turn++) {
        const rlf_torso t = other(0.26 * turn);
        for (double y = -0.1; y < 0.1; y += 0.01) {
            for (double x = -0.05; x < 0.2; x += 0.01) {
                double enter, leave;
                touch found;
                if (!hit(&t, x, y, &enter, &leave) ||
                    !touch_at(&t, rlf_vec3_make(enter * x, enter * y, enter), &found)) {
                    continue;
                }
                hits++;
                assert_true(leave - enter < 0.55);
                /* below the shoulders' middle points are rather of an arm than of their underside
                 */
                double below = enter * y - t.head.y - t.unknown[RLF_TORSO_DROP];
                bool is_underside = below > 0.38 && below < 0.415;
                assert_true(found.distance > -0.03 &&
                            found.distance < (is_underside ? 0.09 : 0.012));
            }
        }
    }
    assert_true(hits > 1000);
}

/* The torso with one of its unknowns so much greater. */
static rlf_torso other_by(const rlf_torso *t, int unknown, double step)
{
    rlf_torso moved = *t;
    if (unknown == RLF_TORSO_TURN) {
        moved.side_x -= step * t->side_z;
        moved.side_z += step * t->side_x;
    } else {
        moved.unknown[unknown] += step;
    }
    return moved;
}

/* Near the surface every slope is what the distance does when that unknown changes a little. (The
 * trunk's fall with height, which is gentle, is left out; farther away points do not count.) */
static void slopes_are_derivatives(void **state)
{
    (void)state;
    const double step = 1e-6;
    int near = 0;
    for (int i = 0; i < 400; i++) {
        rlf_torso t = other(0.37 * i);
        rlf_vec3 p = {t.head.x + (0.13 + 0.0001 * i) * rlf_cos(1.3 * i),
                      t.head.y + 0.3 + 0.0014 * i,
                      t.head.z + (0.13 + 0.0001 * i) * rlf_sin(1.3 * i)};
        touch here, there;
        if (!touch_at(&t, p, &here) || fabs(here.distance) > 0.03) {
            continue;
        }
        near++;
        for (int k = 0; k < RLF_TORSO_UNKNOWNS; k++) {
            rlf_torso moved = other_by(&t, k, step);
            assert_true(touch_at(&moved, p, &there));
            double found = (there.distance - here.distance) / step;
            assert_true(k == RLF_TORSO_DROP ||
                        fabs(found - here.slope[k]) < 0.05 + 15.0 * fabs(here.distance));
        }
    }
    assert_true(near > 100);
}

/* The place where a row of rays at slope y leaves the trunk's picture, towards -1 or 1; false when
 * it misses the trunk. */
static bool find_outline(const rlf_torso *t, double y, double towards, rlf_vec3 *out)
{
    rlf_torso_cut cut[2];
    double inside = t->head.x / t->head.z, outside = inside + 0.15 * towards, z = 0.0;
    cut_by_ray(t, inside, y, cut);
    if (!(cut[0].enter < cut[0].leave)) {
        return false;
    }
    for (int i = 0; i < 40; i++) {
        double x = 0.5 * (inside + outside);
        cut_by_ray(t, x, y, cut);
        bool is_hit = cut[0].enter < cut[0].leave;
        inside = is_hit ? x : inside;
        outside = is_hit ? outside : x;
        z = is_hit ? cut[0].enter : z;
    }
    *out = rlf_vec3_make(z * inside, z * y, z);
    return true;
}

/* A place on the trunk's outline is on its surface, even where it was seen too near; and every
 * slope is what the distance does. */
static void outlines_are_on_the_surface(void **state)
{
    (void)state;
    const double step = 1e-6;
    int found = 0;
    for (int i = 0; i < 200; i++) {
        rlf_torso t = other(0.37 * i);
        rlf_vec3 p;
        touch here, there;
        if (!find_outline(&t, -0.03 + 0.0007 * i, i % 2 == 0 ? 1.0 : -1.0, &p)) {
            continue;
        }
        p = rlf_scale(p, 0.99);
        if (!touch_rim(&t, p, &here)) {
            continue;
        }
        found++;
        assert_true(fabs(here.distance) < 0.002 && fabs(here.moved_m - 0.01 * p.z) < 0.03);
        for (int k = 0; k < RLF_TORSO_UNKNOWNS; k++) {
            rlf_torso moved = other_by(&t, k, step);
            assert_true(touch_rim(&moved, p, &there));
            double slope = (there.distance - here.distance) / step;
            assert_true(k == RLF_TORSO_DROP || fabs(slope - here.slope[k]) < 0.05);
        }
    }
    assert_true(found > 100);
}

enum { MOST = 600 };

/* What the camera sees of the torso, every 3 cm, and of an arm that hangs before it. */
static int32_t see(const rlf_torso *t, bool has_arm, rlf_vec3 out[MOST])
{
    const double arm_x = t->head.x, arm_z = t->head.z - 0.22, arm_r = 0.05;
    int32_t count = 0;
    for (double y = t->head.y + 0.27; y < t->head.y + 0.9 && count < MOST; y += 0.03) {
        for (double x = t->head.x - 0.3; x < t->head.x + 0.3 && count < MOST; x += 0.03) {
            double z = t->head.z, enter, leave;
            bool is_hit = hit(t, x / z, y / z, &enter, &leave);
            bool is_arm = has_arm && fabs(x - arm_x) < arm_r && y > t->head.y + 0.36;
            double before = arm_z - sqrt(fabs(arm_r * arm_r - (x - arm_x) * (x - arm_x)));
            z = is_hit ? enter : 0.0;
            z = is_arm && (z == 0.0 || before < z) ? before : z;
            if (z > 0.0) {
                out[count++] = rlf_vec3_make(z * x / t->head.z, z * y / t->head.z, z);
            }
        }
    }
    return count;
}

static double turned_from(const rlf_torso *a, const rlf_torso *b)
{
    return fabs(a->side_x * b->side_z - a->side_z * b->side_x);
}

/* Mean difference of where rays leave the two torsos. */
static double backs_differ(const rlf_torso *a, const rlf_torso *b)
{
    double sum = 0.0;
    int count = 0;
    for (double y = -0.07; y < 0.12; y += 0.01) {
        for (double x = 0.0; x < 0.16; x += 0.01) {
            double enter, la, lb;
            if (hit(a, x, y, &enter, &la) && hit(b, x, y, &enter, &lb)) {
                sum += fabs(la - lb);
                count++;
            }
        }
    }
    assert_true(count > 50);
    return sum / count;
}

/* Seen from the side, the far half never seen. */
static void the_far_side_is_found(void **state)
{
    (void)state;
    rlf_vec3 seen[MOST];
    for (int arm = 0; arm < 2; arm++) {
        const rlf_torso truth = other(1.45);
        rlf_torso found = usual(1.6);
        const double before = backs_differ(&truth, &found);
        const rlf_torso_points points = {
            .p = seen, .count = see(&truth, arm != 0, seen), .area_m2 = 0.0009};
        for (int frame = 0; frame < 10; frame++) {
            rlf_torso_improve(&found, &points, 2);
        }
        double after = backs_differ(&truth, &found);
        assert_true(turned_from(&truth, &found) < (arm != 0 ? 0.1 : 0.05));
        assert_true(after < 0.02 && after < 0.7 * before);
    }
}

/* A person turns by a right angle in 0.7 s. */
static void a_turn_is_followed(void **state)
{
    (void)state;
    rlf_vec3 seen[MOST];
    rlf_torso found = usual(1.5);
    for (int frame = 0; frame < 30; frame++) {
        const rlf_torso truth = other(1.5 - 0.075 * (frame < 20 ? frame : 20));
        const rlf_torso_points points = {
            .p = seen, .count = see(&truth, true, seen), .area_m2 = 0.0009};
        found.doubt[RLF_TORSO_TURN][RLF_TORSO_TURN] += 0.0064;
        rlf_torso_improve(&found, &points, 2);
        assert_true(turned_from(&truth, &found) < 0.3);
    }
    assert_true(found.misfit < 0.5 && found.area_m2 > 0.1);
}

/* Of a trunk seen from the side, an arm before it, outlines tell how deep it is. */
static void outlines_tell_the_depth(void **state)
{
    (void)state;
    rlf_vec3 seen[MOST], rim[MOST];
    rlf_torso truth = usual(1.5708), found = truth;
    rlf_torso_points points = {.p = seen, .rim = rim, .area_m2 = 0.0009};
    for (int k = 0; k < 3; k++) {
        truth.unknown[RLF_TORSO_DEPTH + k] += 0.02;
    }
    points.count = see(&truth, true, seen);
    for (double y = -0.2; y < 0.15; y += 0.01) {
        for (int side = 0; side < 2; side++) {
            points.rim_count +=
                find_outline(&truth, y, side == 0 ? -1.0 : 1.0, &rim[points.rim_count]) ? 1 : 0;
        }
    }
    for (int frame = 0; frame < 10; frame++) {
        rlf_torso_improve(&found, &points, 2);
    }
    for (int k = 0; k < 3; k++) {
        assert_true(fabs(found.unknown[RLF_TORSO_DEPTH + k] - truth.unknown[RLF_TORSO_DEPTH + k]) <
                    0.005);
    }
}

/* Few points leave a torso as it was, and say so. */
static void nothing_is_made_of_nothing(void **state)
{
    (void)state;
    rlf_torso found = usual(0.3);
    const rlf_torso before = found;
    const rlf_torso_points none = {.area_m2 = 0.001};
    rlf_torso_improve(&found, &none, 3);
    assert_true(found.misfit == 1.0 && found.area_m2 == 0.0);
    assert_true(turned_from(&before, &found) < 1e-12);
    for (int k = 0; k < RLF_TORSO_UNKNOWNS; k++) {
        assert_true(fabs(found.unknown[k] - before.unknown[k]) < 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_end_on_the_surface),    cmocka_unit_test(slopes_are_derivatives),
        cmocka_unit_test(the_far_side_is_found),      cmocka_unit_test(a_turn_is_followed),
        cmocka_unit_test(nothing_is_made_of_nothing), cmocka_unit_test(outlines_are_on_the_surface),
        cmocka_unit_test(outlines_tell_the_depth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
