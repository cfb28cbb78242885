/* Registration: planes keep their analytic depth, near surfaces win, the parallax shadow lies on
 * the right side with the right width and takes the far side's depth. */

#include "registration_rig.h"
#include "test.h"

#include <math.h>
#include <string.h>

static rlf_camera depth_camera(void)
{
    rlf_camera camera = {
        .width = 512, .height = 424, .fx = 365.5, .fy = 365.5, .cx = 255.5, .cy = 211.5};
    return camera;
}

static rlf_camera color_camera(void)
{
    rlf_camera camera = {
        .width = 960, .height = 540, .fx = 540.5, .fy = 540.5, .cx = 479.5, .cy = 269.5};
    return camera;
}

static rlf_pose translation(double x, double y, double z)
{
    rlf_pose T = rlf_pose_identity();
    T.p = rlf_vec3_make(x, y, z);
    return T;
}

TEST_CASE(same_camera_is_a_copy)
{
    make_rig(depth_camera(), depth_camera(), rlf_pose_identity());
    int32_t count = g.depth.width * g.depth.height;
    for (int32_t i = 0; i < count; i++) {
        g.z[i] = i % 7 == 3 ? 0.0f : 0.6f + 0.001f * (float)(i % 3001);
    }
    apply_rig();
    for (int32_t i = 0; i < count; i++) {
        assert_true(g.out.data[i] == g.z[i]);
        assert_int_equal(g.state.data[i],
                         g.z[i] > 0 ? RLF_REGISTERED_VISIBLE : RLF_REGISTERED_EMPTY);
    }
}

/* A tilted plane n.p = d seen by the depth camera, checked along the colour camera's own rays. */
static void check_plane(const rlf_pose *T, rlf_vec3 n, double d, double max_slope_error)
{
    for (int32_t i = 0; i < g.depth.width * g.depth.height; i++) {
        g.z[i] = (float)(d / (n.x * g.ray_x[i] + n.y * g.ray_y[i] + n.z));
    }
    apply_rig();
    rlf_vec3 n_color = rlf_rotate(T->q, n);
    double d_color = d + rlf_dot(n_color, T->p);
    int32_t inside = 0;
    int32_t holes = 0;
    for (int32_t v = 0; v < g.color.height; v++) {
        for (int32_t u = 0; u < g.color.width; u++) {
            rlf_vec3 ray;
            double du, dv;
            if (!rlf_camera_unproject(&g.color, u, v, &ray)) {
                continue;
            }
            double z = d_color / rlf_dot(n_color, ray);
            rlf_vec3 p = rlf_transform_inverse(T, rlf_scale(ray, z));
            if (!rlf_camera_project(&g.depth, p, &du, &dv) || du < 2 || dv < 2 ||
                du > g.depth.width - 3 || dv > g.depth.height - 3) {
                continue;
            }
            inside++;
            float got = rlf_f32_row(&g.out, v)[u];
            holes += rlf_u8_row(&g.state, v)[u] != RLF_REGISTERED_VISIBLE;
            assert_int_not_equal(rlf_u8_row(&g.state, v)[u], RLF_REGISTERED_EMPTY);
            assert_true(fabs(got - z) <= max_slope_error * z);
        }
    }
    assert_true(inside > g.color.width * g.color.height / 2);
    assert_true(holes <= inside / 200); /* the rectangles themselves leave next to no gaps */
}

TEST_CASE(planes_keep_their_depth)
{
    rlf_pose T = translation(-0.052, 0.001, 0.002);
    T.q = rlf_quat_from_axis_angle(rlf_normalize(rlf_vec3_make(0.3, 1, 0.2)), 0.01);
    make_rig(depth_camera(), color_camera(), T);
    check_plane(&T, rlf_vec3_make(0, 0, 1), 2.0, 1e-4);
    /* A rectangle is flat: half a depth pixel and half a colour pixel away the plane has moved. */
    check_plane(&T, rlf_normalize(rlf_vec3_make(0.4, 0.3, 1)), 1.5, 0.003);
}

TEST_CASE(distorted_colour_camera_sees_the_same_plane)
{
    rlf_camera color = color_camera();
    color.distortion_model = RLF_DISTORTION_PLUMB_BOB;
    const double k[5] = {0.09, -0.27, 0.001, -0.0007, 0.09};
    memcpy(color.distortion, k, sizeof(k));
    rlf_pose T = translation(-0.052, 0, 0);
    make_rig(depth_camera(), color, T);
    check_plane(&T, rlf_vec3_make(0, 0, 1), 2.0, 1e-4);
    check_plane(&T, rlf_normalize(rlf_vec3_make(-0.5, 0.2, 1)), 1.5, 0.004);
}

/* A lens that draws the border together, as Azure Kinect's: there the rectangles are wider. */
TEST_CASE(distorted_depth_camera_leaves_no_gaps)
{
    rlf_camera depth = depth_camera();
    depth.distortion_model = RLF_DISTORTION_RATIONAL_POLYNOMIAL;
    const double k[8] = {0.548, -0.021, 0.0, 0.0, -0.0027, 0.89, 0.086, -0.0139};
    memcpy(depth.distortion, k, sizeof(k));
    rlf_pose T = translation(-0.032, 0, 0.004);
    make_rig(depth, color_camera(), T);
    check_plane(&T, rlf_vec3_make(0, 0, 1), 0.5, 1e-4);
    check_plane(&T, rlf_normalize(rlf_vec3_make(-0.3, 0.2, 1)), 1.5, 0.004);
}

/* A near strip before a far wall; returns the shadow's pixels in the middle row. */
static void two_planes(int32_t first, int32_t last, double z_near, double z_far)
{
    for (int32_t v = 0; v < g.depth.height; v++) {
        for (int32_t u = 0; u < g.depth.width; u++) {
            bool is_near = u >= first && u <= last;
            g.z[v * g.depth.width + u] = (float)(is_near ? z_near : z_far);
        }
    }
    apply_rig();
}

TEST_CASE(shadow_has_its_side_width_and_depth)
{
    const double z_near = 1.5;
    const double z_far = 3.0;
    for (int side = -1; side <= 1; side += 2) {
        double b = 0.052 * side; /* p_color = p_depth - b: the colour camera sits at +b */
        make_rig(depth_camera(), color_camera(), translation(-b, 0, 0));
        two_planes(200, 299, z_near, z_far);
        double expected = g.color.fx * 0.052 * (1 / z_near - 1 / z_far);
        double left = g.color.fx * ((199.5 - g.depth.cx) / g.depth.fx - b / z_near) + g.color.cx;
        double right = g.color.fx * ((299.5 - g.depth.cx) / g.depth.fx - b / z_near) + g.color.cx;
        const float *line = rlf_f32_row(&g.out, 270);
        const uint8_t *known = rlf_u8_row(&g.state, 270);
        int32_t near_count = 0;
        int32_t filled = 0;
        for (int32_t u = 130; u < 830; u++) { /* what the depth camera covers */
            bool is_near = line[u] == (float)z_near;
            near_count += is_near;
            if (u > left + 1 && u < right - 1) {
                assert_true(is_near && known[u] == RLF_REGISTERED_VISIBLE);
            }
            if (known[u] == RLF_REGISTERED_FILLED) {
                filled++;
                assert_true(line[u] == (float)z_far);
                /* A camera to the right looks past the right edge, and the other way round. */
                double edge = side > 0 ? right : left - expected;
                assert_true(u > edge - 1.0 && u < edge + expected + 1.0);
            }
            assert_int_not_equal(known[u], RLF_REGISTERED_EMPTY);
        }
        assert_true(fabs(near_count - (right - left)) <= 1.0);
        assert_true(fabs(filled - expected) <= 1.0);
    }
}

/* Row by row without a z-buffer: every pixel lands where its point is seen, or nowhere. */
TEST_CASE(pixels_of_a_row_are_found)
{
    enum { STRIDE = 960 * 4 + 64 };
    make_rig(depth_camera(), color_camera(), translation(-0.052, 0, 0));
    two_planes(200, 299, 1.5, 3.0);
    g.z[200 * 512 + 400] = 0.0f;
    int32_t outside = 0;
    for (int32_t y = 0; y < 424; y += 100) {
        int32_t bytes[512];
        rlf_registration_find_pixels(g.registration, g.z, y, STRIDE, bytes);
        for (int32_t x = 0; x < 512; x++) {
            const rlf_camera *c = &g.color;
            const double z = (double)g.z[y * 512 + x];
            const double u =
                c->fx * ((x - g.depth.cx) / g.depth.fx - (z > 0.0 ? 0.052 / z : 0.0)) + c->cx;
            const double v = c->fy * (y - g.depth.cy) / g.depth.fy + c->cy;
            const bool is_in =
                z > 0.0 && u > -0.5 && v > -0.5 && u < c->width - 0.5 && v < c->height - 0.5;
            if (!is_in) {
                outside++;
                assert_int_equal(bytes[x], -1);
            } else {
                assert_true(fabs(bytes[x] / STRIDE - v) < 0.501);
                assert_true(fabs(bytes[x] % STRIDE / 4 - u) < 0.501);
            }
        }
    }
    assert_true(outside > 1 && outside < 3 * 512);
}

/* The strip of the far wall that the near edge keeps from the colour camera lies on the other side
 * of the strip that it keeps from the depth camera, and is as wide in depth pixels. */
TEST_CASE(both_maps_know_what_is_hidden)
{
    const double z_near = 1.5;
    const double z_far = 3.0;
    for (int side = -1; side <= 1; side += 2) {
        make_rig(depth_camera(), color_camera(), translation(-0.052 * side, 0, 0));
        uint8_t *seen = malloc((size_t)g.depth.width * (size_t)g.depth.height);
        two_planes(200, 299, z_near, z_far);
        g.z[200 * 512 + 400] = 0.0f;
        rlf_aligned out = {g.out, g.state, seen};
        rlf_registration_align(g.registration, g.z, &out);
        assert_int_equal(rlf_u8_row(&g.state, 270)[side > 0 ? 530 : 410], RLF_REGISTERED_FILLED);
        int32_t counts[5] = {0};
        int32_t first = 512;
        int32_t last = 0;
        for (int32_t u = 0; u < 512; u++) {
            uint8_t s = seen[200 * 512 + u];
            counts[s]++;
            first = s == RLF_REGISTERED_HIDDEN && u < first ? u : first;
            last = s == RLF_REGISTERED_HIDDEN && u > last ? u : last;
        }
        double expected = g.depth.fx * 0.052 * (1 / z_near - 1 / z_far);
        assert_true(fabs(counts[RLF_REGISTERED_HIDDEN] - expected) <= 1.0);
        assert_int_equal(last - first + 1, counts[RLF_REGISTERED_HIDDEN]);
        assert_int_equal(side > 0 ? last : first, side > 0 ? 199 : 300);
        assert_int_equal(counts[RLF_REGISTERED_EMPTY], 1);
        assert_int_equal(counts[RLF_REGISTERED_OUTSIDE], 0);
        assert_int_equal(seen[2 * 512 + 200],
                         RLF_REGISTERED_OUTSIDE); /* the colour image is wide */
        out.seen = NULL;
        rlf_registration_align(g.registration, g.z, &out);
        free(seen);
    }
}

TEST_CASE(vertical_baseline_fills_columns)
{
    make_rig(depth_camera(), color_camera(), translation(0, -0.05, 0));
    for (int32_t i = 0; i < g.depth.width * g.depth.height; i++) {
        int32_t v = i / g.depth.width;
        g.z[i] = v >= 180 && v < 240 ? 1.0f : 2.0f;
    }
    apply_rig();
    int32_t filled = 0;
    for (int32_t v = 0; v < g.color.height; v++) {
        if (rlf_u8_row(&g.state, v)[480] == RLF_REGISTERED_FILLED) {
            filled++;
            assert_true(rlf_f32_row(&g.out, v)[480] == 2.0f);
        }
    }
    assert_true(fabs(filled - 540.5 * 0.05 * 0.5) <= 1.0);
}

/* Rows [begin, end) by themselves are those of the whole picture. */
static void check_rows(int32_t begin, int32_t end)
{
    const size_t width = (size_t)g.color.width;
    const size_t pixels = width * (size_t)g.color.height;
    float *z = malloc(pixels * sizeof(float));
    uint8_t *seen = malloc(pixels);
    const rlf_plane_f32 out = {z, g.out.width, g.out.height, g.out.stride};
    const rlf_plane_u8 seen_plane = {seen, g.state.width, g.state.height, g.state.stride};
    const rlf_plane_u8 no_state = {NULL, g.state.width, g.state.height, g.state.stride};
    for (int i = 0; i < 2; i++) {
        memset(z, 1, pixels * sizeof(float));
        memset(seen, 77, pixels);
        rlf_registration_apply_rows(g.registration, g.z, begin, end, &out,
                                    i == 0 ? &seen_plane : &no_state);
        const size_t first = (size_t)begin * width;
        const size_t count = (size_t)(end - begin) * width;
        assert_memory_equal(z + first, g.out.data + first, count * sizeof(float));
        if (i == 0) {
            assert_memory_equal(seen + first, g.state.data + first, count);
        }
    }
    free(z);
    free(seen);
}

TEST_CASE(rows_are_those_of_the_picture)
{
    const rlf_vec3 baselines[3] = {{-0.052, 0.003, 0.01}, {0.0, -0.05, 0.0}, {0.02, 0.0, -0.1}};
    srand(4);
    for (int i = 0; i < 6; i++) {
        rlf_camera color = color_camera();
        if (i >= 3) {
            color.distortion_model = RLF_DISTORTION_PLUMB_BOB;
            color.distortion[0] = 0.05;
        }
        rlf_pose T = {baselines[i % 3], rlf_quat_from_axis_angle(rlf_vec3_make(1, 0, 0), 0.04)};
        make_rig(depth_camera(), color, T);
        for (int32_t k = 0; k < g.depth.width * g.depth.height; k++) {
            int32_t thing = (k % g.depth.width / 40 + k / g.depth.width / 50) % 3;
            g.z[k] = rand() % 9 == 0 ? 0.0f : 1.0f + 0.8f * (float)thing;
        }
        apply_rig();
        check_rows(0, g.color.height);
        check_rows(0, 100);
        check_rows(217, 218);
        check_rows(300, g.color.height);
        check_rows(40, 40);
    }
}

TEST_CASE(wide_holes_stay_empty)
{
    make_rig(depth_camera(), color_camera(), translation(-0.052, 0, 0));
    two_planes(200, 299, 0.0, 3.0);
    assert_int_equal(rlf_u8_row(&g.state, 270)[470], RLF_REGISTERED_EMPTY);
    assert_true(rlf_f32_row(&g.out, 270)[470] == 0.0f);
    memset(g.z, 0, (size_t)g.depth.width * (size_t)g.depth.height * sizeof(float));
    apply_rig();
    for (int32_t i = 0; i < g.color.width * g.color.height; i++) {
        assert_int_equal(g.state.data[i], RLF_REGISTERED_EMPTY);
        assert_true(g.out.data[i] == 0.0f);
    }
}

/* A small depth grid makes rectangles of many pixels; strides and odd sizes are the caller's. */
TEST_CASE(coarse_grid_covers_the_picture)
{
    rlf_camera full = depth_camera();
    rlf_pose T = translation(-0.052, 0, 0);
    make_rig(rlf_camera_decimate(&full, 8), color_camera(), T);
    check_plane(&T, rlf_vec3_make(0, 0, 1), 2.0, 1e-4);
    rlf_camera one = {.width = 1, .height = 1, .fx = 1, .fy = 1};
    make_rig(one, one, rlf_pose_identity());
    g.z[0] = 2.5f;
    apply_rig();
    assert_true(g.out.data[0] == 2.5f);
}

TEST_CASE(bad_depth_and_padding_are_left_alone)
{
    make_rig(depth_camera(), color_camera(), translation(-0.052, 0.01, -0.3));
    int32_t count = g.depth.width * g.depth.height;
    const float odd[6] = {NAN, INFINITY, -1.0f, 1e30f, 1e-30f, 0.29f};
    for (int32_t i = 0; i < count; i++) {
        g.z[i] = i % 2 == 0 ? odd[i % 6] : (i % 3 == 0 ? odd[(i / 3) % 6] : 2.0f);
    }
    const ptrdiff_t width = g.color.width + 3;
    float *padded = malloc((size_t)width * (size_t)g.color.height * sizeof(float));
    for (ptrdiff_t i = 0; i < width * g.color.height; i++) {
        padded[i] = -7.0f;
    }
    rlf_plane_f32 out = {padded, g.color.width, g.color.height, width * (ptrdiff_t)sizeof(float)};
    uint64_t before = rlf_alloc_count();
    rlf_registration_apply(g.registration, g.z, &out, &g.state);
    assert_int_equal(rlf_alloc_count(), before);
    for (int32_t v = 0; v < g.color.height; v++) {
        for (int32_t u = 0; u < g.color.width; u++) {
            float z = rlf_f32_row(&out, v)[u];
            bool is_empty = rlf_u8_row(&g.state, v)[u] == RLF_REGISTERED_EMPTY;
            assert_true(is_empty ? z == 0.0f : fabsf(z - 1.7f) < 1e-5f);
        }
        for (int32_t u = g.color.width; u < width; u++) {
            assert_true(padded[v * width + u] == -7.0f);
        }
    }
    free(padded);
}

TEST_CASE(wrong_cameras_are_refused)
{
    rlf_camera good = depth_camera();
    rlf_camera bad = good;
    bad.fx = 0;
    float ray = 0;
    rlf_pose T = rlf_pose_identity();
    rlf_registration *r = NULL;
    assert_int_equal(rlf_registration_create(&bad, &ray, &ray, &good, &T, &r), RLF_ERROR_INVALID);
    assert_int_equal(rlf_registration_create(&good, &ray, &ray, &bad, &T, &r), RLF_ERROR_INVALID);
    T.p.x = NAN;
    assert_int_equal(rlf_registration_create(&good, &ray, &ray, &good, &T, &r), RLF_ERROR_INVALID);
    assert_null(r);
    rlf_registration_destroy(&r);
    rlf_registration_destroy(NULL);
}

TEST_EACH(NULL, free_rig)
