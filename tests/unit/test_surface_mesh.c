/* Index lists of the organised mesh, fig. 4.3. */

#include "count_assert.h"
#include "relief/surface.h"
#include "test.h"

TEST_CASE(count_is_six_per_square)
{
    assert_int_equal(rlf_mesh_index_count(64, 53), 63 * 52 * 6);
    assert_int_equal(rlf_mesh_index_count(1, 53), 0);
    assert_int_equal(rlf_mesh_index_count(53, 1), 0);
    assert_int_equal(rlf_mesh_index_count(0, 0), 0);
    assert_true(rlf_mesh_index_count(16384, 16384) == (size_t)16383 * 16383 * 6);
}

TEST_CASE(squares_are_t1_then_t2)
{
    uint32_t out[12];
    rlf_mesh_indices(3, 2, out);
    const uint32_t expected[12] = {0, 1, 3, 1, 4, 3, 1, 2, 4, 2, 5, 4};
    assert_memory_equal(out, expected, sizeof expected);
}

/* Each inner vertex belongs to six triangles, and each triangle turns the same way. */
TEST_CASE(mesh_is_a_consistent_triangulation)
{
    enum { WIDTH = 7, HEIGHT = 5 };
    uint32_t out[(WIDTH - 1) * (HEIGHT - 1) * 6];
    int uses[WIDTH * HEIGHT] = {0};
    rlf_mesh_indices(WIDTH, HEIGHT, out);
    for (size_t t = 0; t < sizeof out / sizeof out[0]; t += 3) {
        int x[3], y[3];
        for (int k = 0; k < 3; k++) {
            assert_in_range(out[t + (size_t)k], 0, WIDTH * HEIGHT - 1);
            uses[out[t + (size_t)k]]++;
            x[k] = (int)out[t + (size_t)k] % WIDTH;
            y[k] = (int)out[t + (size_t)k] / WIDTH;
        }
        int twice = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
        assert_int_equal(twice, 1); /* half a square, clockwise with y down */
    }
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        int px = i % WIDTH, py = i / WIDTH;
        bool inner = px > 0 && py > 0 && px < WIDTH - 1 && py < HEIGHT - 1;
        assert_true(!inner || uses[i] == 6);
    }
}

TEST_CASE(curtains_and_holes_are_left_out)
{
    const float depth[12] = {1.0f, 1.0f, 2.0f, 2.0f, 1.0f, 1.02f,
                             2.0f, 2.0f, 1.0f, 0.0f, 2.0f, 2.0f};
    rlf_surface s = {.width = 4, .height = 3, .depth = depth};
    uint32_t out[36];
    size_t count = rlf_mesh_indices_valid(&s, 0.05, out);
    /* left column of squares: 2 above, T1 below; right column: 2 above, 2 below */
    assert_int_equal(count, (2 + 2 + 1 + 2) * 3);
    for (size_t t = 0; t < count; t += 3) {
        for (int k = 0; k < 3; k++) {
            assert_true(depth[out[t + (size_t)k]] > 0.0f);
            assert_true(depth[out[t + (size_t)k]] - depth[out[t]] < 0.5f);
        }
    }
}

TEST_CASE(every_reason_has_a_name)
{
    assert_string_equal(rlf_reason_name(RLF_REASON_NO_RETURN), "no return");
    for (int a = 0; a < RLF_REASON_COUNT; a++) {
        for (int b = 0; b < a; b++) {
            assert_string_not_equal(rlf_reason_name((rlf_reason)a), rlf_reason_name((rlf_reason)b));
        }
    }
}

/* Every triangle of the surface whose corners have one label belongs to that region. */
TEST_CASE(regions_share_out_the_triangles_within_them)
{
    const float depth[12] = {1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f,
                             1.0f, 1.0f, 1.0f, 0.0f, 1.0f, 1.0f};
    const int32_t label[12] = {3, 3, 8, 8, 3, 3, 8, 8, 3, 0, 8, 8};
    const rlf_surface surface = {.width = 4, .height = 3, .depth = depth, .label = label};
    const rlf_region left = {.label = 3, .x0 = 0, .y0 = 0, .x1 = 2, .y1 = 3};
    const rlf_region right = {.label = 8, .x0 = 2, .y0 = 0, .x1 = 4, .y1 = 3};
    uint32_t out[36];
    const uint32_t expected[9] = {0, 1, 4, 1, 5, 4, 4, 5, 8};
    assert_int_equal(rlf_mesh_indices_region(&surface, &left, 0.05, out), 9);
    assert_memory_equal(out, expected, sizeof expected);
    assert_int_equal(rlf_mesh_indices_region(&surface, &right, 0.05, out), 12);
    assert_int_equal(out[0], 2);
}

TEST_CASE(a_missing_surface_has_no_triangles)
{
    const rlf_surface blind = {.width = 4, .height = 3};
    const rlf_region region = {.x1 = 4, .y1 = 3, .label = 1};
    uint32_t out[36];
    int told = 0;
    rlf_set_assert(count_assert, &told);
    assert_int_equal(rlf_mesh_indices_valid(NULL, 0.05, out), 0);
    assert_int_equal(rlf_mesh_indices_valid(&blind, 0.05, out), 0);
    assert_int_equal(rlf_mesh_indices_region(NULL, &region, 0.05, out), 0);
    assert_int_equal(rlf_mesh_indices_region(&blind, &region, 0.05, out), 0);
    assert_int_equal(rlf_mesh_indices_region(&blind, NULL, 0.05, out), 0);
    assert_int_equal(told, 5);
    rlf_set_assert(NULL, NULL);
}
