/* Physics on what the synthetic sensor shows: short versions of section "sensed". */
#include "eval/ball.h"
#include "eval/sensed/throw.h"
#include "relief/io.h"
#include "test.h"

#include <math.h>

/* A ball without friction onto a level floor: up again at its restitution, at the right place. */
TEST_CASE(true_ball_bounces_exactly)
{
    rlf_source *room = NULL;
    assert_int_equal(rlf_open_source("synthetic:empty?color=0", NULL, &room), RLF_OK);
    const rlf_vec3 GRAVITY = {0, 9.81, 0};
    eval_ball ball = {.x = {0, 0.5, 3}, .v = {1, 0, 0}, .radius = 0.1, .restitution = 0.5};
    double fall = sqrt(2.0 * 0.7 / 9.81); /* from 0.5 to the floor at 1.3, less the radius */
    eval_ball_fly(room, &ball, GRAVITY, 0.0, fall + 0.1);
    assert_int_equal(ball.bounces, 1);
    assert_int_equal(ball.first.label, RLF_SYNTHETIC_LABEL_FLOOR);
    assert_true(fabs(ball.first_approach - 9.81 * fall) < 1e-3);
    assert_true(fabs(ball.v.y - (-0.5 * 9.81 * fall + 0.981)) < 1e-3);
    assert_true(fabs(ball.v.x - 1.0) < 1e-12 && fabs(ball.x.x - (fall + 0.1)) < 1e-9);
    /* With friction enough to stick it rolls: v = 5/7 of the sliding speed. */
    eval_ball rough = {
        .x = {0, 0.5, 3}, .v = {1, 0, 0}, .radius = 0.1, .restitution = 0.5, .friction = 1.0};
    eval_ball_fly(room, &rough, GRAVITY, 0.0, fall + 0.1);
    assert_true(fabs(rough.v.x - 5.0 / 7.0) < 1e-9);
    assert_true(fabs(rough.w.z - rough.v.x / 0.1) < 1e-6);
    rlf_source_destroy(&room);
}

/* The person is in the middle of the view from 1.5 s on. The thesis's method shows that there is
 * something to go wrong. */
TEST_CASE(lost_frames_of_a_walking_person_let_nothing_through)
{
    eval_throw_def def = {.source = "synthetic:room?color=0&frames=-1",
                          .aim = EVAL_AIM_ANY,
                          .throws = 40,
                          .per_frame = 4,
                          .begin_s = 1.5,
                          .lost = 7,
                          .seed = 9};
    eval_throws o;
    assert_int_equal(eval_sensed_throw(&def, &o), RLF_OK);
    assert_int_equal(o.thrown, 40);
    assert_int_equal(o.tunnelled + o.swallowed + o.not_finite, 0);
    assert_less(o.fastest, 15.0);
    def.profile = RLF_PROFILE_THESIS;
    assert_int_equal(eval_sensed_throw(&def, &o), RLF_OK);
    assert_true(o.tunnelled > 10 && o.swallowed > 0);
}

TEST_CASE(balls_bounce_as_they_truly_would)
{
    eval_throw_def def = {.source = "synthetic:room?color=0&frames=-1",
                          .aim = EVAL_AIM_ANY,
                          .throws = 80,
                          .balls_only = true,
                          .seed = 9};
    eval_throws live, thesis;
    assert_int_equal(eval_sensed_throw(&def, &live), RLF_OK);
    def.profile = RLF_PROFILE_THESIS;
    assert_int_equal(eval_sensed_throw(&def, &thesis), RLF_OK);
    assert_less(60, live.bounces);
    assert_less(0.85 * (double)live.bounces, live.right_nearby);
    assert_less(thesis.right_nearby, 0.5 * (double)thesis.bounces);
}
