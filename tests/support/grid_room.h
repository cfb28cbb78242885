/* A floor 1 m below the camera and a wall 4 m away as a grid, and one body in them. Included after
 * cmocka.h. */
#ifndef RLF_TEST_GRID_ROOM_H
#define RLF_TEST_GRID_ROOM_H

#include "small_world.h"
#include "test.h"
#include "relief/world.h"

#include "grid_fixture.h"

#define GRID_ROOM_FRAME (1.0 / 30)
#define GRID_ROOM_FLOOR 1.0
#define GRID_ROOM_WALL 4

static grid_fixture *grid_room;
static double grid_room_down; /* y of the way down, of length 1 */

/* A group's tear-down, or each test's. */
static inline int grid_room_destroy(void **state)
{
    (void)state;
    if (grid_room != NULL) {
        grid_fixture_destroy(&grid_room);
    }
    return 0;
}

/* Of its solid only the front is seen: 15 cm are guessed. Instead of one that is there. */
static inline void grid_room_create(void)
{
    grid_room_destroy(NULL);
    grid_plane planes[2] = {grid_floor(GRID_ROOM_FLOOR), grid_wall(GRID_ROOM_WALL)};
    grid_room = grid_fixture_create();
    grid_room_down = 1.0;
    grid_fixture_set_room(grid_room, planes, 2);
    grid_room->grid.background.default_thickness = 0.15;
}

/* A group's set-up. */
static inline int grid_room_start(void **state)
{
    (void)state;
    grid_room_create();
    return 0;
}

static inline rlf_vec3 grid_room_ray(int32_t i)
{
    return grid_fixture_ray(grid_room, i);
}

static inline void grid_room_paint(int32_t i, double z, rlf_vec3 n)
{
    grid_fixture_paint(grid_room, GRID_BACKGROUND, i, z, n);
}

/* Turns the camera upside down: the room is now its image in the plane y = 0. */
static inline void grid_room_turn_over(void)
{
    grid_room_down = -1.0;
    for (int32_t i = 0; i < GRID_W * GRID_H / 2; i++) {
        int32_t other = (GRID_H - 1 - i / GRID_W) * GRID_W + i % GRID_W;
        for (int32_t plane = 2; plane < 6; plane++) {
            float value = grid_room->planes[plane][i];
            grid_room->planes[plane][i] = grid_room->planes[plane][other];
            grid_room->planes[plane][other] = value;
        }
    }
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        grid_room->planes[4][i] = -grid_room->planes[4][i];
    }
}

/* What became of a body. */
typedef struct grid_room_way {
    bool is_there;     /* false: it left the world */
    rlf_vec3 p;        /* where it was last */
    double farthest_z; /* of all its way */
} grid_room_way;

/* One body for so many frames, or until it leaves. */
static inline grid_room_way grid_room_run(rlf_border border, const rlf_body_def *def, int frames)
{
    grid_room_way way = {.is_there = true, .farthest_z = 0.0};
    rlf_world_def world_def = small_world_def();
    world_def.border = border;
    world_def.body_capacity = 1;
    world_def.gravity.y *= grid_room_down;
    rlf_world *world = world_of(&world_def);
    add_body(world, def);
    for (int k = 0; k < frames && way.is_there; k++) {
        grid_room->grid.time_ns++;
        rlf_world_advance(world, &grid_room->grid, GRID_ROOM_FRAME);
        way.is_there = rlf_world_get_snapshot(world)->body_count == 1;
        if (way.is_there) {
            way.p = rlf_world_get_snapshot(world)->bodies[0].T_world_body.p;
            way.farthest_z = rlf_max(way.farthest_z, way.p.z);
        }
    }
    rlf_world_destroy(&world);
    return way;
}

#endif
