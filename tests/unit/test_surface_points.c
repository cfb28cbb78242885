/* Point cloud eq. 4.1: decimation, units, ranges, reasons, rays, strides. */

#include "painted.h"
#include "test.h"

#include <math.h>

static rlf_reconstruct_def plain_def(int32_t width, int32_t height)
{
    rlf_reconstruct_def def = see_size(width, height);
    def.background_method = RLF_BACKGROUND_OFF;
    def.enable_flying_removal = false;
    def.enable_fill = false;
    def.enable_smoothing = def.enable_steadying = false;
    return def;
}

TEST_CASE(every_kept_point_is_eq_4_1)
{
    enum { WIDTH = 101, HEIGHT = 67, PAD = 5 };
    static uint16_t counts[HEIGHT][WIDTH + PAD];
    static const int32_t factors[] = {1, 2, 3, 8, 64};
    for (int32_t y = 0; y < HEIGHT; y++) {
        for (int32_t x = 0; x < WIDTH + PAD; x++) {
            counts[y][x] = (uint16_t)(x < WIDTH ? 600 + 31 * x + 7 * y : 1);
        }
    }
    for (size_t k = 0; k < sizeof factors / sizeof factors[0]; k++) {
        int32_t f = factors[k];
        rlf_reconstruct_def def = plain_def(WIDTH, HEIGHT);
        def.scale_factor = f;
        start_seeing(&def);
        rlf_frame frame = {.rig = &rig,
                           .depth_u16 = &counts[0][0],
                           .depth_stride = sizeof counts[0],
                           .depth_units_per_metre = 1000.0};
        const rlf_surface *s = surface_of(stage, &frame);
        assert_int_equal(s->width, (WIDTH + f - 1) / f);
        assert_int_equal(s->height, (HEIGHT + f - 1) / f);
        assert_int_equal(s->scale_factor, f);
        for (int32_t y = 0; y < s->height; y++) {
            for (int32_t x = 0; x < s->width; x++) {
                double z = counts[y * f][x * f] / 1000.0;
                rlf_vec3 p = rlf_surface_point(s, y * s->width + x);
                assert_float_equal(p.z, z, 1e-6);
                assert_float_equal(p.x, (x * f - rig.depth.cx) * z / rig.depth.fx, 2e-6);
                assert_float_equal(p.y, (y * f - rig.depth.cy) * z / rig.depth.fy, 2e-6);
            }
        }
    }
}

TEST_CASE(lens_distortion_is_undone_and_the_rest_has_a_reason)
{
    rlf_reconstruct_def def = plain_def(64, 48);
    rig.depth.distortion_model = RLF_DISTORTION_PLUMB_BOB;
    rig.depth.distortion[0] = -0.5; /* folds within the picture */
    def.rig = rig;
    paint_all(2.0f);
    start_seeing(&def);
    const rlf_surface *s = see();
    int outside = 0;
    for (int32_t i = 0; i < s->width * s->height; i++) {
        if (s->reason[i] == RLF_REASON_OUTSIDE_LENS) {
            outside++;
            assert_true(s->depth[i] == 0.0f && s->ray_x[i] == 0.0f && s->ray_y[i] == 0.0f);
            continue;
        }
        double u, v;
        assert_true(rlf_camera_project(&rig.depth, rlf_surface_point(s, i), &u, &v));
        assert_float_equal(u, (double)(i % 64), 1e-3);
        assert_float_equal(v, (double)(i / 64), 1e-3);
    }
    assert_in_range(outside, 4, 64 * 48 / 2);
}

TEST_CASE(missing_depth_is_data_with_a_reason)
{
    const float values[9] = {1.0f,   0.0f,   -1.0f,           NAN, INFINITY, 0.49f,
                             4.501f, 1e-40f, (float)-HUGE_VAL};
    static const uint8_t expected[9] = {
        RLF_REASON_OK,        RLF_REASON_NO_RETURN, RLF_REASON_NO_RETURN,
        RLF_REASON_NO_RETURN, RLF_REASON_NO_RETURN, RLF_REASON_TOO_NEAR,
        RLF_REASON_TOO_FAR,   RLF_REASON_TOO_NEAR,  RLF_REASON_NO_RETURN};
    const rlf_reconstruct_def def = plain_def(9, 1);
    memcpy(depth, values, sizeof values);
    start_seeing(&def);
    const rlf_surface *s = see();
    for (int i = 0; i < 9; i++) {
        assert_int_equal(s->reason[i], expected[i]);
        assert_true((s->depth[i] > 0.0f) == (i == 0));
        assert_true(s->normal_z[i] - s->normal_z[i] == 0.0f);
    }
    assert_int_equal(s->valid_count, 1);
}

TEST_CASE(u16_extremes_have_a_reason)
{
    const uint16_t counts[4] = {0, 1, 65535, 5000};
    const rlf_reconstruct_def def = plain_def(4, 1);
    start_seeing(&def);
    rlf_frame frame = {
        .rig = &rig, .depth_u16 = counts, .depth_stride = 8, .depth_units_per_metre = 5000.0};
    const rlf_surface *s = surface_of(stage, &frame);
    assert_int_equal(s->reason[0], RLF_REASON_NO_RETURN);
    assert_int_equal(s->reason[1], RLF_REASON_TOO_NEAR);
    assert_int_equal(s->reason[2], RLF_REASON_TOO_FAR);
    assert_int_equal(s->reason[3], RLF_REASON_OK);
    assert_float_equal(s->depth[3], 1.0, 1e-6);
}

TEST_CASE(mixed_pixels_are_removed_and_planes_kept)
{
    enum { WIDTH = 64, HEIGHT = 48 };
    rlf_reconstruct_def def = plain_def(WIDTH, HEIGHT);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        int x = i % WIDTH;
        /* a near half, a far half that is a steep plane, one column between the two */
        depth[i] = x < 30 ? 1.0f : 2.0f + 0.02f * (float)(x - 30);
        depth[i] = x == 30 ? 1.55f : depth[i];
    }
    def.enable_flying_removal = true;
    start_seeing(&def);
    const rlf_surface *s;
    for (int pass = 0; pass < 2; pass++) {
        depth[20 * WIDTH + 30] += 0.04f; /* not even its column agrees with this one */
        s = see();
    }
    int32_t odd = 20 * WIDTH + 30;
    assert_int_equal(s->reason[odd], RLF_REASON_FLYING);
    assert_true(s->depth[odd] == 0.0f);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        int x = i % WIDTH, y = i / WIDTH;
        bool away = (x < 29 || x > 31) && x > 0 && y > 0 && x < WIDTH - 1 && y < HEIGHT - 1;
        assert_true(!away || s->depth[i] == depth[i]);
    }
}

TEST_CASE(small_holes_are_filled_from_the_right_side)
{
    enum { WIDTH = 80, HEIGHT = 60 };
    rlf_reconstruct_def def = plain_def(WIDTH, HEIGHT);
    rlf_vec3 n = rlf_normalize(rlf_vec3_make(0.4, -0.3, -0.9));
    float *ray_x, *ray_y;
    analytic_rays(&rig.depth, &ray_x, &ray_y);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        int x = i % WIDTH;
        depth[i] = x < 40 ? (float)plane_depth(n, -1.8, ray_x[i], ray_y[i]) : 4.0f;
        bool hole = (x >= 10 && x < 15) || (x >= 38 && x < 42) || (x >= 50 && x < 70);
        depth[i] = hole ? 0.0f : depth[i];
    }
    def.enable_fill = true;
    start_seeing(&def);
    const rlf_surface *s = see();
    int32_t row = 30 * WIDTH;
    for (int x = 10; x < 15; x++) { /* on the plane, exactly */
        double truth = plane_depth(n, -1.8, s->ray_x[row + x], s->ray_y[row + x]);
        assert_int_equal(s->reason[row + x], RLF_REASON_FILLED);
        assert_float_equal(s->depth[row + x], truth, 1e-5);
    }
    assert_true(s->depth[row + 38] < 3.0f && s->depth[row + 39] < 3.0f);   /* near side */
    assert_true(s->depth[row + 40] == 4.0f && s->depth[row + 41] == 4.0f); /* far side */
    for (int x = 50; x < 70; x++) {                                        /* too wide */
        assert_int_equal(s->reason[row + x], RLF_REASON_NO_RETURN);
        assert_true(s->depth[row + x] == 0.0f);
    }
    rlf_free(ray_x);
    rlf_free(ray_y);
}

TEST_EACH(NULL, stop_seeing)
