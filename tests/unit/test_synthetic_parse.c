/* "synthetic:..." strings: what they set, and what is said about wrong ones. */

#include "relief/synthetic.h"
#include "test.h"

#include <string.h>

TEST_CASE(every_key_is_read)
{
    rlf_synthetic_def def = rlf_synthetic_def_default();
    assert_int_equal(rlf_synthetic_parse("synthetic:thesis?seed=18446744073709551615&frames=-1&"
                                         "fps=29.97&noise=0&edge_filter=0&color=640x360",
                                         &def),
                     RLF_OK);
    assert_int_equal(def.scene, RLF_SYNTHETIC_THESIS);
    assert_true(def.seed == UINT64_MAX);
    assert_int_equal(def.frame_count, -1);
    assert_float_equal(def.frames_per_second, 29.97, 1e-12);
    assert_false(def.enable_noise);
    assert_false(def.enable_edge_filter);
    assert_true(def.enable_color);
    assert_int_equal(def.color_width, 640);
    assert_int_equal(def.color_height, 360);
    assert_int_equal(rlf_synthetic_parse("synthetic:hand?color=0&frames=12", &def), RLF_OK);
    assert_false(def.enable_color);
    assert_true(def.enable_noise);
    assert_int_equal(def.frame_count, 12);
    assert_false(def.enable_structured_light);
    assert_int_equal(rlf_synthetic_parse("synthetic:room?noise=steps", &def), RLF_OK);
    assert_true(def.enable_noise && def.enable_structured_light);
    assert_float_equal(def.lamp.y, -1.85, 0.0);
    assert_int_equal(rlf_synthetic_parse("synthetic:room?lamp=-1.5,0.25,-3&seed=7&person=3", &def),
                     RLF_OK);
    assert_float_equal(def.lamp.x, -1.5, 0.0);
    assert_float_equal(def.lamp.y, 0.25, 0.0);
    assert_float_equal(def.lamp.z, -3.0, 0.0);
    assert_int_equal(def.seed, 7);
    assert_int_equal(def.person, 3);
}

TEST_CASE(every_scene_has_its_name)
{
    static const char *const names[] = {"room", "empty", "thesis", "chair",    "book",  "hand",
                                        "lift", "swipe", "carry",  "crossing", "random"};
    for (int i = 0; i < 11; i++) {
        char text[64] = "synthetic:";
        strcat(text, names[i]);
        rlf_synthetic_def def = rlf_synthetic_def_default();
        assert_int_equal(rlf_synthetic_parse(text, &def), RLF_OK);
        assert_int_equal(def.scene, i);
    }
}

TEST_CASE(an_error_names_the_part_and_the_cure)
{
    static const struct {
        const char *source, *part, *cure;
    } cases[] = {
        {"folder", "folder", "synthetic:"},
        {"synthetic:", "''", "thesis"},
        {"synthetic:rooms", "'rooms'", "room, empty"},
        {"synthetic:room?sed=1", "'sed'", "seed"},
        {"synthetic:room?seed", "'seed'", "key=value"},
        {"synthetic:room?", "''", "key=value"},
        {"synthetic:room?seed=1&", "''", "key=value"},
        {"synthetic:room?seed=-1", "'-1'", "whole number"},
        {"synthetic:thesis?grasp=scoop", "grasp", "scene hands only"},
        {"synthetic:room?path=walk&view=side", "view", "scene hands only"},
        {"synthetic:room?seed=99999999999999999999", "'99999999999999999999'", "whole"},
        {"synthetic:room?seed=", "''", "whole number"},
        {"synthetic:room?frames=-2", "'-2'", "endless"},
        {"synthetic:room?frames=3x", "'3x'", "number of frames"},
        {"synthetic:room?fps=0", "'0'", "above 0"},
        {"synthetic:room?fps=nan", "'nan'", "above 0"},
        {"synthetic:room?fps=1e9", "'1e9'", "1000"},
        {"synthetic:room?noise=yes", "'yes'", "0, 1 or steps"},
        {"synthetic:room?edge_filter=2", "'2'", "0 or 1"},
        {"synthetic:room?color=960", "'960'", "WIDTHxHEIGHT"},
        {"synthetic:room?color=0x10", "'0x10'", "4096"},
        {"synthetic:room?color=5000x10", "'5000x10'", "4096"},
    };
    for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
        rlf_synthetic_def def = rlf_synthetic_def_default();
        def.seed = 42;
        assert_int_equal(rlf_synthetic_parse(cases[i].source, &def), RLF_ERROR_INVALID);
        assert_non_null(strstr(rlf_error_text(), cases[i].part));
        assert_non_null(strstr(rlf_error_text(), cases[i].cure));
        assert_int_equal(def.seed, 42);
    }
}

TEST_CASE(a_bad_def_is_refused_with_its_field)
{
    rlf_source *source = NULL;
    rlf_synthetic_def def = rlf_synthetic_def_default();
    def.frames_per_second = -1.0;
    assert_int_equal(rlf_synthetic_create(&def, &source), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "frames_per_second"));
    def = rlf_synthetic_def_default();
    def.color_width = 0;
    assert_int_equal(rlf_synthetic_create(&def, &source), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "color size"));
    def = rlf_synthetic_def_default();
    def.frame_count = -2;
    assert_int_equal(rlf_synthetic_create(&def, &source), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "frame_count"));
    assert_null(source);
}
