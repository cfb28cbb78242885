/* The measures themselves: counts and angles against hand-made surfaces and truth. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "eval/measures/angles.h"
#include "eval/measures/centre.h"
#include "eval/measures/collisions.h"
#include "eval/measures/foreground.h"
#include "eval/measures/normals.h"
#include "measure/points.h"
#include "relief/synthetic.h"

#include <math.h>
#include <string.h>

#define W 32
#define H 20

static void angles_give_mean_median_and_shares(void **state)
{
    (void)state;
    static eval_angles angles;
    memset(&angles, 0, sizeof(angles));
    const double degrees[5] = {1, 2, 3, 40, 179.9999};
    for (int i = 0; i < 5; i++) {
        eval_add_angle(&angles, degrees[i]);
    }
    angles.missing = 5;
    assert_true(fabs(eval_median_deg(&angles) - 3.0) < 0.02);
    assert_true(fabs(eval_mean_deg(&angles) - 45.2) < 0.01);
    assert_true(eval_wrong_percent(&angles) == 40.0);
    assert_true(eval_missing_percent(&angles) == 50.0);
    assert_true(eval_within_percent(&angles, 10.0) == 60.0);
    memset(&angles, 0, sizeof(angles)); /* no samples: no figure, not a figure of 0 */
    assert_true(isnan(eval_mean_deg(&angles)) && isnan(eval_wrong_percent(&angles)));
}

static void band_is_six_pixels_on_both_sides_of_a_jump(void **state)
{
    (void)state;
    float depth[W * H];
    uint8_t band[W * H], scratch[W * H];
    for (int i = 0; i < W * H; i++) {
        depth[i] = i % W < 16 ? 1.0f : 1.05f;
    }
    eval_mark_band(depth, W, H, band, scratch);
    for (int i = 0; i < W * H; i++) {
        bool is_near = i % W >= 15 - 6 && i % W <= 16 + 6;
        assert_int_equal(band[i], is_near);
    }
    for (int i = 0; i < W * H; i++) {
        depth[i] = i % W < 16 ? 1.0f : 1.03f; /* 3 %: no jump */
    }
    eval_mark_band(depth, W, H, band, scratch);
    for (int i = 0; i < W * H; i++) {
        assert_int_equal(band[i], 0);
    }
}

static void decimated_normals_meet_the_right_truth(void **state)
{
    (void)state;
    static float depth[W * H], nx[W * H], nz[W * H], zero[W * H], fx[8], fz[8], fzero[8];
    static uint8_t band[W * H];
    for (int i = 0; i < W * H; i++) {
        depth[i] = 2.0f;
        nx[i] = (i % W) % 8 == 0 ? 0.0f : 1.0f; /* only every 8th pixel faces the camera */
        nz[i] = (i % W) % 8 == 0 ? -1.0f : 0.0f;
    }
    depth[8] = 9.0f; /* beyond the range: not counted */
    for (int i = 0; i < 8; i++) {
        fz[i] = i == 3 ? 0.0f : -1.0f; /* pixel 3 has no normal */
    }
    rlf_truth truth = {.depth = depth, .normal_x = nx, .normal_y = zero, .normal_z = nz};
    rlf_surface surface = {.width = 4,
                           .height = 2,
                           .scale_factor = 8,
                           .normal_x = fx,
                           .normal_y = fzero,
                           .normal_z = fz};
    rlf_rig rig = {.depth = {.width = W, .height = H}, .depth_min_m = 0.5, .depth_max_m = 4.5};
    static eval_normals normals;
    memset(&normals, 0, sizeof(normals));
    eval_normals_add(&normals, &surface, &truth, &rig, band);
    assert_int_equal(normals.interior.count, 6);
    assert_int_equal(normals.interior.missing, 1);
    assert_true(eval_mean_deg(&normals.interior) == 0.0);
    assert_int_equal(normals.band.count, 0);
}

/* A 512 x 424 truth at scale 1, and the same at the thesis's scale 8, judged on the same points. */
static void centre_is_the_thesis_grid_for_every_scale(void **state)
{
    (void)state;
    enum { COUNT = 512 * 424, GRID = 64 * 53 };
    static float depth[COUNT], ones[COUNT], zero[COUNT], found[COUNT], coarse[GRID];
    static uint8_t foreground[COUNT];
    for (int i = 0; i < COUNT; i++) {
        depth[i] = 2.0f;
        ones[i] = found[i] = -1.0f;
    }
    for (int i = 0; i < GRID; i++) {
        coarse[i] = -1.0f;
    }
    found[26 * 8 * 512 + 30 * 8] = 0.0f; /* missing, as is its sample of the coarse grid */
    coarse[26 * 64 + 30] = 0.0f;
    found[26 * 8 * 512 + 31 * 8] = coarse[26 * 64 + 31] = 1.0f; /* turned away */
    found[26 * 8 * 512 + 32 * 8 + 1] = 1.0f;                    /* no point of the grid */
    found[0] = coarse[0] = 1.0f;                                /* not in the centre */
    rlf_truth truth = {.depth = depth,
                       .normal_x = zero,
                       .normal_y = zero,
                       .normal_z = ones,
                       .foreground = foreground};
    rlf_surface fine = {.width = 512,
                        .height = 424,
                        .scale_factor = 1,
                        .normal_x = zero,
                        .normal_y = zero,
                        .normal_z = found,
                        .background_state = RLF_BACKGROUND_READY};
    rlf_surface thesis = fine;
    thesis.width = 64;
    thesis.height = 53;
    thesis.scale_factor = 8;
    thesis.normal_z = coarse;
    rlf_rig rig = {.depth = {.width = 512, .height = 424}, .depth_min_m = 0.5, .depth_max_m = 4.5};
    eval_centre centre = {0};
    eval_centre_add(&centre, &fine, &truth, &rig);
    assert_int_equal(centre.points, 0); /* nothing moves */
    memset(foreground, 1, 1000);
    eval_centre_add(&centre, &fine, &truth, &rig);
    assert_int_equal(centre.points, 56 * 47);
    assert_int_equal(centre.missing, 1);
    assert_int_equal(centre.wrong, 1);
    eval_centre_add(&centre, &thesis, &truth, &rig);
    assert_int_equal(centre.points, 2 * 56 * 47);
    assert_int_equal(centre.missing, 2);
    assert_int_equal(centre.wrong, 2);
}

static void foreground_counts_hits_and_misses(void **state)
{
    (void)state;
    uint8_t found[6] = {1, 1, 0, 0, 1, 0};
    uint8_t is_true[6] = {1, 0, 1, 0, 1, 0};
    uint8_t reason[6] = {RLF_REASON_OK, RLF_REASON_FILLED, RLF_REASON_OK,
                         RLF_REASON_OK, RLF_REASON_OK,     RLF_REASON_OK};
    rlf_truth truth = {.foreground = is_true};
    rlf_surface surface = {.width = 3,
                           .height = 2,
                           .scale_factor = 1,
                           .foreground = found,
                           .reason = reason,
                           .background_state = RLF_BACKGROUND_READY};
    rlf_rig rig = {.depth = {.width = 3, .height = 2}};
    eval_foreground foreground;
    memset(&foreground, 0, sizeof(foreground));
    eval_foreground_add(&foreground, &surface, &truth, &rig);
    assert_true(fabs(eval_precision(&foreground.all) - 2.0 / 3.0) < 1e-12);
    assert_true(fabs(eval_recall(&foreground.all) - 2.0 / 3.0) < 1e-12);
    assert_true(fabs(eval_f_measure(&foreground.all) - 2.0 / 3.0) < 1e-12);
    assert_true(fabs(eval_precision(&foreground.valid) - 1.0) < 1e-12);
    surface.background_state = RLF_BACKGROUND_LEARNING;
    eval_foreground_add(&foreground, &surface, &truth, &rig);
    assert_int_equal(foreground.all.true_positive, 2);
}

/* A 64 x 53 grid with one missing corner and one missing centre point, without and with motion. */
static void missing_points_fall_into_the_four_cases(void **state)
{
    (void)state;
    enum { COUNT = 64 * 53 };
    static uint8_t reason[COUNT];
    reason[0] = RLF_REASON_NO_RETURN;
    reason[26 * 64 + 32] = RLF_REASON_TOO_FAR;
    rlf_surface surface = {.width = 64,
                           .height = 53,
                           .scale_factor = 8,
                           .reason = reason,
                           .background_state = RLF_BACKGROUND_READY};
    rlf_rig rig = {.depth = {.width = 512, .height = 424}};
    measure_points m;
    memset(&m, 0, sizeof(m));
    measure_points_add(&m, &surface, NULL, &rig);
    surface.foreground_count = 100;
    reason[1] = RLF_REASON_NO_RETURN;
    measure_points_add(&m, &surface, NULL, &rig);
    measure_points_add(&m, &surface, NULL, &rig);
    surface.background_state = RLF_BACKGROUND_LEARNING; /* not counted */
    measure_points_add(&m, &surface, NULL, &rig);
    const int64_t frames[4] = {1, 1, 2, 2}, points[4] = {3392, 2632, 3392, 2632};
    const double missing[4] = {2, 1, 3, 1};
    for (int c = 0; c < MEASURE_CASE_COUNT; c++) {
        assert_int_equal(m.cases[c].frames, frames[c]);
        assert_int_equal(m.cases[c].points, points[c]);
        assert_true(measure_missing(&m.cases[c]) == missing[c]);
        assert_true(isnan(measure_counted_percent(&m.cases[c])));
    }
    assert_true(measure_published(&m, MEASURE_MOVING_CENTRE) == 57.113);
    assert_true(fabs(measure_published_off_percent(&m, MEASURE_STILL_FULL) -
                     100.0 * (2.0 / 165.468 - 1.0)) < 1e-9);
    m.width = 512; /* no such table */
    assert_true(isnan(measure_published(&m, MEASURE_MOVING_CENTRE)));
    /* the thesis's own numbers: 57.113 of 2632 points are 8.68 % wrong normals */
    measure_counts thesis = {.frames = 1000, .points = 2632};
    thesis.reasons[RLF_REASON_NO_RETURN] = 57113;
    assert_true(fabs(measure_estimated_percent(&thesis) - 8.68) < 0.005);
    thesis.reasons[RLF_REASON_NO_RETURN] = 1000000; /* 38 % missing spoil no more than all */
    assert_true(measure_estimated_percent(&thesis) == 100.0);
}

static void collision_scene_is_the_same_for_a_seed(void **state)
{
    (void)state;
    rlf_scene a, b, c;
    assert_int_equal(eval_collisions_scene(7, 20, &a), RLF_OK);
    assert_int_equal(eval_collisions_scene(7, 20, &b), RLF_OK);
    assert_int_equal(eval_collisions_scene(8, 20, &c), RLF_OK);
    assert_memory_equal(&a.bodies[3].velocity, &b.bodies[3].velocity, sizeof(rlf_vec3));
    assert_memory_not_equal(&a.bodies[3].velocity, &c.bodies[3].velocity, sizeof(rlf_vec3));
    rlf_scene_destroy(&a);
    rlf_scene_destroy(&b);
    rlf_scene_destroy(&c);
}

/* What the eval says of a bounce at (x, y, 2.57) with the normal (nx, ny, 0): 2 right, 1 within 30
 * degrees, 0 unexplained. */
static int judged(rlf_source *source, double x, double y, double nx, double ny)
{
    eval_collisions e = {0};
    rlf_contact contact = {.point = {x, y, 2.57}, .normal = rlf_normalize((rlf_vec3){nx, ny, 0})};
    eval_collisions_judge(&e, &contact, source);
    assert_int_equal(e.bounces, 1);
    assert_int_equal(e.phantom, 0);
    assert_true(e.off_m < 0.021);
    return e.right > 0 ? 2 : e.unexplained > 0 ? 0 : 1;
}

static void every_direction_between_the_faces_of_an_edge_is_right(void **state)
{
    (void)state;
    const double LEFT = 0.59, TOP = 0.565; /* of the table's top */
    rlf_source *source = NULL;
    rlf_frame frame;
    rlf_synthetic_def def = rlf_synthetic_def_default();
    def.scene = RLF_SYNTHETIC_EMPTY;
    assert_int_equal(rlf_synthetic_create(&def, &source), RLF_OK);
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_int_equal(judged(source, LEFT, TOP, -1, -1), 2);
    assert_int_equal(judged(source, LEFT, TOP, -1, -3), 2);
    assert_int_equal(judged(source, LEFT, TOP, 0, -1), 2);
    assert_int_equal(judged(source, LEFT, TOP, 1, -1), 0); /* of no face there */
    assert_int_equal(judged(source, LEFT + 0.005, TOP, -1, -1), 2);
    assert_int_equal(judged(source, LEFT + 0.02, TOP, -1, -1), 1);
    assert_int_equal(judged(source, LEFT + 0.10, TOP, -1, -1), 0);
    assert_int_equal(judged(source, LEFT + 0.10, TOP, -0.15, -1), 2); /* 8.5 degrees */
    assert_int_equal(judged(source, LEFT + 0.10, TOP, -0.2, -1), 1);  /* 11.3 */
    rlf_source_destroy(&source);
}

/* A place 2 cm over the table is 2 cm off, one in its top 1. */
static void bounces_are_measured_where_they_are(void **state)
{
    (void)state;
    rlf_source *source = NULL;
    rlf_frame frame;
    rlf_synthetic_def def = rlf_synthetic_def_default();
    def.scene = RLF_SYNTHETIC_EMPTY;
    assert_int_equal(rlf_synthetic_create(&def, &source), RLF_OK);
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    eval_collisions e = {0};
    rlf_contact contact = {.point = {0.72, 0.565 - 0.02, 2.57}, .normal = {0, -1, 0}};
    eval_collisions_judge(&e, &contact, source);
    assert_float_equal(e.off_m, 0.02, 1e-6);
    contact.point.y = 0.565 + 0.01;
    eval_collisions_judge(&e, &contact, source);
    assert_float_equal(e.off_m, 0.03, 1e-6);
    rlf_source_destroy(&source);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(angles_give_mean_median_and_shares),
        cmocka_unit_test(band_is_six_pixels_on_both_sides_of_a_jump),
        cmocka_unit_test(decimated_normals_meet_the_right_truth),
        cmocka_unit_test(centre_is_the_thesis_grid_for_every_scale),
        cmocka_unit_test(foreground_counts_hits_and_misses),
        cmocka_unit_test(missing_points_fall_into_the_four_cases),
        cmocka_unit_test(collision_scene_is_the_same_for_a_seed),
        cmocka_unit_test(every_direction_between_the_faces_of_an_edge_is_right),
        cmocka_unit_test(bounces_are_measured_where_they_are),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
