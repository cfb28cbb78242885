/* What `relief info` measures: colour's offset from depth, noise over time, where pixels are
 * missing, and a whole survey. */
#include "info/info.h"
#include "relief/io.h"
#include "test.h"

#include <math.h>
#include <string.h>

/* ---- how far colour is off ------------------------------------------------------------------ */

/* Frames of a simulated room, whose calibration is exact, under a calibration that is off. */
static color_fit_result fit_with(const char *name, double cx, double cy, bool drops_transform)
{
    rlf_source *source = NULL;
    assert_int_equal(rlf_open_source(name, NULL, &source), RLF_OK);
    rlf_rig rig = rlf_source_get_info(source)->rig;
    rig.color.cx += cx;
    rig.color.cy += cy;
    if (drops_transform) {
        rig.T_color_depth = rlf_pose_identity();
    }
    color_fit *fit = color_fit_create(&rig);
    assert_non_null(fit);
    float *depth = rlf_alloc_array((size_t)rig.depth.width * (size_t)rig.depth.height, 4);
    rlf_frame frame;
    for (int i = 0; rlf_source_next(source, &frame) == RLF_OK; i++) {
        if (i % 3 == 0) {
            info_depth_plane(&frame, depth);
            color_fit_add(fit, depth, &frame.color);
        }
    }
    color_fit_result result;
    color_fit_get(fit, &result);
    color_fit_destroy(&fit);
    rlf_free(depth);
    rlf_source_destroy(&source);
    return result;
}

static void expect_offset(const color_fit_result *r, double x, double y)
{
    assert_true(r->is_known);
    assert_true(fabs(r->x - x) <= 1.0);
    assert_true(fabs(r->y - y) <= 1.0);
}

/* Calibration that puts colour too far left finds the picture that far to the right. */
TEST_CASE(a_known_shift_is_found_to_a_pixel)
{
    const char *const rooms[] = {"synthetic:room?frames=9", "synthetic:random?seed=3&frames=9",
                                 "synthetic:random?seed=5&frames=9"};
    const double shifts[4][2] = {{0, 0}, {-3, 2}, {6, 0}, {4, -5}};
    for (int r = 0; r < 3; r++) {
        for (int s = r > 0 ? 1 : 0; s < (r > 0 ? 3 : 4); s++) {
            const color_fit_result fit = fit_with(rooms[r], shifts[s][0], shifts[s][1], false);
            expect_offset(&fit, -shifts[s][0], -shifts[s][1]);
            assert_int_equal(color_fit_is_off(&fit), s > 0);
        }
    }
}

/* The room's cameras are 52 mm apart: without the transform near things are off by more. */
TEST_CASE(a_missing_transform_is_off_by_more_near_by)
{
    const color_fit_result fit = fit_with("synthetic:room?frames=9", 0, 0, true);
    assert_true(fit.is_known && color_fit_is_off(&fit));
    assert_true(fit.x < -6.0); /* f b / z = 540 x 0.052 / 3 = 9 */
    assert_true(fabs(fit.y) <= 1.0);
}

TEST_CASE(without_edges_nothing_is_said)
{
    const rlf_camera lens = {.width = 64, .height = 48, .fx = 60, .fy = 60, .cx = 32, .cy = 24};
    const rlf_rig rig = {.depth = lens,
                         .color = lens,
                         .T_color_depth = rlf_pose_identity(),
                         .has_color = true,
                         .depth_max_m = 5};
    static float depth[64 * 48];
    static uint8_t pixels[64 * 48 * 4];
    const rlf_image_rgba8 color = {pixels, 64, 48, 64 * 4};
    color_fit *fit = color_fit_create(&rig);
    color_fit_result result;
    color_fit_get(fit, &result); /* no frame at all */
    assert_false(result.is_known);
    color_fit_add(fit, depth, &color); /* nothing measured */
    for (int i = 0; i < 64 * 48; i++) {
        depth[i] = 2.0f;
    }
    color_fit_add(fit, depth, &color); /* a wall */
    color_fit_get(fit, &result);
    assert_int_equal(result.edges, 0);
    assert_false(result.is_known || color_fit_is_off(&result));
    color_fit_destroy(&fit);
}

/* ---- noise over time ------------------------------------------------------------------------- */

#define W 60
#define H 40

static const rlf_rig small_rig = {
    .depth = {.width = W, .height = H, .fx = 60, .fy = 60, .cx = 30, .cy = 20},
    .depth_min_m = 0.5,
    .depth_max_m = 4.5,
    .noise = {.c0 = 0.001}};

/* Sum of twelve uniform numbers: normal, deviation 1. */
static double normal(uint32_t *state)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++) {
        *state = *state * 1664525u + 1013904223u;
        sum += (double)(*state >> 8) / 16777216.0;
    }
    return sum;
}

/* Left third at 0.8 m with 2 mm, middle at 2.2 m with 8 mm, right third moves. */
TEST_CASE(noise_is_found_where_nothing_moves)
{
    stillness *s = stillness_create(&small_rig);
    static float depth[W * H];
    uint32_t random = 1;
    for (int t = 0; t < 70; t++) {
        for (int i = 0; i < W * H; i++) {
            const int part = i % W / (W / 3);
            const double z = part == 0 ? 0.8 : part == 1 ? 2.2 : 1.0 + 0.01 * t;
            depth[i] = (float)(z + (part == 1 ? 0.008 : 0.002) * normal(&random));
        }
        stillness_add(s, depth);
    }
    stillness_result r;
    stillness_get(s, &r);
    assert_int_equal(r.frames, 60);
    assert_true(r.still_percent > 62.0 && r.still_percent < 68.0);
    assert_true(fabs(r.bins[1].median_m - 0.002) < 0.0002);
    assert_true(r.bins[1].most_m > 0.002 && r.bins[1].most_m < 0.0028);
    assert_true(fabs(r.bins[4].median_m - 0.008) < 0.0008);
    assert_int_equal(r.bins[2].pixels, 0);
    stillness_destroy(&s);
}

/* Noise that lasts from frame to frame, as structured light has it, in steps of depth, with holes;
 * a sensor that is noisier than it is taken to be; and edges, which take both sides in turn. */
TEST_CASE(a_still_room_is_still_whatever_its_noise)
{
    stillness *s = stillness_create(&small_rig);
    static float depth[W * H], lasting[W * H];
    uint32_t random = 5;
    memset(lasting, 0, sizeof(lasting));
    for (int t = 0; t < 60; t++) {
        for (int i = 0; i < W * H; i++) {
            const double n = normal(&random);
            const bool is_rough = i % W >= W / 2;
            const bool is_missing = (i * 31 + t * 17) % 11 == 0;
            lasting[i] = (float)(0.9 * lasting[i] + 0.43 * n);
            const double sigma = rlf_depth_noise_sigma(&small_rig.noise, 1.8);
            const double z = is_rough ? 3.2 + 0.09 * n : 1.8 + sigma * lasting[i];
            depth[i] = is_missing ? 0.0f : (float)(0.004 * floor(z / 0.004 + 0.5));
        }
        depth[0] = t % 2 == 0 ? 1.8f : 3.2f;
        stillness_add(s, depth);
    }
    stillness_result r;
    stillness_get(s, &r);
    assert_true(r.still_percent > 95.0);
    assert_true(fabs(r.bins[6].median_m - 0.09) < 0.006);
    stillness_destroy(&s);
}

TEST_CASE(noise_over_the_end_of_the_scale_is_not_measured)
{
    stillness *s = stillness_create(&small_rig);
    static float depth[W * H];
    uint32_t random = 9;
    for (int t = 0; t < 60; t++) {
        for (int i = 0; i < W * H; i++) {
            depth[i] = (float)(4.0 + 0.3 * normal(&random));
        }
        stillness_add(s, depth);
    }
    stillness_result r;
    stillness_get(s, &r);
    assert_true(r.still_percent > 90.0);
    for (int b = 0; b < INFO_BINS; b++) {
        assert_true(r.bins[b].pixels == 0 || r.bins[b].median_m >= STILLNESS_MOST_M);
    }
    stillness_destroy(&s);
}

/* ---- missing pixels ---------------------------------------------------------------------------
 */

TEST_CASE(missing_pixels_are_told_apart)
{
    static float depth[W * H];
    for (int y = 0; y < H; y++) {
        for (int x = 0; x < W; x++) {
            const bool is_rim = x < 4;                                     /* 4 x 40 */
            const bool is_hole = x >= 10 && x < 13 && y >= 10 && y < 20;   /* 30, one surface */
            const bool is_shadow = x >= 30 && x < 34 && y >= 20 && y < 30; /* 40, 1 m to 3 m */
            const bool is_side = x >= 55 && y < 5; /* 25, reaches the border */
            const double z = x < 30 ? 1.0 : 3.0;
            depth[y * W + x] = is_rim || is_hole || is_shadow || is_side ? 0.0f : (float)z;
        }
    }
    depth[35 * W + 20] = 0.3f;
    depth[35 * W + 40] = 6.0f;
    missing_counts counts = {0};
    missing_add(&counts, &small_rig, depth);
    const int64_t wanted[MISSING_KIND_COUNT] = {160, 25, 40, 30, 1, 1};
    for (int k = 0; k < MISSING_KIND_COUNT; k++) {
        assert_int_equal(counts.kinds[k], wanted[k]);
    }
    assert_true(fabs(missing_percent_all(&counts) - 100.0 * 257 / (W * H)) < 1e-9);
    memset(depth, 0, sizeof(depth));
    missing_counts none = {0};
    missing_add(&none, &small_rig, depth);
    assert_int_equal(none.kinds[MISSING_RIM], W * H);
}

/* ---- a whole survey ---------------------------------------------------------------------------
 */

TEST_CASE(a_survey_counts_what_comes)
{
    rlf_source *source = NULL;
    assert_int_equal(rlf_open_source("synthetic:room?frames=12&fps=25", NULL, &source), RLF_OK);
    static survey s;
    const survey_options options = {.seconds = 1};
    assert_int_equal(survey_run(source, &options, &s), RLF_OK);
    assert_int_equal(s.frames, 12);
    assert_int_equal(s.with_color, 12);
    assert_int_equal(s.with_pose, 0);
    assert_int_equal(s.failed, 0);
    assert_int_equal(s.status.lost, 0);
    assert_true(fabs(s.interval_s - 0.04) < 1e-6 && fabs(s.duration_s - 0.44) < 1e-6);
    assert_int_equal(s.stillness.frames, 12);
    assert_true(s.has_fit && s.fit.frames == 12);
    assert_true(missing_percent_all(&s.missing) > 1.0);
    rlf_source_destroy(&source);
}
