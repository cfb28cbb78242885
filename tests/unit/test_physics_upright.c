/* A column of which a table hides a strip is solid there, too; its side ends where the column does.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "grid_room.h"

#define TOP_Y 0.3
#define TOP_NEAR 1.4
#define TOP_FAR 2.0
#define COLUMN_Z 3.0
#define COLUMN_SIDE 0.3

static int set_up(void **state)
{
    (void)state;
    grid_room_create();
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        rlf_vec3 ray = grid_room_ray(i);
        double z = TOP_Y / ray.y, x = COLUMN_Z * ray.x;
        if (z > TOP_NEAR && z < TOP_FAR) {
            grid_room_paint(i, z, rlf_vec3_make(0, -1, 0));
        } else if (x > -COLUMN_SIDE && x < COLUMN_SIDE && COLUMN_Z * ray.y < GRID_ROOM_FLOOR) {
            grid_room_paint(i, COLUMN_Z, rlf_vec3_make(0, 0, -1));
        }
    }
    return 0;
}

/* How far a ball comes that flies away from the camera, hidden by the table. */
static double fly(rlf_border border, double x, double y)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape = (rlf_shape){.type = RLF_SHAPE_SPHERE, .radius = 0.04};
    def.position = rlf_vec3_make(x, y, 2.5);
    def.velocity = rlf_vec3_make(0, 0, 2);
    def.gravity_scale = 0.0;
    const grid_room_way way = grid_room_run(border, &def, 20);
    assert_true(way.is_there);
    return way.farthest_z;
}

static void column_goes_on_behind_a_table(void **state)
{
    (void)state;
    for (double y = 0.47; y < 0.52; y += 0.01) {
        assert_true(fly(RLF_BORDER_EXTEND, 0.1, y) < COLUMN_Z - 0.03);
        assert_true(fly(RLF_BORDER_EXTEND, -0.2, y) < COLUMN_Z - 0.03);
    }
}

/* Beside the column nothing is seen above the hidden place but the wall. */
static void air_beside_it_is_free(void **state)
{
    (void)state;
    assert_true(fly(RLF_BORDER_EXTEND, 0.5, 0.5) > COLUMN_Z + 0.3);
    assert_true(fly(RLF_BORDER_OPEN, 0.1, 0.5) > COLUMN_Z + 0.3);
}

/* The side of a column on the right, whose foot the table hides, is no wall before the column. */
static void side_of_a_column_ends_with_it(void **state)
{
    (void)state;
    const double DEPTH = 0.5;
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        rlf_vec3 ray = grid_room_ray(i);
        double table = TOP_Y / ray.y, z = COLUMN_SIDE / ray.x;
        bool is_hidden = table > TOP_NEAR && table < TOP_FAR;
        if (!is_hidden && z > COLUMN_Z && z < COLUMN_Z + DEPTH && z * ray.y < GRID_ROOM_FLOOR) {
            grid_room_paint(i, z, rlf_vec3_make(-1, 0, 0));
        } else if (!is_hidden && z > 0.0 && z < COLUMN_Z && COLUMN_Z * ray.y < GRID_ROOM_FLOOR) {
            grid_room_paint(i, COLUMN_Z, rlf_vec3_make(0, 0, -1));
        }
    }
    rlf_body_def def = rlf_body_def_default();
    def.shape = (rlf_shape){.type = RLF_SHAPE_SPHERE, .radius = 0.04};
    def.velocity = rlf_vec3_make(1, 0, 0);
    def.gravity_scale = 0.0;
    for (double z = 2.4; z < 2.8; z += 0.1) {
        def.position = rlf_vec3_make(0.05, 0.19 * z, z);
        assert_true(grid_room_run(RLF_BORDER_EXTEND, &def, 15).p.x > COLUMN_SIDE + 0.1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(column_goes_on_behind_a_table),
        cmocka_unit_test(air_beside_it_is_free),
        cmocka_unit_test(side_of_a_column_ends_with_it),
    };
    return cmocka_run_group_tests(tests, set_up, grid_room_destroy);
}
