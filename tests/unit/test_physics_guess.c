/* A solid of which only the front is seen is a guess: matter under its faces, not behind them. */
#include "grid_room.h"
#include "test.h"

#define TOP_Y 0.3
#define TOP_NEAR 1.6
#define TOP_FAR 2.2
#define TOP_SIDE 0.4
#define RADIUS 0.05

/* A thin table's top in a room. */
static int set_up(void **state)
{
    (void)state;
    grid_room_create();
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        double z = TOP_Y / grid_room_ray(i).y, x = z * grid_room_ray(i).x;
        if (z > TOP_NEAR && z < TOP_FAR && x > -TOP_SIDE && x < TOP_SIDE) {
            grid_room_paint(i, z, rlf_vec3_make(0, -1, 0));
        }
    }
    return 0;
}

/* Where a body of 5 cm lies a second after it was let go. */
static rlf_vec3 drop(rlf_shape shape, rlf_vec3 from)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape = shape;
    def.position = from;
    def.restitution = 0.0;
    const grid_room_way way = grid_room_run(RLF_BORDER_OPEN, &def, 30);
    assert_true(way.is_there);
    return way.p;
}

static rlf_shape shape_of(int k)
{
    const rlf_shape shapes[2] = {
        {.type = RLF_SHAPE_BOX, .size = {2 * RADIUS, 2 * RADIUS, 2 * RADIUS}},
        {.type = RLF_SHAPE_SPHERE, .radius = RADIUS}};
    return shapes[k];
}

/* On their rays there is matter behind the table's far edge, 15 cm of it. */
TEST_CASE(body_falls_freely_behind_a_tables_far_edge)
{
    for (int k = 0; k < 2; k++) {
        for (double gap = 0.02; gap < 0.1; gap += 0.02) {
            rlf_vec3 from = {0.1, -0.1, TOP_FAR + RADIUS + gap};
            rlf_vec3 p = drop(shape_of(k), from);
            assert_true(p.y > 1.0 - RADIUS - 0.01);
            assert_true(p.x - from.x < 1e-3 && from.x - p.x < 1e-3);
            assert_true(p.z - from.z < 1e-3 && from.z - p.z < 1e-3);
        }
    }
}

TEST_CASE(body_lies_on_the_table)
{
    for (int k = 0; k < 2; k++) {
        for (double z = TOP_NEAR + 0.05; z < TOP_FAR - 0.04; z += 0.08) {
            rlf_vec3 p = drop(shape_of(k), rlf_vec3_make(0.1, TOP_Y - 0.2, z));
            assert_true(p.y < TOP_Y - RADIUS + 0.003 && p.y > TOP_Y - RADIUS - 0.003);
        }
    }
}

/* What is under it falls to the floor. */
TEST_CASE(body_under_the_table_falls)
{
    for (int k = 0; k < 2; k++) {
        rlf_vec3 p = drop(shape_of(k), rlf_vec3_make(0.1, TOP_Y + 0.25, 1.9));
        assert_true(p.y > 1.0 - RADIUS - 0.01);
    }
}

TEST_GROUP(set_up, grid_room_destroy)
