/* The Kinect v2's factory calibration as Relief's cameras. */
#include "io/freenect2/freenect2.h"
#include "kinect2_sample.h"
#include "test.h"

#include <math.h>

/* The raw depth camera is the factory's lens, mirrored: plumb_bob as libfreenect2 computes it. */
TEST_CASE(has_the_factory_s_lens)
{
    const kinect2_ir *ir = &kinect2_sample_ir;
    rlf_rig rig;
    kinect2_fit fit;
    assert_int_equal(kinect2_rig_fit(ir, &kinect2_sample_color, &rig, &fit), RLF_OK);
    for (int i = 0; i < KINECT2_DEPTH_PIXELS; i += 331) {
        const double x = ((double)(i % 512) - (double)ir->cx) / (double)ir->fx;
        const double y = ((double)(i / 512) - (double)ir->cy) / (double)ir->fy;
        const double r2 = x * x + y * y, p1 = (double)ir->p1, p2 = (double)ir->p2;
        const double k = 1.0 + (((double)ir->k3 * r2 + (double)ir->k2) * r2 + (double)ir->k1) * r2;
        const double raw_x = x * k + p2 * (r2 + 2.0 * x * x) + p1 * 2.0 * x * y;
        const double raw_y = y * k + p1 * (r2 + 2.0 * y * y) + p2 * 2.0 * x * y;
        double u, v;
        assert_true(rlf_camera_project(&rig.depth, rlf_vec3_make(-x, y, 1.0), &u, &v));
        assert_true(fabs(u - (511.0 - (raw_x * (double)ir->fx + (double)ir->cx))) < 1e-3);
        assert_true(fabs(v - (raw_y * (double)ir->fy + (double)ir->cy)) < 1e-3);
    }
}

/* The fitted colour camera against the factory's cubics, at points between those of the fit. */
TEST_CASE(fits_the_color_camera)
{
    rlf_rig rig;
    kinect2_fit fit;
    assert_int_equal(kinect2_rig_fit(&kinect2_sample_ir, &kinect2_sample_color, &rig, &fit),
                     RLF_OK);
    print_message("colour camera: %.3f px rms, %.3f px at worst\n", fit.rms_px, fit.worst_px);
    assert_true(fit.rms_px < 0.3 && fit.worst_px < 1.0);
    assert_true(fabs(rig.T_color_depth.p.x + 0.052) < 0.002); /* 52 mm beside the depth camera */
    double worst = 0.0;
    for (int i = 0; i < 4000; i++) {
        const int u = 5 + i * 37 % 500;
        const int v = 5 + i * 101 % 410;
        const double z = 0.9 + (i % 19) * 0.2;
        float at[2];
        kinect2_project(&kinect2_sample_ir, &kinect2_sample_color, (float)u, (float)v,
                        (float)(z * 1000.0), at);
        const double x = -((double)u - (double)kinect2_sample_ir.cx) / 365.5 * z;
        const double y = ((double)v - (double)kinect2_sample_ir.cy) / 365.5 * z;
        double c[2];
        if (at[0] >= 0.0F && at[0] < 1920.0F && at[1] >= 0.0F && at[1] < 1080.0F) {
            const rlf_vec3 q = rlf_transform(&rig.T_color_depth, rlf_vec3_make(x, y, z));
            assert_true(rlf_camera_project(&rig.color, q, &c[0], &c[1]));
            worst = fmax(worst, hypot(c[0] - (1919.0 - (double)at[0]), c[1] - (double)at[1]));
        }
    }
    assert_true(worst < 1.0);
    const kinect2_color none = {0};
    assert_int_not_equal(kinect2_rig_fit(&kinect2_sample_ir, &none, &rig, &fit), RLF_OK);
}
