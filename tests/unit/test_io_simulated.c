/* The simulated camera, and the times and counts of cameras. */
#define _POSIX_C_SOURCE 200809L
#include "io/live/live.h"
#include "io_support.h"
#include "live_watch.h"
#include "relief/io.h"
#include "test.h"

#define W 16
#define H 8
#define FRAMES 600

/* A clip of twenty seconds that is cheap to play: all its frames are one file. */
static int set_up(void **state)
{
    static char list[FRAMES * 32];
    uint16_t pixels[W * H];
    size_t end = 0;
    log_start();
    for (int i = 0; i < FRAMES; i++) {
        end += (size_t)snprintf(list + end, sizeof(list) - end, "%.6f d.png\n", i / 30.0);
    }
    for (int i = 0; i < W * H; i++) {
        pixels[i] = 1500;
    }
    if (test_folder_make(state) != 0) {
        return -1;
    }
    test_write_text("camera.json", "{\"depth\":{\"width\":16,\"height\":8,\"fx\":15,\"fy\":15,"
                                   "\"cx\":7.5,\"cy\":3.5,\"units_per_metre\":1000}}");
    test_write_text("depth.txt", list);
    return rlf_png_write_u16(test_path("d.png"), pixels, W, H);
}

/* ---- times and numbers ---------------------------------------------------------------------- */

static rlf_frame follow(live_follow *f, uint64_t sequence, int64_t time_ns, int64_t host_ns,
                        uint64_t lost)
{
    rlf_frame frame = {.sequence = sequence, .time_ns = time_ns, .color_time_ns = time_ns + 3 * MS};
    uint64_t out_lost;
    assert_true(live_follow_frame(f, host_ns, &frame, &out_lost));
    assert_int_equal(out_lost, lost);
    assert_int_equal(frame.color_time_ns, frame.time_ns + 3 * MS);
    return frame;
}

TEST_CASE(clocks_and_counters_that_start_anew_go_on)
{
    live_follow f = {.has_last = false};
    uint64_t lost;
    assert_int_equal(follow(&f, 10, 5 * SECOND, 100 * SECOND, 0).time_ns, 5 * SECOND);
    rlf_frame frame = follow(&f, 13, 5 * SECOND + 100 * MS, 100 * SECOND + 90 * MS, 2);
    assert_int_equal(frame.sequence, 13);
    assert_int_equal(frame.time_ns, 5 * SECOND + 100 * MS); /* the device's own step */
    rlf_frame twice = {.sequence = 13, .time_ns = 5 * SECOND + 100 * MS};
    assert_false(live_follow_frame(&f, 100 * SECOND + 95 * MS, &twice, &lost));
    /* A clock of 32 bits that wraps, and a counter of 16. */
    frame = follow(&f, 0, 20 * MS, 100 * SECOND + 123 * MS, 0);
    assert_int_equal(frame.sequence, 14);
    assert_int_equal(frame.time_ns, 5 * SECOND + 133 * MS);
    frame = follow(&f, 1, 53 * MS, 100 * SECOND + 160 * MS, 0);
    assert_int_equal(frame.time_ns, 5 * SECOND + 166 * MS);
    /* A clock that is set, and a counter that is no counter. */
    frame = follow(&f, UINT64_MAX, INT64_MAX - 9 * SECOND, 100 * SECOND + 193 * MS, 0);
    assert_int_equal(frame.sequence, 16);
    assert_int_equal(frame.time_ns, 5 * SECOND + 199 * MS);
    frame = follow(&f, 1000000, INT64_MIN, 100 * SECOND + 226 * MS, 0);
    assert_int_equal(frame.sequence, 17);
    assert_int_equal(frame.time_ns, 5 * SECOND + 232 * MS);
    /* Opened again: the same number and time are another frame. */
    live_follow_reconnect(&f);
    frame = follow(&f, 1000000, INT64_MIN, 109 * SECOND + 226 * MS, 0);
    assert_int_equal(frame.sequence, 18);
    assert_int_equal(frame.time_ns, 14 * SECOND + 232 * MS);
}

/* ---- the simulated camera ------------------------------------------------------------------- */

static rlf_source *open_simulated(const char *name, const char *faults)
{
    char text[256];
    rlf_source *source = NULL;
    (void)snprintf(text, sizeof(text), "simulated:%s?of=%s&%s", name, test_folder, faults);
    assert_int_equal(rlf_open_source(text, NULL, &source), RLF_OK);
    return source;
}

TEST_CASE(the_simulated_camera_drops_doubles_and_jumps)
{
    rlf_source *source = open_simulated("a", "drop=7&doubled=5&jitter=10&time_back=1");
    const int64_t start_ns = rlf_clock_ns();
    int64_t time_ns = INT64_MIN;
    for (int i = 0; i < 50; i++) {
        const rlf_frame frame = next_frame(source);
        assert_true(frame.time_ns > time_ns);
        time_ns = frame.time_ns;
    }
    assert_true(rlf_clock_ns() - start_ns > SECOND); /* in real time */
    const rlf_source_status s = rlf_source_get_status(source);
    assert_in_range(s.lost, 6, 30);
    assert_in_range(s.doubled, 7, 40);
    rlf_source_destroy(&source);
}

TEST_CASE(the_simulated_camera_is_pulled_out_and_put_back)
{
    const int64_t start_ns = rlf_clock_ns();
    rlf_source *source = open_simulated("b", "unplug_after=1&replug_after=1.2");
    assert_true(await_line(source, "was pulled out", start_ns) > SECOND);
    rlf_frame frame = next_frame(source);
    while ((frame.flags & RLF_FRAME_DISCONTINUITY) == 0) {
        frame = next_frame(source);
    }
    assert_true(rlf_clock_ns() - start_ns > 2 * SECOND);
    await_count("frames are back", 1);
    rlf_source_destroy(&source);
}

TEST_CASE(the_simulated_camera_stalls)
{
    const int64_t start_ns = rlf_clock_ns();
    rlf_source *source = open_simulated("c", "stall=1.5@1");
    assert_true(await_line(source, "no frame for 1 s", start_ns) > 18 * SECOND / 10);
    (void)next_frame(source);
    await_count("frames are back", 1);
    rlf_source_destroy(&source);
}

TEST_CASE(wrong_faults_are_told)
{
    const char *const wrong[] = {
        "simulated:?drop=1",     "simulated:?stall=2",   "simulated:?stall=2@",
        "simulated:?hang=soon",  "simulated:?jitter=-1", "simulated:?of=simulated:",
        "simulated:?of=nowhere", "simulated:?smell=1",   "simulated:gone?unplug_after=0"};
    for (size_t i = 0; i < sizeof(wrong) / sizeof(wrong[0]); i++) {
        rlf_source *source = NULL;
        assert_true(rlf_open_source(wrong[i], NULL, &source) < 0);
        assert_null(source);
    }
    assert_non_null(strstr(rlf_error_text(), "not plugged in"));
}

TEST_EACH(set_up, test_folder_remove)
