/* `--set`: names and words reach the field that they name, and nothing else. */
#include "settings.h"
#include "test.h"

#include <stdio.h>
#include <string.h>

static rlf_reconstruct_def def_of(rlf_profile profile)
{
    rlf_rig rig = {.depth = {.width = 64, .height = 48, .fx = 60, .fy = 60}, .depth_max_m = 4.5};
    return rlf_reconstruct_def_default(profile, &rig);
}

TEST_CASE(a_setting_reaches_its_field_alone)
{
    setting_list list = {0};
    assert_int_equal(settings_add(&list, "fill=off"), RLF_OK);
    assert_int_equal(settings_add(&list, "background_method=average"), RLF_OK);
    assert_int_equal(settings_add(&list, "region_capacity=7"), RLF_OK);
    assert_int_equal(settings_add(&list, "segment_tau_m=0.15"), RLF_OK);
    rlf_reconstruct_def def = def_of(RLF_PROFILE_LIVE), expected = def_of(RLF_PROFILE_LIVE);
    settings_apply(&list, &def);
    expected.enable_fill = false;
    expected.background_method = RLF_BACKGROUND_AVERAGE;
    expected.region_capacity = 7;
    expected.segment_tau_m = 0.15;
    assert_memory_equal(&def, &expected, sizeof def);
}

TEST_CASE(the_last_one_wins)
{
    setting_list list = {0};
    assert_int_equal(settings_add(&list, "hold=off"), RLF_OK);
    assert_int_equal(settings_add(&list, "hold=on"), RLF_OK);
    rlf_reconstruct_def def = def_of(RLF_PROFILE_THESIS);
    settings_apply(&list, &def);
    assert_true(def.enable_hold);
}

TEST_CASE(what_has_no_effect_is_told)
{
    rlf_reconstruct_def live = def_of(RLF_PROFILE_LIVE), thesis = def_of(RLF_PROFILE_THESIS);
    assert_non_null(settings_need("segment_tau_m=0.1", &live));
    assert_null(settings_need("segment_tau_m=0.1", &thesis));
    assert_non_null(settings_need("foreground_threshold_m=0.1", &live));
    assert_null(settings_need("foreground_sigmas=5", &live));
    assert_non_null(settings_need("absorb_after_s=5", &thesis));
    assert_non_null(settings_need("color_sides=on", &live)); /* the rig has no colour */
    assert_null(settings_need("hold=off", &live));
    live.enable_steadying = false;
    assert_non_null(settings_need("hold=on", &live));
    assert_null(settings_need("depth_max_m=3", &live));
}

TEST_CASE(what_is_no_setting_is_refused)
{
    static const char *const wrong[] = {"",
                                        "fill",
                                        "fill=",
                                        "fil=on",
                                        "=on",
                                        "fill=yes",
                                        "depth_max_m=",
                                        "depth_max_m=3m",
                                        "hold=ON",
                                        "region_capacity=-1",
                                        "region_capacity=1.5",
                                        "region_capacity=1e99",
                                        "normal_method=5"};
    setting_list list = {0};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        assert_int_equal(settings_add(&list, wrong[i]), RLF_ERROR_INVALID);
    }
    assert_int_equal(list.count, 0);
}

TEST_CASE(there_is_an_end_to_them)
{
    setting_list list = {0};
    for (int i = 0; i < SETTINGS_MAX; i++) {
        assert_int_equal(settings_add(&list, "fill=on"), RLF_OK);
    }
    assert_int_equal(settings_add(&list, "fill=on"), RLF_ERROR_INVALID);
}

/* What `relief list settings` and the window's panel show can be given back. */
TEST_CASE(every_setting_shows_what_it_is)
{
    const rlf_reconstruct_def live = def_of(RLF_PROFILE_LIVE);
    for (int32_t i = 0; i < settings_count(); i++) {
        setting_view view;
        char text[96];
        setting_list list = {0};
        rlf_reconstruct_def def = live;
        settings_look(i, &live, &view);
        (void)snprintf(text, sizeof(text), "%s=%s", view.name, view.value);
        assert_int_equal(settings_add(&list, text), RLF_OK);
        settings_apply(&list, &def);
        assert_true(strlen(view.meaning) > 5);
        assert_int_equal(view.is_switch && strcmp(view.words[1], "on") != 0, 0);
        assert_true(view.need == settings_need(text, &live));
    }
}
