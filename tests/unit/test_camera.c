/* Lens model: projection and unprojection are inverses; derived cameras see the same rays. */

#include "relief/camera.h"
#include "test.h"

#include <math.h>
#include <string.h>

static rlf_camera kinect2(void)
{
    rlf_camera camera = {
        .width = 512, .height = 424, .fx = 365.5, .fy = 366.5, .cx = 255.5, .cy = 211.25};
    return camera;
}

TEST_CASE(pinhole_ray_is_equation_4_1)
{
    rlf_camera camera = kinect2();
    rlf_vec3 ray;
    assert_true(rlf_camera_unproject(&camera, 100, 50, &ray));
    assert_true(fabs(ray.x - (100 - 255.5) / 365.5) < 1e-15);
    assert_true(fabs(ray.y - (50 - 211.25) / 366.5) < 1e-15);
    double u, v;
    assert_false(rlf_camera_project(&camera, rlf_vec3_make(0, 0, 0), &u, &v));
    assert_false(rlf_camera_project(&camera, rlf_vec3_make(0, 0, -1), &u, &v));
}

TEST_CASE(distortion_round_trip_is_exact)
{
    rlf_camera cameras[3] = {kinect2(), kinect2(), kinect2()};
    const double kinect[8] = {0.0905, -0.268, 0.001, -0.0007, 0.095};
    const double fr1[8] = {0.262383, -0.953104, -0.005358, 0.002628, 1.163314};
    const double azure[8] = {0.548, -0.021, 2.06e-5, -7.21e-5, -0.00265, 0.8897, 0.0861, -0.0139};
    memcpy(cameras[0].distortion, kinect, sizeof(kinect));
    memcpy(cameras[1].distortion, fr1, sizeof(fr1));
    memcpy(cameras[2].distortion, azure, sizeof(azure));
    for (int c = 0; c < 3; c++) {
        cameras[c].distortion_model =
            c == 2 ? RLF_DISTORTION_RATIONAL_POLYNOMIAL : RLF_DISTORTION_PLUMB_BOB;
        int outside = 0;
        for (int v = 0; v < 424; v++) {
            for (int u = 0; u < 512; u++) {
                rlf_vec3 ray;
                if (!rlf_camera_unproject(&cameras[c], u, v, &ray)) {
                    outside++;
                    continue;
                }
                double pu, pv;
                assert_true(rlf_camera_project(&cameras[c], rlf_scale(ray, 2.7), &pu, &pv));
                assert_true(fabs(pu - u) < 1e-8 && fabs(pv - v) < 1e-8);
                /* As the tables keep it. */
                const volatile float kept[2] = {(float)ray.x, (float)ray.y};
                ray = rlf_vec3_make(kept[0], kept[1], 1.0);
                if (rlf_camera_project(&cameras[c], ray, &pu, &pv)) {
                    assert_true(fabs(pu - u) < 1e-4 && fabs(pv - v) < 1e-4);
                }
            }
        }
        assert_in_range(outside, 0, 490);
    }
}

TEST_CASE(folded_lens_refuses_rays_beyond_the_fold)
{
    rlf_camera camera = kinect2();
    camera.distortion_model = RLF_DISTORTION_PLUMB_BOB;
    camera.distortion[0] = -0.5; /* r (1 - r^2/2) has its maximum 0.5443 at r = 0.8165 */
    rlf_vec3 ray;
    assert_true(rlf_camera_unproject(&camera, 255.5 + 365.5 * 0.54, 211.25, &ray));
    assert_false(rlf_camera_unproject(&camera, 255.5 + 365.5 * 0.55, 211.25, &ray));
    double u, v;
    assert_true(rlf_camera_project(&camera, rlf_vec3_make(0.8, 0, 1), &u, &v));
    assert_false(rlf_camera_project(&camera, rlf_vec3_make(0.83, 0, 1), &u, &v));
}

TEST_CASE(decimated_camera_keeps_rays)
{
    rlf_camera camera = kinect2();
    rlf_camera grid = rlf_camera_decimate(&camera, 8);
    assert_int_equal(grid.width, 64);
    assert_int_equal(grid.height, 53);
    rlf_vec3 full, reduced;
    rlf_camera_unproject(&camera, 8 * 37, 8 * 21, &full);
    rlf_camera_unproject(&grid, 37, 21, &reduced);
    assert_true(rlf_length(rlf_sub(full, reduced)) < 1e-15);
}

TEST_CASE(resized_camera_keeps_image_borders)
{
    rlf_camera camera = kinect2();
    rlf_camera half = rlf_camera_resize(&camera, 256, 212);
    rlf_vec3 full, reduced;
    rlf_camera_unproject(&camera, -0.5, 423.5, &full);
    rlf_camera_unproject(&half, -0.5, 211.5, &reduced);
    assert_true(rlf_length(rlf_sub(full, reduced)) < 1e-15);
}

/* The matrix sends a point to the clip position of the pixel that rlf_camera_project names. */
TEST_CASE(projection_matrix_matches_projection)
{
    rlf_camera camera = kinect2();
    rlf_mat4 m = rlf_camera_projection(&camera, 0.1, 100.0);
    rlf_vec3 p = rlf_vec3_make(0.4, -0.3, 2.0);
    double clip[4];
    for (int i = 0; i < 4; i++) {
        clip[i] = m.m[i][0] * p.x + m.m[i][1] * p.y + m.m[i][2] * p.z + m.m[i][3];
    }
    double u, v;
    assert_true(rlf_camera_project(&camera, p, &u, &v));
    assert_true(fabs((clip[0] / clip[3] + 1) * 0.5 * 512 - 0.5 - u) < 1e-10);
    assert_true(fabs((1 - clip[1] / clip[3]) * 0.5 * 424 - 0.5 - v) < 1e-10);
    /* near and far planes land on -1 and 1 */
    assert_true(fabs((m.m[2][2] * 0.1 + m.m[2][3]) / 0.1 + 1.0) < 1e-12);
    assert_true(fabs((m.m[2][2] * 100 + m.m[2][3]) / 100 - 1.0) < 1e-12);
}

/* A.1 with the vertical field of view of a centred camera is the same projection, seen with y up.
 */
TEST_CASE(field_of_view_matrix_matches_intrinsics)
{
    rlf_camera camera = {
        .width = 512, .height = 424, .fx = 365.5, .fy = 365.5, .cx = 255.5, .cy = 211.5};
    double fov_y = 2.0 * rlf_atan2(212.0, 365.5);
    assert_true(fabs(fov_y * 180 / RLF_PI - 60.2) < 0.1); /* errata 4: 60, not 70 */
    rlf_mat4 a = rlf_camera_projection(&camera, 0.1, 100.0);
    rlf_mat4 b = rlf_projection_from_fov(fov_y, 512.0 / 424.0, 0.1, 100.0);
    assert_true(fabs(a.m[0][0] - b.m[0][0]) < 1e-12);
    assert_true(fabs(-a.m[1][1] - b.m[1][1]) < 1e-12);
    assert_true(fabs(-a.m[2][2] - b.m[2][2]) < 1e-12);
    assert_true(fabs(a.m[2][3] - b.m[2][3]) < 1e-12);
}

TEST_CASE(bad_cameras_are_refused_by_field)
{
    rlf_camera camera = kinect2();
    assert_int_equal(rlf_camera_check(&camera, "depth"), RLF_OK);
    camera.fy = 0;
    assert_int_equal(rlf_camera_check(&camera, "depth"), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "depth: fy"));
    camera = kinect2();
    camera.cx = NAN;
    assert_int_equal(rlf_camera_check(&camera, "depth"), RLF_ERROR_INVALID);
    camera = kinect2();
    camera.width = RLF_IMAGE_SIZE_MAX + 1;
    assert_int_equal(rlf_camera_check(&camera, "depth"), RLF_ERROR_INVALID);
    camera = kinect2();
    camera.distortion[3] = INFINITY;
    assert_int_equal(rlf_camera_check(&camera, "depth"), RLF_ERROR_INVALID);
}
