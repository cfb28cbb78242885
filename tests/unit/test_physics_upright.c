/* A column of which a table hides a strip is solid there, too. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "relief/world.h"

#include "grid_fixture.h"

#define FRAME (1.0 / 30)
#define TOP_Y 0.3
#define TOP_NEAR 1.4
#define TOP_FAR 2.0
#define COLUMN_Z 3.0
#define COLUMN_SIDE 0.3

static grid_fixture *fixture;

static void paint(int32_t i, double z, rlf_vec3 n)
{
    fixture->planes[2][i] = (float)z;
    fixture->planes[3][i] = (float)n.x;
    fixture->planes[4][i] = (float)n.y;
    fixture->planes[5][i] = (float)n.z;
}

static int set_up(void **state)
{
    (void)state;
    fixture = grid_fixture_create();
    grid_plane room[2] = {grid_floor(1.0), grid_wall(4)};
    grid_fixture_set_room(fixture, room, 2);
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        double ray_x = (double)fixture->planes[0][i], ray_y = (double)fixture->planes[1][i];
        double z = TOP_Y / ray_y, x = COLUMN_Z * ray_x;
        if (z > TOP_NEAR && z < TOP_FAR) {
            paint(i, z, rlf_vec3_make(0, -1, 0));
        } else if (x > -COLUMN_SIDE && x < COLUMN_SIDE && COLUMN_Z * ray_y < 1.0) {
            paint(i, COLUMN_Z, rlf_vec3_make(0, 0, -1));
        }
    }
    fixture->grid.background.default_thickness = 0.15;
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    grid_fixture_destroy(&fixture);
    return 0;
}

/* How far a ball comes that flies away from the camera, hidden by the table. */
static double fly(rlf_border border, double x, double y)
{
    rlf_world_def world_def = rlf_world_def_default();
    world_def.border = border;
    world_def.body_capacity = 1;
    rlf_world *world = NULL;
    assert_int_equal(rlf_world_create(&world_def, &world), RLF_OK);
    rlf_body_def def = rlf_body_def_default();
    def.shape = (rlf_shape){.type = RLF_SHAPE_SPHERE, .radius = 0.04};
    def.position = rlf_vec3_make(x, y, 2.5);
    def.velocity = rlf_vec3_make(0, 0, 2);
    def.gravity_scale = 0.0;
    assert_int_equal(rlf_world_add_body(world, &def, NULL), RLF_OK);
    double farthest = 0.0;
    for (int k = 0; k < 20; k++) {
        fixture->grid.time_ns++;
        rlf_world_advance(world, &fixture->grid, FRAME);
        farthest = rlf_max(farthest, rlf_world_get_snapshot(world)->bodies[0].T_world_body.p.z);
    }
    rlf_world_destroy(&world);
    return farthest;
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(column_goes_on_behind_a_table),
        cmocka_unit_test(air_beside_it_is_free),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
