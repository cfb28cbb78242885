/* The sections of `relief-lab eval` that need no simulated camera give what they must. */
#define _POSIX_C_SOURCE 200809L

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "eval/bounds.h"
#include "eval/physics/sheet.h"
#include "eval/sections.h"
#include "eval/table.h"
#include "io_support.h"

#include <math.h>
#include <string.h>

#define BOTH 3

static eval_table table;

static int clear(void **state)
{
    (void)state;
    memset(&table, 0, sizeof(table));
    return 0;
}

static double value(const char *scene, const char *key, rlf_profile profile)
{
    const eval_row *row = eval_table_find(&table, scene, key);
    assert_non_null(row);
    assert_true(row->count[profile] > 0);
    return row->values[profile][0];
}

/* Every bound of a section has its figure and holds. */
static void expect_bounds(const char *scene)
{
    int count = 0;
    for (int32_t i = 0; i < eval_bound_count; i++) {
        const eval_bound *b = &eval_bounds[i];
        if (strcmp(b->scene, scene) == 0) {
            double mean = value(scene, b->key, RLF_PROFILE_LIVE);
            eval_verdict verdict = eval_bound_judge(b, mean);
            print_message("%s %s: %.4g\n", scene, b->key, mean);
            assert_true(verdict == EVAL_GOAL_MET || verdict == EVAL_WITHIN_BOUND);
            count++;
        }
    }
    assert_true(count > 0);
}

static void planes_are_exact_and_eq_4_3_is_not(void **state)
{
    (void)state;
    assert_int_equal(eval_planes_run(&table, 1, BOTH), RLF_OK);
    expect_bounds("planes");
    assert_true(value("planes", "normals_mean_deg", RLF_PROFILE_THESIS) > 1.0);
    assert_true(value("planes", "holes_lost_percent", RLF_PROFILE_THESIS) > 1.0);
}

static void plate_moves_and_the_wall_does_not(void **state)
{
    (void)state;
    assert_int_equal(eval_plate_run(&table, 1, BOTH), RLF_OK);
    expect_bounds("plate");
    assert_true(value("plate", "plate_speed_error_percent", RLF_PROFILE_THESIS) == 100.0);
}

static void bodies_do_what_they_must(void **state)
{
    (void)state;
    assert_int_equal(eval_physics_run(&table, 1, BOTH), RLF_OK);
    expect_bounds("physics");
    assert_true(value("physics", "free_fall_mm", RLF_PROFILE_THESIS) > 100.0); /* Euler at 30 Hz */
}

/* Depth, normal and mask of the analytic sheet along the middle ray. */
static void sheet_shows_walls_and_slab(void **state)
{
    (void)state;
    const eval_wall walls[2] = {{{0, 0, -1}, -3.0}, {{0, -1, 0}, -1.0}};
    const eval_slab slab = {{{0, 0, -1}, -2.0}, {0, 0, 2}, {0.1, 0.1, 0}, 0.3, {1, 2, 3}};
    eval_sheet sheet;
    assert_int_equal(eval_sheet_open(&sheet), RLF_OK);
    eval_sheet_set_room(&sheet, walls, 2);
    const rlf_grid *g = &sheet.grid;
    int32_t middle = g->height / 2 * g->width + g->width / 2;
    int32_t bottom = (g->height - 1) * g->width + g->width / 2;
    assert_true(fabs(g->background.depth[middle] - 3.0) < 1e-6);
    assert_true(fabs(g->background.depth[bottom] * g->ray_y[bottom] - 1.0) < 1e-5);
    assert_true(g->background.normal_y[bottom] == -1.0f);
    assert_int_equal(g->foreground.mask[middle], 0);
    int64_t seen_at = g->time_ns;
    eval_sheet_set_slab(&sheet, &slab);
    assert_true(g->time_ns > seen_at);
    assert_int_equal(g->foreground.mask[middle], 1);
    assert_int_equal(g->foreground.mask[bottom], 0);
    assert_true(g->foreground.depth[middle] == 2.0f && g->foreground.velocity_z[middle] == 3.0f);
    assert_true(g->foreground.thickness[middle] == 0.3f);
    int64_t pixels = 0; /* 0.2 m at 2 m are 36.55 pixels of 365.5 */
    for (int32_t i = 0; i < g->width * g->height; i++) {
        pixels += g->foreground.mask[i];
    }
    assert_in_range(pixels, 36 * 36, 37 * 37);
    assert_true(eval_sheet_sees(rlf_vec3_make(0, 0, 1)));
    assert_false(eval_sheet_sees(rlf_vec3_make(0, 0, -1)));
    eval_sheet_close(&sheet);
}

static void missing_folders_are_named(void **state)
{
    (void)state;
    test_expect_error(eval_public_run(&table, "no_such_folder", BOTH), RLF_ERROR_IO,
                      "no_such_folder", NULL, NULL);
    test_expect_error(eval_public_run(&table, RLF_TEST_ROOT "/examples/../LICENSE", BOTH),
                      RLF_ERROR_IO, "LICENSE", "folder", NULL);
    test_expect_error(eval_public_run(&table, RLF_TEST_ROOT "/tests", BOTH), RLF_ERROR_IO,
                      "depth.bin", "check", NULL);
    assert_int_equal(table.count, 0);
}

/* Public frames with true normals: the figures of the goal sheet. */
static void public_frames_reach_their_goals(void **state)
{
    (void)state;
    const char *folder = RLF_TEST_SHARED "/data/normals";
    if (!test_exists(folder)) {
        print_message("SKIPPED: no frames with true normals in %s\n", folder);
        skip();
    }
    assert_int_equal(eval_public_run(&table, folder, BOTH), RLF_OK);
    expect_bounds("android");
    expect_bounds("demo");
    assert_true(value("android", "normals_mean_deg", RLF_PROFILE_THESIS) > 2.0);
    assert_true(value("demo", "normals_mean_deg", RLF_PROFILE_THESIS) > 2.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(planes_are_exact_and_eq_4_3_is_not, clear),
        cmocka_unit_test_setup(plate_moves_and_the_wall_does_not, clear),
        cmocka_unit_test_setup(bodies_do_what_they_must, clear),
        cmocka_unit_test(sheet_shows_walls_and_slab),
        cmocka_unit_test_setup(missing_folders_are_named, clear),
        cmocka_unit_test_setup(public_frames_reach_their_goals, clear),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
