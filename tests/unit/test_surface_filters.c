/* The two depth filters: smoothing within planes and steadying over time. */

#include "seen_view.h"
#include "test.h"

#include <math.h>
#include <stdlib.h>

enum { WIDTH = 96, HEIGHT = 72, COUNT = WIDTH * HEIGHT };

static int set_up(void **state)
{
    static seen_view view;
    seen_view_create(&view, analytic_rig(WIDTH, HEIGHT), 11);
    *state = &view;
    return 0;
}

/* Every test draws the same noise, whatever ran before it. */
static int begin_noise(void **state)
{
    seen_view *f = *state;
    f->random = (analytic_random){11};
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
    return stage_of(&def);
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

TEST_CASE(smoothing_takes_noise_and_leaves_edges)
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

TEST_CASE(without_filters_depth_is_the_frames)
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

/* The same away from the board's edge and the crease, where a few pixels' planes decide it. */
static double inner_rms(const seen_view *f, const float *depth)
{
    double sum = 0.0, crease = 1.0 / 3.0, far = 6.0 / f->rig.depth.fy;
    int count = 0;
    for (int i = 0; i < COUNT; i++) {
        int x = i % WIDTH - WIDTH / 2;
        if (abs(x) >= 6 && (x < 0 || fabs(f->ray_y[i] - crease) >= far)) {
            sum += (depth[i] - f->truth[i]) * (depth[i] - f->truth[i]);
            count++;
        }
    }
    return sqrt(sum / count);
}

TEST_CASE(what_stands_still_becomes_steady)
{
    seen_view *f = *state;
    set_room(f, 1.6);
    const double most[2] = {0.25, 0.5};
    for (int smoothing = 0; smoothing < 2; smoothing++) {
        rlf_reconstruct *stage = make_stage(f, smoothing, true);
        const rlf_surface *s = process(f, stage, 0);
        double first = inner_rms(f, s->depth);
        for (int t = 1; t < 30; t++) {
            s = process(f, stage, t);
        }
        assert_true(inner_rms(f, s->depth) < most[smoothing] * first);
        rlf_reconstruct_reset(stage);
        s = process(f, stage, 30);
        assert_true(inner_rms(f, s->depth) > 0.8 * first);
        rlf_reconstruct_destroy(&stage);
    }
}

/* What one pixel off by so many sigmas, after 20 exact frames, becomes, in sigmas; with the eight
 * about it, where `wide`. */
static double after_step(seen_view *f, double sigmas, bool wide)
{
    const int at = HEIGHT / 4 * WIDTH + 3 * WIDTH / 4; /* on the wall */
    double sigma = rlf_depth_noise_sigma(&f->rig.noise, f->truth[at]);
    rlf_reconstruct *stage = make_stage(f, false, true);
    const rlf_surface *s = NULL;
    for (int t = 0; t <= 20; t++) {
        for (int i = 0; i < COUNT; i++) {
            int dx = i % WIDTH - at % WIDTH, dy = i / WIDTH - at / WIDTH;
            bool hit = t == 20 && (i == at || (wide && abs(dx) <= 1 && abs(dy) <= 1));
            f->seen[i] = f->truth[i] + (hit ? (float)(sigmas * sigma) : 0.0f);
        }
        s = seen_view_process(f, stage, t);
    }
    double left = (s->depth[at] - f->truth[at]) / sigma;
    rlf_reconstruct_destroy(&stage);
    return left;
}

/* Noise alone passes three sigmas now and then: that is motion only where neighbours move too. */
TEST_CASE(noise_of_one_pixel_is_no_motion)
{
    seen_view *f = *state;
    set_room(f, 1.6);
    assert_true(fabs(after_step(f, 3.5, false)) < 0.2);
    assert_true(fabs(after_step(f, -3.5, false)) < 0.2);
    assert_true(fabs(after_step(f, 3.5, true) - 3.5) < 0.01);
    assert_true(fabs(after_step(f, 6.0, false) - 6.0) < 0.01);
}

/* A board that comes 5 mm nearer per frame and then jumps: the steadied depth is at most the gate
 * away from what the frame alone gives, and after the jump that: but for rounding, since the wall
 * beside it, which is steady, is the origin of the sums. Where a pixel is at the limit of what its
 * planes explain, rounding decides whether they take it: of two in a thousand at most. */
TEST_CASE(nothing_that_moved_stays)
{
    seen_view *f = *state;
    rlf_reconstruct *plain = make_stage(f, true, false);
    rlf_reconstruct *steady = make_stage(f, true, true);
    for (int t = 0; t < 24; t++) {
        set_room(f, t < 20 ? 1.6 - 0.005 * t : 1.2);
        const rlf_surface *a = process(f, plain, t);
        const rlf_surface *b = seen_view_process(f, steady, t);
        int differ = 0;
        for (int i = 0; i < COUNT; i++) {
            double sigma = rlf_depth_noise_sigma(&f->rig.noise, a->depth[i]);
            assert_true(fabs(a->depth[i] - b->depth[i]) <= 12.0 * sigma);
            bool jumped = t == 20 && i % WIDTH < WIDTH / 2 - 1;
            differ += jumped && fabs(a->depth[i] - b->depth[i]) >= 1e-4;
        }
        assert_true(500 * differ < COUNT / 2);
    }
    rlf_reconstruct_destroy(&plain);
    rlf_reconstruct_destroy(&steady);
}

/* The first surface, without a background; it is the stage's, and that the caller's. */
static const rlf_surface *reconstruct_once(seen_view *f, rlf_reconstruct **stage)
{
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &f->rig);
    def.background_method = RLF_BACKGROUND_OFF;
    *stage = stage_of(&def);
    return seen_view_process(f, *stage, 0);
}

/* Drivers leave the border of the image empty: it goes on as what is inside of it. */
TEST_CASE(the_border_goes_on)
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
TEST_CASE(a_ragged_hole_is_no_comb)
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

TEST_GROUP(set_up, seen_view_destroy)
TEST_EACH(begin_noise, NULL)
