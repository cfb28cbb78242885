/* Recordings: what is refused, what a full disk keeps, and that what is read is not written. */
#define _POSIX_C_SOURCE 200809L

#include "recording_sample.h"
#include "test.h"

#include <math.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static rlf_recording *begin(const char *name, bool is_folder)
{
    char path[TEST_PATH_MAX];
    const rlf_source_info info = sample_info();
    const rlf_recording_def def = sample_def(RLF_DEPTH_RVL, RLF_COMPRESSION_NONE);
    rlf_recording *recording = NULL;
    snprintf(path, sizeof(path), "%s%s", test_path(name), is_folder ? "/" : "");
    if (rlf_recording_open(path, &info, &def, &recording) != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    return recording;
}

static int32_t count_frames(const char *name)
{
    rlf_source *source = NULL;
    rlf_frame frame;
    int32_t count = 0;
    if (rlf_open_source(test_path(name), NULL, &source) != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    while (rlf_source_next(source, &frame) == RLF_OK) {
        count++;
    }
    rlf_source_destroy(&source);
    return count;
}

static void spoil(int32_t how, rlf_frame *f)
{
    static const double units[] = {0.0, NAN, INFINITY, 1e308, -1000.0, 2000.0};
    switch (how) {
    case 0:
    case 1:
    case 2:
    case 3:
    case 4:
    case 5: f->depth_units_per_metre = units[how]; break;
    case 6: f->depth_u16 = NULL; break;
    case 7: f->depth_f32 = sample_metres; break;
    case 8: f->depth_stride = SAMPLE_W; break;
    case 9: f->color.width = SAMPLE_CW - 1; break;
    case 10: f->color.stride = SAMPLE_CW; break;
    case 11: f->color.height = SAMPLE_CH * 2; break;
    case 12: f->time_ns = INT64_MIN; break;
    case 13: f->time_ns = INT64_MAX; break;
    case 14: f->color_time_ns = INT64_MAX; break;
    default: /* metres after counts */
        f->depth_u16 = NULL;
        f->depth_f32 = sample_metres;
        f->depth_stride = SAMPLE_W * 4;
        break;
    }
}

TEST_CASE(frames_that_are_none_are_refused)
{
    const rlf_source_info info = sample_info();
    for (int is_folder = 0; is_folder < 2; is_folder++) {
        const char *name = is_folder != 0 ? "checked" : "checked.mcap";
        rlf_recording *recording = begin(name, is_folder != 0);
        for (int32_t i = 0; i < 16; i++) {
            rlf_frame frame = sample_frame(&info.rig, 2 * i, false);
            assert_int_equal(rlf_recording_add(recording, &frame), RLF_OK);
            frame = sample_frame(&info.rig, 2 * i + 1, false);
            spoil(i, &frame);
            assert_int_equal(rlf_recording_add(recording, &frame), RLF_ERROR_INVALID);
        }
        assert_int_equal(rlf_recording_close(&recording, NULL), RLF_OK);
        assert_int_equal(count_frames(name), 16);
    }
}

TEST_CASE(defs_and_names_that_are_none_are_refused)
{
    static const char *const names[] = {"a.mp4", "a.bag", "a", "a.mcap.txt", ".json"};
    const rlf_source_info info = sample_info();
    rlf_recording *recording = NULL;
    for (int32_t i = 0; i < 4; i++) {
        rlf_recording_def def = rlf_recording_def_default();
        def.compression = (rlf_compression)(i == 0 ? 99 : i == 1 ? -1 : 0);
        def.depth_codec = (rlf_depth_codec)(i == 2 ? 7 : i == 3 ? -1 : 0);
        assert_int_equal(rlf_recording_open(test_path("no.mcap"), &info, &def, &recording),
                         RLF_ERROR_INVALID);
    }
    const rlf_recording_def def = rlf_recording_def_default();
    for (size_t i = 0; i < sizeof(names) / sizeof(names[0]); i++) {
        assert_int_equal(rlf_recording_open(test_path(names[i]), &info, &def, &recording),
                         RLF_ERROR_INVALID);
        assert_int_not_equal(access(test_path(names[i]), F_OK), 0);
    }
}

/* A limit on the size of files stands for a disk that is full. */
TEST_CASE(a_full_disk_tells_what_can_be_read)
{
    signal(SIGXFSZ, SIG_IGN);
    const rlf_source_info info = sample_info();
    for (int is_folder = 0; is_folder < 2; is_folder++) {
        const char *name = is_folder != 0 ? "full" : "full.mcap";
        rlf_recording *recording = begin(name, is_folder != 0);
        struct rlimit before;
        assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
        struct rlimit limit = before;
        limit.rlim_cur = is_folder != 0 ? 2000 : 20000;
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
        rlf_result result = RLF_OK;
        for (int32_t i = 0; i < 300 && result == RLF_OK; i++) {
            const rlf_frame frame = sample_frame(&info.rig, i, false);
            result = rlf_recording_add(recording, &frame);
        }
        rlf_recording_status status;
        (void)rlf_recording_close(&recording, &status);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
        assert_int_equal(result, RLF_ERROR_IO);
        assert_true(status.frames > 0);
        assert_int_equal(count_frames(name), status.frames);
    }
}

/* ---- what is read -----------------------------------------------------------------------------
 */

static void expect_refused(const char *name)
{
    const rlf_source_info info = sample_info();
    const rlf_recording_def def = rlf_recording_def_default();
    rlf_recording *recording = NULL;
    assert_int_equal(rlf_recording_open(test_path(name), &info, &def, &recording),
                     RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "while it is read"));
}

TEST_CASE(a_file_that_is_read_is_not_written)
{
    static const char *const names[] = {"read.mcap", "link.mcap", "hard.mcap"};
    const rlf_recording_def def = sample_def(RLF_DEPTH_RVL, RLF_COMPRESSION_ZSTD);
    rlf_source *source = NULL;
    char target[TEST_PATH_MAX];
    sample_record(test_path("read.mcap"), &def, 7, false);
    snprintf(target, sizeof(target), "%s", test_path("read.mcap"));
    assert_int_equal(symlink("read.mcap", test_path("link.mcap")), 0);
    assert_int_equal(link(target, test_path("hard.mcap")), 0);
    assert_int_equal(rlf_open_source(test_path("hard.mcap"), NULL, &source), RLF_OK);
    for (size_t i = 0; i < 3; i++) {
        expect_refused(names[i]);
        assert_int_equal(rlf_file_write(test_path(names[i]), "x", 1), RLF_ERROR_INVALID);
        assert_int_equal(rlf_file_check(test_path(names[i])), RLF_ERROR_INVALID);
        assert_int_equal(count_frames(names[i]), 7);
    }
    rlf_source_destroy(&source);
    assert_int_equal(rlf_file_check(test_path("read.mcap")), RLF_OK);
    sample_record(test_path("link.mcap"), &def, 3, false);
    assert_int_equal(count_frames("read.mcap"), 3);
}

TEST_CASE(a_folder_that_is_read_is_not_written)
{
    static const char *const folders[] = {"seen", "seen/", "seen/depth", "seen/rgb/", "way"};
    static const char *const files[] = {"seen/depth.txt", "seen/camera.json", "way/rgb.txt",
                                        "seen/depth/000001.png", "list.txt"};
    char path[TEST_PATH_MAX];
    const rlf_recording_def def = sample_def(RLF_DEPTH_RVL, RLF_COMPRESSION_ZSTD);
    rlf_source *source = NULL;
    snprintf(path, sizeof(path), "%s/", test_path("seen"));
    sample_record(path, &def, 4, false);
    assert_int_equal(symlink("seen", test_path("way")), 0);
    snprintf(path, sizeof(path), "%s", test_path("seen/depth.txt"));
    assert_int_equal(link(path, test_path("list.txt")), 0);
    assert_int_equal(rlf_open_source(test_path("way"), NULL, &source), RLF_OK);
    for (size_t i = 0; i < sizeof(folders) / sizeof(folders[0]); i++) {
        expect_refused(folders[i]);
        assert_int_equal(rlf_make_folder(test_path(folders[i])), RLF_ERROR_INVALID);
    }
    for (size_t i = 0; i < sizeof(files) / sizeof(files[0]); i++) {
        assert_int_equal(rlf_file_write(test_path(files[i]), "x", 1), RLF_ERROR_INVALID);
    }
    /* What no clip consists of may lie beside it. */
    assert_int_equal(rlf_file_write(test_path("seen/notes.map"), "x", 1), RLF_OK);
    assert_int_equal(rlf_file_write(test_path("seen/notes.map"), "y", 1), RLF_OK);
    assert_int_equal(count_frames("seen"), 4);
    rlf_source_destroy(&source);
    assert_int_equal(rlf_make_folder(test_path("seen")), RLF_OK);
    assert_int_equal(rlf_file_write(test_path("seen/camera.json"), "x", 1), RLF_OK);
}

TEST_GROUP(test_folder_make, test_folder_remove)
