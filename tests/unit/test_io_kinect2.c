/* The Kinect v2's registration, and its factory calibration as Relief's cameras. */
#include "io/freenect2/freenect2.h"
#include "kinect2_sample.h"
#include "test.h"

#include <math.h>
#include <string.h>

/* Planes of one apply. */
typedef struct planes {
    kinect2_registration *registration;
    float *depth;
    uint32_t *color;
    kinect2_registered out;
} planes;

static planes make_planes(const kinect2_ir *ir, const kinect2_color *color)
{
    planes p = {0};
    assert_int_equal(kinect2_registration_create(ir, color, &p.registration), RLF_OK);
    p.depth = rlf_alloc_array(KINECT2_DEPTH_PIXELS, 4);
    p.color = rlf_alloc_array(KINECT2_COLOR_PIXELS, 4);
    p.out.undistorted = rlf_alloc_array(KINECT2_DEPTH_PIXELS, 4);
    p.out.color = rlf_alloc_array(KINECT2_DEPTH_PIXELS, 4);
    p.out.offset = rlf_alloc_array(KINECT2_DEPTH_PIXELS, 4);
    kinect2_sample_depth(p.depth);
    kinect2_sample_colors(p.color);
    return p;
}

static void apply(planes *p)
{
    kinect2_registration_apply(p->registration, p->depth, p->color, &p->out);
}

static void free_planes(planes *p)
{
    kinect2_registration_destroy(&p->registration);
    assert_null(p->registration);
    rlf_free(p->depth);
    rlf_free(p->color);
    rlf_free(p->out.undistorted);
    rlf_free(p->out.color);
    rlf_free(p->out.offset);
}

/* FNV-1a over bytes (Fowler, Noll, Vo). */
static uint64_t hash(const void *data, size_t size)
{
    uint64_t h = UINT64_C(14695981039346656037);
    for (size_t i = 0; i < size; i++) {
        h = (h ^ ((const uint8_t *)data)[i]) * UINT64_C(1099511628211);
    }
    return h;
}

/* The hashes are of what libfreenect2's own Registration::apply (commit fd64c5d, with its filter, a
 * bigdepth picture and a colour map) gave on x86-64 for these very pictures and this calibration.
 */
static void is_libfreenect2_s_bit_for_bit(void **state)
{
    (void)state;
    planes p = make_planes(&kinect2_sample_ir, &kinect2_sample_color);
    for (int i = 0; i < 2; i++) { /* nothing is left of the first */
        apply(&p);
        assert_int_equal(hash(p.out.undistorted, KINECT2_DEPTH_PIXELS * 4),
                         UINT64_C(0x937eed5f8e70943a));
        assert_int_equal(hash(p.out.color, KINECT2_DEPTH_PIXELS * 4), UINT64_C(0x05acc20dd9c1e0dd));
        assert_int_equal(hash(p.out.offset, KINECT2_DEPTH_PIXELS * 4),
                         UINT64_C(0x8660afd81548350c));
        assert_int_equal(hash(kinect2_registration_big_depth(p.registration),
                              (size_t)KINECT2_COLOR_WIDTH * KINECT2_BIG_HEIGHT * 4),
                         UINT64_C(0x2f3bbb61c70ab1a0));
    }
    free_planes(&p);
}

/* What one pixel does can be told by hand: it lowers 5 x 3 pixels round where it lands. */
static void lowers_a_window(void **state)
{
    (void)state;
    planes p = make_planes(&kinect2_sample_ir, &kinect2_sample_color);
    memset(p.depth, 0, KINECT2_DEPTH_PIXELS * 4);
    apply(&p);
    const float *big = kinect2_registration_big_depth(p.registration);
    for (int i = 0; i < KINECT2_COLOR_WIDTH * KINECT2_BIG_HEIGHT; i++) {
        assert_true(isinf(big[i]));
    }
    const int u = 300;
    const int v = 180;
    for (int i = 0; i < KINECT2_DEPTH_PIXELS; i++) {
        p.depth[i] = p.out.undistorted[i] = 0.0F;
    }
    /* The lens moves pixels: find the raw pixel that becomes (u, v). */
    for (int i = 0; i < KINECT2_DEPTH_PIXELS; i++) {
        p.depth[i] = (float)(i + 1);
    }
    apply(&p);
    const int raw = (int)p.out.undistorted[v * KINECT2_DEPTH_WIDTH + u] - 1;
    memset(p.depth, 0, KINECT2_DEPTH_PIXELS * 4);
    p.depth[raw] = 1500.0F;
    apply(&p);
    float at[2];
    kinect2_project(&kinect2_sample_ir, &kinect2_sample_color, (float)u, (float)v, 1500.0F, at);
    const int x = (int)(at[0] + 0.5F);
    const int y = (int)(at[1] + 0.5F);
    assert_int_equal(p.out.offset[v * KINECT2_DEPTH_WIDTH + u], y * KINECT2_COLOR_WIDTH + x);
    assert_int_equal(p.out.color[v * KINECT2_DEPTH_WIDTH + u],
                     p.color[y * KINECT2_COLOR_WIDTH + x]);
    assert_true(big[(y + 1) * KINECT2_COLOR_WIDTH + x] == 1500.0F);
    assert_true(big[y * KINECT2_COLOR_WIDTH + x - 2] == 1500.0F);
    assert_true(big[(y + 2) * KINECT2_COLOR_WIDTH + x + 2] == 1500.0F);
    assert_true(isinf(big[(y + 1) * KINECT2_COLOR_WIDTH + x + 3]) &&
                isinf(big[(y - 1) * KINECT2_COLOR_WIDTH + x]));
    free_planes(&p);
}

/* A near strip hides the colour of what is behind it: those pixels get none. */
static void drops_what_color_cannot_see(void **state)
{
    (void)state;
    planes p = make_planes(&kinect2_sample_ir, &kinect2_sample_color);
    for (int i = 0; i < KINECT2_DEPTH_PIXELS; i++) {
        const int u = i % KINECT2_DEPTH_WIDTH;
        p.depth[i] = u >= 240 && u < 280 ? 800.0F : 3000.0F;
    }
    apply(&p);
    int near_dropped = 0;
    int far_dropped = 0;
    for (int u = 0; u < KINECT2_DEPTH_WIDTH; u++) {
        const int i = 212 * KINECT2_DEPTH_WIDTH + u;
        const bool is_dropped = p.out.offset[i] >= 0 && p.out.color[i] == 0;
        near_dropped += is_dropped && p.out.undistorted[i] == 800.0F;
        far_dropped += is_dropped && p.out.undistorted[i] == 3000.0F;
    }
    /* 52 mm seen at 800 mm and not at 3000 mm: 17 pixels, and one for the window. */
    assert_int_equal(near_dropped, 0);
    assert_in_range(far_dropped, 15, 20);
    free_planes(&p);
}

/* Depth of any kind and a calibration of any kind must not leave the tables. */
static void survives_hostile_input(void **state)
{
    (void)state;
    const float values[] = {NAN, INFINITY, -INFINITY, -1.0F, 1e-30F, 1e30F, 0.0F, 1000.0F};
    kinect2_color wild = kinect2_sample_color;
    wild.cy = 1e20F;
    wild.mx[0] = -1e20F;
    const kinect2_color none = {0};
    const kinect2_ir broken = {.fx = NAN};
    const kinect2_color *const colors[] = {&kinect2_sample_color, &wild, &none};
    for (int c = 0; c < 3; c++) {
        planes p = make_planes(c == 2 ? &broken : &kinect2_sample_ir, colors[c]);
        for (int i = 0; i < KINECT2_DEPTH_PIXELS; i++) {
            p.depth[i] = values[(i * 7 + i / 512) % 8];
        }
        apply(&p);
        for (int i = 0; i < KINECT2_DEPTH_PIXELS; i++) {
            assert_in_range(p.out.offset[i] + 1, 0, KINECT2_COLOR_PIXELS);
        }
        free_planes(&p);
    }
}

static void gives_points(void **state)
{
    (void)state;
    float p[3];
    const rlf_camera camera = kinect2_undistorted_camera(&kinect2_sample_ir);
    kinect2_point(&kinect2_sample_ir, 100, 50, 2000.0F, p);
    rlf_vec3 ray;
    /* The pixel's place in the picture that is not mirrored, where x has the other sign. */
    assert_true(rlf_camera_unproject(&camera, 511 - 100, 50, &ray));
    assert_true(fabs(-ray.x * 2.0 - (double)p[0]) < 1e-6);
    assert_true(fabs(ray.y * 2.0 - (double)p[1]) < 1e-6);
    assert_true(p[2] == 2.0F);
    const float missing[4] = {0.0F, -5.0F, NAN, 0.5F};
    for (int i = 0; i < 4; i++) {
        kinect2_point(&kinect2_sample_ir, 100, 50, missing[i], p);
        assert_true(isnan(p[0]) && isnan(p[1]) && isnan(p[2]));
    }
}

/* The raw depth camera is the factory's lens: its rays lead to the undistorted pixel that
 * libfreenect2's table takes from there, to the half pixel of that table. */
static void has_the_factory_s_lens(void **state)
{
    (void)state;
    rlf_rig rig;
    kinect2_fit fit;
    assert_int_equal(kinect2_rig_fit(&kinect2_sample_ir, &kinect2_sample_color, &rig, &fit),
                     RLF_OK);
    planes p = make_planes(&kinect2_sample_ir, &kinect2_sample_color);
    for (int i = 0; i < KINECT2_DEPTH_PIXELS; i++) {
        p.depth[i] = (float)(i + 1); /* exact: below 2^24 */
    }
    apply(&p);
    for (int i = 0; i < KINECT2_DEPTH_PIXELS; i += 331) {
        const int raw = (int)p.out.undistorted[i] - 1;
        const double x = -((double)(i % 512) - (double)kinect2_sample_ir.cx) / 365.5;
        const double y = ((double)(i / 512) - (double)kinect2_sample_ir.cy) / 365.5;
        double u;
        double v;
        if (raw >= 0) {
            assert_true(rlf_camera_project(&rig.depth, rlf_vec3_make(x, y, 1.0), &u, &v));
            assert_true(fabs(u - (511 - raw % 512)) < 0.51 && fabs(v - raw / 512) < 0.51);
        }
    }
    free_planes(&p);
}

/* The fitted colour camera against the factory's cubics, at points between those of the fit. */
static void fits_the_color_camera(void **state)
{
    (void)state;
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_libfreenect2_s_bit_for_bit),
        cmocka_unit_test(lowers_a_window),
        cmocka_unit_test(drops_what_color_cannot_see),
        cmocka_unit_test(survives_hostile_input),
        cmocka_unit_test(gives_points),
        cmocka_unit_test(has_the_factory_s_lens),
        cmocka_unit_test(fits_the_color_camera),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
