/* The Kinect v2 as a source, against a stub of the shim of libfreenect2. */
#define _POSIX_C_SOURCE 200809L
#include "io/source/backends.h"
#include "kinect2_sample.h"
#include "stub_freenect2.h"
#include "stub_source.h"
#include "test.h"

#include <math.h>

static int set_up(void **state)
{
    (void)state;
    setenv("RELIEF_FREENECT2_LIBRARY", RLF_TEST_STUB, 1);
    *stub_freenect2_get() = (stub_freenect2){.fault = {.devices = 1}};
    return 0;
}

static void close_source(rlf_source *s)
{
    rlf_source_destroy(&s);
    assert_int_equal(stub_freenect2_get()->fault.objects, 0);
}

TEST_CASE(lists_cameras)
{
    stub_freenect2_get()->fault.devices = 2;
    rlf_source_entry entries[1];
    assert_null(io_backend_freenect2.unavailable());
    assert_int_equal(io_backend_freenect2.list(entries, 1), 2);
    assert_string_equal(entries[0].source, "freenect2:00");
    assert_string_equal(entries[0].description, "Kinect v2, serial 00");
}

static void check_depth(const rlf_frame *f, uint64_t number)
{
    for (int v = 0; v < 424; v += 3) {
        const float *row = (const void *)((const char *)f->depth_f32 + v * f->depth_stride);
        for (int u = 0; u < 512; u++) {
            const uint16_t mm = stub_depth_mm(u, v, number);
            const bool is_missing = !(row[u] > 0.0F) || isinf(row[u]);
            assert_int_equal(is_missing, mm == 0);
            assert_true(mm == 0 || row[u] == ((float)mm + 0.25F) / 1000.0F);
        }
    }
}

static void check_color(const rlf_frame *f, uint64_t number)
{
    for (int v = 0; v < 1080; v += 11) {
        for (int u = 0; u < 1920; u += 7) {
            const uint8_t *p = rlf_rgba8_row(&f->color, v) + (ptrdiff_t)u * 4;
            uint8_t rgb[3];
            stub_color(u, v, number, rgb);
            assert_memory_equal(p, rgb, 3);
            assert_int_equal(p[3], 255);
        }
    }
}

TEST_CASE(streams_unmirrored)
{
    for (int is_rgbx = 0; is_rgbx < 2; is_rgbx++) {
        stub_freenect2_get()->is_rgbx = is_rgbx != 0;
        stub_freenect2_get()->first_time = UINT32_MAX - STUB_K2_TICKS; /* wraps after one picture */
        rlf_source *s = stub_open("freenect2:");
        const rlf_source_info *info = rlf_source_get_info(s);
        assert_true(info->is_live && info->frames_per_second == 30.0);
        assert_int_equal(info->rig.depth.width, 512);
        assert_int_equal(info->rig.color.width, 1920);
        int64_t last = 0;
        for (uint64_t n = 1; n <= 4; n++) {
            const rlf_frame f = stub_next(s);
            assert_int_equal(f.sequence, n - 1);
            assert_int_equal(f.flags, RLF_FRAME_UNMIRRORED);
            assert_null(f.depth_u16);
            assert_true(n == 1 || f.time_ns - last == STUB_K2_TICKS * INT64_C(125000));
            assert_int_equal(f.color_time_ns - f.time_ns, STUB_K2_COLOR_LATE_TICKS * 125000);
            last = f.time_ns;
            check_depth(&f, n);
            check_color(&f, n);
        }
        close_source(s);
    }
}

/* align=factory: the pictures of libfreenect2's Registration, mirrored back. */
TEST_CASE(gives_the_factory_s_registration)
{
    rlf_source *s = stub_open("freenect2:?align=factory");
    const rlf_source_info *info = rlf_source_get_info(s);
    assert_int_equal(info->rig.color.width, 512);
    assert_int_equal(info->rig.depth.distortion_model, RLF_DISTORTION_NONE);
    const rlf_frame f = stub_next(s);
    assert_int_equal(f.flags, RLF_FRAME_UNMIRRORED | RLF_FRAME_ALIGNED);
    for (int v = 0; v < 424; v++) {
        for (int u = 0; u < 512; u++) {
            const uint8_t *p = rlf_rgba8_row(&f.color, v) + (ptrdiff_t)u * 4;
            const int x = 1919 - (STUB_K2_ALIGNED_X + 3 * (511 - u));
            assert_int_equal(p[0], x & 255);
            assert_int_equal(p[1], (STUB_K2_ALIGNED_Y + 2 * v) & 255);
        }
    }
    close_source(s);
    stub_refuse("freenect2:?align=yes", RLF_ERROR_INVALID, "none or factory");
}

TEST_CASE(counts_what_is_missing)
{
    stub_fault *fault = &stub_freenect2_get()->fault;
    fault->drop_at = 3;
    fault->drop_count = 4;
    fault->double_at = 4;
    fault->no_color_at = 5;
    fault->damage_at = 6;
    fault->restart_at = 7;
    rlf_source *s = stub_open("freenect2:");
    stub_next(s);
    stub_next(s);
    assert_int_equal(stub_next(s).sequence, 6);
    rlf_frame f;
    assert_int_equal(rlf_source_next(s, &f), RLF_NO_FRAME);
    assert_null(stub_next(s).color.data);
    f = stub_next(s);
    assert_null(f.color.data);
    const int64_t last = f.time_ns;
    f = stub_next(s);
    assert_true(f.time_ns > last && (f.flags & RLF_FRAME_DISCONTINUITY) != 0);
    check_depth(&f, 1);
    const rlf_source_status status = rlf_source_get_status(s);
    assert_int_equal(status.lost, 4);
    assert_int_equal(status.doubled, 1);
    assert_int_equal(status.unpaired, 2);
    close_source(s);
    fault->no_color_at = 1;
    s = stub_open("freenect2:?align=factory");
    assert_int_equal(rlf_source_next(s, &f), RLF_NO_FRAME);
    stub_next(s);
    close_source(s);
}

TEST_CASE(tells_faults)
{
    stub_fault *fault = &stub_freenect2_get()->fault;
    fault->unplug_at = 2;
    rlf_source *s = stub_open("freenect2:");
    stub_next(s);
    assert_int_equal(stub_answer(s, 1), RLF_ERROR_DEVICE);
    close_source(s);
    fault->unplug_at = 0;
    fault->stall_at = 2;
    fault->stall_count = 100;
    s = stub_open("freenect2:");
    stub_next(s);
    assert_int_equal(stub_answer(s, 10), RLF_NO_FRAME);
    assert_int_equal(stub_answer(s, 30), RLF_ERROR_DEVICE);
    assert_non_null(strstr(rlf_error_text(), "plug it in again"));
    close_source(s);
    stub_refuse("freenect2:9", RLF_ERROR_DEVICE, "no Kinect v2");
    fault->open_fails = true;
    stub_refuse("freenect2:", RLF_ERROR_DEVICE, "cannot be opened");
    fault->open_fails = false;
    stub_freenect2_get()->has_bad_numbers = true;
    stub_refuse("freenect2:", RLF_ERROR_INVALID, "calibration");
    assert_int_equal(fault->objects, 0);
}

TEST_EACH(set_up, NULL)
