/* Cameras through OpenNI2, served by a driver of our own, and .oni recordings made from it. */
#define _POSIX_C_SOURCE 200809L
#include "direct_source.h"
#include "io/openni2/openni2.h"
#include "io_support.h"
#include "openni2_driver/control.h"
#include "relief/io.h"
#include "test.h"

#include <dlfcn.h>
#include <math.h>
#include <time.h>

#ifndef RLF_TEST_OPENNI2
#define RLF_TEST_OPENNI2 ""
#endif

static openni2_test_control *control;

static void *symbol(const char *file, const char *name)
{
    char path[TEST_PATH_MAX];
    snprintf(path, sizeof(path), "%s/%s", RLF_TEST_OPENNI2, file);
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (library == NULL) {
        print_error("%s\n", dlerror());
    }
    assert_non_null(library);
    void *found = dlsym(library, name);
    assert_non_null(found);
    return found;
}

static rlf_source *open_source(const char *name)
{
    rlf_source *source = NULL;
    if (test_open_direct(name, &source) != RLF_OK) {
        fail_msg("%s: %s", name, rlf_error_text());
    }
    return source;
}

static uint64_t time_of(int n)
{
    return (uint64_t)n * 33333;
}

/* Every pixel of a frame is what the driver made for picture n, not mirrored. */
static void check_frame(const rlf_frame *f, int n, int color_n)
{
    const rlf_rig *rig = f->rig;
    const int unit = f->depth_units_per_metre > 5000.0 ? 10 : 1;
    for (int y = 0; y < rig->depth.height; y++) {
        for (int x = 0; x < rig->depth.width; x++) {
            const int z = f->depth_u16[y * rig->depth.width + x];
            if (z != driver_depth(n, x, y) * unit) {
                fail_msg("frame %d: depth %d at %d,%d, not %d", n, z, x, y,
                         driver_depth(n, x, y) * unit);
            }
        }
    }
    assert_int_equal(f->color.data != NULL, color_n >= 0);
    for (int y = 0; color_n >= 0 && y < rig->color.height; y++) {
        const uint8_t *row = rlf_rgba8_row(&f->color, y);
        for (int x = 0; x < rig->color.width; x++) {
            for (int c = 0; c < 3; c++) {
                if (row[4 * x + c] != driver_color(color_n, x, y, c)) {
                    fail_msg("colour %d at %d,%d is wrong", color_n, x, y);
                }
            }
            assert_int_equal(row[4 * x + 3], 255);
        }
    }
}

static void send(bool is_depth, int n, int delay_us)
{
    assert_true(control->send(is_depth, n, time_of(n) + (uint64_t)delay_us, n + 1));
}

static void next(rlf_source *source, rlf_frame *f)
{
    rlf_result result = rlf_source_next(source, f);
    if (result != RLF_OK) {
        fail_msg("%s: %s", rlf_result_name(result), rlf_error_text());
    }
    f->rig = &rlf_source_get_info(source)->rig;
}

static int reset(void **state)
{
    (void)state;
    control->mirror_is_stuck = false;
    control->cannot_register = false;
    control->has_no_fov = false;
    control->is_registered = true;
    return 0;
}

static int make_folder(void **state)
{
    return reset(state) + test_folder_make(state);
}

static void frames_are_what_the_driver_made(void **state)
{
    (void)state;
    rlf_source *source = open_source("openni2:");
    const rlf_source_info *info = rlf_source_get_info(source);
    assert_true(info->is_live);
    assert_non_null(strstr(info->device, DRIVER_SERIAL));
    assert_int_equal(info->rig.depth.width, 640);
    assert_int_equal(info->rig.color.width, 640);
    assert_true(control->is_registered); /* as no calibration was given */
    assert_true(fabs(info->rig.depth.fx - 575.82) < 0.05);
    assert_true(fabs(info->rig.depth.fy - 575.82) < 0.05);
    assert_true(info->rig.depth.cx == 319.5 && info->rig.depth.cy == 239.5);
    assert_true(info->rig.depth_max_m == 10.0);
    rlf_frame f;
    for (int n = 0; n < 5; n++) {
        send(true, n, 0);
        send(false, n, 4000);
        next(source, &f);
        check_frame(&f, n, n);
        assert_int_equal(f.sequence, n);
        assert_int_equal(f.time_ns, (int64_t)time_of(n) * 1000);
        assert_int_equal(f.color_time_ns, (int64_t)(time_of(n) + 4000) * 1000);
        assert_int_equal(f.flags, RLF_FRAME_ALIGNED);
        assert_true(rlf_clock_ns() - f.host_time_ns < 1000000000);
    }
    assert_int_equal(rlf_source_next(source, &f), RLF_NO_FRAME);
    rlf_source_destroy(&source);
    assert_int_equal(control->open_count, 0);
}

static void keys_choose_mode_and_streams(void **state)
{
    (void)state;
    rlf_source *source = open_source("openni2:" DRIVER_URI "?mode=512x424@30&aligned=0");
    const rlf_source_info *info = rlf_source_get_info(source);
    assert_int_equal(info->rig.depth.width, 512);
    assert_int_equal(info->rig.color.width, 960); /* there is none of 512 x 424 */
    assert_false(control->is_registered);
    rlf_frame f;
    send(false, 3, 0);
    send(true, 3, 0);
    next(source, &f);
    assert_true(f.depth_units_per_metre == 10000.0);
    check_frame(&f, 3, 3);
    assert_int_equal(f.flags, 0);
    rlf_source_destroy(&source);

    source = open_source("openni2:" DRIVER_SERIAL "?color=0&mode=320x240");
    info = rlf_source_get_info(source);
    assert_false(info->rig.has_color);
    assert_true(info->frames_per_second == 60.0);
    assert_false(control->send(false, 0, 0, 1));
    send(true, 7, 0);
    next(source, &f);
    check_frame(&f, 7, -1);
    rlf_source_destroy(&source);
}

static void mirrored_pictures_are_turned_round(void **state)
{
    (void)state;
    control->mirror_is_stuck = true;
    rlf_source *source = open_source("openni2:");
    rlf_frame f;
    send(true, 2, 0);
    send(false, 2, 0);
    next(source, &f);
    check_frame(&f, 2, 2);
    assert_int_equal(f.flags, RLF_FRAME_ALIGNED | RLF_FRAME_UNMIRRORED);
    rlf_source_destroy(&source);
    /* The user may know better than the driver. */
    source = open_source("openni2:?mirror=0");
    send(true, 2, 0);
    send(false, 2, 0);
    next(source, &f);
    assert_int_equal(f.depth_u16[0], driver_depth(2, 639, 0));
    rlf_source_destroy(&source);
}

static void lost_doubled_and_unpaired_are_counted(void **state)
{
    (void)state;
    rlf_source *source = open_source("openni2:");
    rlf_frame f;
    send(true, 0, 0);
    send(false, 0, 0);
    next(source, &f);
    send(true, 3, 0); /* 1 and 2 are lost */
    send(false, 3, 0);
    next(source, &f);
    check_frame(&f, 3, 3);
    assert_int_equal(f.sequence, 3);
    send(true, 3, 0); /* again */
    assert_int_equal(rlf_source_next(source, &f), RLF_NO_FRAME);
    send(true, 4, 0); /* its colour never comes */
    next(source, &f);
    check_frame(&f, 4, -1);
    send(false, 6, 0); /* colour that is too late for 5 */
    send(true, 5, 0);
    next(source, &f);
    check_frame(&f, 5, -1);
    send(true, 6, 0);
    next(source, &f);
    check_frame(&f, 6, 6);
    const rlf_source_status s = rlf_source_get_status(source);
    assert_int_equal(s.given, 5);
    assert_int_equal(s.lost, 2);
    assert_int_equal(s.doubled, 1);
    assert_int_equal(s.unpaired, 2);
    rlf_source_destroy(&source);
}

static void a_clock_that_starts_again_goes_on_here(void **state)
{
    (void)state;
    rlf_source *source = open_source("openni2:?color=0");
    rlf_frame f;
    send(true, 40, 0);
    next(source, &f);
    const int64_t before = f.time_ns;
    send(true, 1, 0);
    next(source, &f);
    assert_true(f.time_ns > before && f.time_ns - before < 40000000);
    assert_int_equal(f.flags, RLF_FRAME_DISCONTINUITY);
    assert_int_equal(f.sequence, 1);
    rlf_source_destroy(&source);
}

static void an_unplugged_camera_is_told_and_can_come_back(void **state)
{
    (void)state;
    rlf_source *source = open_source("openni2:");
    rlf_frame f;
    send(true, 0, 0);
    send(false, 0, 0);
    next(source, &f);
    control->unplug();
    test_expect_error(rlf_source_next(source, &f), RLF_ERROR_DEVICE, "openni2:", "gone", "plug");
    assert_false(rlf_source_get_status(source).is_connected);
    rlf_source *other = NULL;
    test_expect_error(rlf_open_source("openni2:", NULL, &other), RLF_ERROR_DEVICE,
                      "openni2: no such camera", NULL, "cable");
    rlf_source_destroy(&source);
    source = open_source("openni2:");
    send(true, 9, 0);
    send(false, 9, 0);
    next(source, &f);
    check_frame(&f, 9, 9);
    rlf_source_destroy(&source);
}

static void what_cannot_be_had_is_told(void **state)
{
    (void)state;
    const struct {
        const char *source;
        rlf_result result;
        const char *part, *cure;
    } cases[] = {
        {"openni2:1d27/0601@1/9", RLF_ERROR_DEVICE, "no such camera", "relief list sources"},
        {"openni2:?mode=641x480", RLF_ERROR_UNSUPPORTED, "no such depth mode", "leave mode="},
        {"openni2:?mode=big", RLF_ERROR_INVALID, "mode=big", "640x480@30"},
        {"openni2:?color=2", RLF_ERROR_INVALID, "color=2", "0 or 1"},
        {"openni2:?speed=2", RLF_ERROR_INVALID, "speed", "mode color"},
    };
    for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
        rlf_source *source = NULL;
        test_expect_error(test_open_direct(cases[i].source, &source), cases[i].result,
                          cases[i].source, cases[i].part, cases[i].cure);
        assert_null(source);
        assert_int_equal(control->open_count, 0);
    }
    control->cannot_register = true;
    rlf_source *source = NULL;
    test_expect_error(test_open_direct("openni2:?aligned=1", &source), RLF_ERROR_UNSUPPORTED,
                      "openni2:", "cannot align", "camera=FILE");
}

static void a_calibration_of_the_users_wins(void **state)
{
    (void)state;
    test_write_text("c.json", "{\"depth\":{\"width\":320,\"height\":240,\"fx\":300,\"fy\":301,"
                              "\"cx\":150,\"cy\":120,\"units_per_metre\":1000}}");
    char name[TEST_PATH_MAX];
    snprintf(name, sizeof(name), "openni2:?camera=%s", test_path("c.json"));
    rlf_source *source = open_source(name);
    const rlf_source_info *info = rlf_source_get_info(source);
    assert_true(info->rig.depth.fx == 300.0 && info->rig.depth.fy == 301.0);
    assert_int_equal(info->rig.depth.width, 320);
    assert_false(info->rig.has_color);
    assert_false(control->is_registered);
    rlf_source_destroy(&source);
}

static void what_the_camera_does_not_tell_is_warned_of(void **state)
{
    (void)state;
    control->has_no_fov = true;
    test_log log = {0};
    rlf_set_log(test_log_line, &log);
    rlf_source *source = open_source("openni2:?color=0");
    rlf_set_log(NULL, NULL);
    assert_int_equal(log.count, 1);
    assert_non_null(strstr(log.last, "camera=FILE"));
    assert_true(rlf_source_get_info(source)->rig.depth.fx == 576.0);
    rlf_source_destroy(&source);
}

/* As programs see it: the driver sends by itself, the camera goes and comes back. */
static void a_program_sees_it_come_back(void **state)
{
    (void)state;
    setenv("RELIEF_OPENNI2_TEST_RUN", "1", 1);
    rlf_source *source = NULL;
    rlf_frame f = {0};
    int given = 0;
    if (rlf_open_source("openni2:", NULL, &source) != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    const int64_t end_ns = rlf_clock_ns() + INT64_C(30000000000);
    bool is_back = false;
    while (!is_back && rlf_clock_ns() < end_ns) {
        if (rlf_source_next(source, &f) == RLF_OK) {
            given++;
            is_back = given > 10 && (f.flags & RLF_FRAME_DISCONTINUITY) != 0;
        }
        if (given == 10) {
            given++;
            control->unplug();
        }
    }
    assert_true(is_back);
    assert_true(rlf_source_get_status(source).is_connected);
    rlf_source_destroy(&source);
    unsetenv("RELIEF_OPENNI2_TEST_RUN");
}

/* ---- recordings ---- */

static void pause_ms(int ms)
{
    const struct timespec pause = {0, ms * 1000000L};
    nanosleep(&pause, NULL);
}

typedef int (*create_recorder_fn)(const char *name, void **out);
typedef int (*attach_fn)(void *recorder, void *stream, int lossy);
typedef int (*start_fn)(void *recorder);
typedef int (*destroy_fn)(void **recorder);

#define RECORDED 12

/* Records pictures 0 .. 11 but for 5, with OpenNI2's own recorder. */
static void record(const char *path)
{
    const openni2_api *api = NULL;
    assert_int_equal(openni2_begin("test", &api), RLF_OK);
    void *device = NULL;
    void *streams[2] = {NULL, NULL};
    void *recorder = NULL;
    const openni2_mode modes[2] = {{OPENNI2_DEPTH_1_MM, 640, 480, 30},
                                   {OPENNI2_RGB888, 640, 480, 30}};
    create_recorder_fn create = (create_recorder_fn)0;
    attach_fn attach = (attach_fn)0;
    start_fn start = (start_fn)0;
    destroy_fn end = (destroy_fn)0;
    void *found[4] = {symbol("libOpenNI2.so.0", "oniCreateRecorder"),
                      symbol("libOpenNI2.so.0", "oniRecorderAttachStream"),
                      symbol("libOpenNI2.so.0", "oniRecorderStart"),
                      symbol("libOpenNI2.so.0", "oniRecorderDestroy")};
    memcpy(&create, &found[0], sizeof(create));
    memcpy(&attach, &found[1], sizeof(attach));
    memcpy(&start, &found[2], sizeof(start));
    memcpy(&end, &found[3], sizeof(end));
    assert_int_equal(api->device_open(DRIVER_URI, &device), OPENNI2_OK);
    assert_int_equal(create(path, &recorder), OPENNI2_OK);
    for (int i = 0; i < 2; i++) {
        const int type = i == 0 ? OPENNI2_DEPTH : OPENNI2_COLOR;
        assert_int_equal(api->device_stream(device, type, &streams[i]), OPENNI2_OK);
        assert_int_equal(
            api->stream_set(streams[i], OPENNI2_STREAM_MODE, &modes[i], sizeof(modes[i])),
            OPENNI2_OK);
        assert_int_equal(api->stream_start(streams[i]), OPENNI2_OK);
        assert_int_equal(attach(recorder, streams[i], 0), OPENNI2_OK);
    }
    assert_int_equal(start(recorder), OPENNI2_OK);
    pause_ms(300); /* the recorder's thread starts by and by, and says nothing when it has */
    for (int n = 0; n < RECORDED; n++) {
        if (n != 5) {
            send(true, n, 0);
            send(false, n, 0);
        }
    }
    pause_ms(300);
    end(&recorder);
    for (int i = 0; i < 2; i++) {
        api->stream_stop(streams[i]);
        api->stream_destroy(streams[i]);
    }
    api->device_close(device);
    openni2_end();
}

static void a_recording_is_read_back(void **state)
{
    (void)state;
    record(test_path("clip.oni"));
    rlf_source *source = open_source(test_path("clip.oni"));
    const rlf_source_info *info = rlf_source_get_info(source);
    assert_false(info->is_live);
    assert_int_equal(info->frame_count, RECORDED - 1);
    assert_int_equal(info->rig.depth.width, 640);
    assert_true(fabs(info->rig.depth.fx - 575.82) < 0.05);
    rlf_frame f;
    for (int turn = 0; turn < 2; turn++) {
        for (int i = 0; i < RECORDED - 1; i++) {
            const int n = i < 5 ? i : i + 1;
            next(source, &f);
            check_frame(&f, n, n);
            assert_int_equal(f.sequence, n);
            assert_int_equal(f.time_ns, (int64_t)time_of(n) * 1000);
            assert_int_equal(f.flags, RLF_FRAME_UNMIRRORED);
        }
        assert_int_equal(rlf_source_next(source, &f), RLF_END);
        assert_int_equal(rlf_source_next(source, &f), RLF_END);
        assert_int_equal(rlf_source_restart(source), RLF_OK);
    }
    assert_int_equal(rlf_source_seek(source, 8), RLF_OK);
    next(source, &f);
    check_frame(&f, 9, 9);
    assert_int_equal(f.flags, RLF_FRAME_UNMIRRORED | RLF_FRAME_DISCONTINUITY);
    next(source, &f);
    check_frame(&f, 10, 10);
    rlf_source_destroy(&source);
}

int main(void)
{
    const char *place = RLF_TEST_OPENNI2;
    if (place[0] == '\0') {
        puts("SKIPPED: libOpenNI2.so.0 is not installed (apt install libopenni2-0), or this build "
             "is without RELIEF_WITH_OPENNI2");
        return 77;
    }
    setenv("OPENNI2_REDIST", place, 1);
    const openni2_api *api = NULL;
    if (openni2_begin("test", &api) != RLF_OK) {
        puts(rlf_error_text());
        return 1;
    }
    control = symbol("OpenNI2/Drivers/libReliefTest.so.0", "openni2_test_control_block");
    openni2_end();
#define CAMERA_TEST(f) cmocka_unit_test_setup(f, reset)
#define FOLDER_TEST(f) cmocka_unit_test_setup_teardown(f, make_folder, test_folder_remove)
    const struct CMUnitTest tests[] = {
        CAMERA_TEST(frames_are_what_the_driver_made),
        CAMERA_TEST(keys_choose_mode_and_streams),
        CAMERA_TEST(mirrored_pictures_are_turned_round),
        CAMERA_TEST(lost_doubled_and_unpaired_are_counted),
        CAMERA_TEST(a_clock_that_starts_again_goes_on_here),
        CAMERA_TEST(an_unplugged_camera_is_told_and_can_come_back),
        CAMERA_TEST(what_cannot_be_had_is_told),
        FOLDER_TEST(a_calibration_of_the_users_wins),
        CAMERA_TEST(what_the_camera_does_not_tell_is_warned_of),
        CAMERA_TEST(a_program_sees_it_come_back),
        FOLDER_TEST(a_recording_is_read_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
