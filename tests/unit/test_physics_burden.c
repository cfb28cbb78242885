/* What is light stands under what is heavy. */
#include "grid_room.h"
#include "test.h"

#define SIDE 0.1
#define GAP 0.0005
#define SECONDS 4
#define MOVED 0.01 /* m */

static void add(rlf_world *world, rlf_vec3 size, double mass, rlf_vec3 p)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape.size = size;
    def.mass = mass;
    def.restitution = 0.0;
    def.position = p;
    add_body(world, &def);
}

/* How far any body is from where it was after some seconds, metres; 1 where one still moves. */
static double run(rlf_world **world)
{
    rlf_vec3 starts[16];
    double most = 0.0;
    for (int frame = 0; frame <= SECONDS / GRID_ROOM_FRAME; frame++) {
        const rlf_snapshot *s = rlf_world_get_snapshot(*world);
        for (int32_t i = 0; i < s->body_count; i++) {
            starts[i] = frame == 0 ? s->bodies[i].T_world_body.p : starts[i];
            double moved = rlf_length(rlf_sub(s->bodies[i].T_world_body.p, starts[i]));
            most = rlf_max(most, moved);
        }
        grid_room->grid.time_ns++;
        rlf_world_advance(*world, &grid_room->grid, GRID_ROOM_FRAME);
    }
    const rlf_snapshot *s = rlf_world_get_snapshot(*world);
    for (int32_t i = 0; i < s->body_count; i++) {
        most = s->bodies[i].is_asleep ? most : 1.0;
    }
    rlf_world_destroy(world);
    return most;
}

/* Cubes one on the other, the i-th of mass[i]. */
static double stack(int count, const double *masses)
{
    rlf_world *world = small_world(rlf_vec3_make(0, 9.81, 0));
    for (int i = 0; i < count; i++) {
        double up = (0.5 + i) * SIDE + (1 + i) * GAP;
        add(world, rlf_vec3_make(SIDE, SIDE, SIDE), masses[i],
            rlf_vec3_make(0, GRID_ROOM_FLOOR - up, 2.4));
    }
    return run(&world);
}

static const double ratios[5] = {10, 100, 300, 1000, 3000};

TEST_CASE(heavy_one_stands_on_light_ones)
{
    double most = 0.0;
    for (int lights = 1; lights <= 3; lights++) {
        for (int k = 0; k < 5; k++) {
            double masses[4] = {0.1, 0.1, 0.1, 0.1};
            masses[lights] *= ratios[k];
            most = rlf_max(most, stack(lights + 1, masses));
        }
    }
    assert_less(most, MOVED);
}

TEST_CASE(light_and_heavy_ones_stand_in_turn)
{
    double most = 0.0;
    for (int k = 0; k < 5; k++) {
        const double masses[4] = {0.1, 0.1 * ratios[k], 0.1, 0.1 * ratios[k]};
        most = rlf_max(most, stack(4, masses));
    }
    assert_less(most, MOVED);
}

TEST_CASE(heavy_board_stands_on_two_light_cubes)
{
    double most = 0.0;
    for (int k = 0; k < 5; k++) {
        rlf_world *world = small_world(rlf_vec3_make(0, 9.81, 0));
        for (int side = -1; side <= 1; side += 2) {
            add(world, rlf_vec3_make(SIDE, SIDE, SIDE), 0.1,
                rlf_vec3_make(0.15 * side, GRID_ROOM_FLOOR - 0.5 * SIDE - GAP, 2.4));
        }
        add(world, rlf_vec3_make(0.45, SIDE, 1.5 * SIDE), 0.1 * ratios[k],
            rlf_vec3_make(0, GRID_ROOM_FLOOR - 1.5 * SIDE - 2 * GAP, 2.4));
        most = rlf_max(most, run(&world));
    }
    assert_less(most, MOVED);
}

TEST_GROUP(grid_room_start, grid_room_destroy)
