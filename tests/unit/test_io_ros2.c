/* ROS 2 between two processes: what is sent comes back bit by bit; hosts that die and return. */
#define _POSIX_C_SOURCE 200809L
#include "test.h"

#include "io/source/backends.h"
#include "ros2_host.h"

#define MS INT64_C(1000000)

/* The host is forked before this process has threads. */
static pid_t host;

static int start(void **state)
{
    (void)state;
    host = host_start("ros2:/camera");
    return host > 0 ? 0 : -1;
}

static int stop(void **state)
{
    (void)state;
    host_kill(host);
    return 0;
}

static rlf_result open_direct(const char *source, int32_t key_count, const char *const keys[],
                              const char *const values[], rlf_opened *out)
{
    rlf_address address = {.source = source, .place = "/camera", .key_count = key_count};
    for (int32_t i = 0; i < key_count; i++) {
        address.keys[i] = keys[i];
        address.values[i] = values[i];
    }
    memset(out, 0, sizeof(*out));
    return io_backend_ros2.open(&address, out);
}

static void check_camera(const rlf_camera *a, const rlf_camera *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_true(a->fx == b->fx && a->fy == b->fy && a->cx == b->cx && a->cy == b->cy);
    assert_int_equal(a->distortion_model, b->distortion_model);
    assert_memory_equal(a->distortion, b->distortion, sizeof(a->distortion));
}

static void check_rig(const rlf_rig *rig)
{
    const rlf_rig sent = host_rig();
    check_camera(&rig->depth, &sent.depth);
    check_camera(&rig->color, &sent.color);
    assert_true(rig->has_color);
    assert_memory_equal(&rig->T_color_depth, &sent.T_color_depth, sizeof(rlf_pose));
}

/* Returns the frame's number. */
static uint32_t check_frame(const rlf_frame *f)
{
    const uint32_t number = (uint32_t)f->depth_u16[0] - 1;
    for (int32_t y = 0; y < HOST_H; y++) {
        const uint16_t *row = (const uint16_t *)(const void *)((const char *)f->depth_u16 +
                                                               (ptrdiff_t)y * f->depth_stride);
        for (int32_t x = 0; x < HOST_W; x++) {
            assert_int_equal(row[x], host_depth(number, x, y));
        }
    }
    assert_true(f->depth_units_per_metre == 1000.0);
    assert_non_null(f->color.data);
    for (int32_t y = 0; y < HOST_CH; y++) {
        for (int32_t x = 0; x < HOST_CW; x++) {
            for (int32_t k = 0; k < 3; k++) {
                assert_int_equal(f->color.data[(ptrdiff_t)y * f->color.stride + 4 * x + k],
                                 host_color(number, x, y, k));
            }
        }
    }
    assert_true(f->color_time_ns == f->time_ns);
    return number;
}

static void check_stream(rlf_opened *o, int32_t count)
{
    rlf_frame frame;
    uint32_t first = 0;
    int64_t first_ns = 0;
    int32_t got = 0;
    const int64_t end_ns = rlf_clock_ns() + 20000 * MS;
    while (got < count) {
        assert_true(rlf_clock_ns() < end_ns);
        memset(&frame, 0, sizeof(frame));
        const rlf_result result = o->methods.next(o->self, &frame);
        assert_true(result == RLF_OK || result == RLF_NO_FRAME);
        if (result != RLF_OK) {
            continue;
        }
        const uint32_t number = check_frame(&frame);
        first = got == 0 ? number : first;
        first_ns = got == 0 ? frame.time_ns : first_ns;
        assert_int_equal(number, first + (uint32_t)got);
        /* Stamps keep the camera's steps to the nanosecond. */
        assert_int_equal(frame.time_ns - first_ns, got * HOST_STEP_NS);
        got++;
    }
    rlf_source_status status = {0};
    o->methods.status(o->self, &status);
    assert_int_equal(status.lost + status.unpaired + status.damaged + status.doubled, 0);
}

static void test_comes_back_as_it_was(void **state)
{
    (void)state;
    rlf_opened o;
    for (int i = 0; i < 10 && open_direct("ros2:/camera", 0, NULL, NULL, &o) != RLF_OK; i++) {
    }
    check_rig(&o.info.rig);
    assert_true(o.info.is_live);
    assert_true(o.info.frames_per_second > 29.9 && o.info.frames_per_second < 30.1);
    check_stream(&o, 30);
    o.methods.destroy(o.self);
}

static void test_packed_comes_back_as_it_was(void **state)
{
    static const char *const keys[] = {"depth", "color"};
    static const char *const values[] = {"/camera/depth/image_raw/compressedDepth",
                                         "/camera/color/image_raw/compressed"};
    (void)state;
    rlf_opened o;
    assert_int_equal(open_direct("ros2:/camera", 2, keys, values, &o), RLF_OK);
    check_rig(&o.info.rig);
    check_stream(&o, 15);
    o.methods.destroy(o.self);
}

static void test_is_listed_at_once(void **state)
{
    (void)state;
    rlf_source_entry entries[4];
    int32_t count = 0;
    int64_t best_ns = INT64_MAX;
    /* The host may not be there yet, and a machine that is busy be late once. */
    for (int i = 0; i < 20 && (count != 1 || best_ns > 200 * MS); i++) {
        const int64_t begin_ns = rlf_clock_ns();
        count = io_backend_ros2.list(entries, 4);
        const int64_t took_ns = rlf_clock_ns() - begin_ns;
        best_ns = count == 1 && took_ns < best_ns ? took_ns : best_ns;
    }
    assert_int_equal(count, 1);
    assert_string_equal(entries[0].source, "ros2:/camera");
    assert_true(best_ns <= 200 * MS);
}

static rlf_result next_frame(rlf_source *source, int32_t wait_ms, rlf_frame *out)
{
    const int64_t end_ns = rlf_clock_ns() + wait_ms * MS;
    rlf_result result = RLF_NO_FRAME;
    while (result == RLF_NO_FRAME && rlf_clock_ns() < end_ns) {
        result = rlf_source_next(source, out);
    }
    return result;
}

static void test_a_killed_host_returns(void **state)
{
    (void)state;
    rlf_source *source = NULL;
    rlf_frame frame;
    assert_int_equal(rlf_open_source("ros2:/camera", NULL, &source), RLF_OK);
    assert_int_equal(next_frame(source, 2000, &frame), RLF_OK);
    host_kill(host);
    const int64_t until_ns = rlf_clock_ns() + 1200 * MS;
    while (rlf_clock_ns() < until_ns) {
        const rlf_result result = rlf_source_next(source, &frame);
        assert_true(result == RLF_OK || result == RLF_NO_FRAME);
    }
    assert_false(rlf_source_get_status(source).is_connected);
    host = host_start("ros2:/camera");
    assert_true(host > 0);
    const int64_t begin_ns = rlf_clock_ns();
    assert_int_equal(next_frame(source, 10000, &frame), RLF_OK);
    const int64_t took_ns = rlf_clock_ns() - begin_ns;
    assert_true((frame.flags & RLF_FRAME_DISCONTINUITY) != 0);
    (void)check_frame(&frame);
    printf("resumed after %.0f ms\n", 1e-6 * (double)took_ns);
    /* A second where nothing else runs; this allows for a busy machine. */
    assert_true(took_ns < 3000 * MS);
    rlf_source_destroy(&source);
}

static void test_nobody_there_is_one_line(void **state)
{
    (void)state;
    rlf_source *source = NULL;
    assert_int_equal(rlf_open_source("ros2:/nobody", NULL, &source), RLF_ERROR_DEVICE);
    assert_non_null(strstr(rlf_error_text(), "/camera/depth/image_raw"));
    assert_int_equal(rlf_open_source("ros2:/camera?profile=wan", NULL, &source), RLF_ERROR_INVALID);
    assert_int_equal(rlf_open_source("ros2:/camera?domain=233", NULL, &source), RLF_ERROR_INVALID);
}

/* "host": a camera for another program until it is killed; "peer": reads another program's. */
int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "host") == 0) {
        host_run("ros2:/camera");
    }
    if (argc > 1 && strcmp(argv[1], "peer") == 0) {
        const struct CMUnitTest peer[] = {cmocka_unit_test(test_comes_back_as_it_was)};
        return cmocka_run_group_tests(peer, NULL, NULL);
    }
    host_choose_domain();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_is_listed_at_once),
        cmocka_unit_test(test_comes_back_as_it_was),
        cmocka_unit_test(test_packed_comes_back_as_it_was),
        cmocka_unit_test(test_nobody_there_is_one_line),
        cmocka_unit_test(test_a_killed_host_returns),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
