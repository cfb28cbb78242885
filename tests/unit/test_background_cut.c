/* Another room than the one that was learnt, and things that only look like one. */

#include "painted.h"
#include "test.h"

enum { WIDTH = 96, HEIGHT = 72, COUNT = WIDTH * HEIGHT, LEARNT = 20, LEARNING = 5, NOTICED = 3 };

/* A wall that is `left` metres away at the left border and `right` at the right one. */
static void slanted_wall(double left, double right)
{
    for (int i = 0; i < COUNT; i++) {
        double t = (double)(i % WIDTH) / (WIDTH - 1);
        depth[i] = (float)(1.0 / ((1.0 - t) / left + t / right));
    }
}

static void learn_a_wall(void)
{
    rlf_reconstruct_def def = see_size(WIDTH, HEIGHT);
    def.min_region_points = 8;
    start_seeing(&def);
    paint_all(3.0f);
    see_often(LEARNT);
}

TEST_CASE(another_room_is_learnt_anew)
{
    learn_a_wall();
    slanted_wall(2.0, 4.0);
    const rlf_surface *s = NULL;
    for (int32_t i = 0; i < NOTICED - 1; i++) {
        s = see();
        assert_int_equal(s->background_state, RLF_BACKGROUND_READY);
        assert_true(s->foreground_count > COUNT / 4);
    }
    for (int32_t i = NOTICED - 1; i < NOTICED - 1 + LEARNING; i++) {
        s = see();
        assert_int_equal(s->foreground_count, 0);
    }
    assert_int_equal(s->background_state, RLF_BACKGROUND_READY);
    for (int i = 0; i < COUNT; i++) {
        assert_float_equal(s->background_depth[i], depth[i], 0.002);
    }
}

/* Surfaces stay what they are for two further frames, also when the background starts anew. */
TEST_CASE(older_surfaces_stay_unchanged)
{
    learn_a_wall();
    slanted_wall(2.0, 4.0);
    const rlf_surface *kept = see();
    assert_float_equal(kept->background_depth[0], 3.0, 0.002);
    see_often(2);
    assert_float_equal(kept->background_depth[0], 3.0, 0.002);
}

/* A curtain before four fifths of the view, and its leaving, are no other room. */
TEST_CASE(what_comes_or_goes_is_no_other_room)
{
    learn_a_wall();
    paint((area){0, WIDTH * 4 / 5, 0, HEIGHT}, 1.5f);
    const rlf_surface *s = NULL;
    for (int32_t i = 0; i < 10; i++) {
        s = see();
        assert_int_equal(s->background_state, RLF_BACKGROUND_READY);
    }
    assert_true(s->foreground_count > COUNT * 3 / 4);
    paint_all(3.0f);
    for (int32_t i = 10; i < 20; i++) {
        s = see();
        assert_int_equal(s->background_state, RLF_BACKGROUND_READY);
    }
    assert_int_equal(s->foreground_count, 0);
    assert_float_equal(s->background_depth[0], 3.0, 0.002);
}

TEST_CASE(nothing_seen_is_no_other_room)
{
    learn_a_wall();
    paint_all(0.0f);
    for (int32_t i = 0; i < 10; i++) {
        assert_int_equal(see()->background_state, RLF_BACKGROUND_READY);
    }
}

TEST_EACH(NULL, stop_seeing)
