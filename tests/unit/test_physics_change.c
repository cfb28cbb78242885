/* What stays turns out to be nearer than it was taken to be, and a body lies there: it comes out,
 * and falls through nothing. */
#include "grid_room.h"
#include "test.h"

#define HALF 0.05
#define BODY_Z 2.498
#define DEPTH 0.4
#define FASTEST 4.5 /* m/s: a fall from the block, and not much more */

/* Stands on the floor. */
typedef struct block {
    double side, top, near;
} block;

static void paint(const block *b)
{
    grid_plane planes[2] = {grid_floor(GRID_ROOM_FLOOR), grid_wall(GRID_ROOM_WALL)};
    grid_fixture_set_room(grid_room, planes, 2);
    grid_room->grid.background.version++;
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        rlf_vec3 ray = grid_room_ray(i);
        double x = b->near * ray.x, y = b->near * ray.y, lid = b->top / ray.y;
        if (x > -b->side && x < b->side && y > b->top && y < GRID_ROOM_FLOOR) {
            grid_room_paint(i, b->near, rlf_vec3_make(0, 0, -1));
        } else if (lid > b->near && lid < b->near + DEPTH && lid * ray.x > -b->side &&
                   lid * ray.x < b->side) {
            grid_room_paint(i, lid, rlf_vec3_make(0, -1, 0));
        }
    }
}

static rlf_body_state go_on(rlf_world *world, int frames)
{
    rlf_body_state body = {0};
    for (int k = 0; k < frames; k++) {
        grid_room->grid.time_ns++;
        rlf_world_advance(world, &grid_room->grid, GRID_ROOM_FRAME);
        assert_int_equal(rlf_world_get_snapshot(world)->body_count, 1);
        body = rlf_world_get_snapshot(world)->bodies[0];
        assert_true(rlf_length(body.velocity) < FASTEST);
    }
    return body;
}

/* A body that lies at height y while the block is `before`, and two seconds after it is `after`. */
static rlf_vec3 change(rlf_shape_type type, double y, const block *before, const block *after)
{
    rlf_world_def world_def = small_world_def();
    world_def.border = RLF_BORDER_EXTEND;
    rlf_world *world = world_of(&world_def);
    rlf_body_def def = rlf_body_def_default();
    def.shape = (rlf_shape){.type = type, .radius = HALF};
    def.shape.size = rlf_vec3_make(2 * HALF, 2 * HALF, 2 * HALF);
    def.position = rlf_vec3_make(0, y - HALF, BODY_Z);
    add_body(world, &def);
    paint(before);
    rlf_vec3 p = go_on(world, 20).T_world_body.p;
    assert_true(rlf_length(rlf_sub(p, def.position)) < 0.005);
    paint(after);
    p = go_on(world, 60).T_world_body.p;
    rlf_world_destroy(&world);
    return p;
}

static bool is_outside(const block *b, rlf_vec3 p)
{
    const double SLACK = 0.01;
    bool is_beside = p.x > b->side + HALF - SLACK || p.x < -b->side - HALF + SLACK;
    bool is_before = p.z < b->near - HALF + SLACK || p.z > b->near + DEPTH + HALF - SLACK;
    return p.y < GRID_ROOM_FLOOR && (is_beside || is_before || p.y < b->top - HALF + SLACK);
}

static const rlf_shape_type SHAPES[2] = {RLF_SHAPE_BOX, RLF_SHAPE_SPHERE};
static const double STEPS[6] = {0.01, 0.02, 0.04, 0.06, 0.08, 0.12};

/* By as much as the last rows of tops seen at a low angle are off. */
TEST_CASE(top_comes_up_under_it)
{
    for (int k = 0; k < 6; k++) {
        const block before = {0.3, 0.5, 2.3};
        block after = before;
        after.top -= STEPS[k / 2];
        assert_true(is_outside(&after, change(SHAPES[k % 2], before.top, &before, &after)));
    }
}

TEST_CASE(front_comes_out_over_it)
{
    for (int k = 0; k < 12; k++) {
        const block before = {0.3, 0.5, 2.5 + HALF};
        block after = before;
        after.near -= STEPS[k / 2];
        rlf_vec3 p = change(SHAPES[k % 2], GRID_ROOM_FLOOR, &before, &after);
        assert_true(is_outside(&after, p));
    }
}

/* A leg is two pixels wider, or six: it comes out before it, beside it or behind it. */
TEST_CASE(side_grows_over_it)
{
    for (int k = 0; k < 4; k++) {
        const block before = {0.0, 0.5, 2.46};
        const block after = {k < 2 ? 0.007 : 0.02, 0.5, 2.46};
        rlf_vec3 p = change(SHAPES[k % 2], GRID_ROOM_FLOOR, &before, &after);
        assert_true(p.y < GRID_ROOM_FLOOR - HALF + 0.01);
        assert_true(p.z < after.near - HALF || p.x > 0.02 + HALF || p.x < -0.02 - HALF ||
                    p.z > after.near + 2.0 * after.side + HALF - 0.005);
    }
}

TEST_GROUP(grid_room_start, grid_room_destroy)
