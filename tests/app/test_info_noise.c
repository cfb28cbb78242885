/* `relief info --noise` finds the noise that was put in. */

#include "analytic.h"
#include "info/info.h"
#include "test.h"

#define W 160
#define H 120
#define SIGMA_M 0.004

/* A plane seen at an angle, with noise; a strip before it gives edges, a tenth is missing. */
static void draw(const rlf_rig *rig, analytic_random *r, double unit_m, float depth[W * H])
{
    for (int32_t i = 0; i < W * H; i++) {
        double x = (i % W - rig->depth.cx) / rig->depth.fx;
        double y = (i / W - rig->depth.cy) / rig->depth.fy;
        double z = plane_depth(rlf_vec3_make(0.1, 0.1, -0.98), -2.2, x, y);
        z = (i % W) / 20 == 3 ? z - 0.6 : z;
        z += SIGMA_M * random_normal(r);
        z = unit_m > 0.0 ? unit_m * floor(z / unit_m + 0.5) : z;
        depth[i] = random_uniform(r) < 0.1 ? 0.0f : (float)z;
    }
}

static info_noise *measure(double unit_m, int32_t frames)
{
    static float depth[W * H];
    rlf_rig rig = analytic_rig(W, H);
    analytic_random r = {99};
    info_noise *noise = info_noise_create(&rig);
    assert_non_null(noise);
    for (int32_t t = 0; t < frames; t++) {
        draw(&rig, &r, unit_m, depth);
        rlf_frame frame = analytic_frame(&rig, depth, t);
        info_noise_add(noise, &frame);
    }
    return noise;
}

TEST_CASE(noise_is_found_at_every_step)
{
    const double units_m[] = {0.0, 0.001, 0.005};
    for (int u = 0; u < 3; u++) {
        info_noise *noise = measure(units_m[u], 4);
        for (int k = 0; k < NOISE_KIND_COUNT; k++) {
            double sigma = info_noise_sigma(noise, (noise_kind)k, 4); /* 2 to 2.5 m */
            assert_in_range((int)(1e6 * sigma), 3800, 4400);
        }
        assert_true(info_noise_missing(noise) > 9.5 && info_noise_missing(noise) < 10.5);
        info_noise_destroy(&noise);
    }
}

TEST_CASE(one_frame_has_no_noise_in_time)
{
    info_noise *noise = measure(0.0, 1);
    assert_int_equal(info_noise_frames(noise), 1);
    assert_true(info_noise_sigma(noise, NOISE_TEMPORAL, 4) < 0.0);
    assert_true(info_noise_sigma(noise, NOISE_STEP_1, 4) > 0.0);
    assert_true(info_noise_sigma(noise, NOISE_STEP_1, 12) < 0.0); /* nothing is that far */
    info_noise_destroy(&noise);
}
