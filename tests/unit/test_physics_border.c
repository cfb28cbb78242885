/* Beyond the camera's view the room goes on, or it does not: as the world's def says. */
#include "test.h"
#include "grid_room.h"

#define RING 7 /* pixels without depth around the image, as depth cameras have */

static int set_up(void **state)
{
    (void)state;
    grid_room_create();
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        int32_t x = i % GRID_W, y = i / GRID_W;
        if (x < RING || y < RING || x >= GRID_W - RING || y >= GRID_H - RING) {
            grid_room->planes[2][i] = 0.0f;
        }
    }
    return 0;
}

static rlf_shape shape_of(int k)
{
    const rlf_shape shapes[4] = {{.type = RLF_SHAPE_BOX, .size = {0.2, 0.2, 0.2}},
                                 {.type = RLF_SHAPE_SPHERE, .radius = 0.1},
                                 {.type = RLF_SHAPE_CAPSULE, .radius = 0.1, .height = 0.1},
                                 {.type = RLF_SHAPE_CYLINDER, .radius = 0.1, .height = 0.2}};
    return shapes[k];
}

/* Where the body is after `seconds`; false when it left the world. */
static bool throw_body(rlf_border border, const rlf_body_def *def, double seconds, rlf_vec3 *out)
{
    const grid_room_way way = grid_room_run(border, def, (int)(seconds / GRID_ROOM_FRAME));
    *out = way.p;
    return way.is_there;
}

/* Slid to the right, the left and towards the camera, out of view: it lies on the floor there. */
TEST_CASE(body_out_of_view_lies_on_the_floor)
{
    const rlf_vec3 pushes[3] = {{3, 0, 0}, {-3, 0, 0}, {0, 0, -2.2}};
    for (int k = 0; k < 12; k++) {
        rlf_body_def def = rlf_body_def_default();
        def.shape = shape_of(k / 3);
        def.velocity = pushes[k % 3];
        def.restitution = 0.2;
        double side = k % 3 == 2 ? 0.0 : 1.5 * (pushes[k % 3].x > 0 ? 1 : -1);
        def.position = rlf_vec3_make(side, k / 3 == 2 ? 0.85 : 0.9, k % 3 == 2 ? 1.9 : 2.4);
        rlf_vec3 p = {0, 0, 0};
        double u, v, highest = k / 3 == 2 ? 0.82 : 0.88;
        assert_true(throw_body(RLF_BORDER_EXTEND, &def, 1.0, &p));
        assert_false(grid_fixture_project(NULL, p, &u, &v));
        if (!(p.y < 0.91 && p.y > highest)) {
            fail_msg("shape %d push %d: at %.3f %.3f %.3f", k / 3, k % 3, p.x, p.y, p.z);
        }
        bool is_there = throw_body(RLF_BORDER_OPEN, &def, 1.0, &p);
        assert_true(!is_there || p.y > 1.2); /* fell */
    }
}

/* Dropped where the camera never looks: floor and back wall hold it as in view. */
TEST_CASE(body_that_starts_out_of_view_meets_the_room)
{
    for (int k = 0; k < 4; k++) {
        rlf_body_def def = rlf_body_def_default();
        def.shape = shape_of(k);
        def.position = rlf_vec3_make(-3.2, -0.4, 3.0);
        def.velocity = rlf_vec3_make(0, 0, 4);
        rlf_vec3 p = {0, 0, 0};
        assert_true(throw_body(RLF_BORDER_EXTEND, &def, 1.5, &p));
        if (!(p.y < 0.95 && p.z < 4.0)) {
            fail_msg("shape %d: at %.3f %.3f %.3f", k, p.x, p.y, p.z);
        }
    }
}

/* The room's ring of missing pixels is no gap in the floor. */
TEST_CASE(ring_is_no_gap)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape.size = rlf_vec3_make(0.02, 0.02, 0.02);
    double z = 2.0;
    double u = GRID_W - RING / 2.0;
    def.position = rlf_vec3_make((u - GRID_CX) / GRID_F * z, 0.9, z);
    rlf_vec3 p = {0, 0, 0};
    assert_true(throw_body(RLF_BORDER_EXTEND, &def, 1.0, &p));
    assert_true(p.y < 0.992);
}

/* Who says nothing has a floor where the camera does not look. */
TEST_CASE(first_ball_does_not_fall_past_the_floor)
{
    const rlf_scene scene = {.body_count = 0};
    rlf_body_def def = rlf_body_def_default();
    def.shape = shape_of(1);
    def.position = rlf_vec3_make(0, 0, 1);
    rlf_vec3 p = {0, 0, 0};
    double u, v;
    assert_true(scene.border == rlf_world_def_default().border);
    assert_true(throw_body(rlf_world_def_default().border, &def, 3.0, &p));
    assert_false(grid_fixture_project(NULL, p, &u, &v));
    assert_true(p.y < 0.91 && p.y > 0.88);
}

TEST_CASE(wrong_border_is_refused)
{
    rlf_world_def def = small_world_def();
    def.border = (rlf_border)7;
    rlf_world *world = NULL;
    assert_int_equal(rlf_world_create(&def, &world), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "border"));
}

TEST_GROUP(set_up, grid_room_destroy)
