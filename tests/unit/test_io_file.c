/* Files in and out: pipes in place of files, names of files that are being written, and what error
 * lines say. */
#define _POSIX_C_SOURCE 200809L
#include "test.h"

#include <signal.h>
#include <sys/stat.h>

#include "relief/io.h"
#include "io/file.h"
#include "io_support.h"

/* Whoever waits for a pipe that nobody writes to waits for ever. */
TEST_CASE(pipes_are_refused_at_once)
{
    static const char *const names[] = {"clip/depth.txt", "clip/camera.json",
                                        "p.json",         "p.obj",
                                        "p.gltf",         "p.png",
                                        "p.mcap",         "p.bag",
                                        "p.mkv",          "p.klg",
                                        "p.sens",         "p.oni"};
    rlf_make_folder(test_path("clip"));
    alarm(20);
    for (size_t i = 0; i < sizeof(names) / sizeof(names[0]); i++) {
        assert_int_equal(mkfifo(test_path(names[i]), 0600), 0);
        io_buffer buffer = {0};
        io_bytes bytes;
        test_expect_error(io_file_read(test_path(names[i]), 100, "look", &buffer, &bytes),
                          RLF_ERROR_IO, names[i], "not a regular file", "give the name of a file");
        io_buffer_free(&buffer);
    }
    rlf_source *source = NULL;
#ifdef RLF_HAVE_MCAP
    const size_t first_source = 6;
#else
    const size_t first_source = 7; /* without MCAP that file is not looked at */
#endif
    for (size_t i = first_source; i < sizeof(names) / sizeof(names[0]); i++) {
        test_expect_error(rlf_open_source(test_path(names[i]), NULL, &source), RLF_ERROR_IO,
                          names[i], "not a regular file", NULL);
    }
    test_expect_error(rlf_open_source(test_path("clip"), NULL, &source), RLF_ERROR_IO, "clip/",
                      "not a regular file", NULL);
    rlf_scene scene;
    test_expect_error(rlf_scene_load(test_path("p.json"), &scene), RLF_ERROR_IO, "p.json",
                      "not a regular file", NULL);
    alarm(0);
}

TEST_CASE(some_bytes_are_read_anywhere)
{
    test_write_text("ten", "0123456789");
    io_file file;
    char text[8] = "";
    assert_int_equal(io_file_open(&file, test_path("ten"), "look"), RLF_OK);
    assert_int_equal(file.size, 10);
    assert_int_equal(io_file_read_at(&file, 7, text, 8), 3);
    assert_memory_equal(text, "789", 3);
    assert_int_equal(io_file_read_at(&file, 10, text, 8), 0);
    io_file_close(&file);
    assert_int_equal(file.descriptor, -1);
    test_expect_error(io_file_open(&file, test_path("none"), "look"), RLF_ERROR_IO, "none",
                      "No such file", "look");
    assert_int_equal(file.descriptor, -1);
}

/* A link in the place of the part that is being written leads nowhere. */
TEST_CASE(a_part_follows_no_link)
{
    test_write_text("victim", "mine");
    assert_int_equal(symlink("victim", test_path("out.part")), 0);
    assert_int_equal(rlf_file_write(test_path("out"), "new", 3), RLF_OK);
    struct stat status;
    assert_int_equal(lstat(test_path("out"), &status), 0);
    assert_true(S_ISREG(status.st_mode));
    size_t size;
    char *text = test_read(test_path("victim"), &size);
    assert_string_equal(text, "mine");
    free(text);
}

/* Each has a part of its own, and the last to end gives the file its content. */
TEST_CASE(two_writers_do_not_mix)
{
    io_out_file a, b;
    assert_int_equal(io_out_open(&a, test_path("both")), RLF_OK);
    assert_int_equal(io_out_open(&b, test_path("both")), RLF_OK);
    assert_string_not_equal(a.part, b.part);
    assert_int_equal(io_out_write(&a, "aaaaaa", 6), RLF_OK);
    assert_int_equal(io_out_write(&b, "bb", 2), RLF_OK);
    assert_int_equal(io_out_close(&a, RLF_OK), RLF_OK);
    assert_int_equal(io_out_close(&b, RLF_OK), RLF_OK);
    size_t size;
    char *text = test_read(test_path("both"), &size);
    assert_string_equal(text, "bb");
    free(text);
    assert_false(test_exists(a.part));
    assert_false(test_exists(b.part));
}

TEST_CASE(a_file_written_in_place_has_one_writer)
{
    int first, second;
    test_write_text("log", "older and longer");
    assert_int_equal(io_out_open_in_place(test_path("log"), &first), RLF_OK);
    assert_int_equal(write(first, "new", 3), 3);
    test_expect_error(io_out_open_in_place(test_path("log"), &second), RLF_ERROR_IO, "log",
                      "another program", "choose another name");
    size_t size;
    char *text = test_read(test_path("log"), &size);
    assert_string_equal(text, "new");
    free(text);
    close(first);
    assert_int_equal(io_out_open_in_place(test_path("log"), &second), RLF_OK);
    close(second);
}

/* Names come from files and go to terminals. */
TEST_CASE(error_lines_have_no_control_characters)
{
    test_log log = {0};
    rlf_set_log(test_log_line, &log);
    rlf_fail(RLF_ERROR_IO, "%s: is\nnot\there", "a\x1b[31m\x07\x7f");
    assert_string_equal(rlf_error_text(), "a?[31m??: is not here");
    rlf_log(RLF_LOG_WARNING, "\x1b]0;title\x07");
    assert_string_equal(log.last, "?]0;title?");
    rlf_set_log(NULL, NULL);
}

/* Not why it cannot be looked at afterwards. */
TEST_CASE(a_folder_that_cannot_be_made_says_why)
{
    assert_int_equal(rlf_make_folder(test_path("shut")), RLF_OK);
    assert_int_equal(chmod(test_folder, 0755), 0);
    assert_int_equal(chmod(test_path("shut"), 0555), 0);
    const bool is_root = geteuid() == 0; /* who may write anywhere */
    assert_int_equal(is_root ? seteuid(65534) : 0, 0);
    rlf_result result = rlf_make_folder(test_path("shut/log"));
    assert_int_equal(is_root ? seteuid(0) : 0, 0);
    test_expect_error(result, RLF_ERROR_IO, "shut/log", "Permission denied", "choose a place");
}

TEST_GROUP(test_folder_make, test_folder_remove)
