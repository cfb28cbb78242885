/* .klg and .sens: values, poses, times, damage. */
#define _POSIX_C_SOURCE 200809L
#include "io_support.h"
#include "log_sample.h"
#include "relief/io.h"
#include "test.h"

static const char klg_rig[] =
    "{\"depth\": {\"width\": 16, \"height\": 8, \"fx\": 10, \"fy\": 10, \"cx\": 8, \"cy\": 4, "
    "\"units_per_metre\": 1000}, \"color\": {\"width\": 16, \"height\": 8, \"fx\": 10, \"fy\": 10, "
    "\"cx\": 8, \"cy\": 4}}";

static rlf_source *open_file(const char *name)
{
    rlf_source *source = NULL;
    if (rlf_open_source(name, NULL, &source) != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    return source;
}

static void save(const char *name, byte_file *b)
{
    test_write(name, b->data, b->size);
    free(b);
}

static rlf_frame expect_frame(rlf_source *source, int i)
{
    rlf_frame frame;
    if (rlf_source_next(source, &frame) != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    assert_int_equal(frame.time_ns, 40000000 * (int64_t)i);
    for (int p = 0; p < LOG_SAMPLE_PIXELS; p++) {
        assert_int_equal(frame.depth_u16[p], 1000 + 100 * i + p);
    }
    assert_true(frame.depth_units_per_metre == 1000.0);
    assert_non_null(frame.color.data);
    assert_true(frame.color.data[0] >= 200 && frame.color.data[2] < 50);
    return frame;
}

static void expect_all(rlf_source *source)
{
    assert_int_equal(rlf_source_get_info(source)->frame_count, LOG_SAMPLE_FRAMES);
    rlf_frame frame;
    for (int i = 0; i < LOG_SAMPLE_FRAMES; i++) {
        expect_frame(source, i);
    }
    assert_int_equal(rlf_source_next(source, &frame), RLF_END);
    assert_int_equal(rlf_source_seek(source, 2), RLF_OK);
    expect_frame(source, 2);
    rlf_source_destroy(&source);
}

TEST_CASE(klg_is_read)
{
    test_write_text("camera.json", klg_rig);
    save("clip.klg", klg_sample_make(LOG_SAMPLE_FRAMES));
    expect_all(open_file(test_path("clip.klg")));
    /* The count is written last. */
    rlf_set_log(NULL, NULL);
    save("clip.klg", klg_sample_make(0));
    expect_all(open_file(test_path("clip.klg")));
    char name[TEST_PATH_MAX];
    snprintf(name, sizeof(name), "klg:%s?order=bgr", test_path("clip.klg"));
    rlf_source *source = open_file(name);
    rlf_frame frame;
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_true(frame.color.data[0] < 50 && frame.color.data[2] > 200);
    rlf_source_destroy(&source);
    snprintf(name, sizeof(name), "klg:%s?order=abc", test_path("clip.klg"));
    test_expect_error(rlf_open_source(name, NULL, &source), RLF_ERROR_INVALID, "clip.klg",
                      "order=abc", "bgr");
}

TEST_CASE(klg_without_a_calibration_warns)
{
    test_log log = {0};
    rlf_set_log(test_log_line, &log);
    save("clip.klg", klg_sample_make(LOG_SAMPLE_FRAMES));
    rlf_source *source = open_file(test_path("clip.klg"));
    const rlf_camera *depth = &rlf_source_get_info(source)->rig.depth;
    assert_int_equal(depth->width, 640);
    assert_true(depth->fx == 528.0 && depth->cx == 320.0 && depth->cy == 240.0);
    assert_non_null(strstr(log.last, "528"));
    assert_non_null(strstr(log.last, "camera=FILE"));
    /* Its pictures are smaller than that. */
    rlf_frame frame;
    assert_int_equal(rlf_source_next(source, &frame), RLF_ERROR_FORMAT);
    assert_int_equal(rlf_source_get_status(source).damaged, LOG_SAMPLE_FRAMES);
    rlf_source_destroy(&source);
    rlf_set_log(NULL, NULL);
}

TEST_CASE(sens_is_read)
{
    for (uint32_t packing = 0; packing < 2; packing++) {
        save("clip.sens", sens_sample_make(packing, LOG_SAMPLE_FRAMES));
        rlf_source *source = open_file(test_path("clip.sens"));
        const rlf_rig *rig = &rlf_source_get_info(source)->rig;
        assert_true(rig->depth.fx == 10.0 && rig->depth.fy == 11.0 && rig->depth.cx == 8.0);
        assert_true(rig->color.fx == 20.0 && rig->color.cy == 3.5);
        assert_true(fabs(rig->T_color_depth.p.x - 0.02) < 1e-6);
        for (int i = 0; i < LOG_SAMPLE_FRAMES; i++) {
            const rlf_frame frame = expect_frame(source, i);
            assert_int_equal(frame.has_pose, i != 2);
            if (frame.has_pose) {
                assert_true(fabs(frame.T_world_camera.p.x - i / 10.0) < 1e-6);
                assert_true(frame.T_world_camera.q.w == 1.0);
            }
        }
        rlf_source_destroy(&source);
    }
    rlf_source *source = NULL;
    save("clip.sens", sens_sample_make(2, LOG_SAMPLE_FRAMES));
    test_expect_error(rlf_open_source(test_path("clip.sens"), NULL, &source), RLF_ERROR_UNSUPPORTED,
                      "clip.sens", "packed in a way (2)", "ScanNet's tools");
}

static void check_prefixes(const char *name, const byte_file *b)
{
    rlf_set_log(NULL, NULL);
    int most = 0;
    for (size_t size = 0; size <= b->size; size++) {
        test_write(name, b->data, size);
        rlf_source *source = NULL;
        if (rlf_open_source(test_path(name), NULL, &source) != RLF_OK) {
            assert_null(strchr(rlf_error_text(), '\n'));
            continue;
        }
        rlf_frame frame;
        int count = 0;
        while (rlf_source_next(source, &frame) == RLF_OK) {
            assert_int_equal(frame.depth_u16[5], 1005 + 100 * count);
            count++;
        }
        assert_true(count >= most);
        most = count;
        rlf_source_destroy(&source);
    }
    assert_int_equal(most, LOG_SAMPLE_FRAMES);
}

TEST_CASE(every_prefix_gives_whole_frames)
{
    test_write_text("camera.json", klg_rig);
    byte_file *b = klg_sample_make(LOG_SAMPLE_FRAMES);
    check_prefixes("clip.klg", b);
    free(b);
    b = sens_sample_make(1, LOG_SAMPLE_FRAMES);
    check_prefixes("clip.sens", b);
    free(b);
}

/* Counts and sizes that no file holds cost no memory; what is whole is read. */
TEST_CASE(headers_that_lie_are_survived)
{
    test_log log = {0};
    rlf_set_log(test_log_line, &log);
    test_write_text("camera.json", klg_rig);
    save("clip.klg", klg_sample_make(INT32_MAX));
    expect_all(open_file(test_path("clip.klg")));
    assert_non_null(strstr(log.last, "4 of them are whole"));
    save("clip.sens", sens_sample_make(1, UINT64_MAX));
    expect_all(open_file(test_path("clip.sens")));
    byte_file *b = klg_sample_make(LOG_SAMPLE_FRAMES);
    memset(b->data + 12, 0xFF, 4); /* size of the first depth picture */
    save("clip.klg", b);
    rlf_source *source = NULL;
    test_expect_error(rlf_open_source(test_path("clip.klg"), NULL, &source), RLF_ERROR_FORMAT,
                      "clip.klg", "no depth pictures", NULL);
    test_write_text("clip.sens", "\5\0\0\0 not ours");
    test_expect_error(rlf_open_source(test_path("clip.sens"), NULL, &source), RLF_ERROR_FORMAT,
                      "clip.sens", "version 4", "right file");
    rlf_set_log(NULL, NULL);
}

/* A few bytes that unpack to a gigabyte write no more than one picture. */
TEST_CASE(packed_depth_of_another_size_is_refused)
{
    rlf_set_log(NULL, NULL);
    test_write_text("camera.json", klg_rig);
    byte_file *b = calloc(1, sizeof(*b));
    const size_t bomb_size = 4u << 20;
    uint8_t *zeros = calloc(1, bomb_size);
    uint8_t packed[8192];
    uLongf size = sizeof(packed);
    assert_int_equal(compress(packed, &size, zeros, bomb_size), Z_OK);
    free(zeros);
    bytes_u32(b, 1);
    bytes_u64(b, 0);
    bytes_u32(b, (uint32_t)size);
    bytes_u32(b, 0);
    bytes_put(b, packed, size);
    save("clip.klg", b);
    rlf_source *source = open_file(test_path("clip.klg"));
    rlf_frame frame;
    assert_int_equal(rlf_source_next(source, &frame), RLF_ERROR_FORMAT);
    assert_int_equal(rlf_source_get_status(source).damaged, 1);
    assert_non_null(strstr(rlf_error_text(), "another size than 256 bytes"));
    rlf_source_destroy(&source);
}

/* Times in nanoseconds are told by their distance; those that go back are sorted. */
TEST_CASE(times_are_made_sense_of)
{
    test_log log = {0};
    rlf_set_log(test_log_line, &log);
    test_write_text("camera.json", klg_rig);
    const int64_t ticks[3][4] = {
        {5000000000, 5040000000, 5080000000, 5120000000}, {1000, 1040, 1080, 1120}, {7, 7, 7, 7}};
    const int64_t wanted[3] = {40000000, 40000000, 33333333};
    for (int k = 0; k < 3; k++) {
        byte_file *b = calloc(1, sizeof(*b));
        bytes_u32(b, 4);
        for (int i = 0; i < 4; i++) {
            uint8_t depth[1024];
            const uint32_t size = log_sample_depth(i, true, depth, sizeof(depth));
            bytes_u64(b, (uint64_t)ticks[k][i]);
            bytes_u32(b, size);
            bytes_u32(b, 0);
            bytes_put(b, depth, size);
        }
        save("clip.klg", b);
        log.last[0] = '\0';
        rlf_source *source = open_file(test_path("clip.klg"));
        rlf_frame frame;
        for (int i = 0; i < 2; i++) {
            assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
            assert_int_equal(frame.time_ns, i * wanted[k]);
            assert_null(frame.color.data);
        }
        rlf_source_destroy(&source);
    }
    assert_non_null(strstr(log.last, "30 frames per second"));
    rlf_set_log(NULL, NULL);
}

TEST_EACH(test_folder_make, test_folder_remove)
