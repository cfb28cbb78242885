/* A dump written here, played by Debian's fakenect in place of libfreenect. */
#define _POSIX_C_SOURCE 200809L
#include "direct_source.h"
#include "freenect_test.h"
#include "io_support.h"
#include "relief/io.h"
#include "test.h"

#ifndef RLF_TEST_FAKENECT
#define RLF_TEST_FAKENECT NULL
#endif

#define COUNT 6
#define FRAME_TICKS 2000000u

static uint16_t raw_of(int n, int x, int y)
{
    return (uint16_t)((x + 3 * y + 17 * n) % 2048);
}

static uint8_t color_of(int n, int x, int y, int c)
{
    return (uint8_t)(x + 2 * y + 40 * c + 9 * n);
}

static void write_picture(char *index, char kind, int n, double seconds, uint32_t ticks)
{
    static uint8_t data[640 * 480 * 3 + 64];
    const int pixel_size = kind == 'd' ? 2 : 3;
    char name[64];
    int head = snprintf((char *)data, 64, kind == 'd' ? "P5 640 480 65535\n" : "P6 640 480 255\n");
    for (int i = 0; i < 640 * 480; i++) {
        uint8_t *out = data + head + (ptrdiff_t)i * pixel_size;
        if (kind == 'd') {
            const uint16_t raw = raw_of(n, i % 640, i / 640);
            memcpy(out, &raw, 2);
        } else {
            for (int c = 0; c < 3; c++) {
                out[c] = color_of(n, i % 640, i / 640, c);
            }
        }
    }
    snprintf(name, sizeof(name), "%c-%f-%u.%s", kind, seconds, ticks, kind == 'd' ? "pgm" : "ppm");
    test_write(name, data, (size_t)head + (size_t)640 * 480 * (size_t)pixel_size);
    strcat(strcat(index, name), "\n");
}

/* Six pairs, over the wrap of the device's counter. */
static int write_dump(void **state)
{
    char index[COUNT * 2 * 64] = "";
    int failed = test_folder_make(state);
    for (int n = 0; n < COUNT; n++) {
        const double seconds = 1000.0 + n / 30.0;
        const uint32_t ticks = UINT32_MAX - 3 * FRAME_TICKS + (uint32_t)n * FRAME_TICKS;
        write_picture(index, 'd', n, seconds, ticks);
        write_picture(index, 'r', n, seconds + 0.003, ticks + 180000u);
    }
    test_write_text("INDEX.txt", index);
    char path[TEST_PATH_MAX];
    snprintf(path, sizeof(path), "%s", test_folder);
    return failed + setenv("FAKENECT_PATH", path, 1);
}

static void the_dump_is_what_is_seen(void **state)
{
    (void)state;
    test_log log = {0};
    rlf_set_log(test_log_line, &log);
    rlf_source *source = NULL;
    if (test_open_direct("freenect:", &source) != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    rlf_set_log(NULL, NULL);
    assert_non_null(strstr(log.last, "camera=FILE")); /* it has no factory calibration */
    const rlf_source_info *info = rlf_source_get_info(source);
    assert_true(info->is_live);
    rlf_frame f;
    int64_t first_ns = 0;
    for (int n = 0; n < COUNT; n++) {
        rlf_result result;
        while ((result = rlf_source_next(source, &f)) == RLF_NO_FRAME) {
        }
        assert_int_equal(result, RLF_OK);
        first_ns = n == 0 ? f.time_ns : first_ns;
        assert_true(llabs((long long)(f.time_ns - first_ns - n * INT64_C(100000000) / 3)) <= 1);
        assert_int_equal(f.color_time_ns - f.time_ns, 3000000);
        assert_int_equal(f.sequence, n);
        for (int i = 0; i < 640 * 480; i++) {
            const int x = i % 640;
            const int y = i / 640;
            const int mm = freenect_test_mm(raw_of(n, x, y), 7.5, 120.0, 0.1042);
            assert_int_equal(f.depth_u16[i], mm);
            assert_int_equal(f.color.data[4 * i + 1], color_of(n, x, y, 1));
        }
    }
    const rlf_source_status s = rlf_source_get_status(source);
    assert_int_equal(s.lost, 0);
    assert_int_equal(s.unpaired, 0);
    /* The end of the dump is what an unplugged Kinect is. */
    rlf_result result;
    while ((result = rlf_source_next(source, &f)) == RLF_NO_FRAME) {
    }
    assert_int_equal(result, RLF_ERROR_DEVICE);
    rlf_source_destroy(&source);
}

int main(void)
{
    const char *library = RLF_TEST_FAKENECT;
    if (library == NULL) {
        puts("SKIPPED: fakenect is not installed (apt install libfreenect0.5), or this build is "
             "without RELIEF_WITH_FREENECT");
        return 77;
    }
    setenv("RELIEF_FREENECT_LIBRARY", library, 1);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_dump_is_what_is_seen, write_dump, test_folder_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
