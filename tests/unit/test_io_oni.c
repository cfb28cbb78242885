/* .oni recordings: every value, the packing of depth, damage of all kinds. */
#define _POSIX_C_SOURCE 200809L
#include "io/formats/oni.h"
#include "io_support.h"
#include "oni_sample.h"
#include "relief/io.h"
#include "test.h"

static rlf_source *open_bytes(const oni_bytes *b, const char *keys)
{
    char name[TEST_PATH_MAX + 64];
    test_write("clip.oni", b->data, b->size);
    snprintf(name, sizeof(name), "%s%s", test_path("clip.oni"), keys);
    rlf_source *source = NULL;
    if (rlf_open_source(name, NULL, &source) != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    return source;
}

static void expect_error(const oni_bytes *b, rlf_result wanted, const char *part)
{
    test_write("clip.oni", b->data, b->size);
    rlf_source *source = NULL;
    test_expect_error(rlf_open_source(test_path("clip.oni"), NULL, &source), wanted, "clip.oni",
                      part, NULL);
    assert_null(source);
}

static void check_frame(const rlf_frame *f, int n, bool flips)
{
    for (int p = 0; p < ONI_PIXELS; p++) {
        const int real = flips ? p - p % ONI_W + ONI_W - 1 - p % ONI_W : p;
        assert_int_equal(f->depth_u16[p], oni_sample_depth(n, real));
        for (int c = 0; c < 3 && f->color.data != NULL; c++) {
            /* Only the depth pictures of this file are mirrored. */
            assert_int_equal(f->color.data[4 * p + c], oni_sample_color(n, p, c));
        }
    }
}

static void every_value_is_read(void **state)
{
    (void)state;
    oni_bytes b;
    for (int kind = 0; kind < 4; kind++) {
        const bool is_packed = kind % 2 == 1;
        oni_sample(&b, kind >= 2, is_packed);
        test_log log = {0};
        rlf_set_log(test_log_line, &log);
        rlf_source *source = open_bytes(&b, "");
        rlf_set_log(NULL, NULL);
        assert_int_equal(log.count, is_packed ? 0 : 1); /* not aligned: nothing tells how */
        const rlf_source_info *info = rlf_source_get_info(source);
        assert_int_equal(info->frame_count, ONI_FRAMES);
        assert_true(info->can_seek && !info->is_live);
        assert_true(info->rig.depth.fx > 7.19 && info->rig.depth.fx < 7.21);
        assert_true(info->rig.depth.cx == 3.5 && info->rig.depth.cy == 1.5);
        rlf_frame f;
        for (int n = 0; n < ONI_FRAMES; n++) {
            assert_int_equal(rlf_source_next(source, &f), RLF_OK);
            check_frame(&f, n, is_packed);
            assert_non_null(f.color.data);
            assert_int_equal(f.time_ns, n * ONI_FRAME_US * INT64_C(1000));
            assert_int_equal(f.color_time_ns - f.time_ns, 5000000);
            assert_true(f.depth_units_per_metre == (is_packed ? 1000.0 : 10000.0));
            assert_int_equal(f.flags, is_packed ? RLF_FRAME_UNMIRRORED | RLF_FRAME_ALIGNED : 0);
        }
        assert_int_equal(rlf_source_next(source, &f), RLF_END);
        rlf_source_destroy(&source);
    }
}

static void keys_correct_what_the_file_says(void **state)
{
    (void)state;
    oni_bytes b;
    oni_sample(&b, false, true);
    rlf_source *source = open_bytes(&b, "?mirror=0&aligned=0&color=0");
    rlf_frame f;
    assert_int_equal(rlf_source_next(source, &f), RLF_OK);
    assert_int_equal(f.flags, 0);
    check_frame(&f, 0, false);
    assert_null(f.color.data);
    rlf_source_destroy(&source);
    test_write("clip.oni", b.data, b.size);
    char name[TEST_PATH_MAX + 64];
    snprintf(name, sizeof(name), "%s?aligned=yes", test_path("clip.oni"));
    test_expect_error(rlf_open_source(name, NULL, &source), RLF_ERROR_INVALID, "clip.oni",
                      "aligned=yes", "0 or 1");
}

static void a_calibration_beside_it_wins(void **state)
{
    (void)state;
    oni_bytes b;
    oni_sample(&b, false, true);
    test_write_text("clip.json", "{\"depth\":{\"width\":8,\"height\":4,\"fx\":9,\"fy\":9,\"cx\":4,"
                                 "\"cy\":2,\"units_per_metre\":1000}}");
    rlf_source *source = open_bytes(&b, "");
    assert_true(rlf_source_get_info(source)->rig.depth.fx == 9.0);
    rlf_source_destroy(&source);
    test_write_text("clip.json", "{\"depth\":{\"width\":9,\"height\":4,\"fx\":9,\"fy\":9,\"cx\":4,"
                                 "\"cy\":2,\"units_per_metre\":1000}}");
    expect_error(&b, RLF_ERROR_INVALID, "the calibration is for");
}

static void depth_codes_are_unpacked(void **state)
{
    (void)state;
    /* 300; +1, -1; +6 and none; same twice; by 5 up in a long code; 0x1234; then one and a value.
     */
    const uint8_t data[] = {0x2C, 0x01, 0x57, 0x0D, 0xE1, 0xFF, 0xBB,
                            0xFF, 0x12, 0x34, 0x6F, 0x01, 0x00};
    const uint16_t wanted[] = {300, 301, 300, 306, 306, 306, 311, 0x1234, 0x1234, 0x100};
    uint16_t out[10];
    assert_true(oni_depth_decode(data, sizeof(data), false, out, 10));
    assert_memory_equal(out, wanted, sizeof(wanted));
    for (size_t size = 0; size < sizeof(data); size++) {
        assert_false(oni_depth_decode(data, size, false, out, 10));
    }
    const uint8_t beyond[] = {2, 0, 7, 0, 9, 0, 2, 0}; /* index 2 of a table of 2 */
    assert_false(oni_depth_decode(beyond, sizeof(beyond), true, out, 1));
    const uint8_t cut[] = {0xFF, 0xFF, 7, 0};
    assert_false(oni_depth_decode(cut, sizeof(cut), true, out, 1));
    const uint8_t run[] = {5, 0, 0xEF, 0xEF};
    assert_false(oni_depth_decode(run, sizeof(run), false, out, 10)); /* 60 pixels into 10 */
}

/* What is whole before the cut is read; nothing else happens. */
static void every_prefix_gives_what_is_whole(void **state)
{
    (void)state;
    oni_bytes whole;
    oni_sample(&whole, false, true);
    int64_t most = 0;
    for (size_t size = 0; size < whole.size; size++) {
        oni_bytes b = whole;
        b.size = size;
        test_write("clip.oni", b.data, b.size);
        rlf_source *source = NULL;
        rlf_result result = rlf_open_source(test_path("clip.oni"), NULL, &source);
        if (result != RLF_OK) {
            assert_int_equal(result, RLF_ERROR_FORMAT);
            assert_int_equal(most, 0); /* once there is a picture, there always is */
            continue;
        }
        const int64_t count = rlf_source_get_info(source)->frame_count;
        assert_true(count >= most && count <= ONI_FRAMES);
        most = count;
        rlf_frame f;
        for (int n = 0; n < count; n++) {
            assert_int_equal(rlf_source_next(source, &f), RLF_OK);
            assert_int_equal(f.depth_u16[0], oni_sample_depth(n, ONI_W - 1));
        }
        assert_int_equal(rlf_source_next(source, &f), RLF_END);
        rlf_source_destroy(&source);
    }
    assert_int_equal(most, ONI_FRAMES);
}

static void hostile_headers_are_refused(void **state)
{
    (void)state;
    oni_bytes b;
    oni_begin(&b, false);
    oni_finish(&b);
    expect_error(&b, RLF_ERROR_FORMAT, "no depth");
    b.data[0] = 'X';
    expect_error(&b, RLF_ERROR_FORMAT, "NI10");
    oni_begin(&b, false);
    oni_node_added(&b, 1, 2, ONI_CODEC_NONE);
    oni_mode(&b, 1, 4000000000u, 1);
    oni_data(&b, 1, 5, 1, "ab", 2);
    expect_error(&b, RLF_ERROR_FORMAT, "0 x 1");
    oni_begin(&b, false);
    oni_node_added(&b, 1, 2, ONI_CODEC('1', '2', '3', '4'));
    oni_mode(&b, 1, 1, 1);
    oni_data(&b, 1, 5, 1, "ab", 2);
    expect_error(&b, RLF_ERROR_UNSUPPORTED, "1234");
    oni_begin(&b, false);
    oni_node_added(&b, 1, 2, ONI_CODEC_16Z);
    oni_mode(&b, 1, 16384, 16384);
    oni_data(&b, 1, 5, 1, "abcdefgh", 8);
    expect_error(&b, RLF_ERROR_FORMAT, "16384 x 16384");
    /* A payload that claims 4 GB, and a name that claims as much. */
    oni_sample(&b, false, false);
    const uint32_t huge = 0xFFFFFFFF;
    memcpy(b.data + 24 + 16, &huge, 4);
    expect_error(&b, RLF_ERROR_FORMAT, "no depth");
    oni_sample(&b, false, false);
    memcpy(b.data + 24 + 28, &huge, 4);
    expect_error(&b, RLF_ERROR_FORMAT, "no depth");
}

/* Finds the first packed depth picture and spoils its table. */
static void a_damaged_picture_is_passed_over(void **state)
{
    (void)state;
    oni_bytes b;
    oni_sample(&b, false, true);
    size_t at = 0;
    for (size_t i = 24; i + 8 < b.size && at == 0; i++) {
        const uint8_t head[8] = {'N', 'I', 'R', 0, 10, 0, 0, 0};
        at = memcmp(b.data + i, head, 8) == 0 ? i + 40 : 0;
    }
    assert_true(at > 0);
    b.data[at] = 1;
    rlf_source *source = open_bytes(&b, "");
    rlf_frame f;
    assert_int_equal(rlf_source_next(source, &f), RLF_OK);
    check_frame(&f, 1, true);
    assert_int_equal(rlf_source_get_status(source).damaged, 1);
    rlf_source_destroy(&source);
}

static void time_that_goes_back_is_sorted(void **state)
{
    (void)state;
    oni_bytes b;
    oni_begin(&b, false);
    oni_node_added(&b, 1, 2, ONI_CODEC_NONE);
    oni_mode(&b, 1, 1, 1);
    oni_fov(&b, 1, 1.0, 1.0);
    const char *const pixels[3] = {"b\0", "a\0", "c\0"};
    const uint64_t times[3] = {2000, 1000, 3000};
    for (uint32_t i = 0; i < 3; i++) {
        oni_data(&b, 1, times[i], i + 1, pixels[i], 2);
    }
    oni_finish(&b);
    test_log log = {0};
    rlf_set_log(test_log_line, &log);
    rlf_source *source = open_bytes(&b, "");
    rlf_set_log(NULL, NULL);
    assert_non_null(strstr(log.last, "goes back"));
    rlf_frame f;
    for (int i = 0; i < 3; i++) {
        assert_int_equal(rlf_source_next(source, &f), RLF_OK);
        assert_int_equal(f.depth_u16[0], 'a' + i);
    }
    rlf_source_destroy(&source);
}

int main(void)
{
#define ONI_TEST(f) cmocka_unit_test_setup_teardown(f, test_folder_make, test_folder_remove)
    rlf_set_log(NULL, NULL);
    const struct CMUnitTest tests[] = {
        ONI_TEST(every_value_is_read),
        ONI_TEST(keys_correct_what_the_file_says),
        ONI_TEST(a_calibration_beside_it_wins),
        cmocka_unit_test(depth_codes_are_unpacked),
        ONI_TEST(every_prefix_gives_what_is_whole),
        ONI_TEST(hostile_headers_are_refused),
        ONI_TEST(a_damaged_picture_is_passed_over),
        ONI_TEST(time_that_goes_back_is_sorted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
