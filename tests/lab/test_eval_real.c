/* Figures on real recordings: masks and planes, on input made here. */

#include "eval/real/clip.h"
#include "eval/real/fit.h"
#include "eval/real/mask.h"
#include "eval/real/real.h"
#include "eval/real/run.h"
#include "test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define W 120
#define H 100
#define PIXELS (W * H)

static uint8_t found[PIXELS], truth[PIXELS], scratch[PIXELS];

static void put_disc(uint8_t *mask, double cx, double cy, double radius, uint8_t value)
{
    for (int32_t i = 0; i < PIXELS; i++) {
        double dx = i % W - cx, dy = i / W - cy;
        mask[i] = dx * dx + dy * dy <= radius * radius ? value : mask[i];
    }
}

static real_mask_errors compare(void)
{
    real_mask_errors e;
    real_mask_work work;
    memset(&e, 0, sizeof(e));
    assert_int_equal(real_mask_work_init(&work, W, H), RLF_OK);
    real_mask_add(&e, &work, found, truth);
    real_mask_work_finish(&work);
    return e;
}

static int clear(void **state)
{
    (void)state;
    memset(found, 0, sizeof(found));
    memset(truth, 0, sizeof(truth));
    return 0;
}

TEST_CASE_WITH(equal_masks_have_no_error, clear, NULL)
{
    put_disc(found, 60, 50, 20, 1);
    put_disc(truth, 60, 50, 20, REAL_INSIDE);
    real_mask_errors e = compare();
    assert_true(real_mask_iou(&e) >= 1.0);
    assert_true(real_mask_distance_mean(&e) <= 0.0);
    assert_int_equal(e.blot_inside_max + e.blot_outside_max, 0);
}

/* A circle shifted by s is off by s |cos|, s 2/pi in the mean, to a fraction of a pixel. */
TEST_CASE_WITH(shifted_disc_is_off_by_its_shift, clear, NULL)
{
    put_disc(found, 64, 50, 25, 1);
    put_disc(truth, 60, 50, 25, REAL_INSIDE);
    real_mask_errors e = compare();
    assert_true(fabs(real_mask_distance_mean(&e) - 4.0 * 2.0 / RLF_PI) < 0.35);
    assert_true(fabs(real_mask_distance_p95(&e) - 4.0) < 0.6);
    double half = rlf_acos(2.0 / 25.0); /* the lens of two circles */
    double both = 2.0 * 625.0 * half - 4.0 * sqrt(625.0 - 4.0);
    assert_true(fabs(real_mask_iou(&e) - both / (2.0 * RLF_PI * 625.0 - both)) < 0.01);
}

TEST_CASE_WITH(blots_are_told_from_outlines, clear, NULL)
{
    put_disc(found, 60, 50, 31, 1); /* an outline 1 pixel too wide is no blot */
    put_disc(truth, 60, 50, 30, REAL_INSIDE);
    put_disc(found, 60, 50, 4, 0);
    put_disc(found, 5, 5, 3, 1);
    real_mask_errors e = compare();
    assert_int_equal(e.blot_inside_max, 49); /* pixels of a disc of radius 4 */
    assert_int_equal(e.blot_outside_max, 29);
}

TEST_CASE_WITH(what_is_not_judged_does_not_count, clear, NULL)
{
    put_disc(truth, 60, 50, 20, REAL_INSIDE);
    put_disc(found, 60, 50, 20, 1);
    put_disc(found, 110, 10, 5, 1);
    put_disc(truth, 110, 10, 7, REAL_UNJUDGED);
    real_mask_errors e = compare();
    assert_true(real_mask_iou(&e) >= 1.0);
    assert_true(real_mask_distance_mean(&e) <= 0.0);
    assert_int_equal(e.blot_outside_max, 0);
}

TEST_CASE_WITH(closing_fills_what_is_narrow, clear, NULL)
{
    put_disc(found, 60, 50, 30, 1);
    put_disc(found, 60, 50, 3, 0);
    real_mask_close(found, W, H, scratch);
    assert_int_equal(found[50 * W + 60], 1);
    assert_int_equal(found[50 * W + 92], 0);
    clear(NULL);
    put_disc(found, 60, 50, 30, 1);
    put_disc(found, 60, 50, 8, 0);
    real_mask_close(found, W, H, scratch);
    assert_int_equal(found[50 * W + 60], 0);
}

TEST_CASE_WITH(planes_are_found, clear, NULL)
{
    static float ray_x[PIXELS], ray_y[PIXELS], depth[PIXELS];
    const rlf_depth_noise noise = {0.001, 0, 0};
    const rlf_vec3 up = rlf_normalize(rlf_vec3_make(0.1, -0.8, -0.6));
    for (int32_t i = 0; i < PIXELS; i++) {
        ray_x[i] = (float)((i % W - 60) / 100.0);
        ray_y[i] = (float)((i / W - 50) / 100.0 + 0.6);
        depth[i] = (float)(-1.0 / (up.x * ray_x[i] + up.y * ray_y[i] + up.z));
        bool is_thing = i % W / 20 % 2 == 1 && i / W >= 40 && i / W < 60;
        depth[i] *= is_thing ? 0.8f : 1.0f;
    }
    const real_points points = {W, H, ray_x, ray_y, depth};
    real_plane plane;
    assert_true(real_plane_find(&points, NULL, &noise, &plane));
    assert_true(rlf_dot(plane.n, up) > 0.999999 && fabs(plane.d + 1.0) < 1e-3);
    assert_true(rlf_dot(real_window_normal(&points, 10 * W + 60), up) > 0.99999);
}

TEST_CASE(missing_clips_are_skipped)
{
    static real_table table;
    const real_options options = {.folder = "no_such_folder", .silhouettes = "none"};
    assert_int_equal(real_run(&table, &options), RLF_OK);
    assert_int_equal(table.count, 0);
}

TEST_CASE(rows_keep_their_names)
{
    static real_table table;
    const real_row row = {.key = "k",
                          .title = "T",
                          .relation = '<',
                          .goal = 1.0,
                          .relief = 2.0,
                          .baseline = NAN,
                          .baseline_name = "b"};
    for (int i = 0; i <= REAL_ROWS_MAX; i++) {
        real_add(&table, "part", &row);
    }
    assert_true(table.is_full && table.count == REAL_ROWS_MAX);
}
