/* A live source: newest frame first, counts, unplugging, stalls, drivers that do not return. */
#define _POSIX_C_SOURCE 200809L
#include "io/live/live.h"
#include "io/source/backends.h"
#include "live_watch.h"
#include "test.h"

#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

/* ---- a camera of 4 x 2 pixels --------------------------------------------------------------- */

typedef enum behaviour {
    GIVES,     /* frames */
    IS_SILENT, /* RLF_NO_FRAME at once */
    FAILS,     /* RLF_ERROR_DEVICE, also to open */
    HANGS      /* does not return until told to */
} behaviour;

static struct camera {
    _Atomic int next, open, close; /* behaviour */
    _Atomic int period_ms;
    _Atomic int calls, opened, closed;
    _Atomic uint64_t sequence;
    _Atomic int64_t time_ns, failed_ns;
    _Atomic uint64_t skip; /* numbers that the next frame leaves out */
    _Atomic bool repeats;  /* the next frame has the last one's number and time */
    _Atomic int width;
    _Atomic int color_width; /* 0 = as it was opened */
    uint16_t depth[2][8];    /* rows are longer than the picture */
    uint8_t color[16];
} camera;

static void hang(_Atomic int *state)
{
    while (atomic_load(state) == HANGS) {
        sleep_ms(10);
    }
}

static rlf_result camera_next(void *self, rlf_frame *out)
{
    (void)self;
    camera.calls++;
    hang(&camera.next);
    switch (atomic_load(&camera.next)) {
    case IS_SILENT: return RLF_NO_FRAME;
    case FAILS:
        atomic_store(&camera.failed_ns, rlf_clock_ns());
        return rlf_fail(RLF_ERROR_DEVICE, "no such device");
    default: break;
    }
    sleep_ms(camera.period_ms);
    if (!atomic_exchange(&camera.repeats, false)) {
        camera.sequence += 1 + atomic_exchange(&camera.skip, 0);
        camera.time_ns += camera.period_ms * MS;
    }
    for (int i = 0; i < 8; i++) {
        camera.depth[0][i] = camera.depth[1][i] = (uint16_t)camera.sequence;
    }
    memset(camera.color, (int)camera.sequence, sizeof(camera.color));
    out->sequence = camera.sequence;
    out->time_ns = camera.time_ns;
    out->depth_u16 = camera.depth[0];
    out->depth_stride = sizeof(camera.depth[0]);
    out->depth_units_per_metre = 1000;
    out->color =
        (rlf_image_rgba8){camera.color, camera.color_width > 0 ? camera.color_width : 2, 2, 8};
    return RLF_OK;
}

static void camera_close(void *self)
{
    (void)self;
    hang(&camera.close);
    camera.closed++;
}

static rlf_result camera_open(const rlf_address *address, rlf_opened *out)
{
    hang(&camera.open);
    if (camera.open == FAILS || strcmp(rlf_address_get(address, "serial"), "7") != 0) {
        return rlf_fail(RLF_ERROR_DEVICE, "%s: there is no camera %s", address->source,
                        address->place);
    }
    memset(out, 0, sizeof(*out));
    out->info.rig.depth =
        (rlf_camera){.width = camera.width, .height = 2, .fx = 4, .fy = 4, .cx = 1.5, .cy = 0.5};
    out->info.rig.color = (rlf_camera){.width = 2, .height = 2, .fx = 2, .fy = 2};
    out->info.rig.has_color = true;
    (void)snprintf(out->info.name, sizeof(out->info.name), "%s", address->source);
    out->methods = (rlf_source_methods){.next = camera_next, .destroy = camera_close};
    camera.opened++;
    return RLF_OK;
}

static const rlf_backend backend = {.version = RLF_BACKEND_VERSION,
                                    .scheme = "test",
                                    .keys = "serial",
                                    .is_live = true,
                                    .open = camera_open};

static int set_up(void **state)
{
    (void)state;
    memset(&camera, 0, sizeof(camera));
    camera.period_ms = 5;
    camera.width = 4;
    log_start();
    return 0;
}

/* The address is gone when the call has returned. */
static rlf_result open_camera(rlf_source **out)
{
    char source[32] = "test:here?serial=7", place[8] = "here", key[8] = "serial", value[4] = "7";
    rlf_address address = {.source = source, .place = place, .key_count = 1};
    address.keys[0] = key;
    address.values[0] = value;
    rlf_opened opened;
    const rlf_result result = io_live_open(&backend, &address, &opened);
    memset(source, '?', sizeof(source) - 1);
    memset(value, '?', sizeof(value) - 1);
    return result == RLF_OK ? io_source_create(&opened, out) : result;
}

static rlf_source *open_good(void)
{
    rlf_source *source = NULL;
    assert_int_equal(open_camera(&source), RLF_OK);
    return source;
}

/* ---- frames --------------------------------------------------------------------------------- */

TEST_CASE(the_newest_frame_wins_and_stays_as_it_is)
{
    rlf_source *source = open_good();
    assert_true(rlf_source_get_info(source)->is_live);
    uint64_t last = 0;
    for (int i = 0; i < 5; i++) {
        const int64_t asked_ns = rlf_clock_ns();
        const rlf_frame frame = next_frame(source);
        assert_true(frame.sequence > last);
        assert_true(frame.host_time_ns > asked_ns - 2 * SECOND);
        assert_true(frame.host_time_ns <= rlf_clock_ns());
        assert_int_equal(frame.depth_stride, 8);
        last = frame.sequence;
        sleep_ms(60); /* the camera goes on; this frame must not change */
        for (int k = 0; k < 8; k++) {
            assert_int_equal(frame.depth_u16[k], (uint16_t)last);
        }
        assert_int_equal(frame.color.data[15], (uint8_t)last);
    }
    const rlf_source_status s = rlf_source_get_status(source);
    assert_true(s.late >= 5);
    assert_int_equal(s.given, 5);
    assert_int_equal(s.lost, 0);
    assert_true(s.is_connected && s.silence_s < 0.9);
    assert_true(last <= s.given + s.late + 1);
    rlf_source_destroy(&source);
    assert_int_equal(camera.closed, 1);
}

/* Colour that changes its size is told as what it is, and the camera goes on when it is back. */
TEST_CASE(colour_of_another_size_is_told)
{
    int64_t told_ns = 0;
    rlf_frame frame;
    rlf_source *source = open_good();
    (void)next_frame(source);
    camera.color_width = 1;
    const int64_t start_ns = rlf_clock_ns();
    while (count_lines("its colour is 1 x 2 pixels", &told_ns) == 0 &&
           rlf_clock_ns() < start_ns + 5 * SECOND) {
        assert_int_not_equal(rlf_source_next(source, &frame), RLF_END);
    }
    assert_int_equal(count_lines("its colour is 1 x 2 pixels", &told_ns), 1);
    assert_int_equal(count_lines("is it unplugged", &told_ns), 0);
    camera.color_width = 0;
    const rlf_frame back = next_frame(source);
    assert_true((back.flags & RLF_FRAME_DISCONTINUITY) != 0);
    assert_true(rlf_source_get_status(source).damaged > 0);
    rlf_source_destroy(&source);
}

TEST_CASE(lost_and_doubled_frames_are_counted)
{
    rlf_source *source = open_good();
    (void)next_frame(source);
    camera.skip = 3;
    sleep_ms(60);
    camera.repeats = true;
    sleep_ms(60);
    (void)next_frame(source);
    const rlf_source_status s = rlf_source_get_status(source);
    assert_int_equal(s.lost, 3);
    assert_int_equal(s.doubled, 1);
    rlf_source_destroy(&source);
}

TEST_CASE(waiting_ends_soon_and_is_no_busy_loop)
{
    rlf_source *source = open_good();
    camera.next = IS_SILENT;
    sleep_ms(50);
    rlf_frame frame;
    (void)rlf_source_next(source, &frame); /* the last one */
    const int calls = camera.calls;
    const int64_t start_ns = rlf_clock_ns();
    assert_int_equal(rlf_source_next(source, &frame), RLF_NO_FRAME);
    const int64_t waited_ns = rlf_clock_ns() - start_ns;
    assert_true(waited_ns >= 40 * MS && waited_ns < 500 * MS);
    assert_true(camera.calls - calls <= waited_ns / (2 * MS) + 2);
    rlf_source_destroy(&source);
}

TEST_CASE(frames_allocate_nothing)
{
    rlf_source *source = open_good();
    (void)next_frame(source);
    const uint64_t before = rlf_alloc_count();
    for (int i = 0; i < 20; i++) {
        (void)next_frame(source);
    }
    assert_int_equal(rlf_alloc_count(), before);
    rlf_source_destroy(&source);
}

/* ---- gone and back -------------------------------------------------------------------------- */

static void check_back(rlf_source *source, int64_t time_ns, uint64_t sequence)
{
    const rlf_source_status gone = rlf_source_get_status(source);
    assert_false(gone.is_connected);
    camera.sequence = 0; /* a camera that was switched on again counts from one */
    camera.time_ns = 0;
    camera.open = GIVES;
    camera.next = GIVES;
    const rlf_frame frame = next_frame(source);
    assert_true((frame.flags & RLF_FRAME_DISCONTINUITY) != 0);
    assert_true(frame.sequence > sequence);
    assert_true(frame.time_ns > time_ns && frame.time_ns - time_ns < 30 * SECOND);
    const rlf_frame after = next_frame(source);
    assert_true((after.flags & RLF_FRAME_DISCONTINUITY) == 0);
    assert_true(after.time_ns > frame.time_ns);
    await_count("trying again", 1);
    await_count("frames are back", 1);
    assert_true(rlf_source_get_status(source).is_connected);
    assert_true(rlf_source_get_status(source).silence_s < 1.0);
}

TEST_CASE(a_camera_that_is_pulled_out_is_told_and_found_again)
{
    rlf_source *source = open_good();
    const rlf_frame last = next_frame(source);
    camera.open = FAILS;
    camera.next = FAILS;
    const int64_t start_ns = rlf_clock_ns();
    assert_true(await_line(source, "camera test:here?serial=7: no such device", start_ns) < SECOND);
    sleep_ms(600); /* it is looked for in vain */
    check_back(source, last.time_ns, last.sequence);
    assert_true(camera.opened >= 2 && camera.closed == camera.opened - 1);
    rlf_source_destroy(&source);
    assert_int_equal(camera.closed, camera.opened);
}

TEST_CASE(a_camera_that_falls_silent_is_told_and_opened_again)
{
    rlf_source *source = open_good();
    const rlf_frame last = next_frame(source);
    const int64_t start_ns = rlf_clock_ns();
    camera.next = IS_SILENT;
    const int64_t told_ns = await_line(source, "no frame for 1 s", start_ns);
    assert_true(told_ns > 900 * MS && told_ns < 3 * SECOND);
    assert_true(rlf_source_get_status(source).silence_s > 0.9);
    for (int i = 0; i < 1000 && camera.opened < 2; i++) {
        sleep_ms(10);
    }
    assert_int_equal(camera.opened, 2);
    check_back(source, last.time_ns, last.sequence);
    rlf_source_destroy(&source);
}

TEST_CASE(another_camera_in_its_place_ends_the_source)
{
    rlf_source *source = open_good();
    camera.width = 8;
    camera.next = FAILS;
    rlf_frame frame;
    rlf_result result = RLF_OK;
    while (result >= 0) {
        result = rlf_source_next(source, &frame);
    }
    assert_int_equal(result, RLF_ERROR_DEVICE);
    assert_non_null(strstr(rlf_error_text(), "depth 8 x 2"));
    assert_int_equal(rlf_source_next(source, &frame), RLF_ERROR_DEVICE);
    rlf_source_destroy(&source);
    assert_int_equal(camera.closed, camera.opened);
}

/* ---- drivers that do not return ------------------------------------------------------------- */

static void end_in_time(rlf_source **source)
{
    const int64_t start_ns = rlf_clock_ns();
    int64_t at_ns;
    rlf_source_destroy(source);
    assert_true(rlf_clock_ns() - start_ns < 2 * SECOND);
    assert_int_equal(count_lines("left alone", &at_ns), 1);
}

/* The thread that was left alone tidies up when its driver returns after all. */
static void await_close(void)
{
    camera.next = camera.open = camera.close = GIVES;
    for (int i = 0; i < 1000 && camera.closed != camera.opened; i++) {
        sleep_ms(10);
    }
    sleep_ms(50);
    assert_int_equal(camera.closed, camera.opened);
}

TEST_CASE(a_driver_stuck_in_next_is_told_and_left)
{
    rlf_source *source = open_good();
    const int64_t start_ns = rlf_clock_ns();
    camera.next = HANGS;
    const int64_t told_ns = await_line(source, "no frame for 1 s", start_ns);
    assert_true(told_ns > 900 * MS && told_ns < 3 * SECOND);
    end_in_time(&source);
    await_close();
}

TEST_CASE(a_driver_that_returns_after_all_goes_on)
{
    rlf_source *source = open_good();
    const rlf_frame last = next_frame(source);
    camera.next = HANGS;
    (void)await_line(source, "no frame for 1 s", rlf_clock_ns());
    check_back(source, last.time_ns, last.sequence);
    rlf_source_destroy(&source);
    assert_int_equal(camera.closed, camera.opened);
}

TEST_CASE(a_driver_stuck_in_close_is_left)
{
    rlf_source *source = open_good();
    camera.close = HANGS;
    end_in_time(&source);
    await_close();
}

TEST_CASE(a_driver_stuck_in_open_is_told_and_left)
{
    rlf_source *source = NULL;
    int64_t at_ns;
    camera.open = HANGS;
    const int64_t start_ns = rlf_clock_ns();
    assert_int_equal(open_camera(&source), RLF_ERROR_DEVICE);
    assert_true(rlf_clock_ns() - start_ns < 8 * SECOND);
    assert_non_null(strstr(rlf_error_text(), "did not open it within 5 s"));
    assert_int_equal(count_lines("left alone", &at_ns), 1);
    await_close();
}

TEST_CASE(a_camera_without_a_first_frame_is_not_opened)
{
    rlf_source *source = NULL;
    camera.next = IS_SILENT;
    assert_int_equal(open_camera(&source), RLF_ERROR_DEVICE);
    assert_non_null(strstr(rlf_error_text(), "test:here?serial=7: gave no frame within 5 s"));
    assert_int_equal(camera.closed, camera.opened);
    camera.width = -4; /* a driver that says nonsense */
    assert_true(open_camera(&source) < 0);
    assert_int_equal(camera.closed, camera.opened);
    camera.open = FAILS;
    assert_int_equal(open_camera(&source), RLF_ERROR_DEVICE);
    assert_string_equal(rlf_error_text(), "test:here?serial=7: there is no camera here");
}

static _Atomic uint64_t shown, shown_last, shown_gaps;

static void on_frame(void *context, const rlf_frame *frame)
{
    (void)context;
    const uint64_t last = atomic_exchange(&shown_last, frame->sequence);
    shown_gaps += shown > 0 && frame->sequence != last + 1 ? 1 : 0;
    shown++;
}

/* As who records does: all frames, however slow the reader is. */
TEST_CASE(an_observer_is_shown_every_frame)
{
    rlf_source *source = open_good();
    rlf_frame frame;
    shown = shown_gaps = 0;
    assert_true(rlf_source_observe(source, on_frame, NULL));
    for (int i = 0; i < 5; i++) {
        sleep_ms(60); /* twelve frames */
        assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    }
    assert_true(rlf_source_observe(source, NULL, NULL));
    const uint64_t count = shown;
    assert_true(count > 8 && rlf_source_get_status(source).late > 3);
    assert_int_equal(shown_gaps, 0);
    sleep_ms(50);
    assert_true(shown == count);
    rlf_source_destroy(&source);
}

TEST_EACH(set_up, NULL)
