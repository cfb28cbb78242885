/* A table's top is solid behind what stands on it, where nothing of it is seen. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "grid_room.h"

#define TOP_Y 0.3
#define TOP_NEAR 1.4
#define TOP_FAR 2.0
#define CARTON_Y 0.1 /* of its lid */
#define CARTON_NEAR 1.6
#define CARTON_FAR 1.75
#define CARTON_SIDE 0.15
#define CORNER_Z 1.55
#define CORNER_FAR 1.75
#define CORNER_SLOPE 1.0
#define HALF 0.03 /* of the cube that falls */

static void paint(double right)
{
    grid_room_create();
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        rlf_vec3 ray = grid_room_ray(i);
        double top = TOP_Y / ray.y, lid = CARTON_Y / ray.y;
        double x = CARTON_NEAR * ray.x, y = CARTON_NEAR * ray.y;
        if (top > TOP_NEAR && top < TOP_FAR && top * ray.x < right) {
            grid_room_paint(i, top, rlf_vec3_make(0, -1, 0));
        }
        if (x > -CARTON_SIDE && x < CARTON_SIDE && y > CARTON_Y && y < TOP_Y) {
            grid_room_paint(i, CARTON_NEAR, rlf_vec3_make(0, 0, -1));
        } else if (lid > CARTON_NEAR && lid < CARTON_FAR && lid * ray.x > -CARTON_SIDE &&
                   lid * ray.x < CARTON_SIDE) {
            grid_room_paint(i, lid, rlf_vec3_make(0, -1, 0));
        }
    }
}

/* A carton with an edge towards the camera. Where its sides come down on the top no depth jumps. */
static void paint_corner(void)
{
    grid_room_create();
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        rlf_vec3 ray = grid_room_ray(i);
        double top = TOP_Y / ray.y, aside = ray.x < 0.0 ? -ray.x : ray.x;
        double z = CORNER_Z / (1.0 - CORNER_SLOPE * aside);
        if (top > TOP_NEAR && top < TOP_FAR) {
            grid_room_paint(i, top, rlf_vec3_make(0, -1, 0));
        }
        if (z > 0.0 && z < CORNER_FAR && z * ray.y > CARTON_Y && z * ray.y < TOP_Y) {
            double side = ray.x < 0.0 ? -CORNER_SLOPE : CORNER_SLOPE;
            grid_room_paint(i, z, rlf_normalize(rlf_vec3_make(side, 0, -1)));
        }
    }
}

/* The height at which a cube lies that was let go above (x, z). */
static double drop(rlf_border border, double x, double z)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape.size = rlf_vec3_make(2 * HALF, 2 * HALF, 2 * HALF);
    def.position = rlf_vec3_make(x, 0.22, z);
    def.restitution = 0.0;
    const grid_room_way way = grid_room_run(border, &def, 12);
    assert_true(way.is_there);
    return way.p.y;
}

static void top_goes_on_behind_a_carton(void **state)
{
    (void)state;
    paint(9.0);
    for (double x = -0.1; x < 0.11; x += 0.05) {
        for (double z = 1.84; z < 1.95; z += 0.03) {
            double y = drop(RLF_BORDER_EXTEND, x, z);
            assert_true(y > TOP_Y - HALF - 0.005 && y < TOP_Y - HALF + 0.005);
        }
    }
    assert_true(drop(RLF_BORDER_OPEN, 0.0, 1.9) > TOP_Y + 0.1);
    grid_room_destroy(NULL);
}

static void top_goes_on_behind_a_corner(void **state)
{
    (void)state;
    paint_corner();
    for (double x = -0.06; x < 0.07; x += 0.03) {
        double y = drop(RLF_BORDER_EXTEND, x, CORNER_FAR + HALF + 0.005);
        assert_true(y > TOP_Y - HALF - 0.005 && y < TOP_Y - HALF + 0.005);
    }
    grid_room_destroy(NULL);
}

/* It ends where it is seen to end, beside the carton. */
static void nothing_is_beyond_its_far_edge(void **state)
{
    (void)state;
    paint(9.0);
    assert_true(drop(RLF_BORDER_EXTEND, 0.0, TOP_FAR + 0.1) > TOP_Y + 0.1);
    grid_room_destroy(NULL);
}

/* A top that is not seen on the carton's other side may end behind it. */
static void one_side_alone_says_nothing(void **state)
{
    (void)state;
    paint(0.1);
    assert_true(drop(RLF_BORDER_EXTEND, 0.0, 1.9) > TOP_Y + 0.1);
    grid_room_destroy(NULL);
}

/* What rises from below has met no top: it is not pushed through. */
static void air_below_it_is_free(void **state)
{
    (void)state;
    paint(9.0);
    rlf_body_def def = rlf_body_def_default();
    def.shape.size = rlf_vec3_make(2 * HALF, 2 * HALF, 2 * HALF);
    def.position = rlf_vec3_make(0.0, TOP_Y + 0.1, 1.9);
    def.gravity_scale = 0.0;
    const grid_room_way way = grid_room_run(RLF_BORDER_EXTEND, &def, 10);
    assert_true(way.is_there && way.p.y > TOP_Y + 0.09);
    grid_room_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(top_goes_on_behind_a_carton),
        cmocka_unit_test(top_goes_on_behind_a_corner),
        cmocka_unit_test(nothing_is_beyond_its_far_edge),
        cmocka_unit_test(one_side_alone_says_nothing),
        cmocka_unit_test(air_below_it_is_free),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
