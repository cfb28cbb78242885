/* The folder source: order, pairing, errors in the middle of a clip, and real clips. */
#define _POSIX_C_SOURCE 200809L

#include "io/clip/clip.h"
#include "io/folder/folder.h"
#include "io_support.h"
#include "jpeg_sample.h"
#include "relief/io.h"
#include "test.h"

#define W 16
#define H 8
#define CAMERA "\"width\":16,\"height\":8,\"fx\":15,\"fy\":15,\"cx\":7.5,\"cy\":3.5"
#define DEPTH_JSON "\"depth\":{" CAMERA ",\"units_per_metre\":1000}"

static void write_depth(const char *name, uint16_t value, int32_t width, int32_t height)
{
    uint16_t pixels[32 * 32];
    for (int i = 0; i < 32 * 32; i++) {
        pixels[i] = value;
    }
    assert_int_equal(rlf_png_write_u16(test_path(name), pixels, width, height), RLF_OK);
}

static void write_color(const char *name, uint8_t value)
{
    uint8_t pixels[W * H * 4];
    memset(pixels, value, sizeof(pixels));
    rlf_image_rgba8 image = {pixels, W, H, W * 4};
    assert_int_equal(rlf_png_write_rgba(test_path(name), &image), RLF_OK);
}

/* A clip of five depth pictures (100, 200, ...) and four of colour, one of them a JPEG. */
static int make_clip(void **state)
{
    if (test_folder_make(state) != 0) {
        return -1;
    }
    test_write_text("camera.json", "{" DEPTH_JSON ",\"color\":{" CAMERA "}}");
    test_write_text("depth.txt", "# timestamp filename\n"
                                 "0.000000 d0.png\n0.033333 d1.png\n\n0.066667 d2.png\r\n"
                                 "  # a comment\n0.1 d3.png\n0.133333 d 4.png");
    test_write_text("rgb.txt", "0.020 c0.png\n0.040 c1.png\n0.041 c2.jpg\n0.180 c3.png\n");
    const char *const names[5] = {"d0.png", "d1.png", "d2.png", "d3.png", "d 4.png"};
    for (int i = 0; i < 5; i++) {
        write_depth(names[i], (uint16_t)(100 * (i + 1)), W, H);
    }
    write_color("c0.png", 10);
    write_color("c1.png", 20);
    test_write("c2.jpg", jpeg_sample, sizeof(jpeg_sample));
    write_color("c3.png", 40);
    return 0;
}

static rlf_source *open_clip(void)
{
    rlf_source *source = NULL;
    rlf_result result = rlf_open_source(test_folder, NULL, &source);
    if (result != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    return source;
}

static void expect_open_error(rlf_result wanted, const char *file, const char *part,
                              const char *cure)
{
    rlf_source *source = NULL;
    test_expect_error(rlf_folder_source_open(test_folder, &source), wanted, file, part, cure);
    assert_null(source);
}

TEST_CASE_WITH(frames_come_in_order_with_the_nearest_color, make_clip, test_folder_remove)
{
    rlf_source *source = open_clip();
    const rlf_source_info *info = rlf_source_get_info(source);
    assert_int_equal(info->frame_count, 5);
    assert_false(info->is_live);
    assert_true(info->rig.has_color);
    assert_true(info->frames_per_second > 29.9 && info->frames_per_second < 30.1);
    assert_string_equal(info->name, test_folder);
    /* 0 -> 20 ms; 33 -> 40; 67 -> 41 (26 away); 100 -> none within 50; 133 -> 180 (47 away) */
    const int color[5] = {10, 20, 256, -1, 40};
    const int64_t times[5] = {0, 33333000, 66667000, 100000000, 133333000};
    for (int pass = 0; pass < 2; pass++) {
        rlf_frame frame;
        for (int i = 0; i < 5; i++) {
            assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
            assert_int_equal(frame.sequence, i);
            assert_int_equal(frame.time_ns, times[i]);
            assert_null(frame.depth_f32);
            assert_int_equal(frame.depth_stride, W * 2);
            assert_true(frame.depth_units_per_metre == 1000);
            assert_int_equal(frame.depth_u16[0], 100 * (i + 1));
            assert_int_equal(frame.depth_u16[W * H - 1], 100 * (i + 1));
            if (color[i] < 0) {
                assert_null(frame.color.data);
                continue;
            }
            assert_int_equal(frame.color.width, W);
            assert_int_equal(frame.color.height, H);
            assert_int_equal(frame.color.data[3], 255);
            assert_true(color[i] == 256 ? frame.color.data[0] > 240
                                        : frame.color.data[0] == color[i]);
        }
        assert_int_equal(rlf_source_next(source, &frame), RLF_END);
        assert_int_equal(rlf_source_next(source, &frame), RLF_END);
        assert_int_equal(rlf_source_restart(source), RLF_OK);
    }
    rlf_source_destroy(&source);
}

TEST_CASE_WITH(frames_allocate_nothing, make_clip, test_folder_remove)
{
    rlf_source *source = open_clip();
    rlf_frame frame;
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    uint64_t before = rlf_alloc_count();
    while (rlf_source_next(source, &frame) == RLF_OK) {
    }
    assert_int_equal(rlf_alloc_count(), before);
    rlf_source_destroy(&source);
}

TEST_CASE_WITH(times_that_go_back_are_sorted_with_a_warning, make_clip, test_folder_remove)
{
    test_write_text("depth.txt", "0.2 d2.png\n0.1 d1.png\n0.1 d0.png\n");
    test_log log = {0};
    rlf_set_log(test_log_line, &log);
    rlf_source *source = open_clip();
    rlf_set_log(NULL, NULL);
    assert_int_equal(log.count, 1);
    assert_non_null(strstr(log.last, "depth.txt:2"));
    const int values[2] = {200, 300}; /* of equal times the first of the file */
    rlf_frame frame;
    for (int i = 0; i < 2; i++) {
        assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
        assert_int_equal(frame.depth_u16[0], values[i]);
    }
    const rlf_source_status status = rlf_source_get_status(source);
    assert_int_equal(status.given, 2);
    assert_int_equal(status.doubled, 1);
    rlf_source_destroy(&source);
}

TEST_CASE(unix_times_keep_their_nanoseconds)
{
    const char text[] = "\xEF\xBB\xBF"
                        "1305031229.528784123 a\n1305031229.5287841239 b\n.5 c\n7 d e \n";
    io_bytes file = {"depth.txt", (const uint8_t *)text, strlen(text)};
    io_frame_list list;
    test_log log = {0};
    rlf_set_log(test_log_line, &log);
    assert_int_equal(io_frame_list_parse(&file, &list), RLF_OK);
    rlf_set_log(NULL, NULL);
    assert_int_equal(list.count, 4);
    assert_int_equal(list.entries[0].time_ns, 500000000);
    assert_int_equal(list.entries[1].time_ns, INT64_C(7000000000));
    assert_string_equal(list.entries[1].name, "d e");
    assert_true(list.entries[2].time_ns == INT64_C(1305031229528784123));
    assert_true(list.entries[3].time_ns == INT64_C(1305031229528784123));
    assert_string_equal(list.entries[3].name, "b");
    io_frame_list_free(&list);
}

/* depth.txt of three pictures, with a value for each: whose unit, in units per second, is found. */
TEST_CASE(other_units_are_understood)
{
    static const struct {
        const char *times[3];
        int64_t first_ns, last_ns; /* -1 = refused */
        const char *told;          /* NULL = nothing */
    } lists[] = {
        {{"0", "0.033", "0.066"}, 0, 66000000, NULL},
        {{"0", "1", "2"}, 0, INT64_C(2000000000), NULL},
        {{"1700000000", "1700000060", "1700000120"},
         INT64_C(1700000000000000000),
         INT64_C(1700000120000000000),
         NULL},
        {{"0", "33.3", "66.7"}, 0, 66700000, "milliseconds"},
        {{"500.25", "533", "566"}, 500250000, 566000000, "milliseconds"},
        {{"1700000000000", "1700000000033", "1700000000066"},
         INT64_C(1700000000000000000),
         INT64_C(1700000000066000000),
         "milliseconds"},
        {{"12000000", "12033333", "12066666"},
         INT64_C(12000000000),
         INT64_C(12066666000),
         "microseconds"},
        {{"1700000000000000", "1700000000033333", "1700000000066666.5"},
         INT64_C(1700000000000000000),
         INT64_C(1700000000066666500),
         "microseconds"},
        {{"1700000000000000001", "1700000000033333334", "1700000000066666667"},
         INT64_C(1700000000000000001),
         INT64_C(1700000000066666667),
         "nanoseconds"},
        {{"5000000000", "5033333333", "5066666667"},
         INT64_C(5000000000),
         INT64_C(5066666667),
         "nanoseconds"},
        /* 5 ms or 5 s: only a date tells. */
        {{"1700000000000000000", "1700000000005000000", "1700000000010000000"},
         INT64_C(1700000000000000000),
         INT64_C(1700000000010000000),
         "nanoseconds"},
        {{"900000000000", "900005000000", "900010000000"}, -1, -1, NULL},
        {{"0", "5000", "10000"}, 0, INT64_C(10000000000000), NULL}, /* seconds, as ever */
    };
    for (size_t i = 0; i < sizeof(lists) / sizeof(lists[0]); i++) {
        char text[256];
        snprintf(text, sizeof(text), "%s a\n%s b\n%s c\n", lists[i].times[0], lists[i].times[1],
                 lists[i].times[2]);
        io_bytes file = {"depth.txt", (const uint8_t *)text, strlen(text)};
        io_frame_list list;
        test_log log = {0};
        rlf_set_log(test_log_line, &log);
        const rlf_result result = io_frame_list_parse(&file, &list);
        rlf_set_log(NULL, NULL);
        if (lists[i].first_ns < 0) {
            test_expect_error(result, RLF_ERROR_FORMAT, "depth.txt:1", "more than 4600000000",
                              "write seconds");
            continue;
        }
        assert_int_equal(result, RLF_OK);
        if (list.entries[0].time_ns != lists[i].first_ns ||
            list.entries[2].time_ns != lists[i].last_ns) {
            fail_msg("%s: %lld %lld", lists[i].times[0], (long long)list.entries[0].time_ns,
                     (long long)list.entries[2].time_ns);
        }
        assert_int_equal(log.count, lists[i].told != NULL ? 1 : 0);
        assert_true(lists[i].told == NULL || strstr(log.last, lists[i].told) != NULL);
        io_frame_list_free(&list);
    }
}

TEST_CASE_WITH(broken_lists_are_refused, make_clip, test_folder_remove)
{
    const struct {
        const char *text, *part, *cure;
    } lists[] = {
        {"", "lists no depth pictures", "write one"},
        {"# only a comment\n\n", "lists no depth pictures", "write one"},
        {"0.0 d0.png\nhello d1.png\n", "depth.txt:2", "SECONDS FILE"},
        {"0.0 d0.png\n0.1\n", "depth.txt:2: has no file name", "SECONDS FILE"},
        {"-1.0 d0.png\n", "depth.txt:1", "time in seconds"},
        {"1.0x d0.png\n", "depth.txt:1", "time in seconds"},
        {"nan d0.png\n", "depth.txt:1", "time in seconds"},
        {"99999999999999999999 d0.png\n", "depth.txt:1: its time is more than", "write seconds"},
        {"1700000000000.5 d0.png\n", "depth.txt:1: its time is more than", "not milliseconds"},
    };
    for (size_t i = 0; i < sizeof(lists) / sizeof(lists[0]); i++) {
        test_write_text("depth.txt", lists[i].text);
        expect_open_error(RLF_ERROR_FORMAT, "depth.txt", lists[i].part, lists[i].cure);
    }
    test_write("depth.txt", "0.0 d0\0.png\n", 12);
    expect_open_error(RLF_ERROR_FORMAT, "depth.txt", "not a text file", "SECONDS FILE");
    remove(test_path("depth.txt"));
    expect_open_error(RLF_ERROR_IO, "depth.txt", "No such file", "SECONDS FILE");
}

/* Before memory is asked for a camera that is many times as large as its pictures. */
TEST_CASE_WITH(the_camera_has_the_size_of_its_pictures, make_clip, test_folder_remove)
{
    test_write_text(
        "camera.json",
        "{\"depth\":{\"width\":4096,\"height\":4096,\"fx\":3000,\"fy\":3000,\"cx\":2048,"
        "\"cy\":2048,\"units_per_metre\":1000}}");
    expect_open_error(RLF_ERROR_FORMAT, "d0.png", "but camera.json says 4096 x 4096",
                      "correct camera.json");
}

TEST_CASE_WITH(missing_and_broken_camera_json, make_clip, test_folder_remove)
{
    test_write_text("camera.json", "{}");
    expect_open_error(RLF_ERROR_INVALID, "camera.json", "depth is missing", "intrinsics");
    remove(test_path("camera.json"));
    expect_open_error(RLF_ERROR_INVALID, "camera.json", "no camera is known for pictures of 16 x 8",
                      "?camera=FILE");
}

TEST_CASE_WITH(broken_color_list_is_refused, make_clip, test_folder_remove)
{
    test_write_text("rgb.txt", "zero c0.png\n");
    expect_open_error(RLF_ERROR_FORMAT, "rgb.txt:1", "time in seconds", "SECONDS FILE");
}

/* Each of these happens to the second frame: it is left out, with a line that says why and one that
 * counts. */
static void expect_second_left_out(const char *file, const char *part, const char *cure)
{
    test_log log = {0};
    rlf_set_log(test_log_line, &log);
    rlf_source *source = open_clip();
    rlf_frame frame;
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_int_equal(frame.depth_u16[0], 300);
    const char *const words[3] = {file, part, cure};
    for (int k = 0; k < 3; k++) {
        if (strstr(log.last, words[k]) == NULL) {
            fail_msg("\"%s\" does not mention \"%s\"", log.last, words[k]);
        }
    }
    assert_int_equal(log.count, 1);
    assert_int_equal(rlf_source_get_status(source).damaged, 1);
    while (rlf_source_next(source, &frame) == RLF_OK) {
    }
    assert_int_equal(log.count, 2);
    assert_non_null(strstr(log.last, "1 of 5 depth pictures could not be read: left out"));
    rlf_source_destroy(&source);
    rlf_set_log(NULL, NULL);
}

TEST_CASE_WITH(bad_depth_picture_in_the_middle, make_clip, test_folder_remove)
{
    write_depth("d1.png", 1, H, W);
    expect_second_left_out("d1.png", "8 x 16 but camera.json says 16 x 8", "camera.json");
    test_write("d1.png", "", 0);
    expect_second_left_out("d1.png", "0 bytes", "again");
    size_t size;
    char *whole = test_read(test_path("d0.png"), &size);
    test_write("d1.png", whole, size / 2);
    free(whole);
    expect_second_left_out("d1.png", "cut short", "again");
    write_color("d1.png", 3);
    expect_second_left_out("d1.png", "8-bit colour", "16-bit grey PNG");
    test_write("d1.png", jpeg_sample, sizeof(jpeg_sample));
    expect_second_left_out("d1.png", "not a PNG", "convert");
    remove(test_path("d1.png"));
    expect_second_left_out("d1.png", "No such file", "line 3 out of depth.txt");
}

/* The clip's size is what most of its pictures say. */
TEST_CASE_WITH(a_bad_first_picture_is_left_out, make_clip, test_folder_remove)
{
    write_depth("d0.png", 1, H, W);
    rlf_source *source = open_clip();
    rlf_frame frame;
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_int_equal(frame.depth_u16[0], 200);
    rlf_source_destroy(&source);
}

TEST_CASE_WITH(nothing_that_can_be_read_is_an_error, make_clip, test_folder_remove)
{
    const char *const names[5] = {"d0.png", "d1.png", "d2.png", "d3.png", "d 4.png"};
    for (int i = 0; i < 5; i++) {
        write_color(names[i], 3);
    }
    rlf_source *source = open_clip();
    rlf_frame frame;
    test_expect_error(rlf_source_next(source, &frame), RLF_ERROR_FORMAT, "d0.png", "8-bit colour",
                      "no other frame");
    rlf_source_destroy(&source);
}

/* Depth counts: the frame is there, without colour. */
static void expect_second_without_color(const char *file, const char *part, const char *cure)
{
    test_log log = {0};
    rlf_set_log(test_log_line, &log);
    rlf_source *source = open_clip();
    rlf_frame frame;
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_non_null(frame.color.data);
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_int_equal(frame.depth_u16[0], 200);
    assert_null(frame.color.data);
    assert_non_null(strstr(log.last, file));
    assert_non_null(strstr(log.last, part));
    assert_non_null(strstr(log.last, cure));
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_non_null(frame.color.data);
    rlf_source_destroy(&source);
    rlf_set_log(NULL, NULL);
}

TEST_CASE_WITH(bad_color_picture_in_the_middle, make_clip, test_folder_remove)
{
    test_write("c1.png", jpeg_sample, sizeof(jpeg_sample) - 40);
    expect_second_without_color("c1.png", "cut short", "again");
    write_depth("c1.png", 1, 4, 4);
    expect_second_without_color("c1.png", "4 x 4 but camera.json says 16 x 8", "camera.json");
    remove(test_path("c1.png"));
    expect_second_without_color("c1.png", "No such file", "line 2 out of rgb.txt");
}

TEST_CASE_WITH(clip_without_color, make_clip, test_folder_remove)
{
    remove(test_path("rgb.txt"));
    test_write_text("camera.json", "{" DEPTH_JSON "}");
    rlf_source *source = open_clip();
    assert_false(rlf_source_get_info(source)->rig.has_color);
    rlf_frame frame;
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_null(frame.color.data);
    rlf_source_destroy(&source);
}

/* A camera without pictures, or pictures without a camera: no colour, and a warning that says so.
 */
TEST_CASE_WITH(half_of_the_color_is_none, make_clip, test_folder_remove)
{
    test_log log = {0};
    rlf_set_log(test_log_line, &log);
    test_write_text("rgb.txt", "# timestamp filename\n");
    rlf_source *source = open_clip();
    assert_false(rlf_source_get_info(source)->rig.has_color);
    rlf_source_destroy(&source);
    assert_int_equal(log.count, 1);
    assert_non_null(strstr(log.last, "rgb.txt"));
    test_write_text("rgb.txt", "0.0 c0.png\n");
    test_write_text("camera.json", "{" DEPTH_JSON "}");
    source = open_clip();
    assert_false(rlf_source_get_info(source)->rig.has_color);
    rlf_source_destroy(&source);
    rlf_set_log(NULL, NULL);
    assert_int_equal(log.count, 2);
    assert_non_null(strstr(log.last, "camera.json"));
}

TEST_CASE_WITH(sources_that_cannot_be_opened, make_clip, test_folder_remove)
{
    test_write_text("file.xyz", "x");
    const struct {
        const char *source;
        rlf_result result;
        const char *part, *cure;
    } cases[] = {
        {"", RLF_ERROR_INVALID, "empty", "synthetic:room"},
        {"/no/such/place", RLF_ERROR_IO, "no such file or folder", "synthetic:room"},
        {"nosuch:0", RLF_ERROR_UNSUPPORTED, "\"nosuch:\"", "relief list sources"},
        {"zed:", RLF_ERROR_UNSUPPORTED, "\"zed:\"", "relief list sources"},
        {test_path("file.xyz"), RLF_ERROR_UNSUPPORTED, "is a file", "give the folder"},
    };
    for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
        rlf_source *source = NULL;
        test_expect_error(rlf_open_source(cases[i].source, NULL, &source), cases[i].result,
                          cases[i].source, cases[i].part, cases[i].cure);
        assert_null(source);
    }
}

TEST_CASE(nearest_of_times)
{
    const int64_t known[3] = {10, 20, 40};
    const io_times list = {known, sizeof(known[0]), 3}, none = {.count = 0};
    const int64_t times[7] = {0, 10, 14, 15, 16, 30, 45};
    const int32_t nearest[7] = {0, 0, 0, 0, 1, 1, 2};
    for (int i = 0; i < 7; i++) {
        assert_int_equal(io_time_nearest(&list, times[i], 10), nearest[i]);
    }
    assert_int_equal(io_time_nearest(&list, 51, 10), -1);
    assert_int_equal(io_time_nearest(&none, 0, INT64_MAX - 1), -1);
}

typedef struct clip {
    const char *name;
    int frames, width, height;
    int color_width, color_height; /* 0 = no colour */
} clip;

static void check_clip(const clip *c)
{
    char path[TEST_PATH_MAX];
    snprintf(path, sizeof(path), "%s/data/%s", RLF_TEST_SHARED, c->name);
    rlf_source *source = NULL;
    if (rlf_open_source(path, NULL, &source) != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    const rlf_source_info *info = rlf_source_get_info(source);
    assert_int_equal(info->frame_count, c->frames);
    assert_int_equal(info->rig.depth.width, c->width);
    assert_int_equal(info->rig.depth.height, c->height);
    assert_int_equal(info->rig.has_color, c->color_width > 0);
    int64_t last_time = -1;
    int with_color = 0;
    rlf_frame frame;
    for (int i = 0; i < c->frames; i++) {
        if (rlf_source_next(source, &frame) != RLF_OK) {
            fail_msg("%s", rlf_error_text());
        }
        assert_true(frame.time_ns > last_time);
        last_time = frame.time_ns;
        with_color += frame.color.data != NULL ? 1 : 0;
        if (frame.color.data != NULL) {
            assert_int_equal(frame.color.width, c->color_width);
            assert_int_equal(frame.color.height, c->color_height);
        }
        int valid = 0;
        for (int p = 0; p < c->width * c->height; p++) {
            valid += frame.depth_u16[p] > 0 ? 1 : 0;
        }
        assert_true(valid > c->width * c->height / 4);
    }
    assert_int_equal(rlf_source_next(source, &frame), RLF_END);
    assert_int_equal(with_color, c->color_width > 0 ? c->frames : 0);
    rlf_source_destroy(&source);
}

TEST_CASE(real_clips_play_to_their_end)
{
    static const clip clips[] = {{"hands_toys", 360, 320, 240, 320, 240},
                                 {"room_still", 12, 640, 480, 640, 480},
                                 {"kinect2_frame", 1, 512, 424, 0, 0},
                                 {"azure_frame", 1, 640, 576, 1280, 720},
                                 {"tum_fr1_rpy", 120, 640, 480, 640, 480}};
    if (!test_exists(RLF_TEST_SHARED "/data/azure_frame")) {
        print_message("SKIPPED: no real clips in %s/data\n", RLF_TEST_SHARED);
        skip();
    }
    for (size_t i = 0; i < sizeof(clips) / sizeof(clips[0]); i++) {
        check_clip(&clips[i]);
    }
}

TEST_CASE(real_calibration_is_read)
{
    const char *path = RLF_TEST_SHARED "/data/azure_frame/camera.json";
    if (!test_exists(path)) {
        print_message("SKIPPED: no %s\n", path);
        skip();
    }
    rlf_rig rig;
    double units;
    assert_int_equal(rlf_rig_load(path, &rig, &units), RLF_OK);
    assert_int_equal(rig.depth.distortion_model, RLF_DISTORTION_RATIONAL_POLYNOMIAL);
    assert_true(rig.depth.distortion[7] == -0.013910384848713875);
    assert_true(rig.T_color_depth.p.x == -0.032083429396152496);
    /* The rotation is 4.9 degrees about x: its last row, third column is cos. */
    rlf_mat3 rotation = rlf_quat_to_mat3(rig.T_color_depth.q);
    double error = rotation.m[2][2] - 0.9962812066078186;
    assert_true(error * error < 1e-12);
}
