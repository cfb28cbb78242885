/* Times of the surface stage's steps: they add up, and nothing depends on them. */

#include "painted.h"
#include "test.h"

#include <string.h>

enum { WIDTH = 320, HEIGHT = 240, FRAMES = 8, UNTIMED = 6 };

static void draw(int32_t number)
{
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
        double rx = (i % WIDTH - rig.depth.cx) / rig.depth.fx;
        double ry = (double)(i / WIDTH - rig.depth.cy) / rig.depth.fy;
        double ball = sphere_depth(rlf_vec3_make(0.1 * number - 0.6, 0, 1.5), 0.3, rx, ry);
        depth[i] = ball > 0.0 && number > 4 ? (float)ball : 2.5f;
    }
}

/* A ball that moves, in frames from one end of the clock to the other: no step takes the jump for a
 * short time, and what comes after it is followed again. */
TEST_CASE(a_clock_that_jumps_shows_no_motion)
{
    const int64_t frame_ns = 33333333;
    const rlf_reconstruct_def def = see_size(WIDTH, HEIGHT);
    start_seeing(&def);
    for (int32_t k = 0; k < 2 * FRAMES; k++) {
        draw(k);
        rlf_frame frame = analytic_frame(&rig, depth, k);
        frame.time_ns = k < FRAMES ? RLF_TIME_MAX_NS - (FRAMES - 1 - k) * frame_ns
                                   : -RLF_TIME_MAX_NS + (k - FRAMES + 1) * frame_ns;
        const rlf_surface *s = surface_of(stage, &frame);
        int32_t moving = 0;
        for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
            moving += s->velocity_x[i] != 0.0f;
        }
        assert_true(k == FRAMES ? moving == 0 : k < FRAMES - 1 || moving > 100);
    }
}

TEST_CASE(times_add_up_and_change_nothing)
{
    const rlf_reconstruct_def def = see_size(WIDTH, HEIGHT);
    rlf_reconstruct *timed = stage_of(&def), *plain = stage_of(&def);
    rlf_surface_times times, before;
    rlf_reconstruct_set_times(timed, &times);
    for (int32_t k = 0; k < FRAMES; k++) {
        draw(k);
        const rlf_frame frame = analytic_frame(&rig, depth, k);
        memset(&times, 0xff, sizeof(times)); /* NaN: every step must be written */
        before = times;
        rlf_reconstruct_set_times(timed, k < UNTIMED ? &times : NULL);
        int64_t start = rlf_clock_ns();
        const rlf_surface *a = surface_of(timed, &frame);
        double whole = (double)(rlf_clock_ns() - start) * 1e-6;
        const rlf_surface *b = surface_of(plain, &frame);
        assert_memory_equal(a->depth, b->depth, sizeof(depth));
        assert_memory_equal(a->velocity_x, b->velocity_x, sizeof(depth));
        if (k >= UNTIMED) {
            assert_memory_equal(&times, &before, sizeof(times)); /* off again: not touched */
            continue;
        }
        double sum = 0;
        for (int s = 0; s < RLF_SURFACE_STEP_COUNT; s++) {
            assert_true(times.step_ms[s] >= 0.0);
            sum += times.step_ms[s];
        }
        assert_true(sum <= whole);
        assert_true(times.step_ms[RLF_SURFACE_SMOOTH] > 0.0);
        assert_true(times.step_ms[RLF_SURFACE_BACKGROUND] > 0.0);
    }
    rlf_reconstruct_destroy(&timed);
    rlf_reconstruct_destroy(&plain);
}

TEST_CASE(steps_that_are_off_take_no_time)
{
    see_size(WIDTH, HEIGHT);
    const rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_THESIS, &rig);
    start_seeing(&def);
    rlf_surface_times times;
    rlf_reconstruct_set_times(stage, &times);
    draw(0);
    see();
    assert_true(times.step_ms[RLF_SURFACE_SMOOTH] == 0.0);
    assert_true(times.step_ms[RLF_SURFACE_VELOCITY] == 0.0);
    assert_true(times.step_ms[RLF_SURFACE_NORMALS] > 0.0);
}

TEST_CASE(steps_have_names)
{
    for (int s = 0; s < RLF_SURFACE_STEP_COUNT; s++) {
        assert_true(strlen(rlf_surface_step_name((rlf_surface_step)s)) >= 4);
    }
    assert_string_equal(rlf_surface_step_name(RLF_SURFACE_PUBLISH), "publish");
    assert_string_equal(rlf_surface_step_name(RLF_SURFACE_STEP_COUNT), "unknown");
}

TEST_EACH(NULL, stop_seeing)
