/* A box that stands before a wall from the first frame on, and then goes: it is foreground whole,
 * though most of it shows the depth that it had. */
#include "painted.h"
#include "test.h"

enum { WIDTH = 160, HEIGHT = 120, COUNT = WIDTH * HEIGHT, X0 = 50, X1 = 90, Y0 = 40, Y1 = 80 };
enum { STILL = 60 };

static const float WALL = 2.0f, BOX = 1.4f;

static bool is_box(int i, int x)
{
    return i % WIDTH >= X0 + x && i % WIDTH < X1 + x && i / WIDTH >= Y0 && i / WIDTH < Y1;
}

/* A box `x` pixels aside and `nearer` metres before its place, and what comes in from the left. */
static const rlf_surface *show(int x, float nearer, int hand)
{
    for (int i = 0; i < COUNT; i++) {
        depth[i] = is_box(i, x) ? BOX - nearer : WALL;
        bool is_hand = i % WIDTH < hand && i / WIDTH >= Y0 + 10 && i / WIDTH < Y1 - 10;
        depth[i] = is_hand ? BOX - 0.03f : depth[i];
    }
    return see();
}

static void stand(void)
{
    const rlf_reconstruct_def def = see_size(WIDTH, HEIGHT);
    start_seeing(&def);
    for (int k = 0; k < STILL; k++) {
        assert_int_equal(show(0, 0.0f, 0)->foreground_count, 0);
    }
}

/* Share of the box that is foreground, and of its pixels that still have a background there. */
static double share_of(const rlf_surface *s, int x, bool is_background)
{
    int count = 0, all = 0;
    for (int i = 0; i < COUNT; i++) {
        if (is_box(i, x)) {
            all++;
            bool stands = s->background_depth[i] > 0.0f && s->background_depth[i] < 1.7f;
            count += is_background ? stands : s->foreground[i] != 0;
        }
    }
    return (double)count / all;
}

TEST_CASE(what_goes_aside_is_foreground_whole)
{
    stand();
    const rlf_surface *s = NULL;
    for (int k = 1; k <= 6; k++) {
        s = show(k, 0.0f, 0);
    }
    assert_true(share_of(s, 6, false) > 0.9);
    assert_true(share_of(s, 6, true) < 0.1);
}

TEST_CASE(what_comes_nearer_leaves_nothing_behind_it)
{
    stand();
    const rlf_surface *s = NULL;
    for (int k = 1; k <= 10; k++) {
        s = show(0, 0.004f * (float)k, 0);
    }
    assert_true(share_of(s, 0, false) > 0.9);
    assert_true(share_of(s, 0, true) < 0.1);
}

TEST_CASE(what_is_touched_stays_background)
{
    stand();
    const rlf_surface *s = NULL;
    for (int k = 1; k <= 30; k++) {
        s = show(0, 0.0f, 2 * k + 10);
    }
    assert_true(share_of(s, 0, true) > 0.9);
}

/* Half the side of a plate, which is turned in the image, and its distance. */
static const double half = 18.0, turned = 0.35, plate = 1.4;

/* The plate, moved by a part of a pixel; with the rig's noise. */
static const rlf_surface *show_plate(double x, analytic_random *random)
{
    const double c = rlf_cos(turned), n = rlf_sin(turned);
    for (int i = 0; i < COUNT; i++) {
        const double u = i % WIDTH - 70.0 - x, v = i / WIDTH - 60.0;
        const double a = c * u + n * v, b = c * v - n * u;
        const double z = a < half && a > -half && b < half && b > -half ? plate : (double)WALL;
        const double sigma = rlf_depth_noise_sigma(&rig.noise, z);
        depth[i] = (float)(z + sigma * random_normal(random));
    }
    return see();
}

/* Along the image, by a tenth of a pixel per frame: less than any frame's noise. */
TEST_CASE(what_creeps_has_its_velocity)
{
    const rlf_reconstruct_def def = see_size(WIDTH, HEIGHT);
    start_seeing(&def);
    analytic_random random = {7};
    const double speed = 0.1 * 30.0 * plate / rig.depth.fx;
    int told = -1;
    for (int k = 0; k < 300;
         k++) { /* for most of that it stands, and nothing else does otherwise */
        const double way = k < 240 ? 0.0 : 0.1 * (k - 240);
        const rlf_surface *s = show_plate(way, &random);
        assert_true(k >= 240 || s->foreground_count == 0);
        told = told < 0 && s->foreground_count > 900 ? k : told;
        if (k >= 275) {
            assert_int_equal(s->regions[s->region_count - 1].layer, RLF_LAYER_FOREGROUND);
            const rlf_vec3 v = s->regions[s->region_count - 1].linear_velocity;
            assert_true(rlf_length(rlf_sub(v, rlf_vec3_make(speed, 0, 0))) < 0.3 * speed);
        }
    }
    print_message("at %.0f mm/s: told after %d frames\n", 1e3 * speed, told - 240);
    assert_in_range(told, 240, 270);
}

TEST_EACH(NULL, stop_seeing)
