/* Azure Kinect and Femto cameras, against a stub libk4a. */
#define _POSIX_C_SOURCE 200809L
#include "io/k4a/k4a.h"
#include "io/source/backends.h"
#include "io_support.h"
#include "stub_k4a.h"
#include "stub_source.h"
#include "test.h"

#include <math.h>

static int set_up(void **state)
{
    (void)state;
    setenv("RELIEF_K4A_LIBRARY", RLF_TEST_STUB, 1);
    *stub_k4a_get() = (stub_k4a){.fault = {.devices = 1}, .lens_type = K4A_LENS_BROWN_CONRADY};
    return 0;
}

static void close_source(rlf_source *s)
{
    rlf_source_destroy(&s);
    assert_int_equal(stub_k4a_get()->fault.objects, 0);
}

TEST_CASE(lists_cameras)
{
    stub_fault *fault = &stub_k4a_get()->fault;
    fault->devices = 2;
    rlf_source_entry entries[2];
    assert_null(io_backend_k4a.unavailable());
    assert_int_equal(io_backend_k4a.list(entries, 2), 2);
    assert_string_equal(entries[1].source, "k4a:000121");
    assert_string_equal(entries[1].description, "Azure Kinect or Femto, serial 000121");
    fault->open_fails = true;
    assert_int_equal(io_backend_k4a.list(entries, 1), 2);
    assert_non_null(strstr(entries[0].description, "in use"));
    assert_int_equal(fault->objects, 0);
}

/* The layout of k4a_calibration_t in k4atypes.h 1.4.1: two cameras of 32 words, sixteen transforms
 * of 12, two modes. */
TEST_CASE(has_the_library_s_layout)
{
    assert_int_equal(sizeof(k4a_lens), 60);
    assert_int_equal(sizeof(k4a_camera), 4 * (12 + 2 + 15 + 3));
    assert_int_equal(sizeof(k4a_calibration), 2 * sizeof(k4a_camera) + 16 * 48 + 8);
    assert_int_equal(offsetof(k4a_configuration, depth_delay_off_color_usec), 20);
    assert_int_equal(sizeof(k4a_configuration), 36);
}

static void check_rig(const rlf_source_info *info)
{
    const rlf_rig *rig = &info->rig;
    const double distortion[8] = {0.5,   -2.5, (double)0.00025F, (double)-0.000125F, 1.5, 0.375,
                                  -2.25, 1.375};
    assert_true(info->is_live);
    assert_true(info->frames_per_second == 30.0);
    assert_string_equal(info->device, "k4a: serial 000120");
    assert_int_equal(rig->depth.width, 640);
    assert_int_equal(rig->depth.height, 576);
    assert_true(rig->depth.cx == 323.0 && rig->depth.cy == 284.0);
    assert_true(rig->depth.fx == 512.0 && rig->depth.fy == 512.25);
    assert_int_equal(rig->depth.distortion_model, RLF_DISTORTION_RATIONAL_POLYNOMIAL);
    for (int i = 0; i < 8; i++) {
        assert_true(rig->depth.distortion[i] == distortion[i]);
        assert_true(rig->color.distortion[i] == distortion[i]);
    }
    assert_int_equal(rig->color.width, 1280);
    assert_true(rig->color.fx == 640.0 && rig->color.cx == 643.0);
    /* A tenth of a radian about x: z goes to -y; millimetres. */
    const rlf_vec3 p = rlf_transform(&rig->T_color_depth, rlf_vec3_make(0.0, 0.0, 1.0));
    assert_true(fabs(p.x + 0.032) < 1e-6);
    assert_true(fabs(p.y - (-sin(0.1) - 0.002)) < 1e-6);
    assert_true(fabs(p.z - (cos(0.1) + 0.004)) < 1e-6);
}

static void check_frame(const rlf_frame *f, uint64_t number)
{
    assert_int_equal(f->sequence, number - 1);
    assert_int_equal(f->time_ns, 1000000000 + (int64_t)(number - 1) * STUB_INTERVAL_US * 1000);
    assert_int_equal(f->color_time_ns, f->time_ns + STUB_COLOR_LATE_US * 1000);
    assert_true(f->host_time_ns > 0 && f->depth_units_per_metre == 1000.0);
    for (int v = 0; v < 576; v += 7) {
        const uint16_t *row = (const void *)((const char *)f->depth_u16 + v * f->depth_stride);
        for (int u = 0; u < 640; u += 5) {
            assert_int_equal(row[u], stub_depth_mm(u, v, number));
        }
    }
    for (int v = 8; v < 720; v += 64) {
        for (int u = 8; u < 1280; u += 64) {
            const uint8_t *p = rlf_rgba8_row(&f->color, v) + (ptrdiff_t)u * 4;
            uint8_t rgb[3];
            stub_color(u / 16, v / 16, number, rgb);
            for (int c = 0; c < 3; c++) {
                assert_true(abs(p[c] - rgb[c]) <= 3); /* JPEG */
            }
            assert_int_equal(p[3], 255);
        }
    }
}

TEST_CASE(streams_depth_and_color)
{
    rlf_source *s = stub_open("k4a:");
    check_rig(rlf_source_get_info(s));
    const int wanted[5] = {K4A_FORMAT_COLOR_MJPG, K4A_COLOR_RESOLUTION_720P,
                           K4A_DEPTH_MODE_NFOV_UNBINNED, K4A_FPS_30, 0};
    assert_memory_equal(stub_k4a_get()->configuration, wanted, sizeof(wanted));
    for (uint64_t n = 1; n <= 3; n++) {
        rlf_frame f = stub_next(s);
        check_frame(&f, n);
    }
    stub_k4a_get()->gives_raw = true;
    rlf_frame f = stub_next(s);
    check_frame(&f, 4);
    close_source(s);
}

TEST_CASE(reads_modes)
{
    stub_k4a_get()->fault.devices = 2;
    rlf_source *s = stub_open("k4a:000121?mode=512x512@15&color=2048x1536");
    const int wanted[5] = {K4A_FORMAT_COLOR_MJPG, K4A_COLOR_RESOLUTION_1536P,
                           K4A_DEPTH_MODE_WFOV_2X2BINNED, K4A_FPS_15, 0};
    assert_memory_equal(stub_k4a_get()->configuration, wanted, sizeof(wanted));
    assert_int_equal(rlf_source_get_info(s)->rig.depth.width, 512);
    assert_true(rlf_source_get_info(s)->rig.depth_min_m == 0.25);
    assert_true(rlf_source_get_info(s)->frames_per_second == 15.0);
    close_source(s);
    s = stub_open("k4a:?mode=1024x1024");
    assert_true(rlf_source_get_info(s)->frames_per_second == 15.0);
    close_source(s);
    stub_refuse("k4a:?mode=640x480", RLF_ERROR_INVALID, "640x576");
    stub_refuse("k4a:?color=640x480", RLF_ERROR_INVALID, "1280x720");
    stub_refuse("k4a:?mode=1024x1024@30", RLF_ERROR_INVALID, "at most 15");
    stub_refuse("k4a:?mode=640x576@20", RLF_ERROR_INVALID, "5, 15 or 30");
    stub_refuse("k4a:?mode=640x576@30&color=1280x720@15", RLF_ERROR_INVALID, "one rate");
    stub_refuse("k4a:?rate=3", RLF_ERROR_INVALID, "serial mode color");
    assert_int_equal(stub_k4a_get()->fault.objects, 0);
}

TEST_CASE(counts_what_is_missing)
{
    stub_fault *fault = &stub_k4a_get()->fault;
    fault->drop_at = 3;
    fault->drop_count = 2;
    fault->double_at = 4;
    fault->no_color_at = 5;
    fault->damage_at = 6;
    fault->restart_at = 7;
    rlf_source *s = stub_open("k4a:");
    assert_int_equal(stub_next(s).sequence, 0);
    assert_int_equal(stub_next(s).sequence, 1);
    assert_int_equal(stub_next(s).sequence, 4);
    rlf_frame f;
    assert_int_equal(rlf_source_next(s, &f), RLF_NO_FRAME);
    assert_null(stub_next(s).color.data);
    f = stub_next(s);
    assert_null(f.color.data);
    const int64_t last = f.time_ns;
    f = stub_next(s);
    assert_int_equal(f.flags, RLF_FRAME_DISCONTINUITY);
    assert_true(f.time_ns > last);
    assert_int_equal(f.sequence, 7);
    const rlf_source_status status = rlf_source_get_status(s);
    assert_int_equal(status.lost, 2);
    assert_int_equal(status.doubled, 1);
    assert_int_equal(status.unpaired, 1);
    assert_int_equal(status.damaged, 1);
    close_source(s);
}

TEST_CASE(tells_faults)
{
    stub_fault *fault = &stub_k4a_get()->fault;
    fault->stall_at = 2;
    fault->stall_count = 2;
    fault->unplug_at = 5;
    rlf_source *s = stub_open("k4a:");
    rlf_frame f = stub_next(s);
    rlf_frame ignored;
    assert_int_equal(rlf_source_next(s, &ignored), RLF_NO_FRAME);
    assert_int_equal(rlf_source_next(s, &ignored), RLF_NO_FRAME);
    check_frame(&f, 1);
    stub_next(s);
    assert_int_equal(rlf_source_next(s, &ignored), RLF_ERROR_DEVICE);
    assert_non_null(strstr(rlf_error_text(), "000120 is gone"));
    close_source(s);
    fault->unplug_at = 0;
    fault->damage_depth_at = 1;
    s = stub_open("k4a:");
    assert_int_equal(rlf_source_next(s, &ignored), RLF_NO_FRAME);
    assert_int_equal(rlf_source_get_status(s).damaged, 1);
    close_source(s);
    fault->start_fails = true;
    stub_refuse("k4a:", RLF_ERROR_DEVICE, "does not start");
    fault->open_fails = true;
    stub_refuse("k4a:", RLF_ERROR_DEVICE, "close other programs");
    fault->open_fails = false;
    stub_refuse("k4a:7", RLF_ERROR_DEVICE, "serial number 7");
    stub_k4a_get()->lens_type = K4A_LENS_RATIONAL_6KT;
    stub_refuse("k4a:", RLF_ERROR_DEVICE, "type 3");
    assert_int_equal(fault->objects, 0);
}

static const char *const camera_json =
    "{\"depth\": {\"width\": %d, \"height\": 576, \"fx\": 500, \"fy\": 500, \"cx\": 320, \"cy\": "
    "288, \"units_per_metre\": 1000}, \"color\": {\"width\": 1280, \"height\": 720, \"fx\": 600, "
    "\"fy\": 600, \"cx\": 640, \"cy\": 360}}";

TEST_CASE(takes_the_user_s_calibration)
{
    char text[512];
    char source[TEST_PATH_MAX + 32];
    test_folder_make(NULL);
    snprintf(text, sizeof(text), camera_json, 640);
    test_write_text("camera.json", text);
    snprintf(source, sizeof(source), "k4a:?camera=%s", test_path("camera.json"));
    rlf_source *s = stub_open(source);
    assert_true(rlf_source_get_info(s)->rig.depth.fx == 500.0);
    assert_int_equal(rlf_source_get_info(s)->rig.depth.distortion_model, RLF_DISTORTION_NONE);
    close_source(s);
    snprintf(text, sizeof(text), camera_json, 320);
    test_write_text("camera.json", text);
    stub_refuse(source, RLF_ERROR_INVALID, "320 x 576, the camera's 640 x 576");
    test_folder_remove(NULL);
}

TEST_EACH(set_up, NULL)
