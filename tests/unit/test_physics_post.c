/* A table of which three legs are seen stands on a fourth. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "grid_room.h"

#define TOP_Y 0.3
#define NEAR 1.65 /* of the legs' axes */
#define FAR 2.15
#define RIM 0.05 /* of the top beyond them */
#define SIDE 0.02
#define RADIUS 0.05

static void paint_nearest(int32_t i, double z, rlf_vec3 n)
{
    if (z < (double)grid_room->planes[2][i]) {
        grid_room_paint(i, z, n);
    }
}

/* Legs at the corners x = left and right, NEAR and FAR, less those that are missing. */
static void paint_table(double left, double right, bool has_top, bool has_near_right)
{
    grid_room_create();
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        rlf_vec3 ray = grid_room_ray(i);
        for (int32_t k = 0; k < 4; k++) {
            bool is_near = (k & 1) == 0, is_right = (k & 2) != 0;
            double z = (is_near ? NEAR : FAR) - SIDE, x = is_right ? right : left;
            bool is_leg = z * ray.x > x - SIDE && z * ray.x < x + SIDE && z * ray.y > TOP_Y;
            if (is_leg && (has_near_right || !is_near || !is_right)) {
                paint_nearest(i, z, rlf_vec3_make(0, 0, -1));
            }
        }
        double z = TOP_Y / ray.y, x = z * ray.x;
        if (has_top && z > NEAR - RIM && z < FAR + RIM && x > left - RIM && x < right + RIM) {
            paint_nearest(i, z, rlf_vec3_make(0, -1, 0));
        }
    }
}

/* Where a body is that slides along x on the floor for half a second. */
static double slide(rlf_shape_type type, double x, double z, double speed)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape = (rlf_shape){.type = type, .radius = RADIUS};
    def.shape.size = rlf_vec3_make(2 * RADIUS, 2 * RADIUS, 2 * RADIUS);
    def.position = rlf_vec3_make(x, GRID_ROOM_FLOOR - RADIUS - 0.002, z);
    def.velocity = rlf_vec3_make(speed, 0, 0);
    def.friction = 0.0;
    def.restitution = 0.0;
    const grid_room_way way = grid_room_run(RLF_BORDER_EXTEND, &def, 15);
    assert_true(way.is_there && way.p.y < GRID_ROOM_FLOOR);
    return way.p.x;
}

/* Its near right leg is beside the picture from top to bottom. */
static void leg_beside_the_picture_stops_a_body(void **state)
{
    const double right = 1.35;
    double u, v;
    (void)state;
    paint_table(0.45, right, true, true);
    assert_false(
        grid_fixture_project(NULL, rlf_vec3_make(right - SIDE, TOP_Y, NEAR + SIDE), &u, &v));
    const double touch = right - SIDE - RADIUS;
    assert_true(slide(RLF_SHAPE_SPHERE, right - 0.3, NEAR, 1.0) < touch + 0.02);
    for (double z = NEAR - 0.03; z < NEAR + 0.04; z += 0.03) {
        double x = slide(RLF_SHAPE_BOX, right - 0.3, z, 1.0);
        assert_true(x < touch + 0.02 && x > touch - 0.05);
    }
    assert_true(slide(RLF_SHAPE_SPHERE, right - 0.3, NEAR - 0.15, 1.0) > right + 0.1);
    assert_true(slide(RLF_SHAPE_BOX, right - 0.3, NEAR - 0.15, 1.0) > right + 0.1);
    assert_true(slide(RLF_SHAPE_BOX, right - 0.3, 0.5 * (NEAR + FAR), 1.0) > right + 0.1);
    grid_room_destroy(NULL);
}

static void posts_without_a_top_are_three(void **state)
{
    (void)state;
    paint_table(0.45, 1.35, false, true);
    assert_true(slide(RLF_SHAPE_SPHERE, 1.05, NEAR, 1.0) > 1.45);
    assert_true(slide(RLF_SHAPE_BOX, 1.05, NEAR, 1.0) > 1.45);
    grid_room_destroy(NULL);
}

/* Where the camera sees that there is none, a table stands on three. */
static void a_corner_that_is_seen_empty_is_free(void **state)
{
    (void)state;
    paint_table(-0.4, 0.4, true, false);
    assert_true(slide(RLF_SHAPE_SPHERE, 0.1, NEAR, 1.0) > 0.5);
    assert_true(slide(RLF_SHAPE_BOX, 0.1, NEAR, 1.0) > 0.5);
    grid_room_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(leg_beside_the_picture_stops_a_body),
        cmocka_unit_test(posts_without_a_top_are_three),
        cmocka_unit_test(a_corner_that_is_seen_empty_is_free),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
