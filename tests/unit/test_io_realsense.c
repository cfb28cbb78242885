/* RealSense cameras, against a stub librealsense2. */
#define _POSIX_C_SOURCE 200809L
#include "io/realsense/realsense.h"
#include "io/source/backends.h"
#include "stub_realsense2.h"
#include "stub_source.h"
#include "test.h"

#include <math.h>

static int set_up(void **state)
{
    (void)state;
    setenv("RELIEF_REALSENSE2_LIBRARY", RLF_TEST_STUB, 1);
    *stub_realsense2_get() = (stub_realsense2){.fault = {.devices = 1},
                                               .color_format = RS2_FORMAT_RGB8,
                                               .has_color = true,
                                               .has_big_modes = true,
                                               .depth_scale = 0.001F,
                                               .baseline_mm = 50.0F};
    return 0;
}

/* Whatever happened, the library got back all that it gave. */
static void close_source(rlf_source *s)
{
    rlf_source_destroy(&s);
    assert_int_equal(stub_realsense2_get()->fault.objects, 0);
}

TEST_CASE(lists_cameras)
{
    stub_realsense2_get()->fault.devices = 2;
    rlf_source_entry entries[1];
    assert_null(io_backend_realsense.unavailable());
    assert_int_equal(io_backend_realsense.list(entries, 1), 2);
    assert_string_equal(entries[0].source, "realsense:0001");
    assert_string_equal(entries[0].description, "Stub RealSense, serial 0001");
    assert_int_equal(stub_realsense2_get()->fault.objects, 0);
}

static void check_rig(const rlf_source_info *info)
{
    const rlf_rig *rig = &info->rig;
    assert_true(info->is_live);
    assert_int_equal(info->frame_count, -1);
    assert_true(info->frames_per_second == 30.0);
    assert_string_equal(info->device, "librealsense2: Stub RealSense 0001");
    assert_int_equal(rig->depth.width, 848);
    assert_int_equal(rig->depth.height, 480);
    assert_true(rig->depth.fx == 424.0 && rig->depth.fy == 424.5);
    assert_true(rig->depth.cx == 425.25 && rig->depth.cy == 237.5);
    assert_int_equal(rig->depth.distortion_model, RLF_DISTORTION_NONE);
    assert_true(rig->has_color);
    assert_int_equal(rig->color.width, 1280);
    assert_int_equal(rig->color.height, 720);
    /* sigma = z^2 0.08 / (f B) */
    assert_true(fabs(rig->noise.c2 - 0.08 / (424.0 * 0.05)) < 1e-9);
    /* A tenth of a radian about z: x goes towards y. */
    const rlf_vec3 p = rlf_transform(&rig->T_color_depth, rlf_vec3_make(1.0, 0.0, 2.0));
    assert_true(fabs(p.x - (cos(0.1) + 0.015)) < 1e-6);
    assert_true(fabs(p.y - (sin(0.1) - 0.002)) < 1e-6);
    assert_true(fabs(p.z - 2.001) < 1e-6);
}

static void check_frame(const rlf_frame *f, uint64_t number)
{
    assert_int_equal(f->sequence, number - 1);
    assert_int_equal(f->time_ns, 1000000000 + (int64_t)(number - 1) * STUB_INTERVAL_US * 1000);
    assert_int_equal(f->color_time_ns, f->time_ns + STUB_COLOR_LATE_US * 1000);
    assert_true(f->host_time_ns > 0);
    assert_true(f->depth_units_per_metre == 1000.0);
    assert_null(f->depth_f32);
    assert_int_equal(f->flags, 0);
    for (int v = 0; v < 480; v += 7) {
        const uint16_t *row = (const void *)((const char *)f->depth_u16 + v * f->depth_stride);
        for (int u = 0; u < 848; u += 5) {
            assert_int_equal(row[u], stub_depth_mm(u, v, number));
        }
    }
    for (int v = 0; v < 720; v += 7) {
        for (int u = 0; u < 1280; u += 5) {
            const uint8_t *p = rlf_rgba8_row(&f->color, v) + (ptrdiff_t)u * 4;
            uint8_t rgb[3];
            stub_color(u, v, number, rgb);
            assert_memory_equal(p, rgb, 3);
            assert_int_equal(p[3], 255);
        }
    }
}

TEST_CASE(streams_depth_and_color)
{
    rlf_source *s = stub_open("realsense:");
    check_rig(rlf_source_get_info(s));
    for (uint64_t n = 1; n <= 4; n++) {
        rlf_frame f = stub_next(s);
        check_frame(&f, n);
    }
    close_source(s);
}

TEST_CASE(reads_modes_and_serial)
{
    stub_realsense2_get()->fault.devices = 3;
    rlf_source *s = stub_open("realsense:?serial=0002&mode=640x480@30&color=640x480");
    assert_int_equal(rlf_source_get_info(s)->rig.depth.width, 640);
    assert_int_equal(rlf_source_get_info(s)->rig.color.width, 640);
    assert_non_null(strstr(rlf_source_get_info(s)->device, "0002"));
    close_source(s);
    s = stub_open("realsense:0003");
    assert_non_null(strstr(rlf_source_get_info(s)->device, "0003"));
    close_source(s);
    stub_refuse("realsense:0009", RLF_ERROR_DEVICE, "0009");
    stub_refuse("realsense:?mode=12x13@30", RLF_ERROR_INVALID, "no such mode");
    stub_refuse("realsense:?mode=640x", RLF_ERROR_INVALID, "WIDTHxHEIGHT@RATE");
    stub_refuse("realsense:?mode=640x480@30x", RLF_ERROR_INVALID, "WIDTHxHEIGHT@RATE");
    stub_refuse("realsense:?color=99999x9", RLF_ERROR_INVALID, "WIDTHxHEIGHT@RATE");
    assert_int_equal(stub_realsense2_get()->fault.objects, 0);
}

/* USB 2, a camera without colour, and other pixel formats. */
TEST_CASE(takes_what_the_camera_has)
{
    stub_realsense2 *stub = stub_realsense2_get();
    stub->has_big_modes = false;
    rlf_source *s = stub_open("realsense:");
    assert_int_equal(rlf_source_get_info(s)->rig.depth.width, 640);
    close_source(s);
    stub->has_color = false;
    s = stub_open("realsense:");
    assert_false(rlf_source_get_info(s)->rig.has_color);
    rlf_frame f = stub_next(s);
    assert_null(f.color.data);
    assert_int_equal(rlf_source_get_status(s).unpaired, 0);
    close_source(s);
    stub_refuse("realsense:?color=640x480", RLF_ERROR_INVALID, "no such mode");
    stub->has_color = true;
    stub->color_format = RS2_FORMAT_BGR8;
    s = stub_open("realsense:");
    f = stub_next(s);
    const uint8_t *p = rlf_rgba8_row(&f.color, 20) + 4 * 30;
    assert_true(p[0] == 30 && p[1] == 20 && p[2] == 16 && p[3] == 255);
    close_source(s);
    stub->color_format = RS2_FORMAT_YUYV;
    s = stub_open("realsense:");
    f = stub_next(s);
    p = rlf_rgba8_row(&f.color, 100) + 4 * 31;
    assert_true(p[0] == 116 && p[1] == 116 && p[2] == 116); /* 100 * 255 / 219 */
    close_source(s);
    stub->color_format = 16; /* RAW10 */
    s = stub_open("realsense:");
    assert_false(rlf_source_get_info(s)->rig.has_color);
    close_source(s);
}

/* Relief's lens puts points where the library does, whatever the model is called. */
TEST_CASE(fits_lens)
{
    stub_realsense2 *stub = stub_realsense2_get();
    (void)state;
    const int models[3] = {RS2_DISTORTION_BROWN_CONRADY, RS2_DISTORTION_INVERSE_BROWN_CONRADY,
                           RS2_DISTORTION_MODIFIED_BROWN_CONRADY};
    const float coeffs[5] = {-0.055F, 0.064F, -0.0006F, 0.0009F, -0.021F};
    for (int i = 0; i < 3; i++) {
        stub->color_model = models[i];
        memcpy(stub->color_coeffs, coeffs, sizeof(coeffs));
        rlf_source *s = stub_open("realsense:");
        const rlf_camera *c = &rlf_source_get_info(s)->rig.color;
        rs2_intrinsics in = {1280,         720,          (float)c->cx, (float)c->cy,
                             (float)c->fx, (float)c->fy, models[i],    {0}};
        memcpy(in.coeffs, coeffs, sizeof(coeffs));
        assert_int_equal(c->distortion_model, RLF_DISTORTION_PLUMB_BOB);
        for (int k = 0; k < 25; k++) {
            const float point[3] = {(float)(k % 5 - 2) * 0.25F, (float)(k / 5 - 2) * 0.15F, 1.0F};
            float wanted[2];
            double u;
            double v;
            rs2_project_point_to_pixel(wanted, &in, point);
            assert_true(rlf_camera_project(
                c, rlf_vec3_make((double)point[0], (double)point[1], 1.0), &u, &v));
            assert_true(hypot(u - (double)wanted[0], v - (double)wanted[1]) < 0.1);
        }
        close_source(s);
    }
}

TEST_CASE(reads_units_and_noise)
{
    stub_realsense2_get()->depth_scale = 0.00025F;
    stub_realsense2_get()->baseline_mm = 0.0F;
    rlf_source *s = stub_open("realsense:");
    rlf_frame f = stub_next(s);
    assert_true(f.depth_units_per_metre == 4000.0);
    assert_true(rlf_source_get_info(s)->rig.noise.c0 > 0.0);
    close_source(s);
}

TEST_CASE(counts_lost_and_doubled)
{
    stub_fault *fault = &stub_realsense2_get()->fault;
    fault->drop_at = 3;
    fault->drop_count = 5;
    fault->double_at = 5;
    fault->no_color_at = 6;
    fault->damage_at = 7;
    rlf_source *s = stub_open("realsense:");
    const uint64_t sequences[3] = {0, 1, 7};
    for (int i = 0; i < 3; i++) {
        assert_int_equal(stub_next(s).sequence, sequences[i]);
    }
    assert_int_equal(stub_next(s).sequence, 8);
    rlf_frame f;
    assert_int_equal(rlf_source_next(s, &f), RLF_NO_FRAME);
    assert_null(stub_next(s).color.data);
    assert_null(stub_next(s).color.data);
    f = stub_next(s);
    assert_non_null(f.color.data);
    assert_int_equal(f.sequence, 11);
    const rlf_source_status status = rlf_source_get_status(s);
    assert_int_equal(status.lost, 5);
    assert_int_equal(status.doubled, 1);
    assert_int_equal(status.unpaired, 1);
    assert_int_equal(status.damaged, 1);
    assert_int_equal(status.given, 7);
    close_source(s);
}

/* The last frame stays whole while nothing new comes. */
TEST_CASE(keeps_frame_in_silence)
{
    stub_realsense2_get()->fault.stall_at = 2;
    stub_realsense2_get()->fault.stall_count = 6;
    rlf_source *s = stub_open("realsense:");
    rlf_frame f = stub_next(s);
    rlf_frame ignored;
    for (int i = 0; i < 6; i++) {
        const int64_t start = rlf_clock_ns();
        assert_int_equal(rlf_source_next(s, &ignored), RLF_NO_FRAME);
        assert_true(rlf_clock_ns() - start > 50000000);
    }
    check_frame(&f, 1);
    f = stub_next(s);
    check_frame(&f, 2);
    close_source(s);
}

TEST_CASE(tells_clock_changes)
{
    stub_realsense2_get()->fault.restart_at = 4;
    stub_realsense2_get()->late_clock_at = 7;
    rlf_source *s = stub_open("realsense:");
    int64_t last = -1;
    for (int i = 1; i <= 9; i++) {
        const rlf_frame f = stub_next(s);
        assert_int_equal(f.sequence, i - 1);
        assert_true(f.time_ns > last && f.time_ns - last < 2000000000);
        assert_int_equal(f.color_time_ns - f.time_ns, STUB_COLOR_LATE_US * 1000);
        assert_int_equal(f.flags, i == 4 || i == 7 ? RLF_FRAME_DISCONTINUITY : 0);
        last = f.time_ns;
    }
    assert_int_equal(rlf_source_get_status(s).lost, 0);
    close_source(s);
}

TEST_CASE(tells_faults)
{
    stub_fault *fault = &stub_realsense2_get()->fault;
    fault->unplug_at = 3;
    rlf_source *s = stub_open("realsense:");
    stub_next(s);
    stub_next(s);
    const int64_t start = rlf_clock_ns();
    assert_int_equal(stub_answer(s, 10), RLF_ERROR_DEVICE);
    assert_true(rlf_clock_ns() - start < 1000000000);
    assert_non_null(strstr(rlf_error_text(), "0001 is gone"));
    close_source(s);
    stub_refuse("realsense:", RLF_ERROR_DEVICE, "no RealSense camera");
    fault->unplug_at = 0;
    fault->hang_at = 1;
    fault->hang_ms = 300;
    s = stub_open("realsense:");
    rlf_frame f;
    assert_int_equal(rlf_source_next(s, &f), RLF_NO_FRAME);
    stub_next(s);
    close_source(s);
    fault->start_fails = true;
    stub_refuse("realsense:", RLF_ERROR_DEVICE, "device is busy");
    fault->devices = 0;
    stub_refuse("realsense:", RLF_ERROR_DEVICE, "no RealSense camera");
    assert_int_equal(fault->objects, 0);
}

TEST_CASE(survives_broken_cameras)
{
    stub_realsense2 *stub = stub_realsense2_get();
    stub->fault.damage_depth_at = 2;
    rlf_source *s = stub_open("realsense:");
    rlf_frame f = stub_next(s);
    rlf_frame ignored;
    assert_int_equal(rlf_source_next(s, &ignored), RLF_NO_FRAME);
    check_frame(&f, 1);
    assert_int_equal(stub_next(s).sequence, 2);
    assert_int_equal(rlf_source_get_status(s).damaged, 1);
    assert_int_equal(rlf_source_get_status(s).lost, 1);
    close_source(s);
    stub->color_coeffs[0] = NAN;
    stub->color_model = RS2_DISTORTION_INVERSE_BROWN_CONRADY;
    s = stub_open("realsense:"); /* a pinhole, and a warning */
    assert_int_equal(rlf_source_get_info(s)->rig.color.distortion_model, RLF_DISTORTION_NONE);
    close_source(s);
    stub->color_model = RS2_DISTORTION_BROWN_CONRADY;
    stub_refuse("realsense:", RLF_ERROR_INVALID, "distortion");
    stub->color_model = RS2_DISTORTION_NONE;
    stub->has_bad_turn = true;
    stub_refuse("realsense:", RLF_ERROR_DEVICE, "no rotation");
    stub->depth_scale = NAN;
    stub->has_bad_turn = false;
    stub_refuse("realsense:", RLF_ERROR_DEVICE, "depth unit");
    stub->has_bad_numbers = true;
    stub_refuse("realsense:", RLF_ERROR_INVALID, "fx");
    assert_int_equal(stub->fault.objects, 0);
}

/* As a program opens it: the plug is pulled after some frames and comes back. */
TEST_CASE(comes_back)
{
    stub_fault *fault = &stub_realsense2_get()->fault;
    fault->is_paced = true;
    fault->unplug_at = 5;
    fault->returns_after = 3;
    const int64_t start = rlf_clock_ns();
    rlf_source *s = NULL;
    assert_int_equal(rlf_open_source("realsense:", NULL, &s), RLF_OK);
    int64_t first = 0;
    int64_t last_time = -1;
    int after = 0;
    while (after < 3 && rlf_clock_ns() - start < INT64_C(20000000000)) {
        rlf_frame f;
        const rlf_result result = rlf_source_next(s, &f);
        assert_true(result == RLF_OK || result == RLF_NO_FRAME);
        if (result == RLF_NO_FRAME) {
            continue;
        }
        first = first == 0 ? rlf_clock_ns() - start : first;
        assert_true(f.time_ns > last_time);
        last_time = f.time_ns;
        after += after > 0 || (f.flags & RLF_FRAME_DISCONTINUITY) != 0;
    }
    print_message("first frame after %.0f ms\n", (double)first / 1e6);
    assert_int_equal(after, 3);
    assert_true(first < INT64_C(1500000000));
    assert_true(rlf_source_get_status(s).is_connected);
    close_source(s);
}

TEST_EACH(set_up, NULL)
