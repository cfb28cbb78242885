/* Another room than the one that was learnt, and things that only look like one. */

#include "seen_view.h"
#include "test.h"

enum { WIDTH = 96, HEIGHT = 72, COUNT = WIDTH * HEIGHT, LEARNT = 20, LEARNING = 5, NOTICED = 3 };

static float depth[COUNT];

static rlf_reconstruct *make_stage(void)
{
    rlf_rig rig = analytic_rig(WIDTH, HEIGHT);
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &rig);
    def.min_region_points = 8;
    return seen_view_stage(&def);
}

static const rlf_surface *process(rlf_reconstruct *stage, int32_t number)
{
    rlf_rig rig = analytic_rig(WIDTH, HEIGHT);
    return seen_depth_process(&rig, depth, stage, number);
}

/* A wall that is `left` metres away at the left border and `right` at the right one. */
static void slanted_wall(double left, double right)
{
    for (int i = 0; i < COUNT; i++) {
        double t = (double)(i % WIDTH) / (WIDTH - 1);
        depth[i] = (float)(1.0 / ((1.0 - t) / left + t / right));
    }
}

static rlf_reconstruct *make_learnt_stage(void)
{
    rlf_reconstruct *stage = make_stage();
    slanted_wall(3.0, 3.0);
    for (int32_t i = 0; i < LEARNT; i++) {
        process(stage, i);
    }
    return stage;
}

static void another_room_is_learnt_anew(void **state)
{
    (void)state;
    rlf_reconstruct *stage = make_learnt_stage();
    slanted_wall(2.0, 4.0);
    const rlf_surface *s = NULL;
    for (int32_t i = 0; i < NOTICED - 1; i++) {
        s = process(stage, LEARNT + i);
        assert_int_equal(s->background_state, RLF_BACKGROUND_READY);
        assert_true(s->foreground_count > COUNT / 4);
    }
    for (int32_t i = NOTICED - 1; i < NOTICED - 1 + LEARNING; i++) {
        s = process(stage, LEARNT + i);
        assert_int_equal(s->foreground_count, 0);
    }
    assert_int_equal(s->background_state, RLF_BACKGROUND_READY);
    for (int i = 0; i < COUNT; i++) {
        assert_float_equal(s->background_depth[i], depth[i], 0.002);
    }
    rlf_reconstruct_destroy(&stage);
}

/* Surfaces stay what they are for two further frames, also when the background starts anew. */
static void older_surfaces_stay_unchanged(void **state)
{
    (void)state;
    rlf_reconstruct *stage = make_learnt_stage();
    slanted_wall(2.0, 4.0);
    const rlf_surface *kept = process(stage, LEARNT);
    assert_float_equal(kept->background_depth[0], 3.0, 0.002);
    process(stage, LEARNT + 1);
    process(stage, LEARNT + 2);
    assert_float_equal(kept->background_depth[0], 3.0, 0.002);
    rlf_reconstruct_destroy(&stage);
}

/* A curtain before four fifths of the view, and its leaving, are no other room. */
static void what_comes_or_goes_is_no_other_room(void **state)
{
    (void)state;
    rlf_reconstruct *stage = make_learnt_stage();
    for (int i = 0; i < COUNT; i++) {
        depth[i] = i % WIDTH < WIDTH * 4 / 5 ? 1.5f : 3.0f;
    }
    const rlf_surface *s = NULL;
    for (int32_t i = 0; i < 10; i++) {
        s = process(stage, LEARNT + i);
        assert_int_equal(s->background_state, RLF_BACKGROUND_READY);
    }
    assert_true(s->foreground_count > COUNT * 3 / 4);
    slanted_wall(3.0, 3.0);
    for (int32_t i = 10; i < 20; i++) {
        s = process(stage, LEARNT + i);
        assert_int_equal(s->background_state, RLF_BACKGROUND_READY);
    }
    assert_int_equal(s->foreground_count, 0);
    assert_float_equal(s->background_depth[0], 3.0, 0.002);
    rlf_reconstruct_destroy(&stage);
}

static void nothing_seen_is_no_other_room(void **state)
{
    (void)state;
    rlf_reconstruct *stage = make_learnt_stage();
    memset(depth, 0, sizeof depth);
    for (int32_t i = 0; i < 10; i++) {
        assert_int_equal(process(stage, LEARNT + i)->background_state, RLF_BACKGROUND_READY);
    }
    rlf_reconstruct_destroy(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(another_room_is_learnt_anew),
        cmocka_unit_test(older_surfaces_stay_unchanged),
        cmocka_unit_test(what_comes_or_goes_is_no_other_room),
        cmocka_unit_test(nothing_seen_is_no_other_room),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
