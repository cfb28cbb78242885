/* How deep a solid of which only the front is seen may be: the outline tells where it leans away
 * from what it hides. */
#include "grid_room.h"
#include "test.h"

#define FRONT 2.0
#define RADIUS 0.05
#define GUESS 0.15

/* A block whose front is at FRONT, between those x and y. */
typedef struct block {
    double x0, x1, y0, y1, deep;
} block;

static void paint(const block *b)
{
    grid_room_create();
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        rlf_vec3 ray = grid_room_ray(i);
        double x = FRONT * ray.x, y = FRONT * ray.y, side = b->x1 / ray.x;
        bool is_high = y > b->y0 && y < b->y1;
        if (is_high && x > b->x0 && x < b->x1) {
            grid_room_paint(i, FRONT, rlf_vec3_make(0, 0, -1));
        } else if (is_high && side > FRONT && side < FRONT + b->deep) {
            grid_room_paint(i, side, rlf_vec3_make(1, 0, 0));
        }
    }
}

/* How deep behind the front a body that comes from there is held up at x, its radius off. */
static double met_behind(const block *b, rlf_shape_type type, double x)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape = (rlf_shape){.type = type, .size = {2 * RADIUS, 2 * RADIUS, 2 * RADIUS}};
    def.shape.radius = RADIUS;
    def.position = rlf_vec3_make(x, 0.0, FRONT + 0.6);
    def.velocity = rlf_vec3_make(0.0, 0.0, -2.0);
    def.gravity_scale = 0.0;
    def.restitution = 0.0;
    paint(b);
    const grid_room_way way = grid_room_run(RLF_BORDER_OPEN, &def, 20);
    grid_fixture_destroy(&grid_room);
    assert_true(way.is_there);
    return way.p.z - RADIUS - FRONT;
}

/* The camera looks past the block's right side: a centimetre there is a third of a pixel. */
TEST_CASE(a_flat_thing_is_no_deeper_than_its_outline_shows)
{
    const block flat = {-0.75, -0.4, -0.2, 0.2, 0.0};
    for (int k = 0; k < 2; k++) {
        double deep = met_behind(&flat, k == 0 ? RLF_SHAPE_SPHERE : RLF_SHAPE_BOX, -0.5);
        assert_true(deep > 0.0 && deep < 0.06);
    }
}

TEST_CASE(a_side_that_is_seen_belongs_to_the_solid)
{
    const block deep = {-0.75, -0.4, -0.2, 0.2, 0.12};
    for (int k = 0; k < 2; k++) {
        double met = met_behind(&deep, k == 0 ? RLF_SHAPE_SPHERE : RLF_SHAPE_BOX, -0.5);
        assert_true(met > 0.11 && met < GUESS + 0.01);
    }
}

/* A bar is guessed as deep as its front is wide, not as wide as what is seen of it. */
TEST_CASE(a_side_that_is_seen_makes_no_front_wider)
{
    const block bar = {-1.08, -0.99, -0.3, 0.3, 0.09};
    for (int k = 0; k < 2; k++) {
        double met = met_behind(&bar, k == 0 ? RLF_SHAPE_SPHERE : RLF_SHAPE_BOX, -1.035);
        assert_true(met > 0.07 && met < 0.11);
    }
}

/* All sides of what is straight ahead hide behind its front. */
TEST_CASE(where_nothing_tells_the_guess_stays)
{
    const block ahead = {-0.12, 0.12, -0.12, 0.12, 0.0};
    double met = met_behind(&ahead, RLF_SHAPE_SPHERE, 0.0);
    assert_true(met > GUESS - 0.01 && met < GUESS + 0.01);
}
