/* Registration of a part of the picture: the pixels that are asked for are those of the whole
 * picture to the bit, and few columns of the depth image are looked at. */

#include "camera/register.h"
#include "registration_rig.h"
#include "test.h"

#include <string.h>

enum { WIDTH = 640, HEIGHT = 360, PIXELS = WIDTH * HEIGHT };

static float part_data[PIXELS];
static uint8_t part_known[PIXELS];
static const rlf_plane_f32 part = {part_data, WIDTH, HEIGHT, WIDTH * sizeof(float)};
static const rlf_plane_u8 part_state = {part_known, WIDTH, HEIGHT, WIDTH};

static void begin(rlf_pose T, double distortion)
{
    const rlf_camera depth = {
        .width = 320, .height = 240, .fx = 228.0, .fy = 228.0, .cx = 159.5, .cy = 119.5};
    rlf_camera color = {
        .width = WIDTH, .height = HEIGHT, .fx = 380.0, .fy = 380.0, .cx = 319.5, .cy = 179.5};
    if (distortion != 0.0) {
        color.distortion_model = RLF_DISTORTION_PLUMB_BOB;
        color.distortion[0] = distortion;
    }
    make_rig(depth, color, T);
}

/* Things of many widths before a wall, and holes; nothing is nearer than `nearest`. */
static void fill_depth(float nearest)
{
    for (int32_t i = 0; i < g.depth.width * g.depth.height; i++) {
        const int32_t x = i % g.depth.width;
        const int32_t y = i / g.depth.width;
        const int32_t thing = (x / 37 + y / 23) % 5;
        const bool is_hole = rand() % 11 == 0 || (x / 16 + y / 9) % 13 == 0;
        g.z[i] = is_hole ? 0.0f : (thing == 0 ? nearest : 4.0f) + 0.001f * (float)(x % 7);
    }
    apply_rig();
}

static void check_window(pixel_rect window, double nearest)
{
    const size_t count = (size_t)(window.x1 - window.x0);
    const size_t pixels = (size_t)g.color.width * (size_t)g.color.height;
    memset(part_data, 1, pixels * sizeof(float));
    memset(part_known, 77, pixels);
    registration_apply_window(g.registration, g.z, &window, nearest, &part, &part_state);
    for (int32_t y = window.y0; y < window.y1; y++) {
        assert_memory_equal(rlf_f32_row(&part, y) + window.x0, rlf_f32_row(&g.out, y) + window.x0,
                            count * sizeof(float));
        assert_memory_equal(rlf_u8_row(&part_state, y) + window.x0,
                            rlf_u8_row(&g.state, y) + window.x0, count);
    }
}

TEST_CASE(windows_are_parts_of_the_picture)
{
    const rlf_vec3 baselines[4] = {
        {-0.052, 0.003, 0.01}, {0.0, -0.05, 0.0}, {0.02, 0.0, -0.1}, {0.1, 0.0, 0.0}};
    const float nearest[3] = {0.15f, 0.6f, 1.8f};
    srand(4);
    for (int i = 0; i < 24; i++) {
        const rlf_vec3 axis = rlf_normalize(rlf_vec3_make(1, i % 3, 0.3));
        const rlf_pose T = {baselines[i % 4], rlf_quat_from_axis_angle(axis, 0.02 * (i % 5))};
        begin(T, i % 2 == 0 ? 0.0 : 0.08);
        fill_depth(nearest[i / 8]);
        for (int k = 0; k < 20; k++) {
            const int32_t x0 = rand() % g.color.width;
            const int32_t y0 = rand() % g.color.height;
            const pixel_rect window = {x0, y0, x0 + 1 + rand() % (g.color.width - x0),
                                       y0 + 1 + rand() % (g.color.height - y0)};
            check_window(window, (double)nearest[i / 8]);
            check_window(window, 0.0);
        }
    }
}

TEST_CASE(few_columns_are_looked_at)
{
    const rlf_pose T = {{-0.052, 0, 0}, rlf_quat_identity()};
    begin(T, 0.0);
    int32_t columns[2];
    registration_columns(g.registration, 300, 340, 1.5, columns);
    /* 24 columns, a shift of up to 380 * 0.052 / 1.5 pixels, and their alignment */
    assert_in_range(columns[1] - columns[0], 24, 24 + 2 * 9 + 18);
    registration_columns(g.registration, 300, 340, 0.0, columns);
    assert_int_equal(columns[0], 0);
    assert_int_equal(columns[1], g.depth.width);
    registration_columns(g.registration, 300, 340, 0.01, columns);
    assert_in_range(columns[1] - columns[0], 200, g.depth.width);
}

TEST_EACH(NULL, free_rig)
