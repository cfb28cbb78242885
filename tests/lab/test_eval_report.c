/* Confidence intervals, rows, goals and bounds. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "eval/bounds.h"
#include "eval/figures.h"
#include "eval/report.h"
#include "eval/run.h"
#include "eval/table.h"
#include "eval/statistics.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static eval_table table;

static int clear(void **state)
{
    (void)state;
    memset(&table, 0, sizeof(table));
    return 0;
}

/* 4, 6, 8: mean 6, s = 2, t(2) = 4.303. */
static void interval_is_students(void **state)
{
    (void)state;
    const double values[5] = {4, NAN, 6, 8, NAN};
    statistics s = statistics_of(values, 5);
    assert_int_equal(s.count, 3);
    assert_true(fabs(s.mean - 6.0) < 1e-12);
    assert_true(fabs(s.half_width - 4.303 * 2.0 / sqrt(3.0)) < 1e-9);
    s = statistics_of(values, 2);
    assert_true(s.count == 1 && s.mean == 4.0 && isnan(s.half_width));
    s = statistics_of(values + 1, 1);
    assert_true(s.count == 0 && isnan(s.mean));
}

static void many_values_have_the_normal_quantile(void **state)
{
    (void)state;
    double values[64];
    for (int i = 0; i < 64; i++) {
        values[i] = i % 2 ? 1.0 : -1.0;
    }
    statistics s = statistics_of(values, 64);
    assert_true(s.mean == 0.0);
    assert_true(fabs(s.half_width - 1.998 * sqrt(64.0 / 63.0) / 8.0) < 1e-3); /* t(63) = 1.998 */
}

static void rows_collect_seeds_per_profile(void **state)
{
    (void)state;
    static eval_table other;
    memset(&other, 0, sizeof(other));
    eval_table_add(&table, "room", "a", "A", RLF_PROFILE_LIVE, 1.0);
    eval_table_add(&other, "room", "a", "A", RLF_PROFILE_LIVE, 2.0);
    eval_table_add(&other, "room", "a", "A", RLF_PROFILE_THESIS, 5.0);
    eval_table_add(&other, "empty", "a", "A", RLF_PROFILE_LIVE, 3.0);
    eval_table_merge(&table, &other);
    assert_int_equal(table.count, 2);
    const eval_row *row = eval_table_find(&table, "room", "a");
    assert_non_null(row);
    assert_int_equal(row->count[RLF_PROFILE_LIVE], 2);
    assert_int_equal(row->count[RLF_PROFILE_THESIS], 1);
    assert_true(row->values[RLF_PROFILE_LIVE][1] == 2.0);
    assert_null(eval_table_find(&table, "room", "b"));
}

static void means_are_judged_by_goal_and_bound(void **state)
{
    (void)state;
    const eval_bound most = {"s", "k", '<', 1.0, 2.0, "", ""};
    const eval_bound least = {"s", "k", '>', NAN, 0.5, "", ""};
    assert_int_equal(eval_bound_judge(&most, 1.0), EVAL_GOAL_MET);
    assert_int_equal(eval_bound_judge(&most, 1.5), EVAL_WITHIN_BOUND);
    assert_int_equal(eval_bound_judge(&most, 2.001), EVAL_OUTSIDE);
    assert_int_equal(eval_bound_judge(&most, NAN), EVAL_NOT_MEASURED);
    assert_int_equal(eval_bound_judge(&least, 0.5), EVAL_WITHIN_BOUND);
    assert_int_equal(eval_bound_judge(&least, 0.49), EVAL_OUTSIDE);
}

/* A bound that no figure has would never be looked at; one looser than its goal is the only kind
 * that may differ from it. */
static void bounds_belong_to_figures(void **state)
{
    (void)state;
    for (int32_t i = 0; i < eval_bound_count; i++) {
        const eval_bound *b = &eval_bounds[i];
        assert_ptr_equal(eval_bound_find(b->scene, b->key), b); /* no second one */
        assert_true(b->relation == '<' || b->relation == '>');
        assert_true(isnan(b->goal) || isnan(b->bound) || /* a goal alone */
                    (b->relation == '<' ? b->bound >= b->goal : b->bound <= b->goal));
        bool is_known = eval_scene_find(b->scene) == NULL;
        for (int32_t f = 0; f < eval_figure_count(); f++) {
            is_known = is_known || strcmp(eval_figure_key(f), b->key) == 0;
        }
        if (!is_known) {
            fail_msg("%s: no figure '%s'", b->scene, b->key);
        }
    }
    assert_true(eval_figure_count() <= EVAL_FIGURES_MAX);
}

static int32_t report(bool is_whole)
{
    eval_report_options options = {
        .is_whole = is_whole, .json_path = "eval_report_test.json", .seeds = 2};
    int32_t outside = -1;
    assert_int_equal(eval_report(&table, &options, &outside), RLF_OK);
    return outside;
}

static void a_figure_outside_its_bound_is_counted(void **state)
{
    (void)state;
    const eval_bound *b = eval_bound_find("planes", "normals_mean_deg");
    assert_non_null(b);
    for (int k = 0; k < 2; k++) {
        eval_table_add(&table, "planes", "normals_mean_deg", "  T", RLF_PROFILE_LIVE,
                       b->bound * (0.4 + 0.4 * k));
        eval_table_add(&table, "planes", "normals_mean_deg", "  T", RLF_PROFILE_THESIS, 99.0);
    }
    assert_int_equal(report(true), 0); /* the thesis is not judged */
    eval_table_add(&table, "planes", "normals_mean_deg", "  T", RLF_PROFILE_LIVE, 5.0 * b->bound);
    assert_int_equal(report(true), 1);
    json_t *root = json_load_file("eval_report_test.json", 0, NULL);
    assert_non_null(root);
    json_t *row = json_array_get(json_object_get(root, "figures"), 0);
    assert_string_equal(json_string_value(json_object_get(row, "title")), "T");
    assert_string_equal(json_string_value(json_object_get(row, "verdict")), "OUTSIDE");
    assert_true(json_is_false(json_object_get(row, "ok")));
    json_t *live = json_object_get(row, "live");
    assert_int_equal(json_array_size(json_object_get(live, "values")), 3);
    assert_true(json_real_value(json_object_get(live, "ci95")) > 0.0);
    assert_int_equal(json_integer_value(json_object_get(root, "outside")), 1);
    json_decref(root);
}

static void a_bounded_figure_needs_a_sample(void **state)
{
    (void)state;
    eval_table_add(&table, "planes", "normals_mean_deg", "T", RLF_PROFILE_LIVE, NAN);
    assert_int_equal(report(true), 1);
    assert_int_equal(report(false), 0); /* scenes that were cut short may not show it */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(interval_is_students),
        cmocka_unit_test(many_values_have_the_normal_quantile),
        cmocka_unit_test_setup(rows_collect_seeds_per_profile, clear),
        cmocka_unit_test(means_are_judged_by_goal_and_bound),
        cmocka_unit_test(bounds_belong_to_figures),
        cmocka_unit_test_setup(a_figure_outside_its_bound_is_counted, clear),
        cmocka_unit_test_setup(a_bounded_figure_needs_a_sample, clear),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
