/* Frames without depth, or with hardly any: nothing is learnt of them, and nothing is forgotten. */

#include "painted.h"
#include "test.h"

enum { WIDTH = 96, HEIGHT = 72, COUNT = WIDTH * HEIGHT };

static const rlf_profile PROFILES[2] = {RLF_PROFILE_LIVE, RLF_PROFILE_THESIS};

static void begin(rlf_profile profile)
{
    see_size(WIDTH, HEIGHT);
    rlf_reconstruct_def def = rlf_reconstruct_def_default(profile, &rig);
    def.scale_factor = 1;
    start_seeing(&def);
}

static void room(void)
{
    paint_all(3.0f);
}

/* A twentieth of the pixels: anywhere, or all at one place. */
static void room_of_few(bool is_spread)
{
    analytic_random random = {7};
    for (int i = 0; i < COUNT; i++) {
        const bool is_there =
            is_spread ? random_uniform(&random) < 0.05 : i % WIDTH < 20 && i / WIDTH < 17;
        depth[i] = is_there ? 3.0f : 0.0f;
    }
}

static void left_half(void)
{
    room();
    paint((area){WIDTH / 2, WIDTH, 0, HEIGHT}, 0.0f);
}

/* The room, seen for the first time, is the background; something that comes before it is not. */
static void the_room_is_learnt(void)
{
    const rlf_surface *s = NULL;
    for (int32_t t = 0; t < 12; t++) {
        room();
        s = see();
        assert_int_equal(s->foreground_count, 0);
    }
    assert_false(s->is_blind);
    assert_int_equal(s->background_state, RLF_BACKGROUND_READY);
    for (int i = 0; i < COUNT; i++) {
        assert_float_equal(s->background_depth[i], 3.0, 0.01);
    }
    paint((area){20, 50, 20, 50}, 1.5f);
    s = see();
    assert_in_range(s->foreground_count, 28 * 28, 32 * 32);
}

TEST_CASE(frames_without_depth_teach_nothing)
{
    for (int profile = 0; profile < 2; profile++) {
        begin(PROFILES[profile]);
        for (int32_t t = 0; t < 30; t++) {
            paint_all(0.0f);
            const rlf_surface *s = see();
            assert_true(s->is_blind);
            assert_int_equal(s->background_state, RLF_BACKGROUND_LEARNING);
        }
        the_room_is_learnt();
    }
}

TEST_CASE(a_sensor_that_warms_up_is_waited_for)
{
    for (int profile = 0; profile < 2; profile++) {
        begin(PROFILES[profile]);
        for (int32_t t = 0; t < 30; t++) {
            room_of_few(true);
            assert_true(see()->is_blind);
        }
        the_room_is_learnt();
    }
}

TEST_CASE(a_room_of_little_depth_is_a_room)
{
    begin(RLF_PROFILE_LIVE);
    const rlf_surface *s = NULL;
    for (int32_t t = 0; t < 100; t++) {
        room_of_few(false);
        s = see();
        assert_int_equal(s->is_blind, t <= 90); /* 3 s */
    }
    assert_int_equal(s->background_state, RLF_BACKGROUND_READY);
}

TEST_CASE(the_half_that_comes_late_is_the_room)
{
    for (int profile = 0; profile < 2; profile++) {
        begin(PROFILES[profile]);
        for (int32_t t = 0; t < 30; t++) {
            left_half();
            assert_false(see()->is_blind);
        }
        the_room_is_learnt();
    }
}

TEST_CASE(a_covered_lens_forgets_nothing)
{
    for (int profile = 0; profile < 2; profile++) {
        begin(PROFILES[profile]);
        for (int32_t t = 0; t < 12; t++) {
            room();
            assert_false(see()->is_blind);
        }
        for (int32_t t = 12; t < 42; t++) {
            paint_all(0.0f);
            const rlf_surface *s = see();
            assert_true(s->is_blind);
            assert_int_equal(s->background_state, RLF_BACKGROUND_READY);
            assert_float_equal(s->background_depth[COUNT / 2], 3.0, 0.01);
            assert_int_equal(s->foreground_count, 0);
        }
        the_room_is_learnt();
    }
}

TEST_EACH(NULL, stop_seeing)
