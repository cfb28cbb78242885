/* Plug-ins: what loads, what does not and why, what the program then knows. */
#define _POSIX_C_SOURCE 200809L

#include "io_support.h"
#include "relief/io.h"
#include "test.h"

static void bad_ones_are_refused_with_the_cure(void **state)
{
    (void)state;
    const struct {
        const char *name;
        rlf_result result;
        const char *part, *cure;
    } cases[] = {
        {"version.so", RLF_ERROR_UNSUPPORTED, "version 999", "build it again"},
        {"symbol.so", RLF_ERROR_FORMAT, "without rlf_backend_entry", "give a plug-in"},
        {"null.so", RLF_ERROR_UNSUPPORTED, "cannot be used with this program", "get the plug-in"},
        {"scheme.so", RLF_ERROR_INVALID, "no scheme", "relief/backend.h"},
        {"open.so", RLF_ERROR_INVALID, "no open function", "relief/backend.h"},
        {"taken.so", RLF_ERROR_INVALID, "\"folder:\" is taken", "not used"},
        {"absent.so", RLF_ERROR_IO, "cannot be loaded", NULL},
    };
    for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
        char path[TEST_PATH_MAX];
        snprintf(path, sizeof(path), BAD_PLUGIN_FOLDER "/%s", cases[i].name);
        test_expect_error(rlf_plugin_load(path), cases[i].result, cases[i].name, cases[i].part,
                          cases[i].cure);
    }
    test_expect_error(rlf_plugin_load(""), RLF_ERROR_INVALID, "no path", NULL, NULL);
}

static void files_that_are_no_objects_are_refused(void **state)
{
    (void)state;
    test_write("empty.so", "", 0);
    test_write_text("text.so", "no object at all\n");
    size_t size;
    char *whole = test_read(GOOD_PLUGIN, &size);
    test_write("half.so", whole, size / 2);
    test_write("head.so", whole, 64);
    free(whole);
    const char *const names[] = {"empty.so", "text.so", "half.so", "head.so"};
    for (size_t i = 0; i < sizeof(names) / sizeof(names[0]); i++) {
        test_expect_error(rlf_plugin_load(test_path(names[i])), RLF_ERROR_IO, names[i],
                          "cannot be loaded", NULL);
    }
    test_expect_error(rlf_plugin_load(test_folder), RLF_ERROR_IO, test_folder, "cannot be loaded",
                      NULL);
}

static const rlf_source_kind *find_kind(const char *scheme)
{
    static rlf_source_kind kinds[128];
    const int32_t count = rlf_source_kind_list(kinds, 128);
    for (int32_t i = 0; i < count && i < 128; i++) {
        if (strcmp(kinds[i].scheme, scheme) == 0) {
            return &kinds[i];
        }
    }
    return NULL;
}

static void a_camera_comes_with_its_plug_in(void **state)
{
    (void)state;
    rlf_source *source = NULL;
    assert_int_equal(rlf_open_source("plugin_camera:", NULL, &source), RLF_ERROR_UNSUPPORTED);
    const int32_t before = rlf_source_kind_list(NULL, 0);
    assert_int_equal(rlf_plugin_load(GOOD_PLUGIN), RLF_OK);
    assert_int_equal(rlf_plugin_load(GOOD_PLUGIN), RLF_OK); /* again: nothing happens */
    assert_int_equal(rlf_source_kind_list(NULL, 0), before + 1);
    assert_string_equal(find_kind("plugin_camera")->plugin, GOOD_PLUGIN);
    assert_null(find_kind("folder")->plugin);
    assert_int_equal(rlf_open_source("plugin_camera:?fps=100", NULL, &source), RLF_OK);
    assert_true(rlf_source_get_info(source)->is_live);
    rlf_frame frame;
    for (int given = 0; given < 3;) {
        const rlf_result result = rlf_source_next(source, &frame);
        assert_true(result == RLF_OK || result == RLF_NO_FRAME);
        given += result == RLF_OK ? 1 : 0;
    }
    assert_int_equal(frame.depth_u16[0], 3000);              /* the wall */
    assert_in_range(frame.depth_u16[239 * 320], 2500, 2600); /* the floor before the camera */
    assert_true(frame.host_time_ns > 0);
    rlf_source_destroy(&source);
    test_expect_error(rlf_open_source("plugin_camera:?fps=0", NULL, &source), RLF_ERROR_INVALID,
                      "fps", "1 to 200", NULL);
}

static void one_that_cannot_be_used_here_says_why(void **state)
{
    (void)state;
    assert_int_equal(rlf_plugin_load(BAD_PLUGIN_FOLDER "/unavailable.so"), RLF_OK);
    assert_non_null(strstr(find_kind("nosuch")->unavailable, "apt install nosuch"));
    rlf_source *source = NULL;
    test_expect_error(rlf_open_source("nosuch:", NULL, &source), RLF_ERROR_UNSUPPORTED,
                      "nosuch:", "libnosuch.so", "apt install nosuch");
}

int main(void)
{
    /* What the user of this machine has in the usual folders is no part of the test. */
    setenv("HOME", "/no/such/home", 1);
    unsetenv("RELIEF_PLUGIN_PATH");
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_ones_are_refused_with_the_cure),
        cmocka_unit_test_setup_teardown(files_that_are_no_objects_are_refused, test_folder_make,
                                        test_folder_remove),
        cmocka_unit_test(a_camera_comes_with_its_plug_in),
        cmocka_unit_test(one_that_cannot_be_used_here_says_why),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
