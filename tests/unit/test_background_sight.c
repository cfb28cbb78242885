/* Frames without depth, or with hardly any: nothing is learnt of them, and nothing is forgotten. */

#include "seen_view.h"
#include "test.h"

#include <string.h>

enum { WIDTH = 96, HEIGHT = 72, COUNT = WIDTH * HEIGHT };

static float depth[COUNT];

static rlf_reconstruct *make_stage(rlf_profile profile)
{
    rlf_rig rig = analytic_rig(WIDTH, HEIGHT);
    rlf_reconstruct_def def = rlf_reconstruct_def_default(profile, &rig);
    def.scale_factor = 1;
    return seen_view_stage(&def);
}

static const rlf_surface *process(rlf_reconstruct *stage, int32_t number)
{
    rlf_rig rig = analytic_rig(WIDTH, HEIGHT);
    return seen_depth_process(&rig, depth, stage, number);
}

static void black(void)
{
    memset(depth, 0, sizeof(depth));
}

static void room(void)
{
    for (int i = 0; i < COUNT; i++) {
        depth[i] = 3.0f;
    }
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
    for (int i = 0; i < COUNT; i++) {
        depth[i] = i % WIDTH < WIDTH / 2 ? 3.0f : 0.0f;
    }
}

/* The room, seen for the first time, is the background; after `start` frames and as it is learnt
 * then, and something that comes before it is not. */
static void the_room_is_learnt(rlf_reconstruct *stage, int32_t start)
{
    const rlf_surface *s = NULL;
    for (int32_t t = start; t < start + 12; t++) {
        room();
        s = process(stage, t);
        assert_int_equal(s->foreground_count, 0);
    }
    assert_false(s->is_blind);
    assert_int_equal(s->background_state, RLF_BACKGROUND_READY);
    for (int i = 0; i < COUNT; i++) {
        assert_float_equal(s->background_depth[i], 3.0, 0.01);
    }
    for (int y = 20; y < 50; y++) {
        for (int x = 20; x < 50; x++) {
            depth[y * WIDTH + x] = 1.5f;
        }
    }
    s = process(stage, start + 12);
    assert_in_range(s->foreground_count, 28 * 28, 32 * 32);
}

static void frames_without_depth_teach_nothing(void **state)
{
    (void)state;
    for (int profile = 0; profile < 2; profile++) {
        rlf_reconstruct *stage = make_stage(profile ? RLF_PROFILE_THESIS : RLF_PROFILE_LIVE);
        for (int32_t t = 0; t < 30; t++) {
            black();
            const rlf_surface *s = process(stage, t);
            assert_true(s->is_blind);
            assert_int_equal(s->background_state, RLF_BACKGROUND_LEARNING);
        }
        the_room_is_learnt(stage, 30);
        rlf_reconstruct_destroy(&stage);
    }
}

static void a_sensor_that_warms_up_is_waited_for(void **state)
{
    (void)state;
    for (int profile = 0; profile < 2; profile++) {
        rlf_reconstruct *stage = make_stage(profile ? RLF_PROFILE_THESIS : RLF_PROFILE_LIVE);
        for (int32_t t = 0; t < 30; t++) {
            room_of_few(true);
            assert_true(process(stage, t)->is_blind);
        }
        the_room_is_learnt(stage, 30);
        rlf_reconstruct_destroy(&stage);
    }
}

static void a_room_of_little_depth_is_a_room(void **state)
{
    (void)state;
    rlf_reconstruct *stage = make_stage(RLF_PROFILE_LIVE);
    const rlf_surface *s = NULL;
    for (int32_t t = 0; t < 100; t++) {
        room_of_few(false);
        s = process(stage, t);
        assert_int_equal(s->is_blind, t <= 90); /* 3 s */
    }
    assert_int_equal(s->background_state, RLF_BACKGROUND_READY);
    rlf_reconstruct_destroy(&stage);
}

static void the_half_that_comes_late_is_the_room(void **state)
{
    (void)state;
    for (int profile = 0; profile < 2; profile++) {
        rlf_reconstruct *stage = make_stage(profile ? RLF_PROFILE_THESIS : RLF_PROFILE_LIVE);
        for (int32_t t = 0; t < 30; t++) {
            left_half();
            assert_false(process(stage, t)->is_blind);
        }
        the_room_is_learnt(stage, 30);
        rlf_reconstruct_destroy(&stage);
    }
}

static void a_covered_lens_forgets_nothing(void **state)
{
    (void)state;
    for (int profile = 0; profile < 2; profile++) {
        rlf_reconstruct *stage = make_stage(profile ? RLF_PROFILE_THESIS : RLF_PROFILE_LIVE);
        for (int32_t t = 0; t < 12; t++) {
            room();
            assert_false(process(stage, t)->is_blind);
        }
        for (int32_t t = 12; t < 42; t++) {
            black();
            const rlf_surface *s = process(stage, t);
            assert_true(s->is_blind);
            assert_int_equal(s->background_state, RLF_BACKGROUND_READY);
            assert_float_equal(s->background_depth[COUNT / 2], 3.0, 0.01);
            assert_int_equal(s->foreground_count, 0);
        }
        the_room_is_learnt(stage, 42);
        rlf_reconstruct_destroy(&stage);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_without_depth_teach_nothing),
        cmocka_unit_test(a_sensor_that_warms_up_is_waited_for),
        cmocka_unit_test(a_room_of_little_depth_is_a_room),
        cmocka_unit_test(the_half_that_comes_late_is_the_room),
        cmocka_unit_test(a_covered_lens_forgets_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
