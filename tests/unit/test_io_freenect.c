/* Kinect v1 with its factory calibration, through a stand-in for libfreenect. */
#define _POSIX_C_SOURCE 200809L
#include "direct_source.h"
#include "freenect_stub.h"
#include "freenect_test.h"
#include "io_support.h"
#include "relief/io.h"
#include "test.h"

#include <dlfcn.h>

#ifndef RLF_TEST_FREENECT_STUB
#define RLF_TEST_FREENECT_STUB NULL
#endif

#define FRAME_TICKS 2000000u /* a 30th of a second at 60 MHz */

static freenect_stub_control *control;

static int reset(void **state)
{
    (void)state;
    memset(control, 0, sizeof(*control));
    return 0;
}

static rlf_source *open_source(const char *name)
{
    rlf_source *source = NULL;
    if (test_open_direct(name, &source) != RLF_OK) {
        fail_msg("%s: %s", name, rlf_error_text());
    }
    return source;
}

static void play(const freenect_stub_event *events, int count)
{
    control->events = events;
    control->count = count;
    control->next = 0;
}

static void the_factory_calibration_is_used(void **state)
{
    (void)state;
    rlf_source *source = open_source("freenect:" STUB_SERIAL);
    const rlf_rig *rig = &rlf_source_get_info(source)->rig;
    assert_int_equal(control->depth_format, FREENECT_RAW_11);
    assert_int_equal(control->subdevices, FREENECT_CAMERA);
    const double f = 120.0 / (2.0 * (double)STUB_PIXEL_MM);
    assert_true(fabs(rig->depth.fx - f) < 1e-9 && fabs(rig->depth.fy - f) < 1e-9);
    /* Rows are whole numbers in the tables: some hundredths of a pixel are left. */
    assert_true(fabs(rig->color.fx - STUB_FX) < 0.4 && fabs(rig->color.fy - STUB_FY) < 0.4);
    assert_true(fabs(rig->color.cx - STUB_CX) < 0.1 && fabs(rig->color.cy - STUB_CY) < 0.1);
    assert_true(fabs(rig->T_color_depth.p.x + STUB_COLOR_CM / 100.0) < 0.0002);
    assert_true(fabs(2.0 * rig->T_color_depth.q.z - STUB_SIN) < 0.0005);
    assert_true(fabs(rig->color.distortion[0] - STUB_K1) < 0.005);
    /* A far point lands where the tables put it. */
    const rlf_vec3 p = rlf_vec3_make(200.0, -100.0, 1000.0);
    double u = 0.0;
    double v = 0.0;
    assert_true(rlf_camera_project(&rig->color, rlf_transform(&rig->T_color_depth, p), &u, &v));
    const double bend = 1.0 + STUB_K1 * (0.2 * 0.2 + 0.1 * 0.1);
    const double x = 0.2 * bend;
    const double y = -0.1 * bend;
    assert_true(fabs(u - (STUB_FX * (STUB_COS * x - STUB_SIN * y) + STUB_CX)) < 0.2);
    assert_true(fabs(v - (STUB_FY * (STUB_SIN * x + STUB_COS * y) + STUB_CY)) < 0.2);
    rlf_source_destroy(&source);
}

static void every_count_becomes_its_depth(void **state)
{
    (void)state;
    const freenect_stub_event events[2] = {{true, 3, 100}, {false, 3, 200}};
    play(events, 2);
    rlf_source *source = open_source("freenect:");
    rlf_frame f;
    assert_int_equal(rlf_source_next(source, &f), RLF_OK);
    for (int y = 0; y < 480; y++) {
        for (int x = 0; x < 640; x++) {
            const int mm = freenect_test_mm(stub_raw(3, x, y), 7.5, 120.0, (double)STUB_PIXEL_MM);
            assert_int_equal(f.depth_u16[y * 640 + x], mm);
        }
    }
    assert_int_equal(rlf_rgba8_row(&f.color, 10)[4 * 7 + 2], (uint8_t)((10 * 640 + 7) * 3 + 2 + 3));
    rlf_source_destroy(&source);
}

static void time_goes_on_when_the_counter_wraps(void **state)
{
    (void)state;
    const uint32_t start = UINT32_MAX - 3 * FRAME_TICKS;
    freenect_stub_event events[16];
    for (uint32_t i = 0; i < 8; i++) {
        events[2 * i] = (freenect_stub_event){false, (int)i, start + i * FRAME_TICKS + 300000u};
        events[2 * i + 1] = (freenect_stub_event){true, (int)i, start + i * FRAME_TICKS};
    }
    play(events, 16);
    rlf_source *source = open_source("freenect:0");
    rlf_frame f;
    int64_t last = 0;
    for (int i = 0; i < 8; i++) {
        assert_int_equal(rlf_source_next(source, &f), RLF_OK);
        assert_int_equal(f.sequence, i);
        assert_int_equal(f.flags, 0);
        assert_int_equal(f.color_time_ns - f.time_ns, 5000000);
        assert_true(i == 0 || llabs((long long)(f.time_ns - last - 33333333)) <= 1);
        last = f.time_ns;
    }
    const rlf_source_status s = rlf_source_get_status(source);
    assert_int_equal(s.lost, 0);
    assert_int_equal(s.unpaired, 0);
    rlf_source_destroy(&source);
}

static void lost_pictures_are_counted(void **state)
{
    (void)state;
    const freenect_stub_event events[6] = {{true, 0, 0},
                                           {false, 0, 500},
                                           {true, 3, 3 * FRAME_TICKS},
                                           {false, 3, 3 * FRAME_TICKS + 500},
                                           {true, 4, 4 * FRAME_TICKS},
                                           {true, 5, 5 * FRAME_TICKS}};
    play(events, 6);
    rlf_source *source = open_source("freenect:");
    rlf_frame f;
    const uint64_t sequence[4] = {0, 3, 4, 5};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(rlf_source_next(source, &f), RLF_OK);
        assert_int_equal(f.sequence, sequence[i]);
        assert_int_equal(f.color.data != NULL, i < 2);
    }
    assert_int_equal(rlf_source_next(source, &f), RLF_NO_FRAME);
    const rlf_source_status s = rlf_source_get_status(source);
    assert_int_equal(s.lost, 2);
    assert_int_equal(s.unpaired, 2);
    rlf_source_destroy(&source);
}

static void keys_are_obeyed(void **state)
{
    (void)state;
    const freenect_stub_event events[1] = {{true, 1, 0}};
    play(events, 1);
    rlf_source *source = open_source("freenect:?aligned=1&color=0&mirror=1");
    const rlf_source_info *info = rlf_source_get_info(source);
    assert_int_equal(control->depth_format, FREENECT_REGISTERED);
    assert_false(control->has_video);
    assert_false(info->rig.has_color);
    assert_true(info->rig.T_color_depth.p.x == 0.0);
    rlf_frame f;
    assert_int_equal(rlf_source_next(source, &f), RLF_OK);
    assert_int_equal(f.flags, RLF_FRAME_ALIGNED | RLF_FRAME_UNMIRRORED);
    assert_int_equal(f.depth_u16[0], stub_raw(1, 639, 0)); /* millimetres already */
    rlf_source_destroy(&source);
}

static void an_unplugged_kinect_is_told(void **state)
{
    (void)state;
    const freenect_stub_event events[2] = {{true, 0, 0}, {false, 0, 0}};
    play(events, 2);
    rlf_source *source = open_source("freenect:");
    rlf_frame f;
    assert_int_equal(rlf_source_next(source, &f), RLF_OK);
    control->is_unplugged = true;
    test_expect_error(rlf_source_next(source, &f), RLF_ERROR_DEVICE, "freenect:", "gone", "power");
    assert_false(rlf_source_get_status(source).is_connected);
    rlf_source_destroy(&source);
}

static void what_does_not_open_is_told(void **state)
{
    (void)state;
    rlf_source *source = NULL;
    test_expect_error(test_open_direct("freenect:XYZ", &source), RLF_ERROR_DEVICE, "freenect:XYZ",
                      "cannot be opened", "serial number");
    test_expect_error(test_open_direct("freenect:?mirror=yes", &source), RLF_ERROR_INVALID,
                      "freenect:", "mirror=yes", "0 or 1");
    control->does_not_start = true;
    test_expect_error(test_open_direct("freenect:", &source), RLF_ERROR_DEVICE,
                      "freenect:", "does not start", "USB");
    control->is_absent = true;
    test_expect_error(test_open_direct("freenect:", &source), RLF_ERROR_DEVICE,
                      "freenect:", "no Kinect", "cable");
    assert_null(source);
}

int main(void)
{
    const char *path = RLF_TEST_FREENECT_STUB;
    if (path == NULL) {
        puts("SKIPPED: this build is without RELIEF_WITH_FREENECT");
        return 77;
    }
    setenv("RELIEF_FREENECT_LIBRARY", path, 1);
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    void *found = library != NULL ? dlsym(library, "freenect_stub_get") : NULL;
    if (found == NULL) {
        printf("%s: is not the stand-in for libfreenect\n", path);
        return 1;
    }
    freenect_stub_control *(*get)(void);
    memcpy(&get, &found, sizeof(get));
    control = get();
#define KINECT_TEST(f) cmocka_unit_test_setup(f, reset)
    const struct CMUnitTest tests[] = {
        KINECT_TEST(the_factory_calibration_is_used),
        KINECT_TEST(every_count_becomes_its_depth),
        KINECT_TEST(time_goes_on_when_the_counter_wraps),
        KINECT_TEST(lost_pictures_are_counted),
        KINECT_TEST(keys_are_obeyed),
        KINECT_TEST(an_unplugged_kinect_is_told),
        KINECT_TEST(what_does_not_open_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
