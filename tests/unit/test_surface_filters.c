/* The two depth filters: smoothing within planes and steadying over time. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "seen_view.h"

#include <math.h>

enum { WIDTH = 96, HEIGHT = 72, COUNT = WIDTH * HEIGHT };

static int set_up(void **state)
{
    static seen_view view;
    seen_view_create(&view, analytic_rig(WIDTH, HEIGHT), 11);
    *state = &view;
    return 0;
}

/* A slanted board in the left half, a wall behind it, and a floor that meets the wall. */
static void set_room(seen_view *f, double board)
{
    rlf_vec3 slanted = rlf_normalize(rlf_vec3_make(0.3, 0.2, -1.0));
    for (int i = 0; i < COUNT; i++) {
        double wall = 3.0, x = f->ray_x[i], y = f->ray_y[i];
        double floor = y > 0.0 ? 1.0 / y : 10.0;
        double z = wall < floor ? wall : floor;
        z = i % WIDTH < WIDTH / 2 ? plane_depth(slanted, -board, x, y) : z;
        f->truth[i] = (float)z;
    }
}

static rlf_reconstruct *make_stage(const seen_view *f, bool smoothing, bool steadying)
{
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &f->rig);
    def.background_method = RLF_BACKGROUND_OFF;
    def.enable_fill = def.enable_flying_removal = false;
    def.enable_smoothing = smoothing;
    def.enable_steadying = steadying;
    return seen_view_stage(&def);
}

static const rlf_surface *process(seen_view *f, rlf_reconstruct *stage, int32_t number)
{
    for (int i = 0; i < COUNT; i++) {
        f->seen[i] = seen_view_noisy(f, f->truth[i]);
    }
    return seen_view_process(f, stage, number);
}

static double rms(const float *depth, const float *truth)
{
    double sum = 0.0;
    for (int i = 0; i < COUNT; i++) {
        sum += (depth[i] - truth[i]) * (depth[i] - truth[i]);
    }
    return sqrt(sum / COUNT);
}

static void smoothing_takes_noise_and_leaves_edges(void **state)
{
    seen_view *f = *state;
    set_room(f, 1.6);
    rlf_reconstruct *stage = make_stage(f, true, false);
    const rlf_surface *s = process(f, stage, 0);
    assert_true(rms(s->depth, f->truth) < 0.4 * rms(f->seen, f->truth));
    for (int i = 0; i < COUNT; i++) { /* no pixel of the board goes to the wall or comes from it */
        double sigma = rlf_depth_noise_sigma(&f->rig.noise, f->truth[i]);
        assert_true(fabs(s->depth[i] - f->seen[i]) < 12.0 * sigma);
        assert_true(fabs(s->depth[i] - f->truth[i]) < 12.0 * sigma);
    }
    rlf_reconstruct_destroy(&stage);
}

static void without_filters_depth_is_the_frames(void **state)
{
    seen_view *f = *state;
    set_room(f, 1.6);
    rlf_reconstruct *stage = make_stage(f, false, false);
    for (int t = 0; t < 3; t++) {
        const rlf_surface *s = process(f, stage, t);
        assert_memory_equal(s->depth, f->seen, COUNT * sizeof(float));
    }
    rlf_reconstruct_destroy(&stage);
}

static void what_stands_still_becomes_steady(void **state)
{
    seen_view *f = *state;
    set_room(f, 1.6);
    const double most[2] = {0.3, 0.7}; /* planes leave a little at the crease, in every frame */
    for (int smoothing = 0; smoothing < 2; smoothing++) {
        rlf_reconstruct *stage = make_stage(f, smoothing, true);
        const rlf_surface *s = process(f, stage, 0);
        double first = rms(s->depth, f->truth);
        for (int t = 1; t < 30; t++) {
            s = process(f, stage, t);
        }
        assert_true(rms(s->depth, f->truth) < most[smoothing] * first);
        rlf_reconstruct_reset(stage);
        s = process(f, stage, 30);
        assert_true(rms(s->depth, f->truth) > 0.8 * first);
        rlf_reconstruct_destroy(&stage);
    }
}

/* A board that comes 5 mm nearer per frame and then jumps: the steadied depth is at most the gate
 * away from what the frame alone gives, and after the jump that: but for rounding, since the wall
 * beside it, which is steady, is the origin of the sums. */
static void nothing_that_moved_stays(void **state)
{
    seen_view *f = *state;
    rlf_reconstruct *plain = make_stage(f, true, false);
    rlf_reconstruct *steady = make_stage(f, true, true);
    for (int t = 0; t < 24; t++) {
        set_room(f, t < 20 ? 1.6 - 0.005 * t : 1.2);
        const rlf_surface *a = process(f, plain, t);
        const rlf_surface *b = seen_view_process(f, steady, t);
        for (int i = 0; i < COUNT; i++) {
            double sigma = rlf_depth_noise_sigma(&f->rig.noise, a->depth[i]);
            assert_true(fabs(a->depth[i] - b->depth[i]) <= 12.0 * sigma);
            bool jumped = t == 20 && i % WIDTH < WIDTH / 2 - 1;
            assert_true(!jumped || fabs(a->depth[i] - b->depth[i]) < 1e-4);
        }
    }
    rlf_reconstruct_destroy(&plain);
    rlf_reconstruct_destroy(&steady);
}

/* The first surface, without a background; it is the stage's, and that the caller's. */
static const rlf_surface *reconstruct_once(seen_view *f, rlf_reconstruct **stage)
{
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &f->rig);
    def.background_method = RLF_BACKGROUND_OFF;
    *stage = seen_view_stage(&def);
    return seen_view_process(f, *stage, 0);
}

/* Drivers leave the border of the image empty: it goes on as what is inside of it. */
static void the_border_goes_on(void **state)
{
    seen_view *f = *state;
    set_room(f, 1.6);
    for (int i = 0; i < COUNT; i++) {
        int x = i % WIDTH, y = i / WIDTH;
        bool border = x == 0 || y == 0 || x == WIDTH - 1 || y == HEIGHT - 1;
        f->seen[i] = border ? 0.0f : f->truth[i];
    }
    rlf_reconstruct *stage = NULL;
    const rlf_surface *s = reconstruct_once(f, &stage);
    for (int i = 0; i < COUNT; i++) {
        int x = i % WIDTH;
        bool is_edge = x > WIDTH / 2 - 4 && x < WIDTH / 2 + 4;
        bool is_floor = x >= WIDTH / 2 && f->truth[i] < 2.999f; /* too steep here for pixels */
        if (f->seen[i] > 0.0f || is_edge || is_floor) {
            continue;
        }
        assert_int_equal(s->reason[i], RLF_REASON_FILLED);
        assert_true(fabsf(s->depth[i] - f->truth[i]) < 0.005f);
    }
    rlf_reconstruct_destroy(&stage);
}

/* Of a hole that is as wide as the widest that is filled, and wider by turns, nothing is left. */
static void a_ragged_hole_is_no_comb(void **state)
{
    enum { LEFT = 60, WIDE = 7, TOP = 8, END = 28 }; /* on the wall */
    seen_view *f = *state;
    set_room(f, 1.6);
    for (int i = 0; i < COUNT; i++) {
        int x = i % WIDTH, y = i / WIDTH;
        bool hole = y >= TOP && y < END && x >= LEFT && x < LEFT + WIDE + (y % 3 == 0 ? 3 : 0);
        f->seen[i] = hole ? 0.0f : f->truth[i];
    }
    rlf_reconstruct *stage = NULL;
    const rlf_surface *s = reconstruct_once(f, &stage);
    for (int i = 0; i < COUNT; i++) {
        if (f->seen[i] == 0.0f) {
            assert_int_equal(s->reason[i], RLF_REASON_FILLED);
            assert_true(fabsf(s->depth[i] - f->truth[i]) < 0.001f);
        }
    }
    rlf_reconstruct_destroy(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(smoothing_takes_noise_and_leaves_edges),
        cmocka_unit_test(without_filters_depth_is_the_frames),
        cmocka_unit_test(what_stands_still_becomes_steady),
        cmocka_unit_test(nothing_that_moved_stays),
        cmocka_unit_test(the_border_goes_on),
        cmocka_unit_test(a_ragged_hole_is_no_comb),
    };
    return cmocka_run_group_tests(tests, set_up, seen_view_destroy);
}
