/* The list of recordings shown lately. */
#define _XOPEN_SOURCE 700
#include "io_support.h"
#include "state_folder.h"
#include "test.h"

TEST_CASE(the_newest_recordings_come_first)
{
    char here[400], state_folder[512];
    recent_list list;
    assert_non_null(getcwd(here, sizeof(here)));
    (void)snprintf(state_folder, sizeof(state_folder), "%s/%s/state", here, test_folder);
    assert_int_equal(setenv("XDG_STATE_HOME", state_folder, 1), 0);
    recent_load(&list);
    assert_int_equal(list.count, 0);
    for (int i = 0; i < 10; i++) {
        char name[8];
        (void)snprintf(name, sizeof(name), "clip%d", i);
        assert_int_equal(mkdir(test_path(name), 0777), 0);
        recent_note(test_path(name));
    }
    recent_note(test_path("clip8"));
    recent_note("synthetic:room"); /* is no file */
    assert_int_equal(rmdir(test_path("clip5")), 0);
    recent_load(&list);
    assert_int_equal(list.count, RECENT_MAX - 1); /* one is gone */
    const int expected[RECENT_MAX - 1] = {8, 9, 7, 6, 4, 3, 2};
    for (int i = 0; i < list.count; i++) {
        char end[16];
        (void)snprintf(end, sizeof(end), "/clip%d", expected[i]);
        const size_t length = strlen(list.paths[i]);
        assert_int_equal(list.paths[i][0], '/');
        assert_string_equal(list.paths[i] + length - strlen(end), end);
    }
}

TEST_CASE(without_a_home_nothing_is_kept)
{
    recent_list list;
    unsetenv("XDG_STATE_HOME");
    unsetenv("HOME");
    recent_note(test_folder);
    recent_load(&list);
    assert_int_equal(list.count, 0);
}

TEST_EACH(test_folder_make, test_folder_remove)
